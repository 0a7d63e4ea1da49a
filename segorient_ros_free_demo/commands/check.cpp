// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <segorient/orientation/check_normals.h>

#include <array>
#include <cstdio>
#include <cstring>
#include <optional>

#include "commands/commands.h"
#include "io/cloud_writer.h"
#include "io/output_file.h"
#include "io/readers.h"
#include "render/scene.h"
#include "support/command_line.h"
#include "support/hint_options.h"
#include "support/json.h"
#include "support/memory.h"
#include "support/progress_bar.h"
#include "support/report_lists.h"
#include "support/stage_options.h"

namespace segorient::program {
namespace po = boost::program_options;
namespace {

constexpr int kFaultsFound = 3;  // exit status
constexpr std::size_t kPlacesShown = 5;

std::vector<float> ownNormals(const CloudTable& table) {
  std::vector<float> out;
  out.reserve(3 * table.size);
  for (std::size_t i = 0; i < table.size; ++i) {
    for (const double v : table.triple(table.normals(), i)) out.push_back(static_cast<float>(v));
  }
  return out;
}

double percent(std::size_t part, std::size_t whole) {
  return whole == 0 ? 0.0 : 100.0 * static_cast<double>(part) / static_cast<double>(whole);
}

const char* inWords(NormalFault fault) {
  switch (fault) {
    case NormalFault::SENSOR:
      return "turn their backs to the sensor";
    case NormalFault::INSIDE_OUT:
      return "point inward: a closed part inside out";
    default:
      return "point to the other side than the surface around";
  }
}

std::array<double, 3> moved(const std::array<float, 3>& v, const std::array<double, 3>& origin) {
  std::array<double, 3> out = origin;
  for (std::size_t a = 0; a < 3; ++a) out[a] += static_cast<double>(v[a]);
  return out;
}

void printSummary(const NormalCheck& check, const std::array<double, 3>& origin, bool verbose) {
  std::printf("points          %zu, %zu judged", check.faults.size(), check.judged);
  if (check.without_normal > 0) std::printf(", %zu without normal", check.without_normal);
  if (check.unlike > 0) std::printf(", %zu not along the surface's normal", check.unlike);
  std::printf("\ncontradicting   %zu (%.3f %%) in %zu places\n", check.at_fault,
              percent(check.at_fault, check.judged), check.places.size());
  for (std::size_t i = 0; i < check.places.size(); ++i) {
    if (i == kPlacesShown && !verbose) {
      std::printf("  and %zu more\n", check.places.size() - i);
      break;
    }
    const FaultyPlace& p = check.places[i];
    const std::array<double, 3> where = moved(p.center, origin);
    std::printf("  %9zu points near (%g, %g, %g), size %.3g, %s", p.points, where[0], where[1],
                where[2], static_cast<double>(p.size), inWords(p.fault));
    if (p.scan >= 0) std::printf(", scan %d", p.scan);
    std::printf("\n");
  }
  for (const ScanCheck& s : check.scans) {
    if (s.against_sensor == 0) continue;
    std::printf("scan %-10d %.3f %% of %zu normals turn their backs to its sensor\n", s.scan,
                percent(s.against_sensor, s.judged), s.judged);
  }
}

std::string reportText(const NormalCheck& check, const std::array<double, 3>& origin) {
  JsonWriter json;
  json.field("points", check.faults.size());
  json.field("judged", check.judged);
  json.field("contradicting", check.at_fault);
  json.field("share", percent(check.at_fault, check.judged) / 100.0);
  json.field("without_normal", check.without_normal);
  json.field("unlike", check.unlike);
  addList(json, "places", check.places, origin);
  addList(json, "scans", check.scans);
  return json.finish();
}

// IN with fields that tell each point's fault and place.
void writeMarked(const CloudTable& table, const NormalCheck& check, OutputFile& file) {
  std::vector<std::uint8_t> faults;
  std::vector<std::uint32_t> places;
  for (std::size_t i = 0; i < check.faults.size(); ++i) {
    faults.push_back(static_cast<std::uint8_t>(check.faults[i]));
    places.push_back(static_cast<std::uint32_t>(check.place_of[i]));  // -1: the largest number
  }
  OutputCloud out(table);
  out.add("contradiction", faults.data());
  out.add("place", places.data());
  out.addRest(table);
  writeCloud(out, file);
}

// The cloud in grey, and what is at fault in red.
void drawFaults(const CloudTable& table, const LocalPoints& points, const NormalCheck& check,
                int threads, OutputFile& file) {
  constexpr std::uint32_t kRight = 0xe6e2d8U;
  constexpr std::uint32_t kFault = 0xd03020U;
  CloudTable colors;
  colors.addField("rgb", 'F', 4);
  colors.size = table.size;
  colors.rows.resize(colors.size * colors.row_bytes);
  std::vector<float> normals(4 * table.size, 0.F);
  for (std::size_t i = 0; i < table.size; ++i) {
    const std::uint32_t color = check.place_of[i] < 0 ? kRight : kFault;
    std::memcpy(colors.at(colors.fields[0], i), &color, sizeof(color));
    const auto n = table.triple(table.normals(), i);
    for (std::size_t a = 0; a < 3; ++a) normals[4 * i + a] = static_cast<float>(n[a]);
  }
  const Scene scene = makeScene(colors, points, normals.data(), Coloring::Rgb, threads);
  writePng(drawViews(scene, View{}, true), file);
}

// What is written, each only if it is asked for; opened before anything is read.
struct CheckOutputs {
  std::optional<OutputFile> cloud;
  std::optional<OutputFile> report;
  std::optional<OutputFile> picture;

  CheckOutputs(const std::string& cloud_path, const std::string& report_path,
               const std::string& picture_path) {
    if (!cloud_path.empty()) {
      requireEnding(cloud_path, {".pcd", ".ply", ".las"});
      cloud.emplace(cloud_path);
    }
    if (!picture_path.empty()) {
      requireEnding(picture_path, {".png"});
      picture.emplace(picture_path);
    }
    if (!report_path.empty()) report.emplace(report_path);
  }

  void write(const CloudTable& table, const LocalPoints& points, const NormalCheck& check,
             int threads) {
    if (report) report->write(reportText(check, points.origin()));
    if (cloud) writeMarked(table, check, *cloud);
    if (picture) drawFaults(table, points, check, threads, *picture);
    for (std::optional<OutputFile>* file : {&report, &cloud, &picture}) {
      if (*file) (*file)->commit();
    }
  }
};

// By what the cloud's own orientation and its sensors say.
NormalCheck checkCloud(const CloudTable& table, const LocalPoints& points,
                       const PipelineOptions& options, bool quiet) {
  ProgressBar bar(!quiet, table.size);
  const OrientedCloud ours =
      orientCloud(points.view(), nullptr, options,
                  [&](const char* stage, double fraction) { bar.update(stage, 0.9 * fraction); });
  bar.update("check", 0.9);
  return checkNormals(points.view(), ownNormals(table), ours, *options.orientation.hints,
                      options.threads);
}

}  // namespace

int runCheck(const std::vector<std::string>& words) {
  CommandLine line(
      "check IN [OUT] [options]",
      "Which of the normals that IN has contradict the sensors that saw its points, or\n"
      "its surface: patches that are turned over, and closed parts that are inside out.\n"
      "Sensors are those that IN brings along, or the options name. Exit status: 0 none\n"
      "does, 3 some do. OUT (.pcd, .ply or .las) has the points of IN with fields\n"
      "contradiction (0 none, 1 sensor, 2 surface, 3 inside out) and place (4294967295\n"
      "where there is none).",
      "segorient check scan.ply --picture places.png --report places.json");
  CommonOptions common;
  HintOptions hints;
  std::string report_path;
  std::string picture_path;
  line.arguments({"IN", "OUT"}, 1);
  hints.add(line, false);
  line.options()("report", po::value(&report_path), "what was found, as JSON")(
      "picture", po::value(&picture_path), "PNG: from two sides, what is at fault in red");
  takeSharedOptions(line);
  common.add(line, "all places that contradict");
  if (!line.parse(words)) return 0;
  common.check();
  warnOfSharedOptions(line, common);
  require(!line.given("keep-orientation") || !line.get<bool>("keep-orientation"),
          "check does not take --keep-orientation: it would believe the normals that it judges");
  PipelineOptions options;
  options.threads = common.threads;
  hints.check(line, common, options);
  for (const char* name : {"IN", "OUT"}) requireOwnReport(report_path, line.argument(name), name);
  requireOwnReport(report_path, picture_path, "--picture");
  CheckOutputs outputs(line.argument("OUT"), report_path, picture_path);

  const std::string path = line.argument("IN");
  const CloudTable table = hints.read({path}, common.quiet);
  if (!table.hasNormals()) throw FileError(path, "has no normals to check");
  requireMemory(path, expectedMemory(table.size, options), availableMemory());
  const LocalPoints points(table);
  hints.apply(table, path, points, options);
  const NormalCheck check = checkCloud(table, points, options, common.quiet);
  // "None contradicts" would be said of nothing.
  if (!check.faults.empty() && check.without_normal == check.faults.size()) {
    throw FileError(path, "has no normals to check: all are zero or not finite");
  }
  outputs.write(table, points, check, common.threads);
  if (!common.quiet) printSummary(check, points.origin(), common.verbose);
  return check.places.empty() ? 0 : kFaultsFound;
}

}  // namespace segorient::program
