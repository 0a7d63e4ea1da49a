// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "render/rasterizer.h"

#include <algorithm>
#include <cmath>

#include "common/threads.h"
#include "render/canvas.h"
#include "render/page/vectors.h"
#include "render/projection.h"
#include "render/visibility.h"

namespace segorient::program {
namespace {

using Color = std::array<std::uint8_t, 3>;

constexpr float kAmbient = 0.45F;    // light from everywhere; the rest comes from beside the viewer
constexpr float kLeastSlope = 0.1F;  // discs seen from the edge stay visible
constexpr float kLeastRadius = 0.8F;  // pixels
constexpr float kCutSlack = 0.05F;    // of the radius; closes the gap along the edge
constexpr float kCutRadius = 1.5F;    // pixels; ends of smaller discs are not seen
constexpr int kBand = 32;             // rows that one thread draws at a time
constexpr std::size_t kParts = 32;    // of the splats, which are sorted into bands side by side

Vec normalized(const Vec& v) {
  const float length = std::sqrt(dot(v, v));
  return {v[0] / length, v[1] / length, v[2] / length};
}

Color shade(std::uint32_t rgb, const Vec& normal) {
  static const Vec kLight = normalized({-0.35F, -0.45F, 1.F});
  const float light = kAmbient + (1.F - kAmbient) * std::abs(dot(normal, kLight));
  const auto channel = [&](unsigned shift) {
    return static_cast<std::uint8_t>(std::lround(static_cast<float>(rgb >> shift & 255U) * light));
  };
  return {channel(16), channel(8), channel(0)};
}

// The planes that end a splat, in the picture, relative to its centre.
class Cuts {
 public:
  Cuts(const std::vector<FlatSplat>& flat, const FlatSplat& own, const Splat& splat) {
    if (own.radius < kCutRadius) return;
    for (; size_ < splat.cuts; ++size_) {
      const FlatSplat& other = flat[splat.cutters[size_]];
      Plane& plane = planes_[size_];
      plane.normal = other.normal;
      plane.offset =
          dot(other.normal, {other.center[0] - own.center[0], other.center[1] - own.center[1],
                             other.center[2] - own.center[2]});
      // The splat's own side, whatever the signs of normals are.
      if (plane.offset > 0.F) {
        for (float& v : plane.normal) v = -v;
        plane.offset = -plane.offset;
      }
      plane.offset -= kCutSlack * own.radius;
    }
  }
  bool contain(const Vec& d) const {
    return std::all_of(planes_.begin(), planes_.begin() + static_cast<std::ptrdiff_t>(size_),
                       [&](const Plane& p) { return dot(p.normal, d) >= p.offset; });
  }

 private:
  struct Plane {
    Vec normal;
    float offset = 0.F;
  };
  std::array<Plane, Splat::kMostCutters> planes_;
  std::size_t size_ = 0;
};

// All splats of one view.
class SplatDrawing {
 public:
  SplatDrawing(const Scene& scene, const Projection& projection, const View& view)
      : splats_(scene.splats), threads_(resolveThreads(view.threads)) {
    const auto count = static_cast<std::ptrdiff_t>(splats_.size());
    flat_.resize(splats_.size());
    sides_.resize(splats_.size());
#pragma omp parallel for num_threads(threads_)
    for (std::ptrdiff_t i = 0; i < count; ++i) {
      const Splat& s = splats_[static_cast<std::size_t>(i)];
      FlatSplat& f = flat_[static_cast<std::size_t>(i)];
      f.center = projection.point(s.position);
      f.normal = projection.direction(s.normal);
      if (isWrong(s.side)) f.normal = {-f.normal[0], -f.normal[1], -f.normal[2]};
      if (!std::isfinite(dot(f.normal, f.normal))) f.normal = {0.F, 0.F, 1.F};
      f.radius = std::max(kLeastRadius, s.radius * projection.scale());
      sides_[static_cast<std::size_t>(i)] = firstLook(s, f);
    }
    judgeSides(splats_, flat_, view, projection.scale(), sides_);
  }

  // Band by band: each has one thread, and its splats come in their order.
  void draw(Canvas& canvas) const {
    const auto bands = static_cast<std::size_t>((canvas.height() + kBand - 1) / kBand);
    std::vector<std::vector<std::uint32_t>> members(kParts * bands);
#pragma omp parallel for schedule(dynamic, 1) num_threads(threads_)
    for (std::size_t part = 0; part < kParts; ++part) {
      const std::size_t end = splats_.size() * (part + 1) / kParts;
      for (std::size_t i = splats_.size() * part / kParts; i < end; ++i) {
        if (sides_[i] == Seen::Hidden) continue;
        const FlatSplat& f = flat_[i];
        const auto rows = canvas.rows(f.center[1] - f.radius, f.center[1] + f.radius);
        for (int b = rows.begin / kBand; b * kBand < rows.end; ++b) {
          members[part * bands + static_cast<std::size_t>(b)].push_back(
              static_cast<std::uint32_t>(i));
        }
      }
    }
#pragma omp parallel for schedule(dynamic, 1) num_threads(threads_)
    for (std::size_t b = 0; b < bands; ++b) {
      const int top = static_cast<int>(b) * kBand;
      for (std::size_t part = 0; part < kParts; ++part) {
        for (const std::uint32_t i : members[part * bands + b]) {
          drawOne(i, top, top + kBand, canvas);
        }
      }
    }
  }

 private:
  void drawOne(std::size_t i, int top, int bottom, Canvas& canvas) const {
    const FlatSplat& f = flat_[i];
    const Vec& c = f.center;
    const Vec& n = f.normal;
    const auto color = shade(sides_[i] == Seen::Front ? splats_[i].front : splats_[i].back, n);
    const float nz = std::copysign(std::max(std::abs(n[2]), kLeastSlope), n[2]);
    const float r = f.radius;
    const Cuts cuts(flat_, f, splats_[i]);
    const auto columns = canvas.columns(c[0] - r, c[0] + r);
    const auto rows = canvas.rows(c[1] - r, c[1] + r);
    for (int y = std::max(top, rows.begin); y < std::min(bottom, rows.end); ++y) {
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

  const std::vector<Splat>& splats_;
  int threads_;
  std::vector<FlatSplat> flat_;
  std::vector<Seen> sides_;
};

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

void drawMarker(const Marker& marker, const Projection& projection, Canvas& canvas) {
  const float size = 0.015F * static_cast<float>(std::min(canvas.width(), canvas.height()));
  const Vec c = projection.point(marker.position);
  const auto columns = canvas.columns(c[0] - size, c[0] + size);
  const auto rows = canvas.rows(c[1] - size, c[1] + size);
  for (int y = rows.begin; y < rows.end; ++y) {
    const float dy = std::abs(static_cast<float>(y) + 0.5F - c[1]) / size;
    for (int x = columns.begin; x < columns.end; ++x) {
      const float dx = std::abs(static_cast<float>(x) + 0.5F - c[0]) / size;
      if (marker.kind == Marker::Kind::Sensor) {
        if (dx + dy <= 1.F)
          canvas.cover(x, y, dx + dy > 0.7F ? Color{255, 255, 255} : kSensorColor);
      } else if (const float d = std::hypot(dx, dy); d <= 1.F && d >= 0.7F) {
        canvas.cover(x, y, kWrongColor);
      }
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
  SplatDrawing(scene, projection, large).draw(canvas);
  for (std::size_t i = 0; i < scene.triangles.size(); ++i)
    drawTriangle(scene, i, projection, canvas);
  for (const Marker& m : scene.markers) drawMarker(m, projection, canvas);
  return halved(canvas.picture());
}

}  // namespace segorient::program
