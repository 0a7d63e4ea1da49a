// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "render/projection.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace segorient::program {
namespace {

constexpr double kMargin = 0.04;  // of the picture, left free on each side
constexpr double kRadians = 0.017453292519943295;

float dot(const std::array<float, 3>& a, const std::array<float, 3>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

}  // namespace

Projection::Projection(const View& view, const Scene& scene) {
  const double a = view.azimuth * kRadians;
  const double e = view.elevation * kRadians;
  const double ca = std::cos(a), sa = std::sin(a), ce = std::cos(e), se = std::sin(e);
  axes_[0] = {static_cast<float>(-sa), static_cast<float>(ca), 0.F};
  axes_[1] = {static_cast<float>(se * ca), static_cast<float>(se * sa), static_cast<float>(-ce)};
  axes_[2] = {static_cast<float>(ce * ca), static_cast<float>(ce * sa), static_cast<float>(se)};
  fit(view, scene);
}

std::array<float, 3> Projection::direction(const std::array<float, 3>& d) const {
  return {dot(axes_[0], d), dot(axes_[1], d), dot(axes_[2], d)};
}

std::array<float, 3> Projection::point(const std::array<float, 3>& p) const {
  const std::array<double, 3> d = turned(p);
  return {static_cast<float>(d[0] * scale_ + shift_[0]),
          static_cast<float>(d[1] * scale_ + shift_[1]), static_cast<float>(d[2] * scale_)};
}

std::array<double, 3> Projection::turned(const std::array<float, 3>& p) const {
  std::array<double, 3> out{0.0, 0.0, 0.0};
  for (std::size_t c = 0; c < 3; ++c) {
    for (std::size_t a = 0; a < 3; ++a) {
      out[c] += static_cast<double>(axes_[c][a]) * static_cast<double>(p[a]);
    }
  }
  return out;
}

void Projection::fit(const View& view, const Scene& scene) {
  std::array<double, 2> low;
  std::array<double, 2> high;
  low.fill(std::numeric_limits<double>::max());
  high.fill(std::numeric_limits<double>::lowest());
  const auto extend = [&](const std::array<float, 3>& p) {
    const std::array<double, 3> d = turned(p);
    for (std::size_t c = 0; c < 2; ++c) {
      low[c] = std::min(low[c], d[c]);
      high[c] = std::max(high[c], d[c]);
    }
  };
  for (const Splat& s : scene.splats) extend(s.position);
  for (const auto& v : scene.vertices) extend(v);
  // What lies far off is left outside: the cloud is what the picture is of.
  const std::array<double, 2> near{low[0] - (high[0] - low[0]), low[1] - (high[1] - low[1])};
  const std::array<double, 2> far{high[0] + (high[0] - low[0]), high[1] + (high[1] - low[1])};
  for (const Marker& m : scene.markers) {
    const std::array<double, 3> d = turned(m.position);
    if (d[0] >= near[0] && d[0] <= far[0] && d[1] >= near[1] && d[1] <= far[1]) extend(m.position);
  }
  const std::array<double, 2> room{static_cast<double>(view.width),
                                   static_cast<double>(view.height)};
  scale_ = std::numeric_limits<double>::max();
  for (std::size_t c = 0; c < 2; ++c) {
    const double extent = std::max(1e-30, high[c] - low[c]);
    scale_ = std::min(scale_, room[c] * (1.0 - 2.0 * kMargin) / extent);
  }
  for (std::size_t c = 0; c < 2; ++c) shift_[c] = 0.5 * (room[c] - scale_ * (low[c] + high[c]));
}

}  // namespace segorient::program
