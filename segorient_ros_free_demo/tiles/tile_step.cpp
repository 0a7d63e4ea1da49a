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
    r.confidence = share.confidences[i];
    r.label = share.labels[i];
    r.patch = share.patches[i];
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

}  // namespace

void tileStep(const Plan& plan, const std::string& folder, std::size_t number, int threads) {
  const auto tile = static_cast<std::uint32_t>(number);
  const std::string share_path = tilePath(folder, tile, "share");
  if (std::filesystem::exists(share_path)) {  // the last file that is written
    loadShare(share_path, plan.run, tile);
    return;
  }
  TilePoints points = readPoints(plan, folder, tile);
  const std::vector<TileRole> roles = rolesOf(points.records, tile);
  std::vector<float> xyz;
  xyz.reserve(3 * points.records.size());
  std::vector<float> whole;
  for (const PointRecord& r : points.records) {
    xyz.insert(xyz.end(), r.position, r.position + 3);
    whole.push_back(r.whole);
  }
  TileOptions options;
  options.traits = plan.traits;
  options.k = plan.k;
  options.patch_points = plan.patch_points;
  options.threads = threads;
  options.hints = hintsOf(plan, plan.tile_origins[number]);
  options.hints.viewpoints = points.viewpoints;
  for (std::size_t i = 0; i < options.hints.viewpoints.size(); ++i) {
    const std::size_t a = i % 3;
    options.hints.viewpoints[i] = static_cast<float>(static_cast<double>(points.viewpoints[i]) +
                                                     plan.origin[a] - plan.tile_origins[number][a]);
  }
  TileShare share = workOnTile({xyz.data(), 3, points.records.size()}, roles, whole, options);
  saveRows(ownRows(points, roles, share), tilePath(folder, tile, "rows"), plan.run, tile);
  ShareFile file;
  file.slices = writeTies(points, share.ties, tilePath(folder, tile, "ties"), plan.run, tile);
  file.piece_sizes = std::move(share.piece_sizes);
  file.segment_sizes = std::move(share.segment_sizes);
  file.votes = std::move(share.votes);
  file.patches = std::move(share.patch_list);
  for (const TilePatch& p : file.patches) {
    if (!plan.has_viewpoints) break;
    const float* seen_from = &points.viewpoints[std::size_t{3} * p.row];
    file.viewpoints.insert(file.viewpoints.end(), seen_from, seen_from + 3);
  }
  saveShare(file, share_path, plan.run, tile);
}

}  // namespace segorient::program
