// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "support/hint_options.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <memory>

#include "io/readers.h"

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

}  // namespace

void HintOptions::add(CommandLine& line) {
  line.options()("viewpoint", po::value(&viewpoint_text_),
                 "=X,Y,Z: where all was seen from, else as the file says; what could be seen from "
                 "there faces it")("closed", po::bool_switch(&closed_),
                                   "each part has an inside, whatever one viewpoint says")(
      "open", po::bool_switch(&open_), "one viewpoint decides, whatever looks like an inside")(
      "seeds", po::value(&seeds_), "a cloud of points whose normals are known")(
      "keep-orientation", po::bool_switch(&keep_),
      "take the signs of the normals that IN has as evidence");
}

void HintOptions::check(const CommandLine& line, const CommonOptions& common,
                        const PipelineOptions& options) {
  require(!(closed_ && open_), "--closed and --open exclude each other");
  char end = 0;
  const bool three = std::sscanf(viewpoint_text_.c_str(), "%lf,%lf,%lf%c", &viewpoint_[0],
                                 &viewpoint_[1], &viewpoint_[2], &end) == 3;
  const bool finite =
      std::all_of(viewpoint_.begin(), viewpoint_.end(), [](double v) { return std::isfinite(v); });
  require(viewpoint_text_.empty() || (three && finite),
          "--viewpoint takes three numbers, as in --viewpoint=1.5,0,-2");
  if (options.orientation.method == OrientationMethod::AUTO || common.quiet) return;
  for (const char* name : {"viewpoint", "closed", "open", "seeds", "keep-orientation"}) {
    if (line.given(name)) warn("--" + std::string(name) + " changes nothing without method auto");
  }
}

void HintOptions::apply(const CloudTable& table, const std::string& path, const LocalPoints& points,
                        PipelineOptions& options) const {
  const std::array<double, 3>& origin = points.origin();
  auto hints = std::make_shared<OrientationHints>();
  if (closed_) hints->surface = SurfaceKind::CLOSED;
  if (open_) hints->surface = SurfaceKind::OPEN;
  const std::array<double, 3> sensor{table.viewpoint[0], table.viewpoint[1], table.viewpoint[2]};
  if (!viewpoint_text_.empty() || sensor != std::array<double, 3>{0.0, 0.0, 0.0}) {
    hints->has_viewpoint = true;
    hints->viewpoint = moved(viewpoint_text_.empty() ? sensor : viewpoint_, origin);
  }
  const std::array<const Field*, 3> from{table.find("vp_x"), table.find("vp_y"),
                                         table.find("vp_z")};
  if (std::find(from.begin(), from.end(), nullptr) == from.end()) {
    hints->viewpoints = columns(table, from, origin);
  }
  if (!seeds_.empty()) addSeeds(seeds_, origin, *hints);
  if (keep_) {
    if (!table.hasNormals()) throw FileError(path, "has no normals whose orientation to keep");
    hints->normals = columns(table, table.normals(), {0.0, 0.0, 0.0});
  }
  options.orientation.hints = hints;
}

}  // namespace segorient::program
