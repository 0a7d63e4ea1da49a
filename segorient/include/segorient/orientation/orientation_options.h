// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/export.h>
#include <segorient/orientation/orientation_hints.h>
#include <segorient/surface/segment_mesh.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace segorient {

/// How segments get their orientation relative to each other.
enum class OrientationMethod : std::uint8_t {
  AUTO,         ///< the best known
  PROPAGATION,  ///< spanning tree over the angles between segments (paper, 3.1)
  BOUNDARY,     ///< directions of the segments' boundaries (paper, 3.2.2)
  COMBINED,     ///< the tree, the boundaries where its angle is unreliable, extremal points for the
                ///< rest
  EXTREMAL,     ///< extremal points in the boxes of a subdivision of space (paper, 3.3)
  HOPPE         ///< without segments, for comparison: spanning tree over the angles between
                ///< neighbouring points (Hoppe et al. 1992, as the paper describes it in 3.1)
};

/// auto, propagation, boundary, combined, extremal or hoppe.
SEGORIENT_ORIENTATION_EXPORT const char* toString(OrientationMethod method);

/// \return false, and `method` unchanged, for any other name
SEGORIENT_ORIENTATION_EXPORT bool fromString(const std::string& name, OrientationMethod& method);

/// Which angle stands for two neighbouring segments in propagation (paper, 3.1).
enum class SegmentAngle : std::uint8_t {
  REFERENCE_NORMALS,  ///< between the reference normals: the paper's
  ACROSS_BORDER       ///< between the normals of the point pairs across the border, averaged
};

/// How boundaries are told (paper, 3.2.2).
enum class BoundaryTest : std::uint8_t {
  LOCAL,        ///< from the neighbours of border points
  TRIANGULATED  ///< from triangulations of the segments: the paper's
};

/// Settings of the default method, OrientationMethod::AUTO; the other methods use none of these but
/// find_sensors.
/// Each step can be switched off to see what it is worth. Angles in radians.
struct AutomaticOptions {
  // Normals of single sheets.
  bool denoise = true;         ///< smooth positions first where the noise is above about a spacing
  bool split_walls = true;     ///< keep the points of a parallel wall nearby out of a fit
  bool dominant_plane = true;  ///< at edges, fit the plane that most neighbours lie on

  // Segments of single sheets.
  /// Largest angle between neighbours' normals; 0 = 15 degrees on clean data to 20 on noisy.
  float alpha = 0.F;
  float beta = 0.5235988F;      ///< largest angle to the segment's reference normal (30 degrees)
  float epsilon = 0.1745329F;   ///< what clean-up allows beyond beta (10 degrees)
  bool require_support = true;  ///< a point joins only with several neighbours inside
  bool clean_up = true;         ///< passes 1 and 2 of the paper

  // Their signs.
  bool contract_certain = true;  ///< join unanimous borders first; otherwise all at once
  bool wind_components = true;   ///< in and out by the winding number; otherwise by convention
  bool turn_loose_parts = true;  ///< what borders hardly tell, the winding number does; needs
                                 ///< wind_components
  /// Where points contradict each other, as in scans that do not quite fit, even subsets are
  /// oriented as well, and their signs taken where they explain the cloud better. Not where points
  /// have sensors of their own, which decide.
  bool coarse_levels = true;

  /// Where no sensor is known, look for some, see findSensors(): those that are sure count as if
  /// they were given. orientCloud() does it; what takes segments from elsewhere does not. By the
  /// other methods they change normals only: those that are chosen (NormalEstimator::AUTO and k =
  /// 0) are of planes of more neighbours in scans.
  bool find_sensors = true;

  // The normals that are returned.
  int filter_rounds = 2;      ///< of averaging over neighbours that are on one sheet; 0 = off
  bool filter_wedges = true;  ///< its special care for narrow wedges
  /// Where noise leaves two faces possible, and where bodies touch or overlap, the field of all
  /// oriented points decides. It also tilts doubtful normals, if there are filter_rounds.
  bool winding_normals = true;
  /// Surfaces are fitted around each point at last, on one side of sharp edges, as
  /// NormalEstimator::AUTO does it; with noise, averaged with the above. Not where positions were
  /// smoothed, nor for scans whose noise is more than next to none and a few neighbours do not see.
  bool fit_normals = true;
};

/// How segments are oriented. Angles in radians.
struct OrientationSettings {
  OrientationMethod method = OrientationMethod::AUTO;

  // The paper's methods.
  /// Paper's gamma: angles up to here, and from pi - gamma on, decide; extremal points must be as
  /// near.
  float gamma = 0.6108652F;
  SegmentAngle angle = SegmentAngle::ACROSS_BORDER;
  BoundaryTest boundary = BoundaryTest::LOCAL;
  TriangulationSettings triangulation;  ///< for BoundaryTest::TRIANGULATED
  float min_margin = 0.5F;  ///< majority that a boundary needs to decide: 0.5 is three to one
  std::size_t max_box_points =
      120;  ///< most points in a box of the subdivision for extremal points
  /// Whether segments and borders are checked (beyond the paper): segments that lie over
  /// themselves, or contradict a large part of their borders, are dissolved, as they run from one
  /// side over to another where bodies touch, and their points oriented one by one; a link whose
  /// angle and whose boundary say opposite things decides nothing in COMBINED and EXTREMAL. Not for
  /// PROPAGATION.
  bool check_borders = true;

  // The default method.
  AutomaticOptions automatic;

  /// Whether each connected component is turned outward; otherwise its largest segment keeps its
  /// sign, or, by EXTREMAL, what extremal points say about each segment is the last word. HOPPE has
  /// its own rule: the highest point's normal points up (paper, 3.1). orientCloud() by
  /// AUTO always turns them.
  bool turn_outward = true;
  /// What is known beforehand, by input row; null = nothing. Only AUTO uses it, but for
  /// OrientationHints::suggested, which goes with find_sensors.
  std::shared_ptr<const OrientationHints> hints;
};

/// The same with the number of threads.
struct OrientationOptions : OrientationSettings {
  int threads = 0;  ///< 0 = all cores; no result depends on it
};

/// The paper's rules to the letter for one of its methods: angles between reference normals,
/// boundaries from triangulations with the paper's critical length and its gaps left open, no check
/// of borders beyond the paper, components left as their first segment was. \param method
/// PROPAGATION, BOUNDARY, EXTREMAL, COMBINED or HOPPE
SEGORIENT_ORIENTATION_EXPORT OrientationOptions
paperOptions(OrientationMethod method = OrientationMethod::COMBINED);

/// Names of those settings that were changed from their defaults and that their method does not
/// look at, such as "gamma" with OrientationMethod::AUTO. The classes warn of them.
SEGORIENT_ORIENTATION_EXPORT std::vector<std::string> settingsWithoutEffect(
    const OrientationSettings& settings);

}  // namespace segorient
