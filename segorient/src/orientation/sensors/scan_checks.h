// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/neighborhoods.h>
#include <segorient/common/point_view.h>
#include <segorient/search/median_hash_index.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "common/box.h"
#include "common/every_nth.h"
#include "features/sheet_fit.h"
#include "orientation/sensors/seen_from.h"

namespace segorient::detail {

/// The plane of a point and others, in units of the mean distance to the six nearest.
/// \param row indices, the point itself first, by distance
Plane planeOf(const PointView& points, std::size_t i, const pcl::index_t* row, int count);

/// Share of flags that are set.
inline float shareOf(const std::vector<std::uint8_t>& flags) {
  const auto count = std::count(flags.begin(), flags.end(), std::uint8_t{1});
  return static_cast<float>(count) / static_cast<float>(flags.size());
}

/// Points that one sensor is said to have seen. Neighbours are those among themselves.
class Scan {
 public:
  /// \param points must outlive this if all of them are the sensor's, as must their neighborhoods
  /// \param rows of the points, ascending
  /// \param neighborhoods of the points; null = none are known
  Scan(const PointView& points, const std::vector<std::uint32_t>& rows,
       const std::array<float, 3>& sensor, const Neighborhoods* neighborhoods, int threads);
  Scan(const Scan&) = delete;
  Scan& operator=(const Scan&) = delete;

  std::size_t size() const { return seen_.size(); }

  /// Some thousand points.
  EveryNth sample() const;

  /// Which of these lie behind others: the point's ray passes two of them within their own spacing,
  /// well before it arrives.
  std::vector<std::uint8_t> hidden() const;

  /// Whether the sensor is outside of the box around the points.
  bool isOutside() const { return !box_.contains(sensor_.data(), 0.F); }

  /// Whether those lie behind scattered points, as the ground does in woods: beams pass between
  /// the leaves, and what a sensor sees through hides nothing from it. What hides points that are
  /// on surfaces is on surfaces itself about as often as all points are, in noise, too, unless it
  /// is scattered.
  /// \param hidden as above
  bool seesThrough(const std::vector<std::uint8_t>& hidden) const;

  struct Density {
    /// Scatter of log density about that of a sensor here, over that about a constant.
    float ratio = std::numeric_limits<float>::infinity();
    float constant = 0.F;  ///< the latter: a robust mean deviation
  };
  /// Of equal angles about an axis, or of an image's pixels, density falls with the square of the
  /// distance and with incidence; whichever law fits best.
  Density density() const;

  /// Whether the density tells that the sensor stood elsewhere: a place beside the one that is said
  /// explains it nearly all, and far better, and saw the points from another side.
  bool stoodElsewhere() const;

 private:
  struct Row;
  struct Before;

  void nearest(std::size_t i, int entries, Row& out) const;
  float spacingOf(std::size_t i) const;
  Plane planeAt(std::size_t i) const;
  /// What is before a point, `most` of them at most.
  Before before(std::size_t i, std::size_t most) const;

  std::vector<float> xyz_;  ///< 4 floats; empty where all points are the sensor's
  PointView view_;
  std::array<float, 3> sensor_;
  SeenFrom seen_;
  Box box_;             ///< of the points
  float extent_ = 0.F;  ///< its diagonal
  search::MedianHashIndex index_;
  search::MedianHashIndex directions_;
  const Neighborhoods* near_ = nullptr;  ///< null unless they are known
  int threads_;
};

/// Pairs of neighbours on one smooth sheet, both seen far from grazing, by the scans of their ends.
struct ScanPairs {
  std::size_t scan;   ///< of one end
  std::size_t other;  ///< of the other end
  double pairs;
  double contrary;  ///< of these, those whose ends would face apart
};
/// Of all scans that have such pairs, from either end: those within one scan count twice.
/// \param toward 3 a point, as KnownSensors has them
/// \param scan one a point, -1 = none
std::vector<ScanPairs> findContraryPairs(const PointView& points,
                                         const Neighborhoods& neighborhoods, const float* spacing,
                                         const std::vector<float>& toward,
                                         const std::vector<std::int32_t>& scan, int threads);

}  // namespace segorient::detail
