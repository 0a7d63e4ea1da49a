// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors

#include <algorithm>
#include <filesystem>
#include <set>

#include "tiles/join_tiles.h"
#include "tiles/steps.h"
#include "tiles/tie_file.h"
#include "tiles/tile_file.h"
#include "tiles/tile_records.h"

namespace segorient::program {
namespace {

void append(const std::vector<TileTie>& more, std::vector<TileTie>& ties) {
  ties.insert(ties.end(), more.begin(), more.end());
}

// What each two tiles say of the points that they have in common.
template <typename Joiner>
void addTies(const std::vector<TieReader>& ties, Joiner& joiner) {
  for (std::uint32_t a = 0; a < ties.size(); ++a) {
    std::set<std::uint32_t> others;
    for (const TieSlice& slice : ties[a].slices()) others.insert(slice.other);
    for (const std::uint32_t b : others) {
      if (b <= a) continue;
      if (b >= ties.size()) ties[a].fail();
      std::vector<TileTie> in_a;
      std::vector<TileTie> in_b;
      for (const std::uint32_t owner : {a, b}) {
        append(ties[a].about(b, owner), in_a);
        append(ties[b].about(a, owner), in_b);
        if (in_a.size() != in_b.size()) ties[b].fail();
      }
      joiner.tie(a, in_a, b, in_b);
    }
  }
}

// By tile, whether the field tells it something: all of them in noise, else where cells turn
// points.
std::vector<std::uint8_t> tilesOf(const CloudField& field, const Plan& plan) {
  // Cells are .8 radii wide; a point looks at those around its own.
  constexpr double kFarthestCell = 3.0;
  std::vector<std::uint8_t> out(plan.tiles(), field.noise);
  for (const FieldCell& cell : field.cells) {
    if (field.noise != 0 || cell.value >= 0.F) continue;
    TileTree::Place place{};
    for (std::size_t a = 0; a < 3; ++a) {
      place[a] = static_cast<double>(cell.position[a]) + plan.origin[a];
    }
    double reach = 0.0;
    plan.tree.owner(place, reach);
    reach = std::max(reach, kFarthestCell * static_cast<double>(field.radius));
    plan.tree.forEachWithin(place, reach, [&](std::uint32_t t, double) { out[t] = 1; });
  }
  return out;
}

JoinSummary readSummary(const Plan& plan, const std::string& folder) {
  TileFileReader file(joinPath(folder), TileFileKind::JOIN, plan.run);
  JoinSummary summary;
  summary.pieces = file.value<std::uint64_t>();
  summary.again = file.value<std::uint64_t>();
  summary.components = file.list<ComponentOrientationResult>();
  summary.sensors_dropped = file.value<bool>();
  file.end();
  return summary;
}

}  // namespace

JoinSummary joinStep(const Plan& plan, const std::string& folder, int threads) {
  if (std::filesystem::exists(joinPath(folder))) return readSummary(plan, folder);
  for (std::size_t t = 0; t < plan.tiles(); ++t) {
    if (std::filesystem::exists(tilePath(folder, t, "share"))) continue;
    throw FileError(folder, "cannot be joined before tile " + std::to_string(t) + " is done");
  }
  JoinOptions options;
  options.traits = plan.traits;
  options.patch_points = plan.patch_points;
  options.threads = threads;
  options.hints = hintsOf(plan, plan.origin);
  options.place = plan.place;
  options.sensors_found = plan.found_sensors > 0;
  for (const PlanSeed& s : plan.seeds) {
    OrientationHints::Seed seed;
    for (std::size_t a = 0; a < 3; ++a) {
      seed.position[a] = static_cast<float>(s.position[a] - plan.origin[a]);
      seed.normal[a] = static_cast<float>(s.normal[a]);
    }
    options.hints.seeds.push_back(seed);
  }
  TileJoiner joiner;
  std::vector<TileShare> found(plan.tiles());
  for (std::size_t t = 0; t < plan.tiles(); ++t) {
    ShareFile share =
        loadShare(tilePath(folder, t, "share"), plan.run, static_cast<std::uint32_t>(t));
    std::array<double, 3> offset{};
    for (std::size_t a = 0; a < 3; ++a) offset[a] = plan.tile_origins[t][a] - plan.origin[a];
    const PatchFile patches =
        loadPatches(tilePath(folder, t, "patches"), plan.run, static_cast<std::uint32_t>(t));
    joiner.addTile(share.piece_sizes, share.votes, patches.patches, patches.field_points, offset);
    options.hints.viewpoints.insert(options.hints.viewpoints.end(), patches.viewpoints.begin(),
                                    patches.viewpoints.end());
    options.hints.normals.insert(options.hints.normals.end(), patches.normals.begin(),
                                 patches.normals.end());
    found[t].piece_sizes = std::move(share.piece_sizes);
    found[t].piece_signs = std::move(share.piece_signs);
    found[t].votes = std::move(share.votes);
  }
  std::vector<TieReader> ties;
  for (std::size_t t = 0; t < plan.tiles(); ++t) {
    ties.emplace_back(tilePath(folder, t, "ties"), plan.run, static_cast<std::uint32_t>(t));
  }
  addTies(ties, joiner);
  JoinedTiles joined = joiner.join(options);
  JoinSummary summary;
  const std::vector<std::uint8_t> has_field = tilesOf(joined.field, plan);
  if (!joined.field.cells.empty()) saveField(joined.field, fieldPath(folder), plan.run);
  for (std::size_t t = 0; t < plan.tiles(); ++t) {
    SignsFile file;
    file.field = has_field[t] != 0;
    file.again = file.field || needsFinishing(plan.traits, found[t], joined.tiles[t]);
    file.signs = std::move(joined.tiles[t]);
    summary.again += file.again ? 1 : 0;
    saveSigns(file, tilePath(folder, t, "signs"), plan.run, static_cast<std::uint32_t>(t));
  }
  summary.pieces = joined.pieces;
  summary.components = std::move(joined.components);
  summary.sensors_dropped = joined.sensors_dropped;
  TileFileWriter file(joinPath(folder), TileFileKind::JOIN, plan.run);
  file.value(summary.pieces);
  file.value(summary.again);
  file.list(summary.components);
  file.value(summary.sensors_dropped);
  file.commit();
  return summary;
}

std::vector<std::size_t> tilesAgain(const Plan& plan, const std::string& folder) {
  std::vector<std::size_t> out;
  for (std::size_t t = 0; t < plan.tiles(); ++t) {
    const auto tile = static_cast<std::uint32_t>(t);
    if (loadSigns(tilePath(folder, t, "signs"), plan.run, tile).again) out.push_back(t);
  }
  return out;
}

std::uint64_t labelStep(const Plan& plan, const std::string& folder) {
  const auto count = [](const LabelFile& labels) {
    std::uint64_t segments = 0;
    for (const auto& of_tile : labels) {
      for (const std::uint32_t l : of_tile) segments = std::max<std::uint64_t>(segments, l + 1ULL);
    }
    return segments;
  };
  if (std::filesystem::exists(labelsPath(folder))) {
    return count(loadLabels(labelsPath(folder), plan.run, plan.tiles()));
  }
  LabelJoiner joiner;
  std::vector<TieReader> ties;
  for (std::size_t t = 0; t < plan.tiles(); ++t) {
    const auto tile = static_cast<std::uint32_t>(t);
    const bool again = loadSigns(tilePath(folder, t, "signs"), plan.run, tile).again;
    ties.emplace_back(tilePath(folder, t, again ? "ties2" : "ties"), plan.run, tile);
    joiner.addTile(ties.back().segmentSizes(), ties.back().segmentBorders());
  }
  addTies(ties, joiner);
  std::size_t segments = 0;
  const LabelFile labels = joiner.join(segments);
  saveLabels(labels, labelsPath(folder), plan.run);
  return count(labels);
}

}  // namespace segorient::program
