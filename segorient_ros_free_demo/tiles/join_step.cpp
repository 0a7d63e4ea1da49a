// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <segorient/tiles/join_tiles.h>

#include <algorithm>
#include <filesystem>

#include "tiles/steps.h"
#include "tiles/tile_file.h"
#include "tiles/tile_records.h"

namespace segorient::program {
namespace {

// The points that are in both, in the same order.
void match(const std::vector<TieRecord>& a, const std::vector<TieRecord>& b,
           std::vector<TileTie>& in_a, std::vector<TileTie>& in_b) {
  const auto tieOf = [](const TieRecord& r) {
    TileTie tie;
    tie.piece = r.piece;
    tie.label = r.label;
    std::copy_n(r.normal, 3, tie.normal);
    return tie;
  };
  in_a.clear();
  in_b.clear();
  for (std::size_t i = 0, j = 0; i < a.size() && j < b.size();) {
    if (a[i].row == b[j].row) {
      in_a.push_back(tieOf(a[i++]));
      in_b.push_back(tieOf(b[j++]));
    } else {
      a[i].row < b[j].row ? ++i : ++j;
    }
  }
}

// Each tile's own points beside what others say of them.
// \param file of a tile's ties
template <typename Joiner, typename File>
void addTies(const Plan& plan, const std::vector<std::vector<TieSlice>>& slices, const File& file,
             Joiner& joiner) {
  const auto load = [&](std::size_t tile, const TieSlice& slice) {
    return loadTies(file(tile), plan.run, static_cast<std::uint32_t>(tile), slice);
  };
  std::vector<std::vector<std::pair<std::size_t, const TieSlice*>>> about(slices.size());
  for (std::size_t t = 0; t < slices.size(); ++t) {
    for (const TieSlice& s : slices[t]) {
      if (s.owner < slices.size()) about[s.owner].emplace_back(t, &s);
    }
  }
  std::vector<TileTie> in_a;
  std::vector<TileTie> in_b;
  for (std::size_t a = 0; a < slices.size(); ++a) {
    const auto own = std::find_if(slices[a].begin(), slices[a].end(),
                                  [&](const TieSlice& s) { return s.owner == a; });
    if (own == slices[a].end()) continue;
    const std::vector<TieRecord> mine = load(a, *own);
    for (const auto& [b, slice] : about[a]) {
      if (b == a) continue;
      match(mine, load(b, *slice), in_a, in_b);
      joiner.tie(a, in_a, b, in_b);
    }
  }
}

JoinSummary readSummary(const Plan& plan, const std::string& folder) {
  TileFileReader file(joinPath(folder), TileFileKind::JOIN, plan.run);
  const auto summary = file.value<JoinSummary>();
  file.end();
  return summary;
}

}  // namespace

JoinSummary joinStep(const Plan& plan, const std::string& folder, int threads) {
  if (std::filesystem::exists(joinPath(folder))) return readSummary(plan, folder);
  JoinOptions options;
  options.traits = plan.traits;
  options.threads = threads;
  options.hints = hintsOf(plan, plan.origin);
  TileJoiner joiner;
  std::vector<std::vector<TieSlice>> slices(plan.tiles());
  for (std::size_t t = 0; t < plan.tiles(); ++t) {
    ShareFile share =
        loadShare(tilePath(folder, t, "share"), plan.run, static_cast<std::uint32_t>(t));
    std::array<double, 3> offset{};
    for (std::size_t a = 0; a < 3; ++a) offset[a] = plan.tile_origins[t][a] - plan.origin[a];
    joiner.addTile(share.piece_sizes, share.votes, share.patches, offset);
    options.hints.viewpoints.insert(options.hints.viewpoints.end(), share.viewpoints.begin(),
                                    share.viewpoints.end());
    slices[t] = std::move(share.slices);
  }
  addTies(
      plan, slices, [&](std::size_t t) { return tilePath(folder, t, "ties"); }, joiner);
  JoinedTiles joined = joiner.join(options);
  for (std::size_t t = 0; t < plan.tiles(); ++t) {
    saveSigns(joined.tiles[t], tilePath(folder, t, "signs"), plan.run,
              static_cast<std::uint32_t>(t));
  }
  JoinSummary summary;
  summary.pieces = joined.pieces;
  summary.components = joined.components.size();
  TileFileWriter file(joinPath(folder), TileFileKind::JOIN, plan.run);
  file.value(summary);
  file.commit();
  return summary;
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
  std::vector<std::vector<TieSlice>> slices(plan.tiles());
  std::vector<bool> again(plan.tiles());
  for (std::size_t t = 0; t < plan.tiles(); ++t) {
    const auto tile = static_cast<std::uint32_t>(t);
    FinalFile made = loadFinal(tilePath(folder, t, "final"), plan.run, tile);
    again[t] = made.again;
    if (!made.again) {
      ShareFile share = loadShare(tilePath(folder, t, "share"), plan.run, tile);
      made.segment_sizes = std::move(share.segment_sizes);
      made.slices = std::move(share.slices);
    }
    joiner.addTile(made.segment_sizes);
    slices[t] = std::move(made.slices);
  }
  addTies(
      plan, slices, [&](std::size_t t) { return tilePath(folder, t, again[t] ? "ties2" : "ties"); },
      joiner);
  std::size_t segments = 0;
  const LabelFile labels = joiner.join(segments);
  saveLabels(labels, labelsPath(folder), plan.run);
  return count(labels);
}

}  // namespace segorient::program
