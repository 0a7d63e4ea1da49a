// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <string>

#include "support/command_line.h"
#include "support/hint_options.h"
#include "support/stage_options.h"
#include "tiles/plan.h"

namespace segorient::program {

/// Options about working tile by tile.
class TileFlags {
 public:
  void add(CommandLine& line);
  /// Whether that was asked for.
  bool wanted() const { return !memory_.empty(); }
  const std::string& folder() const { return folder_; }

  /// Before anything is read: throws UsageError where values make no sense, or options do not go
  /// together with tiles.
  TileRequest request(const CommandLine& line, const CommonOptions& common,
                      const PipelineOptions& options, const HintOptions& hints) const;

 private:
  std::string memory_;
  std::string folder_;
  std::uint64_t tile_points_ = 0;
};

}  // namespace segorient::program
