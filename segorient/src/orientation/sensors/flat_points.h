// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/point_view.h>
#include <segorient/search/median_hash_index.h>

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "common/dot.h"
#include "features/sheet_fit.h"

namespace segorient::detail {

/// Some ten thousand points of a cloud, and which of them are on surfaces: those that a plane
/// explains. Noise that is as deep as the points are apart hides points from each other, too.
class FlatPoints {
 public:
  /// The least that a plane shows a surface by.
  static constexpr int kPlane = 12;

  /// Whether the spread of neighbours is that of a surface, not of noise, nor of one scan line.
  /// \param plane of 12 to 24 neighbours
  static bool isFlat(const Plane& plane);

  /// \param points of which an even part is taken
  FlatPoints(const PointView& points, int threads);

  std::size_t size() const { return width_.size(); }
  PointView view() const { return {xyz_.data(), 4, width_.size()}; }
  const search::MedianHashIndex& index() const { return index_; }
  /// Mean distance to the nearest; 0 where points repeat.
  float spacing(std::size_t i) const { return width_[i]; }
  bool isOnSurface(std::size_t i) const { return dot(normal(i), normal(i)) > 0.F; }
  /// Of length 1; 0 of points on no surface.
  const float* normal(std::size_t i) const { return &normal_[4 * i]; }
  /// Those on surfaces, ascending.
  const std::vector<std::size_t>& onSurfaces() const { return on_surfaces_; }
  /// Of these an even part: `count` of them, at most twice as many.
  std::vector<std::size_t> someOnSurfaces(std::size_t count) const;
  std::array<float, 3> middle() const;

 private:
  std::vector<float> xyz_;     ///< 4 floats
  std::vector<float> normal_;  ///< 4 floats
  std::vector<float> width_;
  std::vector<std::size_t> on_surfaces_;
  search::MedianHashIndex index_;
};

/// The same, found once and only if somebody asks.
class FlatPointsOnce {
 public:
  /// \param points must outlive this
  FlatPointsOnce(const PointView& points, int threads) : points_(points), threads_(threads) {}

  const FlatPoints& get() {
    if (!flat_) flat_.emplace(points_, threads_);
    return *flat_;
  }

 private:
  PointView points_;
  int threads_;
  std::optional<FlatPoints> flat_;
};

}  // namespace segorient::detail
