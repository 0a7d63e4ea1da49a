// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/sensors/hiding_place.h"

#include <cmath>
#include <numeric>

#include "common/dot.h"
#include "orientation/sensors/scan_checks.h"

namespace segorient::detail {
bool HidingPlace::isPlausible(const PointView& points, const std::vector<float>& normals) const {
  float balance = 0.F;
  for (const std::uint32_t i : visible) {
    std::array<float, 3> v;
    for (std::size_t a = 0; a < 3; ++a) v[a] = report.position[a] - points[i][a];
    const float length = std::sqrt(dot(v.data(), v.data()));
    const float facing = dot(&normals[4 * std::size_t{i}], v.data()) / length;
    if (!std::isfinite(facing)) continue;
    balance += facing;
  }
  return balance > 0.F;
}

HidingPlace lookFrom(const PointView& points, const std::array<float, 3>& place, int threads) {
  std::vector<std::uint32_t> rows(points.size);
  std::iota(rows.begin(), rows.end(), 0U);
  const Scan scan(points, rows, place, nullptr, threads);
  const std::vector<std::uint8_t> hidden = scan.hidden();
  HidingPlace out;
  out.report.hidden = shareOf(hidden);
  out.report.position = place;
  out.report.points = points.size;
  out.report.density = scan.density().ratio;
  const EveryNth sample = scan.sample();
  for (std::size_t s = 0; s < hidden.size(); ++s) {
    if (hidden[s] == 0) out.visible.push_back(static_cast<std::uint32_t>(sample[s]));
  }
  return out;
}

}  // namespace segorient::detail
