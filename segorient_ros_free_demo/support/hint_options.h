// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/orientation/pipeline.h>
#include <segorient/orientation/trajectory.h>

#include <string>
#include <vector>

#include "io/cloud_table.h"
#include "support/command_line.h"
#include "tiles/plan.h"

namespace segorient::program {

/// The origin of the file's coordinates, as `points` have it: where many sensors put themselves.
std::array<float, 3> localOrigin(const LocalPoints& points);

/// A trajectory of another time base says nothing: throws FileError. Of one that ends early it
/// warns. \param path names what was joined in messages
void requireJoined(const Trajectory& trajectory, const TrajectoryJoin& join,
                   const std::string& path);

/// Gives each point its place at the point's time as vp_x, vp_y, vp_z; where the trajectory says
/// none, those that it had. \param path names `table` in messages
TrajectoryJoin addViewpoints(const Trajectory& trajectory, const std::string& path,
                             CloudTable& table);

/// Pixels in a row of an organised cloud, else 0.
/// \param points that it has; the layout of a file that is streamed has none itself
std::size_t imageWidth(const CloudTable& layout, std::uint64_t points);
inline std::size_t imageWidth(const CloudTable& table) {
  return imageWidth(table, table.size);
}

/// What a user knows about the orientation beforehand, as options of the commands that orient; and
/// what the files say themselves: the place of a sensor, fields vp_x, vp_y, vp_z and scan, and
/// grids.
class HintOptions {
 public:
  /// \param keeps whether --keep-orientation makes sense: otherwise it is taken, but not listed
  void add(CommandLine& line, bool keeps = true);

  /// Before anything is read: throws UsageError where values make no sense.
  void check(const CommandLine& line, const CommonOptions& common, const PipelineOptions& options);

  /// Reads one cloud as it is, several as joinClouds() does. With a trajectory, each point gets its
  /// place at the point's time as vp_x, vp_y, vp_z; how many did is said on standard output unless
  /// `quiet`.
  CloudTable read(const std::vector<std::string>& paths, bool quiet) const;

  /// \param path names `table` in messages
  /// \param points of `table`; hints are moved as they are
  void apply(const CloudTable& table, const std::string& path, const LocalPoints& points,
             PipelineOptions& options) const;
  /// The same for work tile by tile, which reads the clouds itself.
  void apply(TileRequest& request) const;

 private:
  std::string viewpoint_text_;
  std::array<double, 3> viewpoint_{0, 0, 0};
  std::string seeds_;
  std::string trajectory_;
  bool up_ = false;
  bool closed_ = false;
  bool open_ = false;
  bool keep_ = false;
  bool no_sensors_ = false;
  bool quiet_ = false;
};

}  // namespace segorient::program
