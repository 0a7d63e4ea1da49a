// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <algorithm>
#include <filesystem>

#include "tiles/row_file.h"
#include "tiles/steps.h"
#include "tiles/tie_file.h"
#include "tiles/tile_points.h"
#include "tiles/tile_records.h"

namespace segorient::program {
namespace {

std::vector<RowRecord> ownRows(const TilePoints& points, const TileShare& share) {
  std::vector<RowRecord> rows;
  for (std::size_t i = 0; i < points.roles.size(); ++i) {
    if (!isOwn(points.roles[i])) continue;
    RowRecord r;
    r.row = points.rows[i];
    std::copy_n(&share.normals[4 * i], 4, r.normal);
    r.label = share.labels[i];
    r.followed = share.followed[i];
    rows.push_back(r);
  }
  return rows;
}

// All that one tile is worked on with.
struct Work {
  TilePoints points;
  TileOptions options;
  PointView view() const { return {points.xyz.data(), 3, points.roles.size()}; }
};

Work prepare(const Plan& plan, const std::string& folder, std::size_t number, int threads) {
  Work work;
  work.points = readTilePoints(plan, folder, static_cast<std::uint32_t>(number));
  TileOptions& options = work.options;
  options.traits = plan.traits;
  options.k = plan.k;
  options.patch_points = plan.patch_points;
  options.threads = threads;
  options.hints = hintsOf(plan, plan.tile_origins[number]);
  options.hints.viewpoints = work.points.viewpoints;
  for (std::size_t i = 0; i < options.hints.viewpoints.size(); ++i) {
    const std::size_t a = i % 3;
    options.hints.viewpoints[i] =
        static_cast<float>(static_cast<double>(work.points.viewpoints[i]) + plan.origin[a] -
                           plan.tile_origins[number][a]);
  }
  return work;
}

}  // namespace

void tileStep(const Plan& plan, const std::string& folder, std::size_t number, int threads) {
  const auto tile = static_cast<std::uint32_t>(number);
  const std::string share_path = tilePath(folder, tile, "share");
  if (std::filesystem::exists(share_path)) {  // the last file that is written
    loadShare(share_path, plan.run, tile);
    return;
  }
  const Work work = prepare(plan, folder, number, threads);
  TileShare share = workOnTile(work.view(), work.points.roles, work.points.whole, work.options);
  saveRows(ownRows(work.points, share), tilePath(folder, tile, "rows"), plan.run, tile);
  saveTies(work.points.shared, share.ties, tilePath(folder, tile, "ties"), plan.run, tile);
  ShareFile file;
  file.piece_sizes = std::move(share.piece_sizes);
  file.piece_signs = std::move(share.piece_signs);
  file.segment_sizes = std::move(share.segment_sizes);
  file.votes = std::move(share.votes);
  PatchFile patches;
  patches.patches = std::move(share.patch_list);
  for (const TilePatch& p : patches.patches) {
    if (!plan.has_viewpoints) break;
    const float* seen_from = &work.points.viewpoints[std::size_t{3} * p.row];
    patches.viewpoints.insert(patches.viewpoints.end(), seen_from, seen_from + 3);
  }
  savePatches(patches, tilePath(folder, tile, "patches"), plan.run, tile);
  saveShare(file, share_path, plan.run, tile);
}

void finishStep(const Plan& plan, const std::string& folder, std::size_t number, int threads) {
  const auto tile = static_cast<std::uint32_t>(number);
  const std::string path = tilePath(folder, tile, "final");
  if (std::filesystem::exists(path)) {  // the last file that is written
    loadFinal(path, plan.run, tile);
    return;
  }
  const TileSigns signs = loadSigns(tilePath(folder, tile, "signs"), plan.run, tile);
  TileShare first;
  {
    ShareFile share = loadShare(tilePath(folder, tile, "share"), plan.run, tile);
    first.piece_sizes = std::move(share.piece_sizes);
    first.piece_signs = std::move(share.piece_signs);
    first.votes = std::move(share.votes);
  }
  FinalFile file;
  file.again = needsFinishing(first, signs);
  if (file.again) {
    const Work work = prepare(plan, folder, number, threads);
    TileShare share =
        finishTile(work.view(), work.points.roles, work.points.whole, work.options, signs);
    saveRows(ownRows(work.points, share), tilePath(folder, tile, "rows2"), plan.run, tile);
    saveTies(work.points.shared, share.ties, tilePath(folder, tile, "ties2"), plan.run, tile);
    file.segment_sizes = std::move(share.segment_sizes);
  }
  saveFinal(file, path, plan.run, tile);
}

}  // namespace segorient::program
