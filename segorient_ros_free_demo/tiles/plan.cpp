// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "tiles/plan.h"

#include <cstdio>
#include <utility>

#include "tiles/input_state.h"
#include "tiles/tile_file.h"

namespace segorient::program {
namespace {

// The members that are numbers, in one order for both ways.
template <typename Visit, typename P>
void forEachNumber(P& p, const Visit& visit) {
  visit(p.rows);
  visit(p.finite);
  visit(p.origin);
  visit(p.bulk);
  visit(p.step);
  visit(p.traits);
  visit(p.k);
  visit(p.patch_points);
  visit(p.chunk_rows);
  visit(p.has_viewpoints);
  visit(p.has_viewpoint);
  visit(p.viewpoint);
  visit(p.up);
  visit(p.closed);
  visit(p.open);
  visit(p.find_sensors);
  visit(p.found_sensors);
  visit(p.place.shadows.steps);
  visit(p.place.shadows.covered);
  visit(p.place.shadows.hidden);
  visit(p.place.shadows.open);
  visit(p.place.shadows.better_across);
  visit(p.place.found);
  visit(p.place.faces_up);
  visit(p.place.along_way);
  visit(p.place.whole_image);
  visit(p.place.seen_within);
  visit(p.place.may_be_suggested);
  visit(p.place.suggestion_suits);
  visit(p.place_refused);
  visit(p.memory);
  visit(p.keep_orientation);
  visit(p.adds_scans);
  visit(p.adds_viewpoints);
  visit(p.alpha);
  visit(p.beta);
  visit(p.epsilon);
}

}  // namespace

std::string planPath(const std::string& folder) {
  return folder + "/plan";
}

std::string joinPath(const std::string& folder) {
  return folder + "/join";
}

std::string fieldPath(const std::string& folder) {
  return folder + "/field";
}

std::string labelsPath(const std::string& folder) {
  return folder + "/labels";
}

std::string tilePath(const std::string& folder, std::size_t tile, const char* ending) {
  char name[48];
  std::snprintf(name, sizeof(name), "/tile-%06zu.%s", tile, ending);
  return folder + name;
}

void savePlan(const Plan& plan, const std::string& folder) {
  TileFileWriter file(planPath(folder), TileFileKind::PLAN, plan.run);
  forEachNumber(plan, [&](const auto& v) { file.value(v); });
  file.value<std::uint64_t>(plan.inputs.size());
  for (const PlanInput& in : plan.inputs) {
    file.text(in.path);
    file.text(in.streamed);
    for (const std::uint64_t v : {in.bytes, in.head, in.first_row, in.rows}) {
      file.value(v);
    }
    file.value(in.time);
  }
  file.value<std::uint64_t>(plan.outputs.size());
  for (const PlanOutput& out : plan.outputs) {
    file.text(out.path);
    file.value(out.first_input);
    file.value(out.inputs);
  }
  file.list(plan.tile_origins);
  file.list(plan.tile_points);
  file.list(plan.tree.nodes());
  file.text(plan.trajectory);
  file.list(plan.seeds);
  file.commit();
}

Plan loadPlan(const std::string& folder) {
  TileFileReader file(planPath(folder), TileFileKind::PLAN, 0);
  Plan plan;
  plan.run = file.run();
  forEachNumber(plan, [&](auto& v) { file.bytes(&v, sizeof(v)); });
  const auto inputs = file.value<std::uint64_t>();
  for (std::uint64_t i = 0; i < inputs; ++i) {
    PlanInput in;
    in.path = file.text();
    in.streamed = file.text();
    for (std::uint64_t* v : {&in.bytes, &in.head, &in.first_row, &in.rows}) {
      *v = file.value<std::uint64_t>();
    }
    in.time = file.value<std::int64_t>();
    plan.inputs.push_back(std::move(in));
  }
  const auto outputs = file.value<std::uint64_t>();
  for (std::uint64_t i = 0; i < outputs; ++i) {
    PlanOutput out;
    out.path = file.text();
    out.first_input = file.value<std::uint32_t>();
    out.inputs = file.value<std::uint32_t>();
    plan.outputs.push_back(std::move(out));
  }
  plan.tile_origins = file.list<std::array<double, 3>>();
  plan.tile_points = file.list<std::uint64_t>();
  std::vector<TileTree::Node> nodes = file.list<TileTree::Node>();
  plan.trajectory = file.text();
  plan.seeds = file.list<PlanSeed>();
  file.end();
  if (!TileTree::restore(std::move(nodes), plan.tree) || plan.tree.tiles() != plan.tiles() ||
      plan.tile_origins.size() != plan.tiles()) {
    throw FileError(planPath(folder), kDamaged);
  }
  return plan;
}

std::array<double, 3> storedPlace(const Plan& plan, const std::array<double, 3>& place) {
  std::array<double, 3> out = place;
  if (!(plan.step > 0.0)) return out;
  constexpr double kExact =
      4503599627370496.0;  // 2^52: doubles have no smaller parts from there on
  for (double& x : out) {
    const double steps = x / plan.step;
    if (std::fabs(steps) < kExact) x = plan.step * std::nearbyint(steps);
  }
  return out;
}

OrientationHints hintsOf(const Plan& plan, const std::array<double, 3>& origin) {
  OrientationHints hints;
  hints.has_direction = plan.up;
  hints.has_viewpoint = plan.has_viewpoint;
  for (std::size_t a = 0; a < 3; ++a) {
    hints.viewpoint[a] = static_cast<float>(plan.viewpoint[a] - origin[a]);
    hints.suggested.front()[a] = static_cast<float>(-origin[a]);
  }
  if (plan.closed) hints.surface = SurfaceKind::CLOSED;
  if (plan.open) hints.surface = SurfaceKind::OPEN;
  return hints;
}

void requireUnchanged(const Plan& plan) {
  for (const PlanInput& in : plan.inputs) {
    const InputState now = stateOf(in.path);
    if (now.bytes != in.bytes || now.time != in.time || now.head != in.head) {
      throw FileError(in.path, "was changed since the plan was made: remove the work folder");
    }
  }
}

}  // namespace segorient::program
