// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/segmentation/segmentation.h>

#include <cstddef>
#include <cstdint>
#include <vector>

#include "orientation/automatic/border_votes.h"
#include "orientation/sensors/hint_votes.h"
#include "orientation/sensors/known_sensors.h"
#include "segmentation/sheet_segmentation.h"

namespace segorient::detail {

/// What the sensors say of one point's normal as it is: in standard errors of its angle, above 0
/// where it faces its sensor. 0 where that is unknown.
std::vector<float> facingOf(const SheetField& field, std::size_t points,
                            const KnownSensors& sensors);

/// Sums of that by segment, for the sign that its points share; no point counts for more than the
/// sensor alone would decide.
std::vector<Ballot> facingBySegment(const std::vector<float>& facing,
                                    const Segmentation& segmentation);

/// The signs of segments of which sensors saw enough, and then of those that borders tie to them.
/// \param others_follow whether those are turned, too
/// \param signs of the segments, as the surface has them; changed
/// \return which segments sensors decided
std::vector<bool> turnToSensors(const std::vector<Ballot>& ballots,
                                const std::vector<BorderVote>& votes, bool others_follow,
                                std::vector<std::int8_t>& signs);

/// Whether that many standard errors leave no doubt, so that the point need not ask its surface.
bool isClear(double facing);

}  // namespace segorient::detail
