// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "render/rasterizer.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace segorient::program {
namespace {

using Vec = std::array<float, 3>;

constexpr double kMargin = 0.04;     // of the picture, left free on each side
constexpr float kAmbient = 0.45F;    // light from everywhere; the rest comes from beside the viewer
constexpr float kLeastSlope = 0.1F;  // discs seen from the edge stay visible
constexpr double kRadians = 0.017453292519943295;

float dot(const Vec& a, const Vec& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

Vec normalized(const Vec& v) {
  const float length = std::sqrt(dot(v, v));
  return {v[0] / length, v[1] / length, v[2] / length};
}

// World to picture: right, down and towards the viewer, in pixels.
class Projection {
 public:
  Projection(const View& view, const Scene& scene) {
    const double a = view.azimuth * kRadians;
    const double e = view.elevation * kRadians;
    const double ca = std::cos(a), sa = std::sin(a), ce = std::cos(e), se = std::sin(e);
    axes_[0] = {static_cast<float>(-sa), static_cast<float>(ca), 0.F};
    axes_[1] = {static_cast<float>(se * ca), static_cast<float>(se * sa), static_cast<float>(-ce)};
    axes_[2] = {static_cast<float>(ce * ca), static_cast<float>(ce * sa), static_cast<float>(se)};
    fit(view, scene);
  }
  float scale() const { return static_cast<float>(scale_); }
  Vec direction(const Vec& d) const {
    return {dot(axes_[0], d), dot(axes_[1], d), dot(axes_[2], d)};
  }
  Vec point(const Vec& p) const {
    const std::array<double, 3> d = turned(p);
    return {static_cast<float>(d[0] * scale_ + shift_[0]),
            static_cast<float>(d[1] * scale_ + shift_[1]), static_cast<float>(d[2] * scale_)};
  }

 private:
  // In double, as sums of the largest floats overflow.
  std::array<double, 3> turned(const Vec& p) const {
    std::array<double, 3> out{0.0, 0.0, 0.0};
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t a = 0; a < 3; ++a) {
        out[c] += static_cast<double>(axes_[c][a]) * static_cast<double>(p[a]);
      }
    }
    return out;
  }
  void fit(const View& view, const Scene& scene) {
    std::array<double, 2> low;
    std::array<double, 2> high;
    low.fill(std::numeric_limits<double>::max());
    high.fill(std::numeric_limits<double>::lowest());
    const auto extend = [&](const Vec& p) {
      const std::array<double, 3> d = turned(p);
      for (std::size_t c = 0; c < 2; ++c) {
        low[c] = std::min(low[c], d[c]);
        high[c] = std::max(high[c], d[c]);
      }
    };
    for (const Splat& s : scene.splats) extend(s.position);
    for (const Vec& v : scene.vertices) extend(v);
    const std::array<double, 2> room{static_cast<double>(view.width),
                                     static_cast<double>(view.height)};
    scale_ = std::numeric_limits<double>::max();
    for (std::size_t c = 0; c < 2; ++c) {
      const double extent = std::max(1e-30, high[c] - low[c]);
      scale_ = std::min(scale_, room[c] * (1.0 - 2.0 * kMargin) / extent);
    }
    for (std::size_t c = 0; c < 2; ++c) shift_[c] = 0.5 * (room[c] - scale_ * (low[c] + high[c]));
  }

  std::array<Vec, 3> axes_;
  double scale_ = 1.0;
  std::array<double, 2> shift_{0.0, 0.0};
};

class Canvas {
 public:
  Canvas(std::size_t width, std::size_t height)
      : picture_(width, height),
        depth_(width * height, std::numeric_limits<float>::lowest()),
        width_(static_cast<int>(width)),
        height_(static_cast<int>(height)) {}

  // A range of pixels, cut to the picture.
  struct Range {
    int begin;
    int end;
  };
  Range columns(float from, float to) const { return cut(from, to, width_); }
  Range rows(float from, float to) const { return cut(from, to, height_); }

  void put(int x, int y, float depth, const std::array<std::uint8_t, 3>& color) {
    const auto at = static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                    static_cast<std::size_t>(x);
    if (depth <= depth_[at]) return;
    depth_[at] = depth;
    std::copy(color.begin(), color.end(),
              picture_.rgb.begin() + static_cast<std::ptrdiff_t>(3 * at));
  }
  const Picture& picture() const { return picture_; }

 private:
  static Range cut(float from, float to, int end) {
    const auto limit = static_cast<float>(end);
    return {static_cast<int>(std::clamp(std::floor(from), 0.F, limit)),
            static_cast<int>(std::clamp(std::ceil(to) + 1.F, 0.F, limit))};
  }
  Picture picture_;
  std::vector<float> depth_;
  int width_;
  int height_;
};

std::array<std::uint8_t, 3> shade(std::uint32_t rgb, const Vec& normal) {
  static const Vec kLight = normalized({-0.35F, -0.45F, 1.F});
  const float light = kAmbient + (1.F - kAmbient) * std::abs(dot(normal, kLight));
  const auto channel = [&](unsigned shift) {
    return static_cast<std::uint8_t>(static_cast<float>(rgb >> shift & 255U) * light + 0.5F);
  };
  return {channel(16), channel(8), channel(0)};
}

// The half spaces that end a splat, in the picture's frame, relative to its centre.
class Cuts {
 public:
  Cuts(const Scene& scene, const Splat& splat, const Projection& projection) {
    for (std::uint32_t i = 0; i < splat.cuts && i < planes_.size(); ++i) {
      const HalfSpace& cut = scene.cuts[splat.first_cut + i];
      planes_[i].normal = projection.direction(cut.normal);
      planes_[i].offset = (cut.offset - dot(cut.normal, splat.position)) * projection.scale();
      ++size_;
    }
  }
  bool contain(const Vec& d) const {
    return std::all_of(planes_.begin(), planes_.begin() + size_,
                       [&](const HalfSpace& h) { return dot(h.normal, d) >= h.offset; });
  }

 private:
  std::array<HalfSpace, 4> planes_;
  std::ptrdiff_t size_ = 0;
};

void drawSplat(const Scene& scene, const Splat& splat, const Projection& projection,
               Canvas& canvas) {
  const Vec c = projection.point(splat.position);
  Vec n = projection.direction(splat.normal);
  if (!std::isfinite(dot(n, n))) n = {0.F, 0.F, 1.F};
  const bool front = n[2] >= 0.F;
  const auto color = shade(front ? splat.front : splat.back, n);
  const float nz = std::copysign(std::max(std::abs(n[2]), kLeastSlope), front ? 1.F : -1.F);
  const float r = std::max(0.8F, splat.radius * projection.scale());
  const Cuts cuts(scene, splat, projection);
  const auto columns = canvas.columns(c[0] - r, c[0] + r);
  const auto rows = canvas.rows(c[1] - r, c[1] + r);
  for (int y = rows.begin; y < rows.end; ++y) {
    const float dy = static_cast<float>(y) + 0.5F - c[1];
    for (int x = columns.begin; x < columns.end; ++x) {
      const float dx = static_cast<float>(x) + 0.5F - c[0];
      const Vec d{dx, dy, -(n[0] * dx + n[1] * dy) / nz};
      const float d2 = dot(d, d);
      if (d2 > r * r || !cuts.contain(d)) continue;
      // The middle of a disc lies before its rim: neighbouring discs meet half way.
      canvas.put(x, y, c[2] + d[2] - 0.15F * d2 / r, color);
    }
  }
}

void drawTriangle(const Scene& scene, std::size_t i, const Projection& projection, Canvas& canvas) {
  const Triangle& t = scene.triangles[i];
  const Vec a = projection.point(scene.vertices[t[0]]);
  const Vec b = projection.point(scene.vertices[t[1]]);
  const Vec c = projection.point(scene.vertices[t[2]]);
  const Vec u{b[0] - a[0], b[1] - a[1], b[2] - a[2]};
  const Vec v{c[0] - a[0], c[1] - a[1], c[2] - a[2]};
  const Vec cross{u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
  const float area = cross[2];
  if (area == 0.F || !std::isfinite(area)) return;
  // Right, down, towards the viewer is a left-handed frame.
  const bool front = area < 0.F;
  const auto color = shade(front ? scene.front[i] : scene.back[i], normalized(cross));
  const auto columns = canvas.columns(std::min({a[0], b[0], c[0]}), std::max({a[0], b[0], c[0]}));
  const auto rows = canvas.rows(std::min({a[1], b[1], c[1]}), std::max({a[1], b[1], c[1]}));
  for (int y = rows.begin; y < rows.end; ++y) {
    const float py = static_cast<float>(y) + 0.5F - a[1];
    for (int x = columns.begin; x < columns.end; ++x) {
      const float px = static_cast<float>(x) + 0.5F - a[0];
      const float s = (px * v[1] - py * v[0]) / area;
      const float w = (u[0] * py - u[1] * px) / area;
      if (s < 0.F || w < 0.F || s + w > 1.F) continue;
      canvas.put(x, y, a[2] + s * u[2] + w * v[2], color);
    }
  }
}

}  // namespace

Picture drawScene(const Scene& scene, const View& view) {
  // Twice the size and halved: smooth edges.
  View large = view;
  large.width *= 2;
  large.height *= 2;
  const Projection projection(large, scene);
  Canvas canvas(large.width, large.height);
  for (const Splat& s : scene.splats) drawSplat(scene, s, projection, canvas);
  for (std::size_t i = 0; i < scene.triangles.size(); ++i)
    drawTriangle(scene, i, projection, canvas);
  return halved(canvas.picture());
}

}  // namespace segorient::program
