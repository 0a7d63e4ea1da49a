// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "tiles/run_tiles.h"

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "common/peak_memory.h"
#include "io/output_file.h"
#include "support/command_line.h"
#include "support/json.h"
#include "support/progress_bar.h"
#include "support/report_lists.h"
#include "support/stage_options.h"
#include "tiles/input_state.h"
#include "tiles/plan_inputs.h"

namespace segorient::program {
namespace {

// Shares of the time.
constexpr double kPlanned = 0.1;
constexpr double kTiled = 0.75;
constexpr double kJoined = 0.8;
constexpr double kFinished = 0.93;

std::string stageName(const char* stage, std::size_t tile, std::size_t tiles) {
  return std::string(stage) + " " + std::to_string(tile + 1) + "/" + std::to_string(tiles);
}

// Whether a place that was given is not followed.
bool leavesPlaceAside(const Plan& plan, const JoinSummary& joined) {
  return plan.place_refused || (plan.found_sensors == 0 && joined.sensors_dropped);
}

// What all steps did.
struct TilesRun {
  Plan plan;
  JoinSummary joined;
  std::uint64_t segments = 0;
  std::vector<StageTime> seconds;  // of each step

  double total() const {
    double sum = 0.0;
    for (const StageTime& step : seconds) sum += step.seconds;
    return sum;
  }
};

// Times steps one after the other.
class StepClock {
 public:
  explicit StepClock(std::vector<StageTime>& times) : times_(times) {}

  void ended(const char* step) {
    const auto now = Clock::now();
    times_.push_back({step, std::chrono::duration<double>(now - begin_).count()});
    begin_ = now;
  }

 private:
  using Clock = std::chrono::steady_clock;

  std::vector<StageTime>& times_;
  Clock::time_point begin_ = Clock::now();
};

std::string reportText(const TilesRun& run) {
  const Plan& plan = run.plan;
  const JoinSummary& joined = run.joined;
  JsonWriter json;
  json.field("points", plan.rows);
  json.field("non_finite", plan.rows - plan.finite);
  json.field("tiles", plan.tiles());
  json.field("tiles_finished_again", joined.again);
  json.field("pieces", joined.pieces);
  json.field("segments", run.segments);
  json.field("sensors_found", joined.sensors_dropped ? 0U : plan.found_sensors);
  json.field("seen_within", plan.place.seen_within);
  json.field("faces_up", plan.place.faces_up);
  json.field("viewpoint_left_aside", leavesPlaceAside(plan, joined));
  json.field("noise_in_spacings", plan.traits.noise);
  json.field("denoised", plan.traits.denoise != 0);
  json.beginObject("seconds");
  for (const StageTime& step : run.seconds) json.field(step.stage.c_str(), step.seconds);
  json.field("total", run.total());
  json.endObject();
  json.field("peak_memory_bytes", peakMemory());
  addList(json, "components", joined.components);
  return json.finish();
}

TilesRun runSteps(const TileRequest& request, const std::string& folder, WorkFolder& work,
                  ProgressBar& bar) {
  TilesRun run;
  StepClock clock(run.seconds);
  const auto report = [&](const std::string& stage, double from, double to) {
    return [&bar, stage, from, to](double share) { bar.update(stage, from + (to - from) * share); };
  };
  try {
    run.plan = planStep(request, folder, report("plan", 0.0, kPlanned));
  } catch (...) {
    // There is nothing to go on with, unless the folder is that of another run.
    if (!std::filesystem::exists(planPath(folder))) work.remove();
    throw;
  }
  clock.ended("plan");
  const Plan& plan = run.plan;
  bar.setItems(plan.rows);
  const auto all_tiles = [&](const char* stage, double from, double to, auto step) {
    double done = 0.0;
    for (std::size_t t = 0; t < plan.tiles(); ++t) {
      bar.update(stageName(stage, t, plan.tiles()), from + (to - from) * done);
      step(plan, folder, t, request.threads);
      done += static_cast<double>(plan.tile_points[t]) / static_cast<double>(plan.finite);
    }
    clock.ended(stage);
  };
  all_tiles("tile", kPlanned, kTiled, tileStep);
  bar.update("join", kTiled);
  run.joined = joinStep(plan, folder, request.threads);
  clock.ended("join");
  all_tiles("finish", kJoined, kFinished, finishStep);
  run.segments = labelStep(plan, folder);
  const auto outputs = static_cast<double>(plan.outputs.size());
  for (std::size_t o = 0; o < plan.outputs.size(); ++o) {
    const double from = kFinished + (1.0 - kFinished) * static_cast<double>(o) / outputs;
    writeStep(plan, folder, o, request.threads,
              report("write", from, from + (1.0 - kFinished) / outputs));
  }
  clock.ended("write");
  return run;
}

void printSummary(const TilesRun& run) {
  const Plan& plan = run.plan;
  const JoinSummary& joined = run.joined;
  std::printf("points          %llu, %llu not finite\n", static_cast<unsigned long long>(plan.rows),
              static_cast<unsigned long long>(plan.rows - plan.finite));
  std::printf("tiles           %zu, of which %llu were worked on again with the whole's signs\n",
              plan.tiles(), static_cast<unsigned long long>(joined.again));
  std::printf("segments        %llu, of %llu pieces in %llu components\n",
              static_cast<unsigned long long>(run.segments),
              static_cast<unsigned long long>(joined.pieces),
              static_cast<unsigned long long>(joined.components.size()));
  if (plan.found_sensors > 0) {
    std::printf("sensors found   %u%s\n", plan.found_sensors,
                joined.sensors_dropped ? ", but see surfaces from both sides" : "");
  }
  if (plan.place.seen_within) std::printf("sensors found   none, but it was seen from within\n");
  if (plan.place.faces_up) {
    std::printf("sensors found   none, but it is one surface, which faces up\n");
  }
  if (leavesPlaceAside(plan, joined)) {
    std::printf("viewpoint       left aside: the surface contradicts it, or knows better\n");
  }
  std::printf("seconds         %.2f: %s\n", run.total(), timesText(run.seconds).c_str());
  for (const PlanOutput& out : plan.outputs) std::printf("written         %s\n", out.path.c_str());
}

}  // namespace

std::uint64_t parseMemory(const std::string& text) {
  char* end = nullptr;
  const double number = std::strtod(text.c_str(), &end);
  std::string unit(end);
  if (!unit.empty() && (unit.back() == 'B' || unit.back() == 'b')) unit.pop_back();
  double factor = 0.0;
  if (unit.empty()) factor = 1.0;
  if (unit == "M" || unit == "m") factor = 1e6;
  if (unit == "G" || unit == "g") factor = 1e9;
  if (unit == "T" || unit == "t") factor = 1e12;
  const double bytes = number * factor;
  require(end != text.c_str() && factor > 0.0 && std::isfinite(bytes) && bytes < 1e18,
          "--memory takes a size, as in --memory 2G");
  require(bytes >= static_cast<double>(kLeastMemory), "--memory must be 200M at least");
  return static_cast<std::uint64_t>(bytes);
}

std::string workFolderOf(std::string output, const std::string& folder) {
  if (!folder.empty()) return folder;
  while (output.size() > 1 && output.back() == '/') output.pop_back();
  return output + ".work";
}

void runAllSteps(const TileRequest& request, const std::string& folder_asked_for,
                 const std::string& report_path, bool quiet) {
  const std::string folder = workFolderOf(request.output, folder_asked_for);
  Plan names;
  planFiles(request, names);  // what is wrong with the names is known before there is a folder
  // Files of folders are named here first.
  for (const PlanInput& in : names.inputs) requireOwnReport(report_path, in.path, "IN");
  for (const PlanOutput& out : names.outputs) requireOwnReport(report_path, out.path, "OUT");
  if (!report_path.empty()) requireWritable(report_path);
  WorkFolder work(folder, true);
  work.removeUnfinished();
  TilesRun run;
  {
    ProgressBar bar(!quiet, 0);
    run = runSteps(request, folder, work, bar);
  }
  if (!report_path.empty()) {
    OutputFile file(report_path);
    file.write(reportText(run));
    file.commit();
  }
  work.remove();
  if (!quiet) printSummary(run);
}

}  // namespace segorient::program
