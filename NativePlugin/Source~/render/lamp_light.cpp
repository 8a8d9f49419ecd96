// SPDX-License-Identifier: MIT
// Soft shadows of a lamp.
#include "render/lamp_light.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>

#include "render/threads.h"

namespace quickses::render {
namespace {

using glm::vec3;

constexpr int kPoints = 32;           // of the lamp
constexpr float kLampCosine = 0.99f;  // of half the angle that the lamp takes

// How far away a mesh is, from one direction.
class DepthMap {
 public:
  DepthMap(int size, vec3 center, float radius)
      : size_(size),
        center_(center),
        scale_(0.5f * static_cast<float>(size) / (1.02f * radius)),
        depth_(static_cast<size_t>(size) * static_cast<size_t>(size)) {}

  void draw(const SeenMesh &mesh, vec3 toward) {
    toward_ = toward;
    right_ = glm::normalize(glm::cross(vec3(0, 1, 0), toward));
    up_ = glm::cross(toward, right_);
    std::fill(depth_.begin(), depth_.end(), -1e30f);
    places_.resize(mesh.positions.size());
    for (size_t v = 0; v < places_.size(); ++v) places_[v] = place_of(mesh.positions[v]);
    for (size_t t = 0; t < mesh.index_count; t += 3)
      draw_triangle(places_[mesh.indices[t]], places_[mesh.indices[t + 1]], places_[mesh.indices[t + 2]]);
  }

  // The part of the four texels about a point that leave it in the light.
  float lit(vec3 position, float bias) const {
    const vec3 p = place_of(position);
    const float x = p.x - 0.5f, y = p.y - 0.5f;
    const int left = std::clamp(static_cast<int>(x), 0, size_ - 2), low = std::clamp(static_cast<int>(y), 0, size_ - 2);
    const float u = std::clamp(x - static_cast<float>(left), 0.f, 1.f);
    const float v = std::clamp(y - static_cast<float>(low), 0.f, 1.f);
    const auto sees = [&](int dx, int dy) { return depth_[texel(left + dx, low + dy)] <= p.z + bias ? 1.f : 0.f; };
    return (1 - v) * ((1 - u) * sees(0, 0) + u * sees(1, 0)) + v * ((1 - u) * sees(0, 1) + u * sees(1, 1));
  }

 private:
  size_t texel(int x, int y) const {
    return static_cast<size_t>(y) * static_cast<size_t>(size_) + static_cast<size_t>(x);
  }

  vec3 place_of(vec3 p) const {
    const vec3 d = p - center_;
    const float half = 0.5f * static_cast<float>(size_);
    return {half + scale_ * glm::dot(d, right_), half + scale_ * glm::dot(d, up_), glm::dot(d, toward_)};
  }

  void draw_triangle(vec3 a, vec3 b, vec3 c) {
    const vec3 ab = b - a, ac = c - a;
    const float area = ab.x * ac.y - ac.x * ab.y;
    if (area <= 0) return;  // seen from behind
    const vec3 low = glm::max(glm::min(glm::min(a, b), c), 0.f);
    const vec3 high = glm::min(glm::max(glm::max(a, b), c), static_cast<float>(size_ - 1));
    for (int y = static_cast<int>(low.y); y <= static_cast<int>(high.y); ++y)
      for (int x = static_cast<int>(low.x); x <= static_cast<int>(high.x); ++x) {
        const float dx = static_cast<float>(x) + 0.5f - a.x, dy = static_cast<float>(y) + 0.5f - a.y;
        const float wb = (dx * ac.y - ac.x * dy) / area, wc = (ab.x * dy - dx * ab.y) / area;
        if (wb < 0 || wc < 0 || wb + wc > 1) continue;
        float &depth = depth_[texel(x, y)];
        depth = std::max(depth, a.z + wb * ab.z + wc * ac.z);
      }
  }

  const int size_;
  const vec3 center_;
  const float scale_;
  std::vector<float> depth_;
  std::vector<vec3> places_;
  vec3 right_{1, 0, 0}, up_{0, 1, 0}, toward_{0, 0, 1};
};

// Evenly spread over a cap: a spiral with the golden angle.
std::vector<vec3> points_of_lamp(vec3 lamp) {
  const vec3 right = glm::normalize(glm::cross(vec3(0, 1, 0), lamp)), up = glm::cross(lamp, right);
  std::vector<vec3> points;
  for (int k = 0; k < kPoints; ++k) {
    const float z = 1 - (1 - kLampCosine) * (static_cast<float>(k) + 0.5f) / kPoints;
    const float r = std::sqrt(1 - z * z), angle = 2.39996323f * static_cast<float>(k);
    points.push_back(right * (r * std::cos(angle)) + up * (r * std::sin(angle)) + lamp * z);
  }
  return points;
}

}  // namespace

std::vector<float> lamp_light(const SeenMesh &mesh, vec3 lamp, unsigned threads) {
  constexpr float kTexel = 0.25f, kAbove = 0.35f, kBias = 0.15f;  // Å
  constexpr float kOne = 65536;
  vec3 low(1e30f), high(-1e30f);
  for (const vec3 &p : mesh.positions) low = glm::min(low, p), high = glm::max(high, p);
  const vec3 center = (low + high) * 0.5f;
  const float radius = std::max(1e-3f, glm::length(high - center));
  const int size = static_cast<int>(std::clamp(2 * radius / kTexel, 256.f, 1024.f));
  const float bias = kBias + 2 * radius / 1024;
  const std::vector<vec3> points = points_of_lamp(lamp);
  // Whole numbers, so that threads may add in any order.
  std::vector<uint32_t> seen(mesh.positions.size());
  std::atomic<size_t> next{0};
  std::mutex mutex;
  run_on_threads(std::min(threads, static_cast<unsigned>(kPoints)), [&] {
    DepthMap map(size, center, radius);
    std::vector<uint32_t> own(seen.size());
    for (size_t k; (k = next++) < points.size();) {
      map.draw(mesh, points[k]);
      for (size_t v = 0; v < own.size(); ++v)
        if (glm::dot(mesh.normals[v], points[k]) > 0)
          own[v] += static_cast<uint32_t>(kOne * map.lit(mesh.positions[v] + mesh.normals[v] * kAbove, bias));
    }
    const std::lock_guard<std::mutex> lock(mutex);
    for (size_t v = 0; v < own.size(); ++v) seen[v] += own[v];
  });
  std::vector<float> light(seen.size());
  for (size_t v = 0; v < light.size(); ++v) light[v] = static_cast<float>(seen[v]) / (kOne * kPoints);
  return light;
}

}  // namespace quickses::render
