// SPDX-License-Identifier: MIT
// A picture of a surface.
#include "render/picture.h"

#include <algorithm>
#include <atomic>
#include <cmath>

#include "render/lamp_light.h"
#include "render/look.h"
#include "render/threads.h"

namespace quickses::render {
namespace {

using glm::vec3;

constexpr int kBandRows = 64;  // of samples that are drawn together, in whole pixels
static_assert(kBandRows >= kMostSamples, "a band is a pixel high at least");
constexpr size_t kMostBandBytes = size_t(256) << 20;  // of all threads, but for the first
constexpr int64_t kSubpixels = 256;
constexpr uint32_t kNothing = ~uint32_t(0);

// Of a vertex: whole numbers, so that what is inside of a triangle is told exactly, and neighbours leave no gap.
struct Place {
  int64_t x, y;
  float z;
};

int64_t cross(const Place &a, const Place &b, int64_t x, int64_t y) {
  return (b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x);
}

float smooth_step(float low, float high, float v) {
  const float t = std::clamp((v - low) / (high - low), 0.f, 1.f);
  return t * t * (3 - 2 * t);
}

// What is seen in some rows of samples.
struct Band {
  int first = 0, end = 0;  // rows
  std::vector<float> depth;
  std::vector<uint32_t> triangle;  // of the front
};

class Painter {
 public:
  Painter(const io::MeshView &mesh, const Camera &camera, vec3 middle, const PictureSettings &settings)
      : mesh_(mesh),
        settings_(settings),
        columns_(settings.width * settings.samples),
        rows_(settings.height * settings.samples),
        band_height_(kBandRows / settings.samples) {
    for (size_t byte = 0; byte < pigments_.size(); ++byte) pigments_[byte] = pigment_of(static_cast<uint8_t>(byte));
    turn(camera, middle);
    lamp_ = glm::normalize(kLamp);
    lamp_light_ = lamp_light(seen_, lamp_, settings.threads);
    place(camera);
    sort_into_bands();
  }

  Image paint() const {
    Image image{settings_.width, settings_.height, std::vector<uint8_t>(4 * pixel(0, settings_.height))};
    std::atomic<int> next{0};
    const size_t in_band = static_cast<size_t>(end_row(0) - first_row(0)) * static_cast<size_t>(columns_);
    const size_t affordable = kMostBandBytes / (in_band * (sizeof(float) + sizeof(uint32_t)));
    run_on_threads(static_cast<unsigned>(std::clamp<size_t>(affordable, 1, settings_.threads)), [&] {
      Band band;
      for (int k; (k = next++) < band_count();) {
        draw_band(k, band);
        const int end = std::min(settings_.height, (k + 1) * band_height_);
        for (int y = k * band_height_; y < end; ++y)
          for (int x = 0; x < settings_.width; ++x) resolve(band, x, y, &image.rgba[4 * pixel(x, y)]);
      }
    });
    return image;
  }

 private:
  size_t pixel(int x, int y) const {
    return static_cast<size_t>(y) * static_cast<size_t>(settings_.width) + static_cast<size_t>(x);
  }
  int band_count() const { return (settings_.height + band_height_ - 1) / band_height_; }
  // With a pixel above and below, for the outlines.
  int first_row(int band) const { return std::max(0, (band * band_height_ - 1) * settings_.samples); }
  int end_row(int band) const { return std::min(rows_, ((band + 1) * band_height_ + 1) * settings_.samples); }

  void turn(const Camera &camera, vec3 middle) {
    const auto turned = [&](vec3 p) {
      return vec3(glm::dot(p, camera.right), glm::dot(p, camera.up), glm::dot(p, camera.toward));
    };
    seen_.positions.resize(mesh_.vertex_count), seen_.normals.resize(mesh_.vertex_count);
    for (size_t v = 0; v < mesh_.vertex_count; ++v) {
      const float *p = mesh_.positions + 3 * v, *n = mesh_.normals + 3 * v;
      seen_.positions[v] = turned(vec3(p[0], p[1], p[2]) - middle);
      seen_.normals[v] = turned({n[0], n[1], n[2]});
    }
    seen_.indices = mesh_.indices;
    seen_.index_count = 3 * size_t(mesh_.triangle_count);
  }

  void place(const Camera &camera) {
    const glm::vec2 size(columns_, rows_);
    const float scale = camera.pixels_per_angstrom(size);
    places_.resize(mesh_.vertex_count);
    for (size_t v = 0; v < places_.size(); ++v) {
      const vec3 p = seen_.positions[v];
      const float k = scale * camera.distance / std::max(camera.distance - p.z, 0.1f * camera.distance);
      const auto units = [](float pixels) { return static_cast<int64_t>(std::llround(pixels * kSubpixels)); };
      places_[v] = {units(0.5f * size.x + k * p.x), units(0.5f * size.y - k * p.y), p.z};
    }
  }

  // The samples, of n, whose middle is between two places.
  static std::pair<int, int> samples_between(int64_t low, int64_t high, int n) {
    const int64_t first = (low + kSubpixels / 2) / kSubpixels, end = (high - kSubpixels / 2) / kSubpixels + 1;
    return {static_cast<int>(std::clamp<int64_t>(first, 0, n)), static_cast<int>(std::clamp<int64_t>(end, 0, n))};
  }
  std::pair<int, int> rows_of(size_t t) const {
    const auto [low, high] = std::minmax({places_[corner(t, 0)].y, places_[corner(t, 1)].y, places_[corner(t, 2)].y});
    return samples_between(low, high, rows_);
  }
  uint32_t corner(size_t t, size_t k) const { return mesh_.indices[3 * t + k]; }

  // y goes down, so what faces the eye goes round clockwise: backwards.
  int64_t area_of(size_t t) const {
    const Place &c = places_[corner(t, 2)];
    return -cross(places_[corner(t, 0)], places_[corner(t, 1)], c.x, c.y);
  }

  // Which triangles are in which band, one band after the other.
  void sort_into_bands() {
    const auto for_each_band = [&](size_t t, const auto &action) {
      const auto [low, high] = rows_of(t);
      if (low >= high || area_of(t) <= 0) return;
      const int in_band = band_height_ * settings_.samples;
      const int last = std::min(band_count() - 1, (high - 1 + settings_.samples) / in_band);
      for (int band = std::max(0, (low - settings_.samples) / in_band); band <= last; ++band)
        action(static_cast<size_t>(band));
    };
    starts_.assign(static_cast<size_t>(band_count()) + 1, 0);
    for (size_t t = 0; t < mesh_.triangle_count; ++t) for_each_band(t, [&](size_t band) { ++starts_[band + 1]; });
    for (size_t k = 1; k < starts_.size(); ++k) starts_[k] += starts_[k - 1];
    sorted_.resize(starts_.back());
    std::vector<size_t> ends(starts_.begin(), starts_.end() - 1);
    for (size_t t = 0; t < mesh_.triangle_count; ++t)
      for_each_band(t, [&](size_t band) { sorted_[ends[band]++] = static_cast<uint32_t>(t); });
  }

  size_t sample(const Band &band, int x, int y) const {
    return static_cast<size_t>(y - band.first) * static_cast<size_t>(columns_) + static_cast<size_t>(x);
  }

  // How much of each corner there is in a sample.
  vec3 weights_of(size_t t, int x, int y) const {
    const Place &a = places_[corner(t, 0)], &b = places_[corner(t, 1)], &c = places_[corner(t, 2)];
    const int64_t px = x * kSubpixels + kSubpixels / 2, py = y * kSubpixels + kSubpixels / 2;
    return vec3(static_cast<float>(-cross(b, c, px, py)), static_cast<float>(-cross(c, a, px, py)),
                static_cast<float>(-cross(a, b, px, py))) /
           static_cast<float>(area_of(t));
  }

  void draw_band(int number, Band &band) const {
    band.first = first_row(number), band.end = end_row(number);
    const size_t size = static_cast<size_t>(band.end - band.first) * static_cast<size_t>(columns_);
    band.depth.assign(size, -1e30f);
    band.triangle.assign(size, uint32_t(kNothing));
    for (size_t k = starts_[static_cast<size_t>(number)]; k < starts_[static_cast<size_t>(number) + 1]; ++k)
      draw_triangle(sorted_[k], band);
  }

  void draw_triangle(uint32_t t, Band &band) const {
    const Place &a = places_[corner(t, 0)], &b = places_[corner(t, 1)], &c = places_[corner(t, 2)];
    const auto [low, high] = std::minmax({a.x, b.x, c.x});
    const auto [x0, x1] = samples_between(low, high, columns_);
    const auto [row0, row1] = rows_of(t);
    const float area = static_cast<float>(area_of(t));
    // What is beside each side changes by the same from sample to sample.
    const int64_t step_a = (c.y - b.y) * kSubpixels, step_b = (a.y - c.y) * kSubpixels,
                  step_c = (b.y - a.y) * kSubpixels;
    const int64_t px = x0 * kSubpixels + kSubpixels / 2;
    for (int y = std::max(row0, band.first); y < std::min(row1, band.end); ++y) {
      const int64_t py = y * kSubpixels + kSubpixels / 2;
      int64_t wa = -cross(b, c, px, py), wb = -cross(c, a, px, py), wc = -cross(a, b, px, py);
      size_t at = sample(band, x0, y);
      for (int x = x0; x < x1; ++x, ++at, wa += step_a, wb += step_b, wc += step_c) {
        if ((wa | wb | wc) < 0) continue;
        const float z =
            (static_cast<float>(wa) * a.z + static_cast<float>(wb) * b.z + static_cast<float>(wc) * c.z) / area;
        if (z <= band.depth[at]) continue;
        band.depth[at] = z;
        band.triangle[at] = t;
      }
    }
  }

  vec3 color_of(uint32_t vertex) const {
    if (!mesh_.colors) return vec3(pigments_[kGrey]);
    const uint8_t *rgb = mesh_.colors + 4 * size_t(vertex);
    return {pigments_[rgb[0]], pigments_[rgb[1]], pigments_[rgb[2]]};
  }

  // The colour of a sample, linear.
  vec3 shade(const Band &band, int x, int y) const {
    const uint32_t t = band.triangle[sample(band, x, y)];
    const vec3 weights = weights_of(t, x, y);
    vec3 normal(0), color(0);
    float open = 0, lamp = 0;
    for (int k = 0; k < 3; ++k) {
      const uint32_t vertex = corner(t, static_cast<size_t>(k));
      normal += seen_.normals[vertex] * weights[k];
      color += color_of(vertex) * weights[k];
      open += (mesh_.occlusion ? mesh_.occlusion[vertex] : 1) * weights[k];
      lamp += lamp_light_[vertex] * weights[k];
    }
    normal *= 1 / std::sqrt(std::max(glm::dot(normal, normal), 1e-20f));
    color = look(color, normal, lamp_, open, lamp);
    if (settings_.edges) color *= 1 - 0.62f * edge_line(t, weights);
    return color * (1 - 0.55f * outline(band, x, y));
  }

  // 1 on the sides of the triangle, 0 beyond a line's width.
  float edge_line(size_t t, vec3 weights) const {
    float nearest = 1e30f;
    for (size_t k = 0; k < 3; ++k) {
      const Place &a = places_[corner(t, (k + 1) % 3)], &b = places_[corner(t, (k + 2) % 3)];
      const float length = std::hypot(static_cast<float>(b.x - a.x), static_cast<float>(b.y - a.y));
      nearest = std::min(nearest, static_cast<float>(area_of(t)) * weights[static_cast<int>(k)] / length);
    }
    const float width = 0.55f * static_cast<float>(settings_.samples * kSubpixels);
    return 1 - smooth_step(0.6f * width, 1.2f * width, nearest);
  }

  // How far the surface falls off beside the sample, 0 to 1.
  float outline(const Band &band, int x, int y) const {
    constexpr float kLow = 1.5f, kHigh = 9;  // Å
    constexpr float kDiagonal = 0.70710678f;
    const float step = 0.9f * static_cast<float>(settings_.samples), here = band.depth[sample(band, x, y)];
    const int straight = static_cast<int>(std::lround(step)), slanted = static_cast<int>(std::lround(step * kDiagonal));
    float fall = 0;
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx) {
        const int length = dx != 0 && dy != 0 ? slanted : straight;
        const int sx = x + dx * length, sy = y + dy * length;
        if (sx < 0 || sy < band.first || sx >= columns_ || sy >= band.end) continue;
        const size_t beside = sample(band, sx, sy);
        if (band.triangle[beside] != kNothing) fall += smooth_step(kLow, kHigh, here - band.depth[beside]);
      }
    return std::min(1.f, fall / 4);
  }

  // Samples of the same triangle in a pixel are shaded once, if there are no lines across them.
  void resolve(const Band &band, int x, int y, uint8_t *rgba) const {
    const int n = settings_.samples;
    struct Sample {
      uint32_t triangle;
      int x, y;
    };
    std::array<Sample, kMostSamples * kMostSamples> samples;
    int covered = 0;
    for (int sy = y * n; sy < (y + 1) * n; ++sy)
      for (int sx = x * n; sx < (x + 1) * n; ++sx) {
        const uint32_t t = band.triangle[sample(band, sx, sy)];
        if (t != kNothing) samples[static_cast<size_t>(covered++)] = {t, sx, sy};
      }
    const auto begin = samples.begin(), end = begin + covered;
    // By insertion: there are few, and mostly they are in order.
    for (auto at = begin; at != end; ++at)
      std::rotate(
          std::upper_bound(begin, at, *at, [](const Sample &a, const Sample &b) { return a.triangle < b.triangle; }),
          at, at + 1);
    vec3 sum(0);
    for (auto first = begin; first != end;) {
      auto last = first + 1;
      while (!settings_.edges && last != end && last->triangle == first->triangle) ++last;
      const bool is_whole = last - first == n * n;  // then the middle is not half way: rows begin at the left
      const Sample &middle = *(first + (is_whole ? (n + 1) * (n / 2) : (last - first) / 2));
      sum += srgb_of(shade(band, middle.x, middle.y)) * static_cast<float>(last - first);
      first = last;
    }
    const auto byte = [](float v) { return static_cast<uint8_t>(std::clamp(v, 0.f, 255.f) + 0.5f); };
    const auto all = static_cast<float>(n * n);
    if (settings_.background) {
      const float free = static_cast<float>(n * n - covered);
      for (int k = 0; k < 3; ++k)
        rgba[k] = byte((255 * sum[k] + free * (*settings_.background)[static_cast<size_t>(k)]) / all);
      rgba[3] = 255;
    } else if (covered != 0) {
      for (int k = 0; k < 3; ++k) rgba[k] = byte(255 * sum[k] / static_cast<float>(covered));
      rgba[3] = byte(255 * static_cast<float>(covered) / all);
    }
  }

  const io::MeshView &mesh_;
  const PictureSettings &settings_;
  const int columns_, rows_;  // of samples
  const int band_height_;     // pixels
  std::array<float, 256> pigments_;
  SeenMesh seen_;
  vec3 lamp_;
  std::vector<float> lamp_light_;
  std::vector<Place> places_;
  std::vector<size_t> starts_;    // of the bands in sorted_
  std::vector<uint32_t> sorted_;  // triangles
};

}  // namespace

Image draw(const io::MeshView &mesh, const Camera &camera, vec3 middle, const PictureSettings &settings) {
  return Painter(mesh, camera, middle, settings).paint();
}

}  // namespace quickses::render
