// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "features/automatic_normals.h"
#include "features/cloud_noise.h"

namespace segorient::detail {

/// Cubic surfaces at what no quadratic one fits.
struct EdgeCubics {
  int k = 0;                       ///< neighbours; 0 where noise is too much for such surfaces
  std::vector<pcl::index_t> rows;  ///< what no quadratic one fits
  std::vector<float> normals;      ///< 4 a row; empty without such surfaces
  std::size_t nearer = 0;          ///< of the rows: they are clearly nearer than quadratic ones

  /// Takes them, if they fit most of the rows better.
  /// \param all 4 floats a point
  void takeIfBetter(const AutomaticNormalTraits* known, float* all,
                    AutomaticNormalReport& report) const;
};

/// Normals without a choice to make, see estimateNormalsAutomatically(), step by step. Points are
/// open until noise explains what a surface leaves of their neighbours: each step leaves fewer.
class SurfaceEstimation {
 public:
  /// \param normals 4 floats for each row of the table
  /// \param rows of the table; null = all
  /// \param index of the points, for what the table does not have, or null
  SurfaceEstimation(const Surroundings& surroundings, const CloudNoise& noise,
                    const AutomaticNormalTraits* known, int threads, float* normals,
                    const std::vector<pcl::index_t>* rows,
                    const search::MedianHashIndex* index = nullptr);

  AutomaticNormalReport run(std::vector<pcl::index_t>* unexplained);
  /// Of a part of a noisy cloud: quadratic surfaces, and cubic ones at what these leave open, which
  /// the whole cloud decides on. Not where fewTell() is false: then steps look at all points.
  /// \param cubics found, not taken
  AutomaticNormalReport runPart(EdgeCubics& cubics);

 private:
  int available() const { return of_.table.k() - 1; }
  float* normalOf(pcl::index_t row) const { return normals_ + 4 * static_cast<std::size_t>(row); }

  template <typename Condition>
  std::size_t close(const Condition& condition);
  template <typename Residual>
  std::size_t closeExplained(int k, Fitted fitted, const Residual& residual);
  template <typename Residual>
  std::size_t countCubic(const std::vector<pcl::index_t>& rows, const Residual& cubic,
                         double share) const;
  void findTelling(int k, Fitted fitted);
  bool tells(std::size_t row) const;
  void takeQuadratics();
  void acrossLines();
  void keepEdges();
  bool isAnalytic();
  void takeCubics();
  void takePlanes();
  void triangulate();
  EdgeCubics cubicsAtEdges();
  void countUndefined();

  const Surroundings of_;
  const search::MedianHashIndex* index_;
  const AutomaticNormalTraits* known_;
  double noise_;
  double in_spacings_;
  int threads_;
  float* normals_;
  AutomaticNormalReport report_;
  bool lines_ = false;  ///< and without noise: few neighbours are of one line
  std::vector<pcl::index_t> rows_;
  std::vector<pcl::index_t> open_;
  Surfaces quadratics_;
  std::vector<std::uint8_t> telling_;  ///< by row, of those that were open; empty = all are
};

}  // namespace segorient::detail
