// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/orientation/orientation_result.h>

#include <cstdint>
#include <string>
#include <vector>

#include "tiles/plan.h"

// The steps of a cloud that is oriented tile by tile. Each makes files of others, moves them to
// their places when they are whole, and does nothing if they are there already; so each may be
// repeated, on any machine that sees the folder. All throw FileError.
namespace segorient::program {

/// Reads the inputs twice: cuts them into tiles, and gives each tile a file with its points and
/// those around it; measures what no tile can tell alone.
/// \param folder to work in, see WorkFolder
Plan planStep(const TileRequest& request, const std::string& folder,
              const StepProgress& progress = {});

/// Normals, pieces, votes and segments of one tile.
void tileStep(const Plan& plan, const std::string& folder, std::size_t tile, int threads);

/// After the join: the same tile again with the signs of the whole cloud, if its own were others.
void finishStep(const Plan& plan, const std::string& folder, std::size_t tile, int threads);

/// After all tiles are finished: the segments of the whole cloud. \return how many they are
std::uint64_t labelStep(const Plan& plan, const std::string& folder);

/// What was found in joining, for summaries.
struct JoinSummary {
  std::uint64_t pieces = 0;
  std::uint64_t again = 0;                             ///< tiles that have to be worked on again
  std::vector<ComponentOrientationResult> components;  ///< by descending number of points
  bool sensors_dropped = false;  ///< whether those that are known are left aside
};

/// The signs of all tiles' pieces, from what tiles say of them.
JoinSummary joinStep(const Plan& plan, const std::string& folder, int threads);
/// After the join: the tiles that have to be worked on again, ascending.
std::vector<std::size_t> tilesAgain(const Plan& plan, const std::string& folder);

/// Writes one output: the points of its inputs in their order. Finishes tiles that are not.
void writeStep(const Plan& plan, const std::string& folder, std::size_t output, int threads,
               const StepProgress& progress = {});

/// Draws what steps up to join made, as a coloured cloud: tiles apart from each other, each with
/// its halo in grey, and above them the graph of the larger pieces, black where pieces of one tile
/// vote on each other, red where two tiles have points of both. For clouds that fit in memory.
void drawStep(const Plan& plan, const std::string& folder, const std::string& out);

/// Bytes that a step takes for each point of its tile (395 were measured), beside what the program
/// takes anyway.
constexpr std::uint64_t kBytesPerPoint = 450;
constexpr std::uint64_t kBytesAnyway = 150'000'000;

}  // namespace segorient::program
