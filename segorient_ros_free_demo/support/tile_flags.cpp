// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "support/tile_flags.h"

#include "tiles/run_tiles.h"

namespace segorient::program {
namespace po = boost::program_options;
namespace {

// What works on the whole cloud at once, or is joined to it by time.
constexpr const char* kWholeOnly[] = {
    "trajectory", "seeds", "keep-orientation", "report", "normals", "recompute", "alpha", "beta",
    "gamma",      "delta", "epsilon"};

}  // namespace

void TileFlags::add(CommandLine& line) {
  line.options()(
      "memory", po::value(&memory_),
      "work tile by tile in so much memory, as in 2G, on inputs of any size; IN may then "
      "be folders, and OUT a folder that is there: one OUT for each IN")(
      "work", po::value(&folder_),
      "the folder for tiles, beside OUT by default; a run that was interrupted goes on there");
  line.unlisted()("tile-points", po::value(&tile_points_));
}

TileRequest TileFlags::request(const CommandLine& line, const CommonOptions& common,
                               const PipelineOptions& options, const HintOptions& hints) const {
  require(options.orientation.method == OrientationMethod::AUTO,
          "tile by tile, there is no method but auto");
  for (const char* name : kWholeOnly) {
    require(!line.given(name), "--" + std::string(name) + " is not for tiles (--memory)");
  }
  TileRequest request;
  request.inputs = line.inputs();
  request.output = line.argument("OUT");
  request.memory = parseMemory(memory_);
  request.tile_points = tile_points_;
  request.k = options.k;
  request.threads = common.threads;
  hints.apply(request);
  return request;
}

}  // namespace segorient::program
