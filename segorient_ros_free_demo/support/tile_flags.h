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
  /// Whether it is the only way: the inputs can be read point by point, and would not fit in what
  /// memory there is as a whole. Then it is as if it had been asked for, with most of that memory,
  /// or as much as a run had that is to be gone on with; and said on standard error unless `quiet`.
  bool needed(const CommandLine& line, const CommonOptions& common, const PipelineOptions& options);
  const std::string& folder() const { return folder_; }

  /// Before anything is read: throws UsageError where values make no sense, or options do not go
  /// together with tiles.
  TileRequest request(const CommandLine& line, const CommonOptions& common,
                      const PipelineOptions& options, const HintOptions& hints) const;

 private:
  std::string memory_;
  std::string folder_;
  std::uint64_t tile_points_ = 0;
  std::uint64_t available_ = 0;  ///< instead of what there is; 0 = what there is
};

}  // namespace segorient::program
