// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/export.h>

#include <array>
#include <cstddef>

#include "features/local_fit_job.h"
#include "features/sheet_fit.h"

namespace segorient::detail {

/// Neighbours spread in one direction only, as on a ring, if their variance across it in the plane
/// is less than this part of that along it: their plane is any plane through it.
constexpr float kOneLine = 0.15F;
/// The same for a few: of nine random points of a plane one set in 25 is below that, one in 1,000
/// below this. A scanner's line is, if its noise is no more than half of its step.
constexpr float kOneScanLine = 0.04F;

/// Least-squares planes of the nearest neighbours of some points, themselves counted, for one
/// number of neighbours. Values of one kind lie side by side.
struct GrownPlanes {
  static constexpr std::size_t kRows = 256;  ///< most points at once
  using Values = std::array<float, kRows>;

  std::array<Values, 3> normal;  ///< NaN where variances are too alike to tell
  std::array<Values, 3> lambda;  ///< variances, ascending: the larger two to a thousandth where
                                 ///< they meet; NaN where all points are one
  std::array<Values, 3> mean;    ///< of the offsets from the point
  Values n;                      ///< points
  Values unit;                   ///< of lengths; 1 unless squares would over- or underflow

  bool hasNormal(std::size_t i) const { return normal[0][i] == normal[0][i]; }
  /// \param length what lengths are to be measured in
  SEGORIENT_FEATURES_EXPORT Plane at(std::size_t i, float length = 1.F) const;
};

/// Fits planes to neighbourhoods that grow, each of some sizes, for rows [begin, end) of a job.
/// \param job its normals, curvatures and residuals are not touched; entries: largest of sizes + 1
/// \param sizes neighbours beside the point itself, ascending
/// \param end at most begin + GrownPlanes::kRows
/// \param planes one a size; row begin + i at [i]
SEGORIENT_FEATURES_EXPORT void fitGrownPlanes(const LocalFitJob& job, const int* sizes,
                                              std::size_t count, std::size_t begin, std::size_t end,
                                              GrownPlanes* planes);

/// Most values that findMedians() takes: a point and 22 around it.
constexpr std::size_t kMostMedian = 23;

/// Medians of several values of each of GrownPlanes::kRows points: of an even number the larger of
/// the two in the middle.
/// \param count kMostMedian at most \param values the j-th of point i at [j * kRows + i]; NaN where
/// there is none \param medians one a point; NaN where there is no value
void findMedians(const float* values, std::size_t count, float* medians);

}  // namespace segorient::detail
