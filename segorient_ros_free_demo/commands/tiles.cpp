// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <algorithm>
#include <charconv>
#include <cstdio>
#include <filesystem>

#include "commands/commands.h"
#include "support/command_line.h"
#include "support/hint_options.h"
#include "support/stage_options.h"
#include "support/tile_flags.h"
#include "tiles/input_state.h"
#include "tiles/plan_inputs.h"
#include "tiles/steps.h"

namespace segorient::program {
namespace {

constexpr const char* kPurpose =
    "The steps of 'orient --memory', one by one, for any engine that can run commands on\n"
    "machines that share a folder:\n"
    "  segorient tiles plan DIR IN... OUT --memory 2G   once, first; prints how many tiles\n"
    "  segorient tiles tile DIR N                       each tile from 0 on, in any order\n"
    "  segorient tiles join DIR                         once, after all tiles; prints which of "
    "them\n"
    "                                                   are to be worked on again\n"
    "  segorient tiles tile DIR N                       these again, in any order, or not: write\n"
    "                                                   does what is left of that\n"
    "  segorient tiles write DIR [N]                    each output from 0 on, or all\n"
    "  segorient tiles draw DIR OUT.ply                 after join: tiles, halos and the graph as "
    "a\n"
    "                                                   cloud, for 'render --color rgb'\n"
    "  segorient tiles clean DIR                        removes the steps' files\n"
    "Files are there whole or not at all; a step whose result is there does nothing.\n"
    "'tile' without N works on all tiles that are not done. See segorient/doc/tiles.md.";

constexpr const char* kExample = "segorient tiles plan work scans/ out.ply --memory 4G";

int runPlan(const std::vector<std::string>& words) {
  CommandLine line("tiles plan DIR IN... OUT [options]", kPurpose, kExample);
  CommonOptions common;
  StageOptions stages;
  HintOptions hints;
  TileFlags tiles;
  line.argumentsMany("IN", "OUT");
  tiles.add(line);
  stages.add(line, LastStage::ORIENTATION);
  hints.add(line);
  common.add(line);
  if (!line.parse(words)) return 0;
  common.check();
  PipelineOptions options;
  stages.apply(line, common, options);
  hints.check(line, common, options);
  require(tiles.wanted(), "--memory is missing: how much one step may take, as in --memory 2G");
  TileRequest request = tiles.request(line, common, options, hints);
  require(request.inputs.size() >= 2, "IN is missing: segorient tiles plan DIR IN... OUT");
  const std::string folder = request.inputs[0];
  request.inputs.erase(request.inputs.begin());
  Plan names;
  planFiles(request, names);  // what is wrong with the names is known before there is a folder
  const WorkFolder work(folder, true);
  work.removeUnfinished();
  const Plan plan = planStep(request, folder);
  std::printf("tiles %zu\noutputs %zu\n", plan.tiles(), plan.outputs.size());
  return 0;
}

// What is no folder of ours is not to be made one, nor to be emptied.
void requireFolder(const std::string& folder) {
  if (!std::filesystem::exists(folder + "/lock")) throw FileError(folder, "is no work folder");
}

std::size_t numberOf(const std::string& text, std::size_t count, const char* what) {
  std::size_t n = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), n);
  require(error == std::errc() && end == text.data() + text.size(),
          "'" + text + "' is no number of " + what);
  require(n < count, "there is no " + std::string(what) + " " + text + ": they are 0 to " +
                         std::to_string(count - 1));
  return n;
}

// Calls step(n) for the one that is asked for, or for all.
template <typename Step>
void forEachAsked(const std::string& number, std::size_t count, const char* what,
                  const Step& step) {
  const bool one = !number.empty();
  const std::size_t first = one ? numberOf(number, count, what) : 0;
  for (std::size_t n = first; n < (one ? first + 1 : count); ++n) step(n);
}

}  // namespace

int runTiles(const std::vector<std::string>& words) {
  const std::string step = words.empty() ? "" : words[0];
  const std::vector<std::string> rest(words.begin() + (words.empty() ? 0 : 1), words.end());
  if (step == "plan") return runPlan(rest);
  CommandLine line("tiles plan|tile|join|write|draw|clean DIR [N] [options]", kPurpose, kExample);
  CommonOptions common;
  line.arguments({"STEP", "DIR", "N"}, 1);
  common.add(line);
  if (!line.parse(words)) return 0;
  common.check();
  require(step == "tile" || step == "join" || step == "write" || step == "draw" || step == "clean",
          "'" + step + "' is no step: plan, tile, join, write, draw or clean");
  const std::string folder = line.argument("DIR");
  const std::string number = line.argument("N");
  const bool draws = step == "draw";
  require(step == "tile" || step == "write" || draws || number.empty(), step + " takes no number");
  require(!draws || !number.empty(), "OUT.ply is missing: segorient tiles draw DIR OUT.ply");
  if (draws) requireEnding(number, {".ply", ".pcd"});
  if (step == "clean") {
    if (!std::filesystem::exists(folder)) return 0;  // it was cleaned already
    requireFolder(folder);
    WorkFolder(folder, true).remove();
    return 0;
  }
  const Plan plan = loadPlan(folder);  // before the folder is made where there is none
  const WorkFolder work(folder, step == "join");
  if (step == "join") {
    joinStep(plan, folder, common.threads);
    for (const std::size_t t : tilesAgain(plan, folder)) std::printf("again %zu\n", t);
  }
  if (draws) drawStep(plan, folder, number);
  if (step == "tile") {
    forEachAsked(number, plan.tiles(), "tile", [&](std::size_t n) {
      const bool joined = std::filesystem::exists(joinPath(folder));
      (joined ? finishStep : tileStep)(plan, folder, n, common.threads);
    });
  }
  if (step == "write") {
    forEachAsked(number, plan.outputs.size(), "output",
                 [&](std::size_t n) { writeStep(plan, folder, n, common.threads); });
  }
  return 0;
}

}  // namespace segorient::program
