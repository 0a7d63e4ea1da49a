// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/neighborhoods.h>

#include <cstddef>
#include <cstdint>
#include <vector>

#include "orientation/automatic/border_votes.h"
#include "tiles/join_tiles.h"

namespace segorient::detail {

/// The votes between the pieces of all tiles, ascending by (a, b): those of borders, and those of
/// points that two tiles have. Votes of several tiles on the same two add up.
///
/// Pieces that are the same are not simply put together: where a piece of one tile mixes two sides,
/// which it may by a leak at the rim of its halo, its ties to both contradict the borders between
/// these, and no tie may be the last word.
SEGORIENT_TILES_EXPORT std::vector<BorderVote> gatherVotes(std::vector<TileVote> votes,
                                                           const std::vector<PieceTie>& ties);

/// Labels that are next to each other along a border; where corners touch, some pairs of neighbours
/// mean little.
SEGORIENT_TILES_EXPORT std::vector<LabelBorder> labelBorders(
    const Neighborhoods& neighborhoods, const std::vector<std::int32_t>& labels);

/// Unites labels that most of what each has in the other's tile ties together, those that have most
/// points in common first; numbered by descending size, then by the first that had it. Where tiles
/// cut a smooth surface in different ways, each tie is right, but a chain of them would unite
/// segments that are next to each other in one tile: such are never united.
/// \param pairs of labels \param borders labels that are next to each other
/// \param count those with points \return by label
SEGORIENT_TILES_EXPORT std::vector<std::uint32_t> uniteLabels(
    const std::vector<std::uint32_t>& sizes, std::vector<PieceTie> pairs,
    const std::vector<LabelBorder>& borders, std::size_t& count);

}  // namespace segorient::detail
