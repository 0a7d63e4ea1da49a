// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "support/two_normals.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace segorient::program {
namespace {

constexpr double kDegrees = 57.295779513082320877;

// Towards the sensor that saw a point, in double: 0 0 0 where it is not known.
std::array<double, 3> towardsSensor(const PointView& points, std::size_t row,
                                    const OrientationHints& hints) {
  std::array<double, 3> out{0.0, 0.0, 0.0};
  if (3 * row + 2 < hints.viewpoints.size() && isFinite(&hints.viewpoints[3 * row])) {
    for (std::size_t a = 0; a < 3; ++a) {
      out[a] =
          static_cast<double>(hints.viewpoints[3 * row + a]) - static_cast<double>(points[row][a]);
    }
  } else if (hints.has_direction) {
    std::copy_n(hints.direction.begin(), 3, out.begin());
  }
  return out;
}

double facing(const float* normal, const std::array<double, 3>& sensor) {
  double sum = 0.0;
  for (std::size_t a = 0; a < 3; ++a) sum += static_cast<double>(normal[a]) * sensor[a];
  return sum;
}

}  // namespace

void turnToOwnSensors(const PointView& points, const OrientationHints& hints, Normals& normals) {
  for (std::size_t i = 0; i < points.size; ++i) {
    if (!(facing(&normals[4 * i], towardsSensor(points, i, hints)) < 0.0)) continue;
    for (std::size_t a = 0; a < 3; ++a) normals[4 * i + a] = -normals[4 * i + a];
  }
}

double shareFacing(const PointView& points, const OrientationHints& hints, const Normals& normals) {
  std::size_t known = 0;
  std::size_t front = 0;
  for (std::size_t i = 0; i < points.size; ++i) {
    std::array<double, 3> sensor = towardsSensor(points, i, hints);
    if (sensor == std::array<double, 3>{0.0, 0.0, 0.0} && hints.has_viewpoint) {
      for (std::size_t a = 0; a < 3; ++a) {
        sensor[a] = static_cast<double>(hints.viewpoint[a]) - static_cast<double>(points[i][a]);
      }
    }
    const double seen = facing(&normals[4 * i], sensor);
    if (seen == 0.0 || !std::isfinite(seen)) continue;
    ++known;
    if (seen > 0.0) ++front;
  }
  return known == 0 ? NAN : 100.0 * static_cast<double>(front) / static_cast<double>(known);
}

Normals ownNormals(const CloudTable& table) {
  Normals out(4 * table.size, 0.F);
  for (std::size_t i = 0; i < table.size; ++i) {
    const auto n = table.triple(table.normals(), i);
    const double length = std::hypot(n[0], n[1], n[2]);
    for (std::size_t a = 0; a < 3; ++a) out[4 * i + a] = static_cast<float>(n[a] / length);
  }
  return out;
}

Difference compareNormals(const Normals& a, const Normals& b) {
  Difference d;
  std::vector<double> angles;
  double sum = 0.0;
  for (std::size_t i = 0; 4 * i < a.size(); ++i) {
    double dot = 0.0;
    for (std::size_t c = 0; c < 3; ++c) {
      dot += static_cast<double>(a[4 * i + c]) * static_cast<double>(b[4 * i + c]);
    }
    if (!std::isfinite(dot)) continue;
    if (dot < 0.0) ++d.opposite;
    angles.push_back(kDegrees * std::acos(std::min(1.0, std::abs(dot))));
    sum += angles.back() * angles.back();
  }
  d.compared = angles.size();
  if (angles.empty()) return d;
  std::sort(angles.begin(), angles.end());
  d.median = angles[angles.size() / 2];
  d.p90 = angles[angles.size() * 9 / 10];
  d.rms = std::sqrt(sum / static_cast<double>(angles.size()));
  return d;
}

}  // namespace segorient::program
