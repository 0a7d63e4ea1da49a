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
  options.alpha = plan.alpha;
  options.beta = plan.beta;
  options.epsilon = plan.epsilon;
  options.patch_points = plan.patch_points;
  options.threads = threads;
  options.frame = plan.bulk;
  for (std::size_t a = 0; a < 3; ++a) {
    options.frame.low[a] -= plan.tile_origins[number][a];
    options.frame.high[a] -= plan.tile_origins[number][a];
  }
  options.place = plan.place;
  options.hints = hintsOf(plan, plan.tile_origins[number]);
  options.hints.viewpoints = work.points.viewpoints;
  options.hints.normals = work.points.normals;
  for (std::size_t i = 0; i < options.hints.viewpoints.size(); ++i) {
    const std::size_t a = i % 3;
    options.hints.viewpoints[i] =
        static_cast<float>(static_cast<double>(work.points.viewpoints[i]) + plan.origin[a] -
                           plan.tile_origins[number][a]);
  }
  return work;
}

// Three numbers of the first point of each patch; none where points have none.
std::vector<float> ofPatches(const std::vector<float>& of_points,
                             const std::vector<TilePatch>& patches) {
  std::vector<float> out;
  for (const TilePatch& p : patches) {
    if (of_points.empty()) break;
    const auto from = of_points.begin() + std::ptrdiff_t{3} * p.row;
    out.insert(out.end(), from, from + 3);
  }
  return out;
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
  saveRows(ownRows(work.points, share), work.points.starts, tilePath(folder, tile, "rows"),
           plan.run, tile);
  saveTies(work.points.shared, share, tilePath(folder, tile, "ties"), plan.run, tile);
  ShareFile file;
  file.piece_sizes = std::move(share.piece_sizes);
  file.piece_signs = std::move(share.piece_signs);
  file.votes = std::move(share.votes);
  PatchFile patches;
  patches.patches = std::move(share.patch_list);
  patches.field_points = std::move(share.field_points);
  patches.viewpoints = ofPatches(work.points.viewpoints, patches.patches);
  patches.normals = ofPatches(work.points.normals, patches.patches);
  savePatches(patches, tilePath(folder, tile, "patches"), plan.run, tile);
  saveShare(file, share_path, plan.run, tile);
}

void finishStep(const Plan& plan, const std::string& folder, std::size_t number, int threads) {
  const auto tile = static_cast<std::uint32_t>(number);
  const SignsFile file = loadSigns(tilePath(folder, tile, "signs"), plan.run, tile);
  const std::string ties_path = tilePath(folder, tile, "ties2");
  // The last file that is written.
  if (!file.again || std::filesystem::exists(ties_path)) return;
  const Work work = prepare(plan, folder, number, threads);
  CloudField field;
  if (file.field) field = loadField(fieldPath(folder), plan.run);
  for (FieldCell& cell : field.cells) {
    for (std::size_t a = 0; a < 3; ++a) {
      cell.position[a] = static_cast<float>(static_cast<double>(cell.position[a]) + plan.origin[a] -
                                            plan.tile_origins[number][a]);
    }
  }
  const TileShare share = finishTile(work.view(), work.points.roles, work.points.whole,
                                     work.options, file.signs, field);
  saveRows(ownRows(work.points, share), work.points.starts, tilePath(folder, tile, "rows2"),
           plan.run, tile);
  saveTies(work.points.shared, share, ties_path, plan.run, tile);
}

}  // namespace segorient::program
