// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/orientation/orientation_hints.h>

#include <array>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "common/bulk_bounds.h"
#include "tiles/tile_share.h"
#include "tiles/tile_tree.h"

namespace segorient::program {

/// What the user asked for.
struct TileRequest {
  std::vector<std::string> inputs;  ///< files, in order
  std::string output;               ///< a file, or an existing folder
  std::uint64_t memory = 0;         ///< bytes of one step
  std::uint64_t tile_points = 0;    ///< most points of a tile; 0 = as the memory allows
  std::int32_t k = 0;               ///< neighbours; 0 = the default
  std::array<double, 3> viewpoint{0, 0, 0};
  bool has_viewpoint = false;
  bool up = false;
  bool closed = false;
  bool open = false;
  bool find_sensors = true;
  bool keep_orientation = false;
  std::string seeds;       ///< a file, or empty
  std::string trajectory;  ///< a file, or empty
  float alpha = 0.F;       ///< settings of segments, see TileOptions
  float beta = 0.F;
  float epsilon = 0.F;
  int threads = 0;  ///< changes no result
};

/// A file that points are read from, and what tells whether it was changed since.
struct PlanInput {
  std::string path;
  std::string streamed;  ///< where its points are read: the same, or a copy that can be streamed
  std::uint64_t bytes = 0;
  std::int64_t time = 0;
  std::uint64_t head = 0;  ///< checksum of its first bytes
  std::uint64_t first_row = 0;
  std::uint64_t rows = 0;
};

/// A file that is written: the results of some inputs.
struct PlanOutput {
  std::string path;
  std::uint32_t first_input = 0;
  std::uint32_t inputs = 0;
};

/// A point whose normal is known.
struct PlanSeed {
  std::array<double, 3> position{0, 0, 0};
  std::array<double, 3> normal{0, 0, 0};
};

/// What plan found out and all other steps go by.
struct Plan {
  std::uint64_t run = 0;  ///< stands for inputs, outputs and options
  std::vector<PlanInput> inputs;
  std::vector<PlanOutput> outputs;
  std::uint64_t rows = 0;
  std::uint64_t finite = 0;
  std::uint64_t memory = 0;  ///< as it was asked for
  std::array<double, 3> origin{0, 0, 0};
  Bounds bulk;  ///< where the points are but for strays, as a sample tells
  TileTree tree;
  double step = 0.0;  ///< what coordinates in tiles are multiples of; 0 = of nothing
  std::vector<std::array<double, 3>> tile_origins;
  std::vector<std::uint64_t> tile_points;  ///< own ones
  TileTraits traits;
  std::int32_t k = 0;
  std::uint32_t patch_points = 1;
  std::uint64_t chunk_rows = 1;  ///< rows of an output that plan and write hold at once
  bool has_viewpoints = false;   ///< whether points carry where they were seen from
  bool has_viewpoint = false;
  std::array<double, 3> viewpoint{0, 0, 0};
  bool up = false;
  bool closed = false;
  bool open = false;
  bool find_sensors = true;
  bool keep_orientation = false;
  bool adds_scans = false;       ///< whether outputs get a field scan: the number of the input
  bool adds_viewpoints = false;  ///< whether they get fields vp_x, vp_y, vp_z
  float alpha = 0.F;
  float beta = 0.F;
  float epsilon = 0.F;
  std::uint32_t found_sensors = 0;
  CloudPlace place;
  /// Whether the one place that all points were said to have been seen from is not followed.
  bool place_refused = false;
  std::string trajectory;
  std::vector<PlanSeed> seeds;

  std::size_t tiles() const { return tile_points.size(); }
  /// Whether points carry to which side their normals are: as they were in the input, or the mean
  /// direction to where they were seen from.
  bool hasNormals() const { return keep_orientation || place.seen_within; }
};

/// Called with the share of a step that is done, 0 to 1.
using StepProgress = std::function<void(double)>;

Plan loadPlan(const std::string& folder);
void savePlan(const Plan& plan, const std::string& folder);

/// A finite place as tiles have it: its owner is the tile of that.
std::array<double, 3> storedPlace(const Plan& plan, const std::array<double, 3>& place);

/// What is known of all points alike, in coordinates relative to `origin`.
OrientationHints hintsOf(const Plan& plan, const std::array<double, 3>& origin);

/// Throws FileError if an input is no longer what it was.
void requireUnchanged(const Plan& plan);

/// "DIR/tile-000007.points".
std::string tilePath(const std::string& folder, std::size_t tile, const char* ending);
std::string planPath(const std::string& folder);
std::string joinPath(const std::string& folder);
std::string fieldPath(const std::string& folder);
std::string labelsPath(const std::string& folder);

}  // namespace segorient::program
