// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/neighborhoods.h>
#include <segorient/common/point_view.h>
#include <segorient/orientation/orientation_hints.h>
#include <segorient/orientation/orientation_result.h>
#include <segorient/segmentation/segmentation.h>
#include <segorient/segmentation/sheet_segmentation.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace segorient {

/// Options of orientSheets(). Each step can be switched off to see what it is worth.
struct AutoOrientationOptions {
  bool contract_certain = true;  ///< join unanimous borders first; otherwise all at once
  bool flip_clusters = true;     ///< single clusters are turned over while that agrees better
  bool wind_components = true;   ///< in and out by the winding number; otherwise by convention
  bool turn_loose_parts = true;  ///< what borders hardly tell, the winding number does; needs
                                 ///< wind_components
  bool infer_viewpoint = true;   ///< a scan from one place: what disagrees with it is turned over,
                                 ///< but for cavities that the winding number vouches for
  int threads = 0;               ///< see resolveThreads()
};

/// A border where sure evidence was overruled: the surface cannot be oriented there.
struct Contradiction {
  std::int32_t a = 0;  ///< segments
  std::int32_t b = 0;
  float weight = 0.F;                         ///< votes overruled
  std::array<float, 3> where{0.F, 0.F, 0.F};  ///< a point of the border
};

/// Segments that certain borders hold together: their relative orientation was not in doubt, but
/// for single ones that the winding number of a clean closed surface has turned over.
struct ClusterOrientationResult {
  std::size_t points = 0;
  std::int32_t component = -1;  ///< into OrientationResult::components
  float confidence = 0.F;       ///< how far its borders to other clusters agree; 1 without any
};

/// What orientSheets() found beside the result itself.
struct AutoOrientation {
  OrientationResult result;
  std::vector<std::int32_t> cluster_of;            ///< per segment, into `clusters`
  std::vector<ClusterOrientationResult> clusters;  ///< by descending number of points
  std::vector<Contradiction> contradictions;       ///< by descending weight
  float viewpoint_agreement = 0.F;                 ///< see ViewpointFit
};

/// Orients segments that do not mix sides, whatever they are part of: closed or open, nested,
/// linked, many parts. Borders vote; certain borders are contracted, the surest first; what is left
/// between some tens of clusters is decided by all their borders together; connected components are
/// turned outward by the winding number, and where that says nothing (a plane), to +z; parts whose
/// borders hardly tell are turned over where the winding number says so clearly; hints then go
/// before all that as OrientationHints says.
AutoOrientation orientSheets(const PointView& points, const Neighborhoods& neighborhoods,
                             const SheetField& field, const Segmentation& segmentation,
                             const AutoOrientationOptions& options = {},
                             const PointHints& hints = {});

}  // namespace segorient
