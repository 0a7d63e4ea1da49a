// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/export.h>
#include <segorient/common/point_view.h>
#include <segorient/orientation/orientation_hints.h>
#include <segorient/orientation/pipeline.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace segorient {

/// What a normal contradicts.
enum class NormalFault : std::uint8_t {
  NONE,       ///< nothing, or it could not be judged
  SENSOR,     ///< the sensor that saw the point: the normal turns its back to it
  SURFACE,    ///< the normals around: the surface would have to turn over between them
  INSIDE_OUT  ///< in and out: with nearly all others of its closed part, it points inward
};

/// none, sensor, surface or inside_out.
SEGORIENT_ORIENTATION_EXPORT const char* toString(NormalFault fault);

/// A connected patch of normals at fault.
struct FaultyPlace {
  NormalFault fault = NormalFault::SURFACE;  ///< what most of it contradicts
  std::size_t points = 0;
  std::array<float, 3> center{0.F, 0.F, 0.F};  ///< mean of its points
  float size = 0.F;                            ///< longest side of the box around it
  float confidence = 0.F;  ///< mean of that of the orientation that it was compared with
  std::int32_t scan = -1;  ///< that more than half of its points are of, if scans are known
};

/// The points of one scan whose sensor is known.
struct ScanCheck {
  std::int32_t scan = 0;
  std::size_t judged = 0;
  std::size_t against_sensor = 0;
};

/// What checkNormals() found; rows are those of the input.
struct NormalCheck {
  std::vector<NormalFault> faults;     ///< one a row
  std::vector<std::int32_t> place_of;  ///< one a row: into `places`, or -1
  std::vector<FaultyPlace> places;     ///< the largest first
  std::vector<ScanCheck> scans;        ///< by number
  std::size_t judged = 0;              ///< rows
  std::size_t at_fault = 0;            ///< rows in places
  std::size_t without_normal = 0;      ///< rows whose normal is NaN or 0, or that have no place
  std::size_t unlike = 0;  ///< rows whose normal is not even nearly along the surface's: not judged
};

/// Which normals that a cloud has contradict what is known of its sensors, or its surface, as
/// orientCloud() finds it. Only signs are judged, and only where the normal is within 60 degrees of
/// the line that was found.
///
/// A single point, and a patch so narrow that each of its points has neighbours of the other
/// opinion, proves nothing: noise and sharp edges make such. Where the surface's own orientation is
/// in doubt (confidence below 0.5), or turns over along the patch's border itself (a Moebius band
/// must, somewhere), nothing is said either. A part is inside out only if it is closed; which side
/// of an open surface is meant is its owner's choice.
///
/// \param normals 3 floats a row, of any length; NaN or 0 = none
/// \param ours of orientCloud() for these points, with these hints and OrientationMethod::AUTO,
///        without using `normals`
/// \return empty vectors where the sizes do not agree
SEGORIENT_ORIENTATION_EXPORT NormalCheck checkNormals(const PointView& points,
                                                      const std::vector<float>& normals,
                                                      const OrientedCloud& ours,
                                                      const OrientationHints& hints,
                                                      int threads = 0);

}  // namespace segorient
