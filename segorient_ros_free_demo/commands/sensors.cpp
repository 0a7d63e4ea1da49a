// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <segorient/orientation/sensors.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "commands/commands.h"
#include "io/output_file.h"
#include "io/readers.h"
#include "support/command_line.h"
#include "support/hint_options.h"
#include "support/json.h"
#include "support/report_lists.h"
#include "support/sensor_report.h"
#include "support/stage_options.h"

namespace segorient::program {
namespace po = boost::program_options;
namespace {

using Position = std::array<double, 3>;

// A place that the file names, and how many points were seen from there.
struct GivenSensor {
  Position position{0, 0, 0};
  std::size_t points = 0;
};

// By fields vp_x, vp_y, vp_z, else the file's own viewpoint where that is not 0; most points first.
std::vector<GivenSensor> givenSensors(const CloudTable& table) {
  std::map<Position, std::size_t> counts;
  const std::array<const Field*, 3> from{table.find("vp_x"), table.find("vp_y"),
                                         table.find("vp_z")};
  if (from[0] != nullptr && from[1] != nullptr && from[2] != nullptr) {
    for (std::size_t i = 0; i < table.size; ++i) {
      const Position p = table.triple(from, i);
      if (std::isfinite(p[0]) && std::isfinite(p[1]) && std::isfinite(p[2])) ++counts[p];
    }
  } else {
    const Position p{table.viewpoint[0], table.viewpoint[1], table.viewpoint[2]};
    if (p != Position{0, 0, 0}) counts[p] = table.size;
  }
  std::vector<GivenSensor> out;
  for (const auto& [position, points] : counts) out.push_back({position, points});
  std::stable_sort(out.begin(), out.end(),
                   [](const auto& a, const auto& b) { return a.points > b.points; });
  return out;
}

void printGiven(const std::vector<GivenSensor>& given, bool verbose) {
  constexpr std::size_t kShown = 10;
  if (given.empty()) {
    std::printf("given           none\n");
    return;
  }
  std::printf("given           %zu\n", given.size());
  for (std::size_t i = 0; i < given.size(); ++i) {
    if (i == kShown && !verbose) {
      std::printf("  and %zu more\n", given.size() - i);
      break;
    }
    const Position& p = given[i].position;
    std::printf("  (%.6g, %.6g, %.6g) for %zu points\n", p[0], p[1], p[2], given[i].points);
  }
}

std::string jsonText(std::size_t points, const std::vector<GivenSensor>& given,
                     const SensorReport& report, const Position& origin) {
  JsonWriter json;
  json.field("points", points);
  json.beginArray("given");
  for (const GivenSensor& s : given) {
    json.beginItem();
    json.field("x", s.position[0]);
    json.field("y", s.position[1]);
    json.field("z", s.position[2]);
    json.field("points", s.points);
    json.endObject();
  }
  json.endArray();
  addList(json, "sensors", report.sensors, origin);
  json.field("deviation", report.deviation);
  json.field("chance", report.chance);
  json.field("faces_up", report.faces_up);
  json.field("why", report.why);
  return json.finish();
}

}  // namespace

int runSensors(const std::vector<std::string>& words) {
  CommandLine line(
      "sensors IN [OUT.json] [options]",
      "Says where the sensors of IN stood: what the file says of them, and what its\n"
      "points do, whose density falls with distance and incidence from where they were\n"
      "seen. OUT.json has all of it.",
      "segorient sensors scan.pcd sensors.json");
  CommonOptions common;
  line.arguments({"IN", "OUT.json"}, 1);
  takeSharedOptions(line);
  common.add(line, "a line for every sensor");
  if (!line.parse(words)) return 0;
  common.check();
  warnOfSharedOptions(line, common);
  const std::string out = line.argument("OUT.json");
  std::optional<OutputFile> file;
  if (!out.empty()) {
    requireEnding(out, {".json"});
    file.emplace(out);
  }

  const CloudTable table = readUsableCloud(line.argument("IN"));
  const std::vector<GivenSensor> given = givenSensors(table);
  const LocalPoints points(table);
  SensorOptions options;
  options.threads = common.threads;
  options.image_width = imageWidth(table);
  options.suggestions = {localOrigin(points)};
  const SensorReport report = findSensors(points.view(), options);
  if (!common.quiet) {
    std::printf("points          %zu\n", table.size);
    printGiven(given, common.verbose);
    std::printf("found           %zu: %s\n", report.sensors.size(), report.why.c_str());
    for (const FoundSensor& s : report.sensors) {
      std::printf("  %s\n", describeSensor(s, points.origin()).c_str());
    }
  }
  if (file) {
    file->write(jsonText(table.size, given, report, points.origin()));
    file->commit();
    if (!common.quiet) std::printf("written         %s\n", out.c_str());
  }
  return 0;
}

}  // namespace segorient::program
