// SPDX-License-Identifier: MIT
// From where a molecule is looked at.
#include "render/camera.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace quickses::render {
namespace {

using glm::dvec3;
using glm::vec3;

constexpr float kDistance = 6;  // of the eye, in radii of the whole

vec3 center_of(const Balls &balls, size_t i) {
  return {balls.centers[3 * i], balls.centers[3 * i + 1], balls.centers[3 * i + 2]};
}

dvec3 mean_of(const Balls &balls) {
  dvec3 sum(0);
  for (size_t i = 0; i < balls.count; ++i) sum += dvec3(center_of(balls, i));
  return sum / static_cast<double>(balls.count);
}

// Eigenvectors of a symmetric matrix by Jacobi's rotations, that of the largest eigenvalue first.
glm::dmat3 eigenvectors(glm::dmat3 m) {
  glm::dmat3 vectors(1);
  for (int sweep = 0; sweep < 32; ++sweep)
    for (const auto &[p, q] : {std::pair(0, 1), std::pair(0, 2), std::pair(1, 2)}) {
      if (m[p][q] == 0) continue;
      const double theta = (m[q][q] - m[p][p]) / (2 * m[p][q]);
      const double t = (theta < 0 ? -1 : 1) / (std::abs(theta) + std::sqrt(theta * theta + 1));
      const double c = 1 / std::sqrt(t * t + 1), s = t * c;
      glm::dmat3 rotation(1);
      rotation[p][p] = rotation[q][q] = c;
      rotation[q][p] = s;
      rotation[p][q] = -s;
      m = glm::transpose(rotation) * m * rotation;
      m[p][q] = m[q][p] = 0;
      vectors = vectors * rotation;
    }
  int order[] = {0, 1, 2};
  std::stable_sort(order, order + 3, [&](int a, int b) { return m[a][a] > m[b][b]; });
  return {vectors[order[0]], vectors[order[1]], vectors[order[2]]};
}

// The longest first. Of the two ways to point, the one of the longer tail, so that a copy looks the same.
glm::dmat3 principal_axes(const Balls &balls) {
  const dvec3 mean = mean_of(balls);
  glm::dmat3 covariance(0);
  for (size_t i = 0; i < balls.count; ++i) {
    const dvec3 d = dvec3(center_of(balls, i)) - mean;
    covariance += glm::outerProduct(d, d);
  }
  glm::dmat3 axes = eigenvectors(covariance);
  for (int k = 0; k < 2; ++k) {
    double skew = 0;
    for (size_t i = 0; i < balls.count; ++i) {
      const double along = glm::dot(dvec3(center_of(balls, i)) - mean, axes[k]);
      skew += along * along * along;
    }
    if (skew < 0) axes[k] = -axes[k];
  }
  axes[2] = glm::cross(axes[0], axes[1]);
  return axes;
}

bool are_parallel(vec3 a, vec3 b) { return glm::length(glm::cross(a, b)) < 1e-3f; }

// How far a ball reaches along one axis of the picture, in the plane through the middle. The eye is far outside of it.
float reach(float across, float near, float radius, float distance) {
  const float depth = distance - near, sine = radius / std::hypot(across, depth);
  return distance * std::tan(std::atan2(std::abs(across), depth) + std::asin(sine));
}

}  // namespace

Camera::Camera(const Balls &atoms, const Balls &seen, const View &view, bool is_tall) : filled_(view.fill * view.zoom) {
  if (view.toward) {
    toward = glm::normalize(*view.toward);
    for (const vec3 vertical : {view.up ? glm::normalize(*view.up) : vec3(0, 0, 1), vec3(0, 0, 1), vec3(0, 1, 0)}) {
      up = vertical;
      if (!are_parallel(up, toward)) break;
    }
  } else {
    const glm::dmat3 axes = principal_axes(atoms);
    toward = axes[2], up = axes[1];
    if (view.up) {
      up = glm::normalize(*view.up);
      if (are_parallel(up, toward)) toward = axes[1];
    } else if (is_tall) {
      toward = -axes[2], up = axes[0];  // the second goes to the right then
    }
  }
  if (view.toward) {
    right = glm::normalize(glm::cross(up, toward));
    up = glm::cross(toward, right);
  } else {
    right = glm::normalize(glm::cross(up, toward));
    toward = glm::cross(right, up);
  }
  const float spin = glm::radians(view.turn[0]), nod = glm::radians(view.turn[1]);
  // The molecule turns, so the eye goes the other way.
  const vec3 spun = toward * std::cos(spin) - right * std::sin(spin);
  right = right * std::cos(spin) + toward * std::sin(spin);
  toward = spun * std::cos(nod) + up * std::sin(nod);
  up = up * std::cos(nod) - spun * std::sin(nod);

  vec3 low(1e30f), high(-1e30f);
  const vec3 mean(mean_of(atoms));
  const auto place = [&](size_t i, vec3 from) {
    const vec3 d = center_of(seen, i) - from;
    return vec3(glm::dot(d, right), glm::dot(d, up), glm::dot(d, toward));
  };
  for (size_t i = 0; i < seen.count; ++i) {
    const vec3 at = place(i, mean), radius(seen.radius(i));
    low = glm::min(low, at - radius), high = glm::max(high, at + radius);
  }
  const vec3 box = (low + high) * 0.5f;
  offset_ = right * box.x + up * box.y + toward * box.z;
  float radius = 1e-3f;
  for (size_t i = 0; i < seen.count; ++i)
    radius = std::max(radius, glm::length(place(i, mean + offset_)) + seen.radius(i));
  distance = kDistance * radius;
  half = glm::vec2(1e-3f);
  for (size_t i = 0; i < seen.count; ++i) {
    const vec3 at = place(i, mean + offset_);
    for (int axis = 0; axis < 2; ++axis)
      half[axis] = std::max(half[axis], reach(at[axis], at.z, seen.radius(i), distance));
  }
}

vec3 Camera::middle(const Balls &atoms) const { return vec3(mean_of(atoms)) + offset_; }

float Camera::pixels_per_angstrom(glm::vec2 size) const {
  return 0.5f * filled_ * std::min(size.x / half.x, size.y / half.y);
}

}  // namespace quickses::render
