// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/orientation/trajectory.h>

#include <cstdint>

#include "io/cloud_stream.h"
#include "tiles/plan.h"

namespace segorient::program {

/// An input's points block by block, with the fields that outputs get beside the input's own: where
/// the sensor was at each point's time, and, of several inputs to one output, which one it is.
class PlannedInput {
 public:
  /// \param trajectory may have no poses
  PlannedInput(const Plan& plan, const PlanInput& input, const Trajectory& trajectory);
  const CloudTable& layout() const { return stream_.layout(); }
  /// \param most points of the block \return false behind the last one
  bool next(CloudTable& block, std::uint64_t most);
  /// How many scans the blocks so far are of.
  std::uint64_t scans() const { return scans_; }

 private:
  void addScan(CloudTable& block);

  const Plan& plan_;
  const PlanInput& input_;
  const Trajectory& trajectory_;
  CloudStream stream_;
  CloudTable read_;
  std::uint64_t scans_ = 1;
};

/// The plan's; none where it has none.
Trajectory trajectoryOf(const Plan& plan);

}  // namespace segorient::program
