// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <segorient/tiles/tile_share.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "orientation/automatic/stages.h"
#include "search/prepared_cloud.h"

namespace segorient {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

std::size_t at(std::int32_t i) {
  return static_cast<std::size_t>(i);
}

PipelineOptions pipelineOptions(int k, int threads) {
  PipelineOptions options;
  options.k = k;
  options.threads = threads;
  options.orientation.automatic.find_sensors = false;
  return options;
}

void copyEvidence(const Evidence& from, float* to) {
  to[0] = from.weight;
  to[1] = from.absolute;
  to[2] = from.reliable;
}

class Tile {
 public:
  Tile(const PointView& points, const std::vector<TileRole>& roles, const std::vector<float>& whole,
       int threads)
      : cloud_(points, nullptr, threads),
        roles_(roles),
        own_(cloud_.size()),
        whole_(cloud_.size()) {
    for (std::size_t i = 0; i < own_.size(); ++i) {
      own_[i] = isOwn(roles[cloud_.rowOf(i)]) ? 1 : 0;
      // Of its own points there is none better to say anything.
      whole_[i] = own_[i] != 0 ? std::numeric_limits<float>::infinity()
                               : whole[cloud_.rowOf(i)] / cloud_.unit();
    }
  }

  TileShare work(const TileOptions& options) {
    const TileTraits& traits = options.traits;
    record_.traits.noise = {traits.noise, traits.wide_noise, traits.thin != 0};
    record_.traits.residual = traits.residual;
    record_.traits.scan_scales = traits.scan != 0;
    record_.denoise = traits.denoise != 0;
    record_.voters = &own_;
    record_.whole = &whole_;
    PipelineOptions pipeline = pipelineOptions(options.k, options.threads);
    // All that is seen of a tile alone may well be what one place could see.
    pipeline.orientation.automatic.infer_viewpoint =
        std::all_of(roles_.begin(), roles_.end(), isOwn);
    stages_ = detail::runAutoStages(
        cloud_, pipeline, resolveHints(options.hints, cloud_), [](const char*, double) {},
        &record_);
    listVotes();
    makePatches(options.patch_points);
    turnAsPieces();
    scatter();
    listTies();
    return std::move(out_);
  }

 private:
  void listVotes();
  void makePatches(std::uint32_t most);
  void turnAsPieces();
  void scatter();
  void listTies();
  void pieceNormal(std::size_t i, float* out) const;
  std::int32_t followed(std::size_t i) const;

  PreparedCloud cloud_;
  const std::vector<TileRole>& roles_;
  std::vector<std::uint8_t> own_;  // by distinct point, as all below
  std::vector<float> whole_;
  detail::SheetRecord record_;
  detail::AutoStages stages_;
  std::vector<std::int32_t> patch_of_;
  TileShare out_;
};

void Tile::listVotes() {
  out_.votes.reserve(record_.votes.size());
  for (const BorderVote& v : record_.votes) {
    TileVote vote;
    vote.a = v.a;
    vote.b = v.b;
    copyEvidence(v.sheet(), vote.sheet);
    copyEvidence(v.wall, vote.wall);
    vote.count = v.count;
    out_.votes.push_back(vote);
  }
}

void Tile::pieceNormal(std::size_t i, float* out) const {
  const auto sign = static_cast<float>(record_.segments.signs[i]);
  for (std::size_t a = 0; a < 3; ++a) out[a] = sign * record_.sheets.normals[4 * i + a];
}

// Points come in an order in which those near each other are side by side.
void Tile::makePatches(std::uint32_t most) {
  const std::size_t pieces = record_.segments.segments.size();
  out_.piece_sizes.assign(pieces, 0);
  std::vector<std::int32_t> open(pieces, -1);
  patch_of_.assign(cloud_.size(), -1);
  for (std::size_t i = 0; i < cloud_.size(); ++i) {
    const std::int32_t piece = record_.segments.labels[i];
    if (piece < 0 || own_[i] == 0) continue;
    ++out_.piece_sizes[at(piece)];
    std::int32_t& mine = open[at(piece)];
    if (mine < 0 || out_.patch_list[at(mine)].points >= most) {
      mine = static_cast<std::int32_t>(out_.patch_list.size());
      out_.patch_list.emplace_back();
      out_.patch_list.back().piece = piece;
      out_.patch_list.back().row = static_cast<std::uint32_t>(cloud_.rowOf(i));
    }
    patch_of_[i] = mine;
    TilePatch& patch = out_.patch_list[at(mine)];
    float normal[3];
    pieceNormal(i, normal);
    // Means as they grow: a single point stays exactly what it is.
    const float share = 1.F / static_cast<float>(++patch.points);
    const float* place = record_.smoothed.empty() ? cloud_.points()[i] : &record_.smoothed[4 * i];
    for (std::size_t a = 0; a < 3; ++a) {
      patch.position[a] += share * (place[a] * cloud_.unit() - patch.position[a]);
      patch.normal[a] += share * (normal[a] - patch.normal[a]);
    }
    const float h = record_.sheets.spacing[i] * cloud_.unit();
    patch.spacing = patch.points == 1 ? h : std::sqrt(patch.spacing * patch.spacing + h * h);
    patch.residual += share * (record_.sheets.normals[4 * i + 3] - patch.residual);
    patch.reliable += record_.sheets.reliable[i];
  }
  for (TilePatch& patch : out_.patch_list) {
    if (patch.points == 1) continue;
    float length = 0.F;
    for (const float n : patch.normal) length += n * n;
    length = std::sqrt(length);
    for (float& n : patch.normal) n = length > 0.F ? n / length : 0.F;
  }
}

// The patch whose sign a point's final normal follows: its own, unless the filter turned the normal
// as those around are, or the point is of no piece.
// \return the point of that patch, itself or a neighbour; -1 where there is none
std::int32_t Tile::followed(std::size_t i) const {
  const float* n = &stages_.normals[4 * i];
  const auto agrees = [&](std::size_t j) {
    const float* m = &record_.sheets.normals[4 * j];
    const auto sign = static_cast<float>(stages_.orientation.result.point_signs[j]);
    return patch_of_[j] >= 0 && sign * (n[0] * m[0] + n[1] * m[1] + n[2] * m[2]) > 0.F;
  };
  const Neighborhoods& nb = cloud_.neighborhoods();
  for (int j = 0; j < nb.count(i); ++j) {  // itself first
    if (agrees(static_cast<std::size_t>(nb.indices(i)[j]))) return nb.indices(i)[j];
  }
  return patch_of_[i] >= 0 ? static_cast<std::int32_t>(i) : -1;
}

// The tile's own signs are taken back, so that each normal is turned as its patch is.
void Tile::turnAsPieces() {
  std::vector<std::int32_t> followed_patch(cloud_.size(), -1);
  for (std::size_t i = 0; i < cloud_.size(); ++i) {
    if (own_[i] == 0 || !std::isfinite(stages_.normals[4 * i])) continue;
    const std::int32_t point = followed(i);
    if (point < 0) continue;
    followed_patch[i] = patch_of_[at(point)];
    const auto sign = static_cast<float>(record_.segments.signs[at(point)] *
                                         stages_.orientation.result.point_signs[at(point)]);
    for (std::size_t a = 0; a < 3; ++a) stages_.normals[4 * i + a] *= sign;
  }
  patch_of_ = std::move(followed_patch);
}

void Tile::scatter() {
  out_.normals = cloud_.scatter(stages_.normals, 4, kNaN);
  out_.confidences = cloud_.scatter(stages_.confidences, 1, 0.F);
  out_.labels = cloud_.scatter(stages_.segmentation.labels, 1, std::int32_t{-1});
  out_.patches = cloud_.scatter(patch_of_, 1, std::int32_t{-1});
  out_.segment_sizes.assign(stages_.segmentation.segments.size(), 0);
  for (std::size_t row = 0; row < roles_.size(); ++row) {
    if (!isOwn(roles_[row])) {
      out_.patches[row] = -1;
    } else if (out_.labels[row] >= 0) {
      ++out_.segment_sizes[at(out_.labels[row])];
    }
  }
}

void Tile::listTies() {
  for (std::size_t row = 0; row < roles_.size(); ++row) {
    if (roles_[row] == TileRole::OWN || cloud_.pointOf(row) < 0) continue;
    const auto i = static_cast<std::size_t>(cloud_.pointOf(row));
    if (cloud_.rowOf(i) != row) continue;  // repeats another one
    TileTie tie;
    tie.row = static_cast<std::uint32_t>(row);
    tie.piece = record_.segments.labels[i];
    if (tie.piece < 0 && own_[i] == 0) continue;
    tie.label = stages_.segmentation.labels[i];
    if (tie.piece >= 0) pieceNormal(i, tie.normal);
    out_.ties.push_back(tie);
  }
}

}  // namespace

TileTraits measureTileTraits(const PointView& points, int k, bool from_sensors, int threads) {
  PreparedCloud cloud(points, nullptr, threads);
  TileTraits out;
  if (cloud.size() == 0) return out;
  const detail::CloudTraits found =
      detail::measureTraits(cloud, pipelineOptions(k, threads), from_sensors);
  out.noise = found.sheets.noise.fine;
  out.wide_noise = found.sheets.noise.coarse;
  out.thin = found.sheets.noise.thin ? 1 : 0;
  out.residual = found.sheets.residual;
  out.scan = found.sheets.scan_scales ? 1 : 0;
  out.denoise = found.denoise ? 1 : 0;
  return out;
}

TileShare workOnTile(const PointView& points, const std::vector<TileRole>& roles,
                     const std::vector<float>& whole, const TileOptions& options) {
  return Tile(points, roles, whole, options.threads).work(options);
}

}  // namespace segorient
