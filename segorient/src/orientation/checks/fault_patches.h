// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/orientation/check_normals.h>

#include <cstdint>
#include <vector>

#include "search/prepared_cloud.h"

namespace segorient {

/// Neighbours that are asked for their opinion: those within about 1.6 spacings.
constexpr int kCheckNeighbors = 8;
/// Three votes of four; see SegmentOrientationResult.
constexpr float kConfident = 0.5F;

/// What is known of the normal of a distinct point.
struct Judgement {
  std::int8_t sign = 0;    ///< +1 along our normal, -1 against it, 0 not judged
  std::int8_t facing = 0;  ///< +1 its sensor sees the normal's front, -1 its back, 0 not known
  float seen = 0.F;        ///< cosine between normal and sensor, 0 not known
  NormalFault fault = NormalFault::NONE;
};

/// Points at fault that hang together and prove something.
struct FaultPatches {
  std::vector<FaultyPlace> places;      ///< fault and confidence only
  std::vector<std::int32_t> of_points;  ///< into `places`, -1 where there is none
};

/// \param cloud with a table of kCheckNeighbors
/// \param ours by input row
FaultPatches findFaultPatches(const PreparedCloud& cloud, const std::vector<Judgement>& judgements,
                              const OrientedCloud& ours);

}  // namespace segorient
