// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
// A virtual room, seen by virtual sensors with exact rays.
#pragma once

#include <segorient/common/point_view.h>
#include <segorient/orientation/sensors.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <random>
#include <vector>

#include "common/directions.h"

namespace segorient {

using Vector = std::array<double, 3>;

// A room 6 x 4 x 3 with a cupboard, seen from inside.
struct Room {
  Vector size{6.0, 4.0, 3.0};
  Vector low{4.5, 0.0, 0.0};  // the cupboard
  Vector high{6.0, 1.0, 2.0};

  double firstHit(const Vector& o, const Vector& d) const {
    double leave = 1e30;
    double enter_box = 0.0;
    double leave_box = 1e30;
    for (std::size_t a = 0; a < 3; ++a) {
      if (std::fabs(d[a]) < 1e-12) {
        if (o[a] < low[a] || o[a] > high[a]) leave_box = -1.0;
        continue;
      }
      leave = std::min(leave, ((d[a] > 0 ? size[a] : 0.0) - o[a]) / d[a]);
      const double s = (low[a] - o[a]) / d[a];
      const double t = (high[a] - o[a]) / d[a];
      enter_box = std::max(enter_box, std::min(s, t));
      leave_box = std::min(leave_box, std::max(s, t));
    }
    return enter_box < leave_box && enter_box > 0.0 ? std::min(enter_box, leave) : leave;
  }
};

class Scan {
 public:
  explicit Scan(const Room& room = {}) : room_(room) {}
  void add(const Vector& o, const Vector& d) {
    const double t = room_.firstHit(o, d);
    for (std::size_t a = 0; a < 3; ++a) rows_.push_back(static_cast<float>(o[a] + t * d[a]));
  }
  void addNothing() { rows_.insert(rows_.end(), 3, std::numeric_limits<float>::quiet_NaN()); }
  void move(const Vector& by) {
    for (std::size_t i = 0; i < rows_.size(); ++i) rows_[i] += static_cast<float>(by[i % 3]);
  }
  void blur(float noise) {
    std::mt19937 random(5);
    std::normal_distribution<float> error(0.F, noise);
    for (float& v : rows_) v += error(random);
  }
  void scale(float by) {
    for (float& v : rows_) v *= by;
  }
  std::vector<float>& rows() { return rows_; }
  PointView view() const { return {rows_.data(), 3, rows_.size() / 3}; }

 private:
  Room room_;
  std::vector<float> rows_;
};

// A scanner on a tripod: equal steps of azimuth and elevation.
// \param lowest elevation
inline Scan scanFrom(const Vector& station, double step_degrees, const Room& room = {},
                     double lowest = -1.0) {
  Scan scan(room);
  const double step = step_degrees * kPi / 180.0;
  for (double e = lowest; e < 1.5; e += step) {
    for (double a = 0.1 * step; a < 2.0 * kPi; a += step) {
      scan.add(station, {std::cos(e) * std::cos(a), std::cos(e) * std::sin(a), std::sin(e)});
    }
  }
  return scan;
}

// A lidar of few beams that turns while it goes along: from each of the poses.
inline Scan scanAlong(const std::vector<Vector>& poses, const Room& room) {
  Scan scan(room);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    for (double e = -24.0; e <= 8.0; e += 2.0) {
      for (double a = 0.1 * static_cast<double>(i); a < 360.0; a += 1.0) {
        const double azimuth = a * kPi / 180.0;
        const double elevation = e * kPi / 180.0;
        scan.add(poses[i], {std::cos(elevation) * std::cos(azimuth),
                            std::cos(elevation) * std::sin(azimuth), std::sin(elevation)});
      }
    }
  }
  return scan;
}

// A lidar of few beams, tilted by 45 degrees, which swings while it is carried about in a room.
struct Carried {
  Scan scan;
  std::vector<Vector> from;  // by row
};

inline Carried carriedAbout() {
  Carried out;
  constexpr int kPoses = 30;
  for (int i = 0; i < kPoses; ++i) {
    const double way = 2.0 * kPi * i / kPoses;
    const Vector place{3.0 + 1.4 * std::cos(way), 2.2 + 0.9 * std::sin(way),
                       1.4 + 0.1 * std::sin(5.0 * way)};
    const double heading = way + 0.6 * std::sin(i);
    for (double e = -14.0; e <= 14.0; e += 4.0) {
      for (double a = 0.1 * i; a < 360.0; a += 1.5) {
        const double elevation = e * kPi / 180.0;
        const double azimuth = a * kPi / 180.0;
        const Vector d{std::cos(elevation) * std::cos(azimuth),
                       std::cos(elevation) * std::sin(azimuth), std::sin(elevation)};
        // About x by 45 degrees, then about z.
        const double y = (d[1] - d[2]) * std::sqrt(0.5);
        const double z = (d[1] + d[2]) * std::sqrt(0.5);
        out.scan.add(place, {std::cos(heading) * d[0] - std::sin(heading) * y,
                             std::sin(heading) * d[0] + std::cos(heading) * y, z});
        out.from.push_back(place);
      }
    }
  }
  return out;
}

constexpr std::size_t kWidth = 120;
constexpr std::size_t kHeight = 90;

// A camera that looks along `forward` (level) from `eye`; every 50th pixel is missing.
inline Scan viewFrom(const Vector& eye, double heading, const Room& room = {}) {
  Scan scan(room);
  const Vector forward{std::cos(heading), std::sin(heading), 0.0};
  const Vector right{std::sin(heading), -std::cos(heading), 0.0};
  for (std::size_t i = 0; i < kWidth * kHeight; ++i) {
    const std::size_t row = i / kWidth;
    const double u = (static_cast<double>(i % kWidth) - 60.0) / 100.0;
    const double v = (static_cast<double>(row) - 45.0) / 100.0;
    if (i % 50 == 7) {
      scan.addNothing();
    } else {
      scan.add(eye, {forward[0] + u * right[0], forward[1] + u * right[1], -v});
    }
  }
  return scan;
}

// A box sampled evenly, at random.
inline std::vector<float> evenBox(std::size_t count) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> unit(0.F, 1.F);
  std::vector<float> rows;
  for (std::size_t i = 0; i < count; ++i) {
    std::array<float, 3> p{unit(random), unit(random), unit(random)};
    p[i % 3] = i % 2 == 0 ? 0.F : 1.F;
    rows.insert(rows.end(), p.begin(), p.end());
  }
  return rows;
}

inline double distanceTo(const FoundSensor& sensor, const Vector& truth) {
  double sum = 0.0;
  for (std::size_t a = 0; a < 3; ++a) {
    sum += std::pow(static_cast<double>(sensor.position[a]) - truth[a], 2);
  }
  return std::sqrt(sum);
}

}  // namespace segorient
