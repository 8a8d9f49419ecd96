// SPDX-License-Identifier: MIT
// How much light reaches each vertex: the mesh is drawn as depth maps from many directions, and each vertex asks every
// map whether it is seen from there (the ambient occlusion of QuteMol: Tarini, Cignoni, Montani 2006).
#pragma once

#include <algorithm>
#include <atomic>
#include <mutex>
#include <thread>

#include "scene.h"

namespace render {

template <class Work>
void run_threads(const Work &work) {
  std::vector<std::thread> threads;
  for (unsigned k = 0; k < std::max(1u, std::thread::hardware_concurrency()); ++k) threads.emplace_back(work);
  for (std::thread &thread : threads) thread.join();
}

struct Frame {
  Vec right, up, toward;  // orthonormal; toward points at the eye or the light
};
inline Frame frame_of(Vec toward) {
  const Vec right = unit(cross(std::fabs(toward.y) < 0.9f ? Vec{0, 1, 0} : Vec{1, 0, 0}, toward));
  return {right, cross(toward, right), toward};
}

class DepthMap {
 public:
  explicit DepthMap(int size) : size_(size), depth_(static_cast<size_t>(size) * static_cast<size_t>(size)) {}

  void draw(const Mesh &mesh, const Frame &frame) {
    frame_ = frame;
    scale_ = 0.5f * static_cast<float>(size_) / (1.02f * mesh.radius);
    center_ = mesh.center;
    std::fill(depth_.begin(), depth_.end(), -1e30f);
    screen_.resize(mesh.positions.size());
    for (size_t v = 0; v < screen_.size(); ++v) screen_[v] = project(mesh.positions[v]);
    for (size_t t = 0; t < mesh.indices.size(); t += 3)
      draw_triangle(screen_[mesh.indices[t]], screen_[mesh.indices[t + 1]], screen_[mesh.indices[t + 2]]);
  }

  // The part of the four texels around a point that leave it in the light, 0 to 1.
  float lit(Vec position, float bias) const {
    const Vec p = project(position);
    const float fx = p.x - 0.5f, fy = p.y - 0.5f;
    const int x = std::clamp(static_cast<int>(fx), 0, size_ - 2), y = std::clamp(static_cast<int>(fy), 0, size_ - 2);
    const float u = std::clamp(fx - static_cast<float>(x), 0.f, 1.f),
                v = std::clamp(fy - static_cast<float>(y), 0.f, 1.f);
    const auto see = [&](int dx, int dy) { return at(x + dx, y + dy) <= p.z + bias ? 1.f : 0.f; };
    return (1 - v) * ((1 - u) * see(0, 0) + u * see(1, 0)) + v * ((1 - u) * see(0, 1) + u * see(1, 1));
  }

 private:
  Vec project(Vec p) const {
    const Vec d = p - center_;
    const float half = 0.5f * static_cast<float>(size_);
    return {half + scale_ * dot(d, frame_.right), half + scale_ * dot(d, frame_.up), dot(d, frame_.toward)};
  }
  float at(int x, int y) const {
    return depth_[static_cast<size_t>(y) * static_cast<size_t>(size_) + static_cast<size_t>(x)];
  }

  void draw_triangle(Vec a, Vec b, Vec c) {
    const float area = (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y);
    if (area <= 0) return;  // seen from behind
    const int x0 = std::max(0, static_cast<int>(std::min({a.x, b.x, c.x}))),
              x1 = std::min(size_ - 1, static_cast<int>(std::max({a.x, b.x, c.x})));
    const int y0 = std::max(0, static_cast<int>(std::min({a.y, b.y, c.y}))),
              y1 = std::min(size_ - 1, static_cast<int>(std::max({a.y, b.y, c.y})));
    for (int y = y0; y <= y1; ++y)
      for (int x = x0; x <= x1; ++x) {
        const float px = static_cast<float>(x) + 0.5f, py = static_cast<float>(y) + 0.5f;
        const float wb = ((px - a.x) * (c.y - a.y) - (c.x - a.x) * (py - a.y)) / area;
        const float wc = ((b.x - a.x) * (py - a.y) - (px - a.x) * (b.y - a.y)) / area;
        if (wb < 0 || wc < 0 || wb + wc > 1) continue;
        float &depth = depth_[static_cast<size_t>(y) * static_cast<size_t>(size_) + static_cast<size_t>(x)];
        depth = std::max(depth, a.z + wb * (b.z - a.z) + wc * (c.z - a.z));
      }
  }

  int size_;
  std::vector<float> depth_;
  std::vector<Vec> screen_;
  Frame frame_;
  Vec center_;
  float scale_ = 1;
};

// Per vertex the part of the directions from which it is seen, 0 to 1; weighted by the cosine to the normal if asked
// for. Sums are whole numbers, so that the threads may add in any order.
inline std::vector<float> find_light(const Mesh &mesh, const std::vector<Vec> &directions, bool by_cosine) {
  constexpr float kOne = 65536.f;
  const size_t vertices = mesh.positions.size();
  std::vector<uint32_t> seen(vertices, 0), total(vertices, 0);
  std::atomic<size_t> next{0};
  std::mutex mutex;
  run_threads([&] {
    DepthMap map(std::clamp(static_cast<int>(2 * mesh.radius / 0.25f), 256, 1024));
    const float bias = 0.15f + 2 * mesh.radius / 1024.f;
    std::vector<uint32_t> own_seen(vertices, 0), own_total(vertices, 0);
    for (size_t k; (k = next++) < directions.size();) {
      map.draw(mesh, frame_of(directions[k]));
      for (size_t v = 0; v < vertices; ++v) {
        const float cosine = dot(mesh.normals[v], directions[k]), weight = by_cosine ? std::max(0.f, cosine) : 1.f;
        own_total[v] += static_cast<uint32_t>(kOne * weight);
        if (cosine > 0)
          own_seen[v] +=
              static_cast<uint32_t>(kOne * weight * map.lit(mesh.positions[v] + mesh.normals[v] * 0.35f, bias));
      }
    }
    const std::lock_guard<std::mutex> lock(mutex);
    for (size_t v = 0; v < vertices; ++v) seen[v] += own_seen[v], total[v] += own_total[v];
  });
  std::vector<float> light(vertices);
  for (size_t v = 0; v < vertices; ++v)
    light[v] = total[v] > 0 ? static_cast<float>(seen[v]) / static_cast<float>(total[v]) : 0.f;
  return light;
}

// Evenly spread directions: over the sphere, or over a cone about an axis.
inline std::vector<Vec> directions_about(Vec axis, float cos_angle, int count) {
  const Frame f = frame_of(axis);
  std::vector<Vec> directions;
  for (int k = 0; k < count; ++k) {
    const float z = 1.f - (1.f - cos_angle) * (static_cast<float>(k) + 0.5f) / static_cast<float>(count);
    const float r = std::sqrt(std::max(0.f, 1.f - z * z)), angle = 2.39996323f * static_cast<float>(k);
    directions.push_back(f.right * (r * std::cos(angle)) + f.up * (r * std::sin(angle)) + f.toward * z);
  }
  return directions;
}

}  // namespace render
