// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/export.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace segorient {

/// What an orientation rests on.
enum class DecidedBy : std::uint8_t {
  NOTHING,       ///< no evidence; the sign is arbitrary
  SEED,          ///< the segment that its component started from
  PROPAGATION,   ///< angle to an oriented neighbour
  BOUNDARY,      ///< direction of the boundary shared with an oriented neighbour
  EXTREMAL,      ///< extremal points of the object
  ENCLOSURE,     ///< extremal points, and lying inside other components
  SURROUNDINGS,  ///< votes of the oriented points around
  GLOBAL,        ///< an energy over the whole component or cloud
  HINTS          ///< what was known beforehand, see OrientationHints
};

/// nothing, seed, propagation, boundary, extremal, enclosure, surroundings, global or hints.
SEGORIENT_ORIENTATION_EXPORT const char* toString(DecidedBy by);

/// The orientation of one segment.
struct SegmentOrientationResult {
  std::int8_t sign = 0;  ///< +1 keeps the reference normal, -1 inverts everything in it
  DecidedBy by = DecidedBy::NOTHING;
  float confidence = 0.F;       ///< 0 a guess, 1 all evidence agrees
  std::int32_t component = -1;  ///< into OrientationResult::components
  bool hard = false;            ///< no method decided it: the sign is the best evidence there is
  /// What its extremal points say about the sign: 1 all agree, -1 all contradict; 0 where there are
  /// none, or the method does not ask them. Near -1 at the rims of open objects (paper, 3.3).
  float extremal_agreement = 0.F;
};

/// The orientation of one connected component: which way is out.
struct ComponentOrientationResult {
  DecidedBy by = DecidedBy::NOTHING;
  std::int8_t sign = 1;  ///< what its relative orientation was multiplied by
  /// How far the evidence spoke for its side before that: -1 all against, 1 all for. From the
  /// winding number (AUTO) 0 to 1.
  float evidence = 0.F;
  float votes = 0.F;       ///< how much evidence there was: the paper's methods, in extremal points
  float confidence = 0.F;  ///< of the sign, 0 a guess, 1 all evidence agrees
  /// Share of the borders between its segments that the result contradicts. Far from 0: the surface
  /// is not orientable, or segments mix two sides of it.
  float contradiction = 0.F;
  /// How far the winding number of the cloud is from 1/2 on it, mean square: near 0 for a clean
  /// closed surface, below 0.1 for a noisy one, 1/4 for a sheet. 1 where nobody asked.
  float residual = 1.F;
  /// Share of what is known of single points (seeds, normals) that the result contradicts; AUTO.
  float against_known = 0.F;
  std::size_t points = 0;
};

/// A border where sure evidence was overruled: the surface cannot be oriented there.
struct Contradiction {
  std::int32_t a = 0;  ///< segments
  std::int32_t b = 0;
  float weight = 0.F;                         ///< votes overruled
  std::array<float, 3> where{0.F, 0.F, 0.F};  ///< a point of the border
};

/// What speaks against one component's signs at one scale, see ComponentOrientationResult.
struct ComponentEnergy {
  std::size_t points = 0;
  float borders = 0.F;  ///< contradiction
  float winding = 1.F;  ///< residual
  float known = 0.F;    ///< against_known
};

/// What speaks against the signs that a scale found, as shares of the surface: see the part
/// "Scans that do not quite fit" of the page about orientation.
struct ScaleEnergy {
  float radius = 0.F;   ///< no two points of the subset are nearer, in spacings; 0 = all points
  float outside = 0.F;  ///< of closed surface in front of points, where nothing should be
  float facing = 0.F;   ///< pairs of neighbours that face each other
  float backs = 0.F;    ///< pairs with their backs to each other, as on thin walls; costs nothing
  float total = 0.F;    ///< outside + 3 facing: the least is best
  bool taken = false;
  std::vector<ComponentEnergy> components;  ///< by descending number of the scale's points
};

/// Segments that certain borders hold together: their relative orientation was not in doubt, but
/// for single ones that the winding number of a clean closed surface has turned over.
struct ClusterOrientationResult {
  std::size_t points = 0;
  std::int32_t component = -1;  ///< into OrientationResult::components
  float confidence = 0.F;       ///< how far its borders to other clusters agree; 1 without any
};

/// What every method of orientation returns. The oriented normal of point i is
/// point_signs[i] times its input normal.
struct OrientationResult {
  std::vector<SegmentOrientationResult> segments;      ///< by label
  std::vector<ComponentOrientationResult> components;  ///< by descending number of points
  std::vector<std::int8_t> point_signs;        ///< +1 or -1; 0 only where there is no normal
  std::vector<float> point_confidences;        ///< 0 to 1
  std::vector<std::int32_t> point_components;  ///< -1 where there is no normal
};

}  // namespace segorient
