// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <algorithm>
#include <filesystem>
#include <numeric>

#include "tiles/steps.h"
#include "tiles/tile_file.h"
#include "tiles/tile_records.h"

namespace segorient::program {
namespace {

// A tile's points as they are in its file.
struct TilePoints {
  std::vector<PointRecord> records;
  std::vector<float> viewpoints;  // 3 a point, or empty
};

TilePoints readPoints(const Plan& plan, const std::string& folder, std::uint32_t tile) {
  TileFileReader file(tilePath(folder, tile, "points"), TileFileKind::POINTS, plan.run, tile);
  TilePoints points;
  const auto size = static_cast<std::size_t>(plan.tile_inputs[tile]);
  const std::size_t width = plan.has_viewpoints ? 3 : 0;
  if (file.remaining() == size * (sizeof(PointRecord) + width * sizeof(float))) {
    points.records.resize(size);
    points.viewpoints.resize(width * size);
    for (std::size_t i = 0; i < size; ++i) {
      file.bytes(&points.records[i], sizeof(PointRecord));
      if (width > 0) file.bytes(&points.viewpoints[width * i], width * sizeof(float));
    }
  }
  file.end();  // has more to read, and throws, where the size is not the plan's
  return points;
}

std::vector<TileRole> rolesOf(const std::vector<PointRecord>& records, std::uint32_t tile) {
  std::vector<TileRole> roles;
  roles.reserve(records.size());
  for (const PointRecord& r : records) {
    if ((r.owner & ~kShared) != tile) {
      roles.push_back(TileRole::HALO);
    } else {
      roles.push_back((r.owner & kShared) != 0 ? TileRole::SHARED : TileRole::OWN);
    }
  }
  return roles;
}

std::vector<RowRecord> ownRows(const TilePoints& points, const std::vector<TileRole>& roles,
                               const TileShare& share) {
  std::vector<RowRecord> rows;
  for (std::size_t i = 0; i < roles.size(); ++i) {
    if (!isOwn(roles[i])) continue;
    RowRecord r;
    r.row_low = points.records[i].row_low;
    r.row_high = points.records[i].row_high;
    std::copy_n(&share.normals[4 * i], 4, r.normal);
    r.label = share.labels[i];
    r.followed = share.followed[i];
    rows.push_back(r);
  }
  return rows;
}

// Ties by the tile that owns the point, and by row.
std::vector<TieSlice> writeTies(const TilePoints& points, const std::vector<TileTie>& ties,
                                const std::string& path, std::uint64_t run, std::uint32_t tile) {
  const auto owner = [&](std::size_t t) { return points.records[ties[t].row].owner & ~kShared; };
  std::vector<std::size_t> order(ties.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return owner(a) < owner(b); });
  TileFileWriter file(path, TileFileKind::TIES, run, tile);
  std::vector<TieSlice> slices;
  std::vector<TieRecord> records;
  for (std::size_t i = 0; i < order.size();) {
    TieSlice slice;
    slice.owner = owner(order[i]);
    slice.first = i;
    records.clear();
    for (; i < order.size() && owner(order[i]) == slice.owner; ++i) {
      const TileTie& tie = ties[order[i]];
      TieRecord r;
      r.row = points.records[tie.row].row();
      r.piece = tie.piece;
      r.label = tie.label;
      std::copy_n(tie.normal, 3, r.normal);
      records.push_back(r);
    }
    slice.count = records.size();
    Checksum sum;
    sum.add(records.data(), records.size() * sizeof(TieRecord));
    slice.checksum = sum.value();
    file.bytes(records.data(), records.size() * sizeof(TieRecord));
    slices.push_back(slice);
  }
  file.commitPlain();
  return slices;
}

// All that one tile is worked on with.
struct Work {
  TilePoints points;
  std::vector<TileRole> roles;
  std::vector<float> xyz;
  std::vector<float> whole;
  TileOptions options;
  PointView view() const { return {xyz.data(), 3, roles.size()}; }
};

Work prepare(const Plan& plan, const std::string& folder, std::size_t number, int threads) {
  const auto tile = static_cast<std::uint32_t>(number);
  Work work;
  work.points = readPoints(plan, folder, tile);
  work.roles = rolesOf(work.points.records, tile);
  work.xyz.reserve(3 * work.roles.size());
  for (const PointRecord& r : work.points.records) {
    work.xyz.insert(work.xyz.end(), r.position, r.position + 3);
    work.whole.push_back(r.whole);
  }
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
  TileShare share = workOnTile(work.view(), work.roles, work.whole, work.options);
  saveRows(ownRows(work.points, work.roles, share), tilePath(folder, tile, "rows"), plan.run, tile);
  ShareFile file;
  file.slices = writeTies(work.points, share.ties, tilePath(folder, tile, "ties"), plan.run, tile);
  file.piece_sizes = std::move(share.piece_sizes);
  file.piece_signs = std::move(share.piece_signs);
  file.segment_sizes = std::move(share.segment_sizes);
  file.votes = std::move(share.votes);
  file.patches = std::move(share.patch_list);
  for (const TilePatch& p : file.patches) {
    if (!plan.has_viewpoints) break;
    const float* seen_from = &work.points.viewpoints[std::size_t{3} * p.row];
    file.viewpoints.insert(file.viewpoints.end(), seen_from, seen_from + 3);
  }
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
    TileShare share = finishTile(work.view(), work.roles, work.whole, work.options, signs);
    saveRows(ownRows(work.points, work.roles, share), tilePath(folder, tile, "rows2"), plan.run,
             tile);
    file.slices =
        writeTies(work.points, share.ties, tilePath(folder, tile, "ties2"), plan.run, tile);
    file.segment_sizes = std::move(share.segment_sizes);
  }
  saveFinal(file, path, plan.run, tile);
}

}  // namespace segorient::program
