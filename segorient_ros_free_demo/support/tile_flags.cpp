// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "support/tile_flags.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>

#include "io/cloud_stream.h"
#include "support/memory.h"
#include "tiles/plan_inputs.h"
#include "tiles/run_tiles.h"

namespace segorient::program {
namespace po = boost::program_options;
namespace {

// Bytes that all inputs take in memory, with all that orienting takes beside them; 0 where they
// can't be read point by point.
std::uint64_t bytesAsAWhole(const std::vector<std::string>& inputs,
                            const PipelineOptions& options) {
  std::uint64_t points = 0;
  std::uint64_t bytes = 0;
  for (const std::string& path : listClouds(inputs)) {
    if (!CloudStream::canRead(path)) return 0;
    const CloudStream stream(path, 4096);
    points += stream.size();
    bytes += stream.size() * stream.layout().row_bytes;
  }
  return bytes + expectedMemory(static_cast<std::size_t>(points), options);
}

}  // namespace

void TileFlags::add(CommandLine& line) {
  line.options()(
      "memory", po::value(&memory_),
      "work tile by tile in so much memory, as in 2G, on inputs of any size; IN may then "
      "be folders, and OUT a folder that is there: one OUT for each IN")(
      "work", po::value(&folder_),
      "the folder for tiles, beside OUT by default; a run that was interrupted goes on there");
  line.unlisted()("tile-points", po::value(&tile_points_));
  line.unlisted()("available-memory", po::value(&available_));
}

bool TileFlags::needed(const CommandLine& line, const CommonOptions& common,
                       const PipelineOptions& options) {
  if (options.orientation.method != OrientationMethod::AUTO) return false;
  const std::uint64_t available = available_ > 0 ? available_ : availableMemory();
  const auto most = static_cast<std::uint64_t>(0.8 * static_cast<double>(available));
  std::uint64_t bytes = 0;
  try {
    bytes = bytesAsAWhole(line.inputs(), options);
  } catch (const FileError&) {
    return false;  // who reads it says why it can't be read
  }
  if (bytes <= available || (most < kLeastMemory && available_ == 0)) return false;
  std::uint64_t memory = std::max(most, kLeastMemory);
  const std::string folder = workFolderOf(line.argument("OUT"), folder_);
  if (std::filesystem::exists(planPath(folder))) memory = loadPlan(folder).memory;
  memory_ = std::to_string(memory);
  if (common.quiet) return true;
  char text[160];
  std::snprintf(text, sizeof(text),
                ": would take about %.1f GB of memory, and %.1f GB are free: tile by tile, as with "
                "--memory %.1fG",
                static_cast<double>(bytes) / 1e9, static_cast<double>(available) / 1e9,
                static_cast<double>(memory) / 1e9);
  warn(line.inputs()[0] + text);
  return true;
}

TileRequest TileFlags::request(const CommandLine& line, const CommonOptions& common,
                               const PipelineOptions& options, const HintOptions& hints) const {
  require(options.orientation.method == OrientationMethod::AUTO,
          "tile by tile, there is no method but auto");
  TileRequest request;
  request.inputs = line.inputs();
  request.output = line.argument("OUT");
  request.memory = parseMemory(memory_);
  request.tile_points = tile_points_;
  request.k = options.k;
  if (line.given("alpha")) request.alpha = options.segmentation.alpha;
  if (line.given("beta")) request.beta = options.segmentation.beta;
  if (line.given("epsilon")) request.epsilon = options.segmentation.epsilon;
  request.threads = common.threads;
  hints.apply(request);
  return request;
}

}  // namespace segorient::program
