// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/neighborhoods.h>
#include <segorient/common/point_view.h>

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "features/grown_planes.h"
#include "features/local_fit_job.h"
#include "features/sheet_fit.h"
#include "features/sheet_normals.h"
#include "features/sheet_walls.h"

namespace segorient::detail {

/// The plane of a point's sheet; lengths in spacings.
struct PointFit {
  Plane plane;
  float curvature = 0.F;
  WallSplit split;
  bool all_on_it = false;  ///< none of the neighbours is off the plane
};

/// Of the sizes of kSheetScales.
using SheetPlanes = std::array<GrownPlanes, kSheetScales.size()>;

/// One point and its neighbours; lengths in spacings.
class Neighborhood {
 public:
  /// \param planes the point's at [r]
  Neighborhood(const PointView& points, const Neighborhoods& nb, std::size_t i, float spacing,
               const SheetPlanes& planes, std::size_t r, bool lines)
      : points_(points), nb_(nb), i_(i), spacing_(spacing), planes_(planes), r_(r), lines_(lines) {}

  const Offsets& offsets();
  Plane planeOf(std::size_t scale);
  /// Whether those that a plane was fitted to may be of a contour, whose own plane it then is: in
  /// clouds of lines, those on a conic.
  bool isContour(std::size_t scale, const Plane& plane) const;

 private:
  const PointView& points_;
  const Neighborhoods& nb_;
  std::size_t i_;
  float spacing_;
  const SheetPlanes& planes_;
  std::size_t r_;
  bool lines_;
  std::optional<Offsets> offsets_;
};

/// See estimateSheetNormals(); whatever walls there are.
/// \param smallest number of the smallest of kSheetScales that noise leaves
PointFit fitPoint(Neighborhood& of, std::size_t smallest, const NoiseLevel& noise,
                  const SheetNormalOptions& options);

/// Points that see two walls keep the plane of their own.
/// \param job its rows are those of `fits` \param spacing of all points \param thin see NoiseLevel
void keepOwnWalls(const LocalFitJob& job, const float* spacing, bool thin,
                  std::vector<PointFit>& fits);

}  // namespace segorient::detail
