// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/export.h>
#include <segorient/common/neighborhoods.h>
#include <segorient/common/point_view.h>
#include <segorient/orientation/orientation_options.h>
#include <segorient/orientation/orientation_result.h>
#include <segorient/orientation/sensors.h>
#include <segorient/segmentation/segmentation.h>

#include <algorithm>
#include <cstdint>
#include <vector>

#include "orientation/automatic/border_votes.h"
#include "orientation/sensors/known_sensors.h"
#include "orientation/sensors/point_hints.h"
#include "segmentation/sheet_segmentation.h"

namespace segorient {

/// What orientSheets() found beside the result itself.
struct AutoOrientation : detail::SeenPoints {
  OrientationResult result;
  std::vector<ClusterOrientationResult> clusters;  ///< by descending number of points
  std::vector<Contradiction> contradictions;       ///< by descending weight
  bool place_idle = false;                         ///< the one place for all points decided nothing
  std::vector<KnownSensor> sensors;                ///< positions in the points' unit
  /// One a component, whether it is open ground with what stands on it.
  std::vector<std::uint8_t> ground;
  /// The same, whether hints turned it to the other side than it has without them.
  std::vector<std::uint8_t> inside_out;

  /// Whether places were given, and they decided nothing: none is believed, or the surface knows
  /// better everywhere.
  bool leavesAllToSurface() const {
    return !sensors.empty() &&
           (place_idle || std::none_of(sensors.begin(), sensors.end(),
                                       [](const KnownSensor& s) { return s.used; }));
  }
};

/// Orients segments that do not mix sides, whatever they are part of: closed or open, nested,
/// linked, many parts. Borders vote; certain borders are contracted, the surest first; what is left
/// between some tens of clusters is decided by all their borders together; connected components are
/// turned outward by the winding number, and where that says nothing (a plane), to +z; parts whose
/// borders hardly tell are turned over where the winding number says so clearly; hints then go
/// before all that as OrientationHints says.
///
/// \param points each may stand for several of the cloud's, of one segment
/// \param neighborhoods needed only if hints name sensors
/// \param votes see borderVotes()
/// \param count how many points the cloud has; sizes of segments are counted in these
SEGORIENT_ORIENTATION_EXPORT AutoOrientation
orientSheets(const PointView& points, const Neighborhoods& neighborhoods, const SheetField& field,
             const Segmentation& segmentation, std::vector<BorderVote> votes, std::size_t count,
             const AutomaticOptions& options = {}, const PointHints& hints = {}, int threads = 0);

}  // namespace segorient
