// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/orientation/trajectory.h>

#include <cstdint>
#include <functional>

#include "io/cloud_table.h"
#include "tiles/plan.h"
#include "tiles/point_packets.h"

namespace segorient::program {

/// Reads the points of an output's inputs block by block, with the fields that outputs get beside
/// the inputs' own: where the sensor was at each point's time, and, of several inputs to one
/// output, which one it is. Chunks, Plan::chunk_rows of them at most, are the same whenever they
/// are read.
///
/// \param trajectory see trajectoryOf()
/// \param joined if not null, its numbers of points and its times get those of all blocks
/// \param visit may take the block over
/// \param end called behind each chunk, and behind the last block
void forEachBlock(const Plan& plan, const PlanOutput& output, const Trajectory& trajectory,
                  const std::function<void(CloudTable&)>& visit, const std::function<void()>& end,
                  TrajectoryJoin* joined = nullptr);

/// Places and cells of a block's points as tiles have them. \param out room for all of them
void storePoints(const Plan& plan, const CloudTable& block, int threads, StoredPoint* out);

/// The plan's; without poses where it has none.
Trajectory trajectoryOf(const Plan& plan);

}  // namespace segorient::program
