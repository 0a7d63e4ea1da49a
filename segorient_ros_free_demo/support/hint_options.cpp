// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "support/hint_options.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>

#include "io/join_clouds.h"
#include "io/readers.h"
#include "support/stage_options.h"

namespace segorient::program {
namespace po = boost::program_options;
namespace {

// Three fields of every point, less `origin`.
std::vector<float> columns(const CloudTable& table, const std::array<const Field*, 3>& fields,
                           const std::array<double, 3>& origin) {
  std::vector<float> out;
  out.reserve(3 * table.size);
  for (std::size_t i = 0; i < table.size; ++i) {
    const auto v = table.triple(fields, i);
    for (std::size_t a = 0; a < 3; ++a) out.push_back(static_cast<float>(v[a] - origin[a]));
  }
  return out;
}

std::array<float, 3> moved(const std::array<double, 3>& position,
                           const std::array<double, 3>& origin) {
  std::array<float, 3> out{};
  for (std::size_t a = 0; a < 3; ++a) out[a] = static_cast<float>(position[a] - origin[a]);
  return out;
}

void addSeeds(const std::string& path, const std::array<double, 3>& origin,
              OrientationHints& hints) {
  const CloudTable seeds = readUsableCloud(path);
  if (!seeds.hasNormals()) throw FileError(path, "has no normals");
  for (std::size_t i = 0; i < seeds.size; ++i) {
    hints.seeds.push_back({moved(seeds.position(i), origin),
                           moved(seeds.triple(seeds.normals(), i), {0.0, 0.0, 0.0})});
  }
}

std::vector<std::int32_t> scansOf(const CloudTable& table, const Field& field) {
  std::vector<std::int32_t> out(table.size, -1);
  for (std::size_t i = 0; i < table.size; ++i) {
    const double v = table.value(field, i);
    if (v >= 0.0 && v < 2147483648.0) out[i] = static_cast<std::int32_t>(v);
  }
  return out;
}

// When each point was measured.
std::vector<double> timesOf(const CloudTable& table, const std::string& path) {
  for (const char* name : {"time", "gps_time", "t", "timestamp", "GPSTime"}) {
    const Field* field = table.find(name);
    if (field == nullptr) continue;
    std::vector<double> out;
    out.reserve(table.size);
    for (std::size_t i = 0; i < table.size; ++i) out.push_back(table.value(*field, i));
    return out;
  }
  throw FileError(path,
                  "has no field time, gps_time, t, timestamp or GPSTime to join a trajectory to");
}

void addTrajectory(const Trajectory& trajectory, const std::string& path, bool quiet,
                   CloudTable& table) {
  const TrajectoryJoin join = addViewpoints(trajectory, path, table);
  requireJoined(trajectory, join, path);
  if (!quiet) std::printf("trajectory      %zu points have a place of the sensor\n", join.joined);
}

}  // namespace

void requireJoined(const Trajectory& trajectory, const TrajectoryJoin& join,
                   const std::string& path) {
  if (join.joined == 0) throw FileError(path, explainNoOverlap(trajectory, join));
  const std::size_t without = join.outside + join.without_time;
  if (without > 0) {
    warn(path + ": " + std::to_string(without) +
         " points were not measured within the trajectory's time; it says no sensor for them");
  }
}

TrajectoryJoin addViewpoints(const Trajectory& trajectory, const std::string& path,
                             CloudTable& table) {
  TrajectoryJoin join = joinTrajectory(trajectory, timesOf(table, path));
  const std::array<const Field*, 3> known = table.viewpoints();
  const bool had = table.hasViewpoints();
  std::vector<double> before;
  for (std::size_t i = 0; had && i < table.size; ++i) {
    for (const double v : table.triple(known, i)) before.push_back(v);
  }
  const std::uint32_t size = table.find("x")->size;
  table.appendFields(
      {{"vp_x", 'F', size, 1, 0}, {"vp_y", 'F', size, 1, 0}, {"vp_z", 'F', size, 1, 0}});
  const std::array<const Field*, 3> to = table.viewpoints();
  for (std::size_t i = 0; i < table.size; ++i) {
    const bool joined = std::isfinite(join.viewpoints[3 * i]);
    for (std::size_t a = 0; a < 3; ++a) {
      table.setReal(*to[a], i, had && !joined ? before[3 * i + a] : join.viewpoints[3 * i + a]);
    }
  }
  return join;
}

CloudTable HintOptions::read(const std::vector<std::string>& paths, bool quiet) const {
  std::vector<CloudTable> clouds;
  clouds.reserve(paths.size());
  for (const std::string& path : paths) clouds.push_back(readUsableCloud(path));
  const std::string name = paths.size() == 1 ? paths[0] : paths[0] + " and others";
  CloudTable table = paths.size() == 1
                         ? std::move(clouds[0])
                         : joinClouds(std::move(clouds), paths, viewpoint_text_.empty() && !up_);
  if (paths.size() > 1) {
    for (const std::string& note : table.notes) warn(note);
  }
  if (!trajectory_.empty()) addTrajectory(readTrajectory(trajectory_), name, quiet, table);
  return table;
}

std::array<float, 3> localOrigin(const LocalPoints& points) {
  return moved({0.0, 0.0, 0.0}, points.origin());
}

std::size_t imageWidth(const CloudTable& layout, std::uint64_t points) {
  return layout.height > 1 && layout.width * layout.height == points ? layout.width : 0;
}

void HintOptions::add(CommandLine& line, bool keeps) {
  line.options()("viewpoint", po::value(&viewpoint_text_),
                 "=X,Y,Z: where all was seen from, else as the file says; what could be seen from "
                 "there faces it")(
      "trajectory", po::value(&trajectory_),
      "text, time x y z a line: where a moving sensor was; joined to the points' time (field time, "
      "gps_time, t, timestamp or GPSTime)")("up", po::bool_switch(&up_),
                                            "the sensor was far above (+z), as on an aircraft")(
      "closed", po::bool_switch(&closed_), "each part has an inside, whatever one viewpoint says")(
      "open", po::bool_switch(&open_), "one viewpoint decides, whatever looks like an inside")(
      "seeds", po::value(&seeds_), "a cloud of points whose normals are known")(
      "no-sensors", po::bool_switch(&no_sensors_),
      "do not look for where the sensors stood; see segorient sensors");
  auto options = keeps ? line.options() : line.unlisted();
  options("keep-orientation", po::bool_switch(&keep_),
          "take the signs of the normals that IN has as evidence");
}

void HintOptions::check(const CommandLine& line, const CommonOptions& common,
                        const PipelineOptions& options) {
  require(!(closed_ && open_), "--closed and --open exclude each other");
  require(!up_ || viewpoint_text_.empty(), "--up and --viewpoint exclude each other");
  char end = 0;
  const bool three = std::sscanf(viewpoint_text_.c_str(), "%lf,%lf,%lf%c", &viewpoint_[0],
                                 &viewpoint_[1], &viewpoint_[2], &end) == 3;
  const bool finite = std::all_of(viewpoint_.begin(), viewpoint_.end(), [](double v) {
    return std::fabs(v) <= static_cast<double>(std::numeric_limits<float>::max());
  });
  quiet_ = common.quiet;
  require(viewpoint_text_.empty() || (three && finite),
          "--viewpoint takes three numbers, as in --viewpoint=1.5,0,-2");
  if (options.orientation.method == OrientationMethod::AUTO || common.quiet) return;
  constexpr const char* kWhy = "without method auto";
  nameUnused(line, {"viewpoint", "trajectory", "up", "closed", "open", "seeds", "keep-orientation"},
             kWhy);
  if (!choosesNormals(options)) nameUnused(line, {"no-sensors"}, kWhy);
}

void HintOptions::apply(const CloudTable& table, const std::string& path, const LocalPoints& points,
                        PipelineOptions& options) const {
  const std::array<double, 3>& origin = points.origin();
  options.orientation.automatic.find_sensors = !no_sensors_;
  auto hints = std::make_shared<OrientationHints>();
  hints->suggested = {localOrigin(points)};
  if (closed_) hints->surface = SurfaceKind::CLOSED;
  if (open_) hints->surface = SurfaceKind::OPEN;
  const std::array<double, 3> sensor{table.viewpoint[0], table.viewpoint[1], table.viewpoint[2]};
  const bool has_sensor = sensor != std::array<double, 3>{0.0, 0.0, 0.0};
  if (up_) {
    hints->has_direction = true;
  } else if (!viewpoint_text_.empty() || has_sensor) {
    hints->has_viewpoint = true;
    hints->viewpoint = moved(viewpoint_text_.empty() ? sensor : viewpoint_, origin);
  }
  if (table.hasViewpoints()) {
    hints->viewpoints = columns(table, table.viewpoints(), origin);
    const bool all = std::all_of(hints->viewpoints.begin(), hints->viewpoints.end(),
                                 [](float v) { return std::isfinite(v); });
    if (all && !quiet_ && (up_ || !viewpoint_text_.empty())) {
      warn(std::string(up_ ? "--up" : "--viewpoint") + " changes nothing where " + path +
           " says where each point was seen from (vp_x vp_y vp_z)");
    }
  }
  if (const Field* scan = table.find("scan")) hints->scans = scansOf(table, *scan);
  hints->grids = table.grids;
  if (table.height > 1) hints->grids = {{0, table.width, table.height}};
  if (!seeds_.empty()) addSeeds(seeds_, origin, *hints);
  if (keep_) {
    if (!table.hasNormals()) throw FileError(path, "has no normals whose orientation to keep");
    hints->normals = columns(table, table.normals(), {0.0, 0.0, 0.0});
  }
  options.orientation.hints = hints;
}

void HintOptions::apply(TileRequest& request) const {
  request.has_viewpoint = !viewpoint_text_.empty();
  request.viewpoint = viewpoint_;
  request.up = up_;
  request.closed = closed_;
  request.open = open_;
  request.find_sensors = !no_sensors_;
  request.keep_orientation = keep_;
  request.seeds = seeds_;
  request.trajectory = trajectory_;
}

}  // namespace segorient::program
