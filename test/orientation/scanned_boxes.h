// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
// Scans of boxes by rays, whose true normals face the sensor.
#pragma once

#include <segorient/orientation/pipeline.h>

#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <random>
#include <vector>

#include "sheet_fixture.h"

namespace segorient::test {

using Vector = std::array<double, 3>;

struct Box {
  Vector low;
  Vector high;
};

struct Scans {
  std::vector<float> xyz;      // 4 floats a point
  std::vector<float> normals;  // the same: facing the sensor
  std::vector<float> sensors;  // 3 floats a point
  std::vector<int> scan;
  std::size_t size() const { return scan.size(); }
};

// Nearest face of a box that the ray meets, and its normal; infinite where it meets none.
inline double hit(const Box& box, const Vector& from, const Vector& along, Vector& normal) {
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t a = 0; a < 3; ++a) {
    for (const double plane : {box.low[a], box.high[a]}) {
      const double t = (plane - from[a]) / along[a];
      if (!(t > 1e-9) || t >= nearest) continue;
      bool inside = true;
      for (std::size_t b = 0; b < 3; ++b) {
        const double x = from[b] + t * along[b];
        inside = inside && (b == a || (x >= box.low[b] && x <= box.high[b]));
      }
      if (!inside) continue;
      nearest = t;
      normal = {0.0, 0.0, 0.0};
      normal[a] = along[a] < 0.0 ? 1.0 : -1.0;
    }
  }
  return nearest;
}

// The same of several boxes.
inline double hit(const std::vector<Box>& boxes, const Vector& from, const Vector& along,
                  Vector& normal) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const Box& box : boxes) {
    Vector n{};
    const double t = hit(box, from, along, n);
    if (t >= nearest) continue;
    nearest = t;
    normal = n;
  }
  return nearest;
}

// What a ray meets after a distance, by the scan of that number.
inline void addPoint(const Vector& from, const Vector& along, double distance, const Vector& normal,
                     int number, Scans& out) {
  for (std::size_t a = 0; a < 3; ++a) {
    out.xyz.push_back(static_cast<float>(from[a] + distance * along[a]));
    out.normals.push_back(static_cast<float>(normal[a]));
    out.sensors.push_back(static_cast<float>(from[a]));
  }
  out.xyz.push_back(0.F);
  out.normals.push_back(0.F);
  out.scan.push_back(number);
}

// What a scanner of equal angles sees; noise along the ray.
inline void scan(const std::vector<Box>& boxes, const Vector& from, int lines, double noise,
                 unsigned seed, Scans& out) {
  std::mt19937 rng(seed);
  std::normal_distribution<double> gauss(0.0, noise > 0.0 ? noise : 1.0);
  const int number = out.scan.empty() ? 0 : out.scan.back() + 1;
  for (int e = 0; e < lines; ++e) {
    const double elevation = M_PI * ((e + 0.5) / lines - 0.5);
    if (std::fabs(elevation) > 1.1) continue;  // lines crowd at the poles
    for (int z = 0; z < 2 * lines; ++z) {
      const double azimuth = M_PI * (z + 0.31) / lines;
      const Vector along{std::cos(elevation) * std::cos(azimuth),
                         std::cos(elevation) * std::sin(azimuth), std::sin(elevation)};
      Vector normal{};
      const double nearest = hit(boxes, from, along, normal);
      if (!std::isfinite(nearest)) continue;
      addPoint(from, along, nearest + (noise > 0.0 ? gauss(rng) : 0.0), normal, number, out);
    }
  }
}

inline OrientedCloud orient(const std::vector<float>& xyz, const OrientationHints& hints) {
  PipelineOptions options;
  options.orientation.hints = std::make_shared<OrientationHints>(hints);
  return orientCloud(viewOf(xyz), nullptr, options);
}

inline OrientationHints eachItsOwn(const Scans& scans) {
  OrientationHints hints;
  hints.viewpoints = scans.sensors;
  return hints;
}

inline OrientationHints seenFrom(const Vector& place) {
  OrientationHints hints;
  hints.has_viewpoint = true;
  for (std::size_t a = 0; a < 3; ++a) hints.viewpoint[a] = static_cast<float>(place[a]);
  return hints;
}

// A box with another one on its floor, from inside: it closes, so that what is outward is away.
inline Scans room(const Vector& station) {
  Scans out;
  scan({{{0, 0, 0}, {4, 3, 2.5}}, {{2, 1, 0}, {3, 2, 0.8}}}, station, 80, 0.003, 1, out);
  return out;
}

/// Four stations around a solid of two boxes.
struct Around {
  std::array<Vector, 4> stations{{{4, 0.5, 0.6}, {-0.7, 5, 1}, {-4.5, -0.4, 1.2}, {0.3, -4, 2}}};
  Scans scans;

  Around() {
    const std::vector<Box> solid{{{-1, -0.6, -1}, {1, 0.6, 0.7}},
                                 {{-0.4, -0.3, 0.7}, {0.5, 0.3, 1.5}}};
    for (unsigned s = 0; s < 4; ++s) scan(solid, stations[s], 190, 0.003, 4 + s, scans);
  }

  /// Hints by which each scan was seen from where another one was. \param of_scan below 0: unknown
  OrientationHints withPoses(const std::array<int, 4>& of_scan) const {
    OrientationHints hints = eachItsOwn(scans);
    for (std::size_t i = 0; i < scans.size(); ++i) {
      const int said = of_scan[static_cast<std::size_t>(scans.scan[i])];
      for (std::size_t a = 0; a < 3; ++a) {
        hints.viewpoints[3 * i + a] =
            said < 0 ? std::numeric_limits<float>::quiet_NaN()
                     : static_cast<float>(stations[static_cast<std::size_t>(said)][a]);
      }
    }
    return hints;
  }
};

}  // namespace segorient::test
