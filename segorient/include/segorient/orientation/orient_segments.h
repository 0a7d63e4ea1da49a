// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/neighborhoods.h>
#include <segorient/common/point_view.h>
#include <segorient/orientation/method.h>
#include <segorient/orientation/orientation_hints.h>
#include <segorient/orientation/orientation_result.h>
#include <segorient/orientation/segment_relations.h>
#include <segorient/segmentation/segmentation.h>
#include <segorient/surface/segment_mesh.h>

#include <cstddef>
#include <memory>

namespace segorient {

/// Settings of orientSegments(). Angles in radians.
struct OrientationOptions {
  OrientationMethod method = OrientationMethod::AUTO;
  /// Paper's gamma: angles up to here, and from pi - gamma on, decide; extremal points must be as
  /// near.
  float gamma = 0.6108652F;
  SegmentAngle angle = SegmentAngle::ACROSS_BORDER;
  BoundaryTest boundary = BoundaryTest::LOCAL;
  TriangulationOptions triangulation;  ///< for BoundaryTest::TRIANGULATED; its threads are not used
  float min_margin = 0.5F;  ///< majority that a boundary needs to decide, see BoundaryVote
  std::size_t max_box_points =
      120;  ///< most points in a box of the subdivision for extremal points
  /// Whether segments and borders are checked (beyond the paper): segments that lie over
  /// themselves, or contradict a large part of their borders, are dissolved, as they run from one
  /// side over to another where bodies touch, and their points oriented one by one; a link whose
  /// angle and whose boundary say opposite things decides nothing in COMBINED and EXTREMAL. Not for
  /// PROPAGATION.
  bool check_borders = true;
  /// Whether each connected component is turned outward; otherwise its largest segment keeps its
  /// sign, or, by EXTREMAL, what extremal points say about each segment is the last word. HOPPE has
  /// its own rule, see orientByPointTree().
  bool turn_outward = true;
  /// What is known beforehand, by input row; null = nothing. Only AUTO uses it; a function that is
  /// given PointHints uses those instead.
  std::shared_ptr<const OrientationHints> hints;
  int threads = 0;  ///< see resolveThreads()
};

/// Orients a segmented cloud: segments by the chosen method, every other point that has a normal
/// from what surrounds it, and every connected component outward (paper, section 3).
///
/// \param normals 4 floats a row; the sign of each is arbitrary
/// \param neighborhoods of every point
/// \param graph of the segmentation, see buildSegmentGraph()
/// \return all signs 0 if the sizes do not agree
OrientationResult orientSegments(const PointView& points, const PointView& normals,
                                 const Neighborhoods& neighborhoods,
                                 const Segmentation& segmentation, const SegmentGraph& graph,
                                 const OrientationOptions& options, const PointHints& hints = {});

}  // namespace segorient
