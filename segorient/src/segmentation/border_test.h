// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <pcl/types.h>

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <vector>

#include "segmentation/distinct_points.h"
#include "segmentation/growth_state.h"

namespace segorient::segmentation {

/// Two neighbours in different segments; the first one's neighbours make up a patch.
struct PointPair {
  std::int32_t a, b;  ///< segments, the smaller one first
  std::uint32_t p, q;
};

struct TestedBorder {
  std::int32_t a = 0;
  std::int32_t b = 0;
  std::size_t pairs = 0;
  bool smooth = false;
  bool flipped = false;  ///< whether the signs of the two disagree
};

/// Tells smooth borders from sharp ones by the surface itself: the estimated normals lean over near
/// an edge, on a smooth surface and on a roof of 45 degrees by about as much.
class BorderTest {
 public:
  BorderTest(const SegmentationOptions& options, const GrowthState& state);

  /// Not for several threads at once: it has memory of its own that it works in.
  /// \param begin all pairs of one border
  TestedBorder test(const PointPair* begin, const PointPair* end);

 private:
  using Matrix8 = Eigen::Matrix<double, 8, 8>;

  /// Sums over a border's patches. In each, heights z over the tangent plane, x across the border
  /// and y along it, are fitted by a quadratic surface and a kink |x|; the kink is common to all
  /// patches.
  struct KinkSums {
    double kink_kink = 0;
    double kink_height = 0;
    double squares = 0;  ///< sum of the squared kinks of single patches, weighted
    double residual = 0;
    double freedom = 0;
    int patches = 0;

    /// \param products of 1, x, y, x^2, xy, y^2, |x| and z, summed up over a patch of so many
    /// points
    void add(const Matrix8& products, double points);
  };

  KinkSums measure(const PointPair* pairs, std::size_t count, int rings);
  bool isVague(const KinkSums& sums) const;
  bool isSmooth(const KinkSums& sums) const;
  bool setFrame(const PointPair& pair, const Eigen::Vector3d& middle, Eigen::Matrix3d& frame) const;
  void addPatch(const PointPair& pair, int rings, KinkSums& sums);
  bool passesOn(const Node& p, const Node& q) const;
  void listPatch(const PointPair& pair, int rings);
  void addNear(std::size_t p, const PointPair& pair);

  const GrowthState& state_;
  float cos_alpha_;
  float max_curvature_;
  float max_residual_;
  double most_slope_;
  DistinctPoints found_;
  std::vector<pcl::index_t> patch_;  ///< ascending
  std::vector<pcl::index_t> ring_, next_;
};

}  // namespace segorient::segmentation
