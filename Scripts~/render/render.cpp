// SPDX-License-Identifier: MIT
// Draws a mesh that quickses wrote (PLY) as a PNG picture, without a GPU: z-buffer, supersampling, light from all sides
// and from one lamp with soft shadows. The pictures of the documentation are made with it.
//   g++ -O3 -std=c++17 -pthread Scripts~/render/render.cpp -lz -o .build/render
//   .build/render MESH.ply STRUCTURE.pdb PICTURE.png [--color chain|element|RRGGBB] [--run N] [--size WxH]
//                 [--up X,Y,Z] [--turn SPIN,NOD] [--zoom F] [--shift X,Y] [--edges] [--samples N]
#include "image.h"
#include "occlusion.h"
#include "scene.h"

#include <cstdio>

namespace render {
namespace {

struct Options {
  std::string mesh, structure, picture, color = "d3cdc2";
  int width = 900, height = 700, samples = 4;  // samples along one side of a pixel
  size_t run = 1;
  Vec up = {0, 1, 0};      // the direction of the structure that points upward
  float turn[2] = {0, 0};  // degrees: about the vertical, then towards the eye
  float zoom = 1, shift[2] = {0, 0};
  bool edges = false;
};

// Ends of the triangles seen in each sample.
class Canvas {
 public:
  static constexpr uint32_t kNothing = ~uint32_t(0);

  Canvas(int width, int height)
      : width_(width), height_(height), depth_(size(), -1e30f), triangle_(size(), uint32_t(kNothing)) {}

  int width() const { return width_; }
  int height() const { return height_; }
  uint32_t triangle(int x, int y) const { return triangle_[place(x, y)]; }
  float depth(int x, int y) const { return depth_[place(x, y)]; }

  // Each thread draws all triangles into a band of rows of its own.
  void draw(const std::vector<Vec> &screen, const std::vector<uint32_t> &indices) {
    const int bands = 32;
    std::atomic<int> next{0};
    run_threads([&] {
      for (int band; (band = next++) < bands;)
        draw_band(screen, indices, band * height_ / bands, (band + 1) * height_ / bands);
    });
  }

 private:
  size_t size() const { return static_cast<size_t>(width_) * static_cast<size_t>(height_); }
  size_t place(int x, int y) const {
    return static_cast<size_t>(y) * static_cast<size_t>(width_) + static_cast<size_t>(x);
  }

  void draw_band(const std::vector<Vec> &screen, const std::vector<uint32_t> &indices, int first, int last) {
    for (size_t t = 0; t < indices.size(); t += 3) {
      const Vec a = screen[indices[t]], b = screen[indices[t + 1]], c = screen[indices[t + 2]];
      const float low = std::min({a.y, b.y, c.y}), high = std::max({a.y, b.y, c.y});
      if (high < static_cast<float>(first) || low > static_cast<float>(last)) continue;
      const float area = (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y);
      if (area >= 0) continue;  // y goes down: counter-clockwise is negative
      const int y0 = std::max(first, static_cast<int>(low)), y1 = std::min(last - 1, static_cast<int>(high));
      const int x0 = std::max(0, static_cast<int>(std::min({a.x, b.x, c.x})));
      const int x1 = std::min(width_ - 1, static_cast<int>(std::max({a.x, b.x, c.x})));
      for (int y = y0; y <= y1; ++y)
        for (int x = x0; x <= x1; ++x) {
          const float px = static_cast<float>(x) + 0.5f, py = static_cast<float>(y) + 0.5f;
          const float wb = ((px - a.x) * (c.y - a.y) - (c.x - a.x) * (py - a.y)) / area;
          const float wc = ((b.x - a.x) * (py - a.y) - (px - a.x) * (b.y - a.y)) / area;
          if (wb < 0 || wc < 0 || wb + wc > 1) continue;
          const float z = a.z + wb * (b.z - a.z) + wc * (c.z - a.z);
          if (z <= depth_[place(x, y)]) continue;
          depth_[place(x, y)] = z;
          triangle_[place(x, y)] = static_cast<uint32_t>(t);
        }
    }
  }

  int width_, height_;
  std::vector<float> depth_;
  std::vector<uint32_t> triangle_;
};

// Turns mesh and atoms so that the eye looks along -z and y points upward.
void turn(Mesh &mesh, std::vector<Atom> &atoms, const Options &o) {
  const float degree = 0.01745329f, c = std::cos(o.turn[0] * degree), s = std::sin(o.turn[0] * degree);
  const float d = std::cos(o.turn[1] * degree), t = std::sin(o.turn[1] * degree);
  const Frame frame = frame_of(unit(o.up));
  const auto turned = [&](Vec p) {
    const Vec q{dot(p, frame.right), dot(p, frame.toward), -dot(p, frame.up)};
    const Vec r{c * q.x + s * q.z, q.y, c * q.z - s * q.x};
    return Vec{r.x, d * r.y - t * r.z, t * r.y + d * r.z};
  };
  Vec low{1e30f, 1e30f, 1e30f}, high{-1e30f, -1e30f, -1e30f};
  for (Vec &p : mesh.positions) {
    p = turned(p - mesh.center);
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
  }
  for (Vec &n : mesh.normals) n = turned(n);
  for (Atom &atom : atoms) atom.center = turned(atom.center - mesh.center);
  mesh.center = (low + high) * 0.5f;
}

float smooth_step(float low, float high, float v) {
  const float t = std::clamp((v - low) / (high - low), 0.f, 1.f);
  return t * t * (3 - 2 * t);
}

class Renderer {
 public:
  Renderer(const Mesh &mesh, const std::vector<Atom> &atoms, const Options &options)
      : mesh_(mesh),
        atoms_(atoms),
        colors_(color_atoms(atoms, options.color, options.run)),
        options_(options),
        canvas_(options.width * options.samples, options.height * options.samples) {}

  Image render() {
    lamp_ = unit(Vec{-0.45f, 0.62f, 0.64f});
    sky_light_ = find_light(mesh_, directions_about({0, 0, 1}, -1.f, 256), true);
    lamp_light_ = find_light(mesh_, directions_about(lamp_, std::cos(0.13f), 48), false);
    place_camera();
    canvas_.draw(screen_, mesh_.indices);
    Image image{options_.width, options_.height,
                std::vector<uint8_t>(4 * static_cast<size_t>(options_.width) * static_cast<size_t>(options_.height))};
    std::atomic<int> next{0};
    run_threads([&] {
      for (int y; (y = next++) < image.height;)
        for (int x = 0; x < image.width; ++x)
          resolve(
              x, y,
              &image.rgba[4 * (static_cast<size_t>(y) * static_cast<size_t>(image.width) + static_cast<size_t>(x))]);
    });
    return image;
  }

 private:
  // Perspective from afar. Depths on the screen stay in Å along the line of sight.
  void place_camera() {
    const float w = static_cast<float>(canvas_.width()), h = static_cast<float>(canvas_.height());
    float wide = 0, tall = 0;
    const float distance = 6.f * mesh_.radius;
    screen_.resize(mesh_.positions.size());
    for (size_t v = 0; v < screen_.size(); ++v) {
      const Vec p = mesh_.positions[v] - mesh_.center;
      const float k = distance / (distance - p.z);
      screen_[v] = {p.x * k, p.y * k, p.z};
      wide = std::max(wide, std::fabs(p.x * k)), tall = std::max(tall, std::fabs(p.y * k));
    }
    scale_ = options_.zoom * 0.485f * std::min(w / wide, h / tall);
    for (Vec &p : screen_)
      p = {(0.5f + options_.shift[0]) * w + scale_ * p.x, (0.5f + options_.shift[1]) * h - scale_ * p.y, p.z};
  }

  // The color of one sample, linear.
  Vec shade(int x, int y) const {
    const uint32_t t = canvas_.triangle(x, y);
    const uint32_t *corner = &mesh_.indices[t];
    const Vec a = screen_[corner[0]], b = screen_[corner[1]], c = screen_[corner[2]];
    const float px = static_cast<float>(x) + 0.5f, py = static_cast<float>(y) + 0.5f;
    const float area = (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y);
    float w[3];
    w[1] = ((px - a.x) * (c.y - a.y) - (c.x - a.x) * (py - a.y)) / area;
    w[2] = ((b.x - a.x) * (py - a.y) - (px - a.x) * (b.y - a.y)) / area;
    w[0] = 1 - w[1] - w[2];
    Vec normal, place;
    float sky = 0, lamp = 0;
    for (int k = 0; k < 3; ++k) {
      normal = normal + mesh_.normals[corner[k]] * w[k];
      place = place + mesh_.positions[corner[k]] * w[k];
      sky += w[k] * sky_light_[corner[k]];
      lamp += w[k] * lamp_light_[corner[k]];
    }
    normal = unit(normal);
    // The colour of the corners' owner whose surface is nearest: sharp borders, whatever the size of the triangles.
    size_t owner = 0;
    float depth = -1e30f;
    for (int k = 0; k < 3; ++k) {
      const size_t i = static_cast<size_t>(mesh_.owners[corner[k]]);
      const Vec offset = place - atoms_[i].center;
      const float own = atoms_[i].radius - std::sqrt(dot(offset, offset));
      if (own > depth) depth = own, owner = i;
    }
    const Vec albedo = colors_[owner];
    const Vec half = unit(lamp_ + Vec{0, 0, 1});
    const float facing = std::max(0.f, normal.z), lit = lamp * std::max(0.f, dot(normal, lamp_));
    const float up = 0.5f + 0.5f * normal.y;
    const Vec sky_color = Vec{0.78f, 0.74f, 0.72f} * (1 - up) + Vec{0.92f, 0.97f, 1.05f} * up;
    const float depth_of_sky = std::pow(sky, 1.15f);
    Vec color = albedo * (sky_color * (0.82f * depth_of_sky) + Vec{1.02f, 0.98f, 0.92f} * (0.78f * lit));
    const float shine =
        0.05f * lamp * std::pow(std::max(0.f, dot(normal, half)), 28.f) + 0.05f * sky * std::pow(1 - facing, 4.f);
    color = color + Vec{1, 1, 1} * shine;
    if (options_.edges) color = color * (1 - 0.62f * edge_line(a, b, c, area, w));
    return color * (1 - 0.55f * outline(x, y));
  }

  // 1 on the sides of the triangle, 0 beyond a line's width.
  float edge_line(Vec a, Vec b, Vec c, float area, const float *w) const {
    const auto length = [](Vec p, Vec q) { return std::hypot(p.x - q.x, p.y - q.y); };
    const float nearest = std::fabs(area) * std::min({w[0] / length(b, c), w[1] / length(c, a), w[2] / length(a, b)});
    const float width = 0.55f * static_cast<float>(options_.samples);
    return 1 - smooth_step(0.6f * width, 1.2f * width, nearest);
  }

  // How sharply the surface falls off beside the sample, 0 to 1.
  float outline(int x, int y) const {
    const float step = 0.9f * static_cast<float>(options_.samples), here = canvas_.depth(x, y);
    float fall = 0;
    for (int k = 0; k < 8; ++k) {
      const int sx = x + static_cast<int>(std::lround(step * std::cos(0.785398f * static_cast<float>(k))));
      const int sy = y + static_cast<int>(std::lround(step * std::sin(0.785398f * static_cast<float>(k))));
      if (sx < 0 || sy < 0 || sx >= canvas_.width() || sy >= canvas_.height()) continue;
      if (canvas_.triangle(sx, sy) == Canvas::kNothing) continue;
      fall += smooth_step(1.5f, 9.f, here - canvas_.depth(sx, sy));
    }
    return std::min(1.f, fall / 4);
  }

  void resolve(int x, int y, uint8_t *rgba) const {
    const int n = options_.samples;
    Vec sum;
    int covered = 0;
    for (int sy = y * n; sy < (y + 1) * n; ++sy)
      for (int sx = x * n; sx < (x + 1) * n; ++sx) {
        if (canvas_.triangle(sx, sy) == Canvas::kNothing) continue;
        const Vec c = shade(sx, sy);
        sum = sum + Vec{tone(c.x), tone(c.y), tone(c.z)};
        ++covered;
      }
    if (covered == 0) return;
    // In steps of 3: the file is half as large, and nobody sees it.
    const float each = 85.f / static_cast<float>(covered);
    rgba[0] = static_cast<uint8_t>(3 * static_cast<int>(sum.x * each + 0.5f));
    rgba[1] = static_cast<uint8_t>(3 * static_cast<int>(sum.y * each + 0.5f));
    rgba[2] = static_cast<uint8_t>(3 * static_cast<int>(sum.z * each + 0.5f));
    rgba[3] = static_cast<uint8_t>(255 * covered / (n * n));
  }

  // Linear light to sRGB, highlights rolled off.
  static float tone(float v) {
    v = std::max(0.f, v);
    v = v < 0.6f ? v : 0.6f + 0.4f * (1 - std::exp(-(v - 0.6f) / 0.4f));
    return v <= 0.0031308f ? 12.92f * v : 1.055f * std::pow(v, 1 / 2.4f) - 0.055f;
  }

  const Mesh &mesh_;
  const std::vector<Atom> &atoms_;
  std::vector<Vec> colors_;  // of the atoms
  Options options_;
  Canvas canvas_;
  Vec lamp_;
  std::vector<float> sky_light_, lamp_light_;
  std::vector<Vec> screen_;
  float scale_ = 1;
};

Options parse(int argc, char **argv) {
  Options o;
  std::vector<std::string> names;
  for (int k = 1; k < argc; ++k) {
    const std::string flag = argv[k];
    if (flag == "--edges") {
      o.edges = true;
      continue;
    }
    if (flag.rfind("--", 0) != 0) {
      names.push_back(flag);
      continue;
    }
    if (++k == argc) throw std::runtime_error(flag + " needs a value");
    const char *value = argv[k];
    bool good = true;
    if (flag == "--color")
      o.color = value;
    else if (flag == "--run")
      o.run = std::max(1ul, std::stoul(value));
    else if (flag == "--size")
      good = std::sscanf(value, "%dx%d", &o.width, &o.height) == 2 && o.width > 0 && o.height > 0;
    else if (flag == "--turn")
      good = std::sscanf(value, "%f,%f", &o.turn[0], &o.turn[1]) == 2;
    else if (flag == "--up")
      good = std::sscanf(value, "%f,%f,%f", &o.up.x, &o.up.y, &o.up.z) == 3;
    else if (flag == "--shift")
      good = std::sscanf(value, "%f,%f", &o.shift[0], &o.shift[1]) == 2;
    else if (flag == "--zoom")
      good = std::sscanf(value, "%f", &o.zoom) == 1;
    else if (flag == "--samples")
      good = std::sscanf(value, "%d", &o.samples) == 1 && o.samples > 0;
    else
      throw std::runtime_error("unknown option " + flag);
    if (!good) throw std::runtime_error(flag + ": '" + value + "' can't be read");
  }
  if (names.size() != 3)
    throw std::runtime_error("needs a mesh (PLY), its structure (PDB) and the name of a picture (PNG)");
  o.mesh = names[0], o.structure = names[1], o.picture = names[2];
  return o;
}

}  // namespace
}  // namespace render

int main(int argc, char **argv) {
  try {
    const render::Options options = render::parse(argc, argv);
    render::Mesh mesh = render::read_ply(options.mesh);
    std::vector<render::Atom> atoms = render::read_atoms(options.structure);
    for (int32_t owner : mesh.owners)
      if (owner < 0 || static_cast<size_t>(owner) >= atoms.size())
        throw std::runtime_error("the mesh names an atom that '" + options.structure + "' does not have");
    render::turn(mesh, atoms, options);
    render::write_png(options.picture, render::Renderer(mesh, atoms, options).render());
  } catch (const std::exception &error) {
    std::fprintf(stderr, "render: %s\n", error.what());
    return 1;
  }
  return 0;
}
