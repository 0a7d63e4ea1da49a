// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <map>
#include <optional>

#include "commands/commands.h"
#include "io/output_file.h"
#include "io/readers.h"
#include "support/command_line.h"
#include "support/json.h"
#include "support/stage_options.h"

namespace segorient::program {
namespace {

// Positions of a row may differ by rounding to float on the way, by 1e-5 of the extent.
constexpr double kPositionTolerance = 1e-5;
constexpr double kFloatStep = 1.2e-7;
constexpr double kDegrees = 57.295779513082320877;

struct Evaluation {
  std::size_t points = 0;
  std::size_t scored = 0;          // points that have a true normal
  std::size_t without_normal = 0;  // of those, points whose result has none; they count as wrong
  std::size_t agreeing = 0;
  std::size_t opposite = 0;
  std::size_t agreeing_by_part = 0;  // with the better sign of each part
  std::size_t parts = 0;             // 0: the truth has no field `part`
  // Angles in degrees; NaN where no point has both normals.
  double rms = NAN;
  double median = NAN;
  double p90 = NAN;

  double share(std::size_t n) const {
    return scored == 0 ? 0.0 : 100.0 * static_cast<double>(n) / static_cast<double>(scored);
  }
};

std::optional<std::array<double, 3>> unitNormal(const CloudTable& table, std::size_t row) {
  std::array<double, 3> n = table.triple(table.normals(), row);
  const double length = std::hypot(n[0], n[1], n[2]);
  if (!std::isfinite(length) || length == 0.0) return std::nullopt;
  for (double& v : n) v /= length;
  return n;
}

void checkSamePoints(const CloudTable& truth, const CloudTable& result, const std::string& path) {
  if (truth.size != result.size) {
    throw FileError(path, "has " + std::to_string(result.size) + " points, the truth has " +
                              std::to_string(truth.size));
  }
  const LocalPoints local(truth);
  const double tolerance = kPositionTolerance * local.extent() + kFloatStep * local.reach();
  for (std::size_t i = 0; i < truth.size; ++i) {
    const auto a = truth.position(i);
    const auto b = result.position(i);
    for (std::size_t c = 0; c < 3; ++c) {
      const bool both_bad = !std::isfinite(a[c]) && !std::isfinite(b[c]);
      if (!both_bad && !(std::abs(a[c] - b[c]) <= tolerance)) {
        throw FileError(path, "point " + std::to_string(i) + " is not where the truth has it");
      }
    }
  }
}

void setAngles(std::vector<double>& angles, Evaluation& e) {
  if (angles.empty()) return;
  double sum = 0.0;
  for (const double a : angles) sum += a * a;
  e.rms = std::sqrt(sum / static_cast<double>(angles.size()));
  const auto quantile = [&](double q) {
    const auto at = static_cast<std::ptrdiff_t>(q * static_cast<double>(angles.size() - 1));
    std::nth_element(angles.begin(), angles.begin() + at, angles.end());
    return angles[static_cast<std::size_t>(at)];
  };
  e.median = quantile(0.5);
  e.p90 = quantile(0.9);
}

Evaluation evaluate(const CloudTable& truth, const CloudTable& result) {
  struct Votes {
    std::size_t agreeing = 0;
    std::size_t opposite = 0;
  };
  Evaluation e;
  e.points = truth.size;
  const Field* part = truth.find("part");
  std::map<double, Votes> parts;
  std::vector<double> angles;
  for (std::size_t i = 0; i < truth.size; ++i) {
    const auto t = unitNormal(truth, i);
    if (!t) continue;
    ++e.scored;
    const auto r = unitNormal(result, i);
    if (!r) {
      ++e.without_normal;
      continue;
    }
    const double dot = (*t)[0] * (*r)[0] + (*t)[1] * (*r)[1] + (*t)[2] * (*r)[2];
    ++(dot > 0.0 ? e.agreeing : e.opposite);
    if (part != nullptr) {
      Votes& votes = parts[truth.value(*part, i)];
      ++(dot > 0.0 ? votes.agreeing : votes.opposite);
    }
    angles.push_back(kDegrees * std::acos(std::min(1.0, std::abs(dot))));
  }
  setAngles(angles, e);
  e.parts = parts.size();
  for (const auto& [id, votes] : parts) {
    e.agreeing_by_part += std::max(votes.agreeing, votes.opposite);
  }
  return e;
}

void print(const Evaluation& e) {
  const std::size_t flipped = std::max(e.agreeing, e.opposite);
  std::printf("points                      %zu", e.points);
  if (e.scored != e.points) std::printf(" (%zu with a true normal)", e.scored);
  std::printf("\noriented as the truth       %.4f %%  (%zu wrong)\n", e.share(e.agreeing),
              e.scored - e.agreeing);
  std::printf("with one global flip        %.4f %%  (%zu wrong%s)\n", e.share(flipped),
              e.scored - flipped, e.opposite > e.agreeing ? "; flipped" : "; not needed");
  if (e.parts > 0) {
    std::printf("with a flip of each part    %.4f %%  (%zu wrong, %zu parts)\n",
                e.share(e.agreeing_by_part), e.scored - e.agreeing_by_part, e.parts);
  }
  if (e.without_normal > 0) std::printf("without a normal            %zu\n", e.without_normal);
  std::printf("angle to the true normal    ");
  if (std::isnan(e.rms)) {
    std::printf("-\n");
    return;
  }
  std::printf("rms %.3f  median %.3f  p90 %.3f deg  (sign ignored)\n", e.rms, e.median, e.p90);
}

std::string report(const Evaluation& e) {
  JsonWriter json;
  json.field("points", e.points);
  json.field("scored", e.scored);
  json.field("without_normal", e.without_normal);
  json.field("oriented_percent", e.share(e.agreeing));
  json.field("oriented_percent_global_flip", e.share(std::max(e.agreeing, e.opposite)));
  json.field("flipped", e.opposite > e.agreeing);
  if (e.parts > 0) {
    json.field("parts", e.parts);
    json.field("oriented_percent_part_flips", e.share(e.agreeing_by_part));
  }
  json.beginObject("angle_degrees");
  json.field("rms", e.rms);
  json.field("median", e.median);
  json.field("p90", e.p90);
  json.endObject();
  return json.finish();
}

}  // namespace

int runEvaluate(const std::vector<std::string>& words) {
  CommandLine line(
      "evaluate TRUTH RESULT [options]",
      "Compares the normals of RESULT with the true ones of TRUTH, point by point: both\n"
      "hold the same points in the same order. Prints the share of points that are\n"
      "oriented as the truth, as they are and after the better global flip (and after\n"
      "one flip of each part, if TRUTH has a field `part`), and the angles between the\n"
      "normals. A point of RESULT without a normal counts as wrong.",
      "segorient evaluate truth.ply oriented.pcd --report score.json");
  std::string report_path;
  CommonOptions common;
  line.arguments({"TRUTH", "RESULT"});
  line.options()("report", boost::program_options::value(&report_path), "the same as JSON");
  takeSharedOptions(line);
  common.add(line);
  if (!line.parse(words)) return 0;
  common.check();
  warnOfSharedOptions(line, common);
  for (const char* name : {"TRUTH", "RESULT"}) {
    requireOwnReport(report_path, line.argument(name), name);
  }

  std::optional<OutputFile> report_file;
  if (!report_path.empty()) report_file.emplace(report_path);
  const CloudTable truth = readCloud(line.argument("TRUTH"));
  const CloudTable result = readCloud(line.argument("RESULT"));
  if (!truth.hasNormals()) throw FileError(line.argument("TRUTH"), "has no normals");
  if (!result.hasNormals()) throw FileError(line.argument("RESULT"), "has no normals");
  checkSamePoints(truth, result, line.argument("RESULT"));
  const Evaluation e = evaluate(truth, result);
  if (e.scored == 0) {
    throw FileError(line.argument("TRUTH"), "has no normals: all are zero or not finite");
  }
  if (!common.quiet) print(e);
  if (report_file) {
    report_file->write(report(e));
    report_file->commit();
  }
  return 0;
}

}  // namespace segorient::program
