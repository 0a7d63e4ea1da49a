// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "tiles/tile_share.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "orientation/automatic/sign_energy.h"
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
    run(options);
    listVotes();
    cutPatches(record_.segments, options.patch_points);
    makePatches();
    listSigns();
    followPieces();
    scatter();
    listTies();
    return std::move(out_);
  }

  TileShare finish(const TileOptions& options, const TileSigns& signs) {
    record_.known = [&](const Segmentation& pieces) {
      cutPatches(pieces, options.patch_points);
      return orientAsKnown(pieces, signs);
    };
    run(options);
    followed_.assign(cloud_.size(), -1);
    scatter();
    listTies();
    return std::move(out_);
  }

 private:
  void run(const TileOptions& options);
  AutoOrientation orientAsKnown(const Segmentation& pieces, const TileSigns& signs) const;
  void listVotes();
  void cutPatches(const Segmentation& pieces, std::uint32_t most);
  void makePatches();
  void listSigns();
  void followPieces();
  void scatter();
  void listTies();
  void pieceNormal(std::size_t i, float* out) const;
  std::int32_t followed(std::size_t i) const;
  void towardSensor(std::size_t i, float* toward) const;

  PreparedCloud cloud_;
  const std::vector<TileRole>& roles_;
  std::vector<std::uint8_t> own_;  // by distinct point, as all below
  std::vector<float> whole_;
  PointHints hints_;
  detail::SheetRecord record_;
  detail::AutoStages stages_;
  std::vector<std::int32_t> patch_of_;  // of its own points
  std::vector<std::int32_t> followed_;  // see TileShare
  TileShare out_;
};

void Tile::run(const TileOptions& options) {
  const TileTraits& traits = options.traits;
  record_.traits.noise = {traits.noise, traits.wide_noise, traits.thin != 0};
  record_.traits.residual = traits.residual;
  record_.traits.scan_scales = traits.scan != 0;
  record_.final_traits.surfaces.noise = static_cast<double>(traits.surface_noise / cloud_.unit());
  record_.final_traits.surfaces.in_spacings = static_cast<double>(traits.surface_ratio);
  record_.final_traits.surfaces.analytic = traits.analytic != 0;
  record_.final_traits.surfaces.cubic_edges = traits.cubic_edges != 0;
  record_.final_traits.edges = traits.edges != 0;
  record_.denoise = traits.denoise != 0;
  record_.voters = &own_;
  record_.whole = &whole_;
  PipelineOptions pipeline = pipelineOptions(options.k, options.threads);
  // All that is seen of a tile alone may well be what one place could see.
  pipeline.orientation.automatic.infer_viewpoint = std::all_of(roles_.begin(), roles_.end(), isOwn);
  const auto set = [](float value, float& a, float& b) {
    if (value > 0.F) a = b = value;
  };
  AutomaticOptions& automatic = pipeline.orientation.automatic;
  set(options.alpha, automatic.alpha, pipeline.segmentation.alpha);
  set(options.beta, automatic.beta, pipeline.segmentation.beta);
  set(options.epsilon, automatic.epsilon, pipeline.segmentation.epsilon);
  hints_ = resolveHints(options.hints, cloud_);
  stages_ = detail::runAutoStages(
      cloud_, pipeline, hints_, [](const char*, double) {}, &record_);
}

// Of points of the halo: their own tile knows whether their sensors are to be believed; here it is
// the surroundings that they are for.
void Tile::towardSensor(std::size_t i, float* toward) const {
  const bool own = !hints_.sensors.empty();
  if (!own && !hints_.has_viewpoint) return;
  float squares = 0.F;
  for (std::size_t a = 0; a < 3; ++a) {
    const float from = own ? hints_.sensors[3 * i + a] : hints_.viewpoint[a];
    toward[a] = from - cloud_.points()[i][a];
    squares += toward[a] * toward[a];
  }
  const float length = std::sqrt(squares);
  const bool known = std::isfinite(length) && length > 0.F;
  for (std::size_t a = 0; a < 3; ++a) toward[a] = known ? toward[a] / length : 0.F;
}

AutoOrientation Tile::orientAsKnown(const Segmentation& pieces, const TileSigns& signs) const {
  AutoOrientation out;
  out.result.point_signs.assign(cloud_.size(), 0);
  out.result.point_confidences.assign(cloud_.size(), 0.F);
  out.result.point_components.assign(cloud_.size(), -1);
  if (!signs.toward.empty()) out.toward.assign(3 * cloud_.size(), 0.F);
  for (std::size_t i = 0; i < cloud_.size(); ++i) {
    const std::int32_t piece = pieces.labels[i];
    if (piece < 0 || at(piece) >= signs.pieces.size()) continue;
    std::int8_t sign = signs.pieces[at(piece)];
    const std::size_t patch = at(patch_of_[i]);
    if (patch_of_[i] >= 0 && patch < signs.patches.size()) {
      sign = signs.patches[patch];
      if (!signs.toward.empty()) std::copy_n(&signs.toward[3 * patch], 3, &out.toward[3 * i]);
    } else if (!signs.toward.empty()) {
      towardSensor(i, &out.toward[3 * i]);
    }
    out.result.point_signs[i] = static_cast<std::int8_t>(sign * pieces.signs[i]);
    out.result.point_components[i] = 0;
  }
  return out;
}

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
void Tile::cutPatches(const Segmentation& pieces, std::uint32_t most) {
  std::vector<std::int32_t> open(pieces.segments.size(), -1);
  std::vector<std::uint32_t> filled(pieces.segments.size(), 0);
  std::int32_t count = 0;
  patch_of_.assign(cloud_.size(), -1);
  for (std::size_t i = 0; i < cloud_.size(); ++i) {
    const std::int32_t piece = pieces.labels[i];
    if (piece < 0 || own_[i] == 0) continue;
    if (open[at(piece)] < 0 || filled[at(piece)] >= most) {
      open[at(piece)] = count++;
      filled[at(piece)] = 0;
    }
    ++filled[at(piece)];
    patch_of_[i] = open[at(piece)];
  }
}

void Tile::makePatches() {
  out_.piece_sizes.assign(record_.segments.segments.size(), 0);
  for (std::size_t i = 0; i < cloud_.size(); ++i) {
    if (patch_of_[i] < 0) continue;
    const std::int32_t piece = record_.segments.labels[i];
    ++out_.piece_sizes[at(piece)];
    if (at(patch_of_[i]) == out_.patch_list.size()) {
      out_.patch_list.emplace_back();
      out_.patch_list.back().piece = piece;
      out_.patch_list.back().row = static_cast<std::uint32_t>(cloud_.rowOf(i));
    }
    TilePatch& patch = out_.patch_list[at(patch_of_[i])];
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

// The signs of pieces, as most of their points have them.
void Tile::listSigns() {
  const std::vector<SegmentOrientationResult>& found = stages_.orientation.result.segments;
  out_.piece_signs.reserve(found.size());
  for (const SegmentOrientationResult& piece : found) out_.piece_signs.push_back(piece.sign);
}

// The piece whose sign a point's final normal follows: its own, unless the filter turned the normal
// as those around are, or the point is of no piece.
// \return the point of that piece, itself or a neighbour; -1 where there is none
std::int32_t Tile::followed(std::size_t i) const {
  const float* n = &stages_.normals[4 * i];
  const auto agrees = [&](std::size_t j) {
    const float* m = &record_.sheets.normals[4 * j];
    const auto sign = static_cast<float>(stages_.orientation.result.point_signs[j]);
    return sign * (n[0] * m[0] + n[1] * m[1] + n[2] * m[2]) > 0.F;
  };
  const Neighborhoods& nb = cloud_.neighborhoods();
  for (int j = 0; j < nb.count(i); ++j) {  // itself first
    if (agrees(static_cast<std::size_t>(nb.indices(i)[j]))) return nb.indices(i)[j];
  }
  return record_.segments.labels[i] >= 0 ? static_cast<std::int32_t>(i) : -1;
}

// The tile's own signs are taken back, so that each normal is turned as its piece is.
void Tile::followPieces() {
  followed_.assign(cloud_.size(), -1);
  for (std::size_t i = 0; i < cloud_.size(); ++i) {
    if (own_[i] == 0 || !std::isfinite(stages_.normals[4 * i])) continue;
    const std::int32_t point = followed(i);
    if (point < 0) continue;
    followed_[i] = record_.segments.labels[at(point)];
    const auto sign = static_cast<float>(record_.segments.signs[at(point)] *
                                         stages_.orientation.result.point_signs[at(point)]);
    for (std::size_t a = 0; a < 3; ++a) stages_.normals[4 * i + a] *= sign;
  }
}

void Tile::scatter() {
  out_.normals = cloud_.scatter(stages_.normals, 4, kNaN);
  out_.labels = cloud_.scatter(stages_.segmentation.labels, 1, std::int32_t{-1});
  out_.followed = cloud_.scatter(followed_, 1, std::int32_t{-1});
  out_.segment_sizes.assign(stages_.segmentation.segments.size(), 0);
  for (std::size_t row = 0; row < roles_.size(); ++row) {
    if (!isOwn(roles_[row])) {
      out_.followed[row] = -1;
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

TileTraits measureTileTraits(const PointView& points, int k, const OrientationHints& hints,
                             int threads) {
  PreparedCloud cloud(points, nullptr, threads);
  TileTraits out;
  if (cloud.size() == 0) return out;
  PipelineOptions pipeline = pipelineOptions(k, threads);
  pipeline.orientation.automatic.coarse_levels = false;
  const detail::AutoStages found = detail::runAutoStages(
      cloud, pipeline, resolveHints(hints, cloud), [](const char*, double) {});
  out.noise = found.sheets.noise.fine;
  out.wide_noise = found.sheets.noise.coarse;
  out.thin = found.sheets.noise.thin ? 1 : 0;
  out.residual = found.sheets.residual;
  out.scan = found.sheets.scan_scales ? 1 : 0;
  out.denoise = found.denoised ? 1 : 0;
  const AutomaticNormalTraits& surfaces = found.final_traits.surfaces;
  out.edges = found.final_traits.edges ? 1 : 0;
  out.analytic = surfaces.analytic ? 1 : 0;
  out.cubic_edges = surfaces.cubic_edges ? 1 : 0;
  out.surface_noise = static_cast<float>(surfaces.noise) * cloud.unit();
  out.surface_ratio = static_cast<float>(surfaces.in_spacings);
  // From there on, all levels are tried.
  constexpr float kContradictory = 0.001F;
  const float facing =
      detail::opposedPairs(cloud.points(), cloud.neighborhoods(), found.normals, threads).facing;
  out.layers = facing >= kContradictory ? 1 : 0;
  return out;
}

TileShare workOnTile(const PointView& points, const std::vector<TileRole>& roles,
                     const std::vector<float>& whole, const TileOptions& options) {
  return Tile(points, roles, whole, options.threads).work(options);
}

bool needsFinishing(const TileShare& share, const TileSigns& signs) {
  // Of sensors, the whole knows which are to be believed.
  if (!signs.toward.empty()) return true;
  // A point of a border has about eight neighbours across it: four of 100,000 points.
  constexpr double kMost = 3e-4;
  std::uint64_t points = 0;
  std::uint64_t wrong = 0;
  for (const std::uint32_t size : share.piece_sizes) points += size;
  const auto right = [&](std::int32_t piece) {
    const std::size_t p = at(piece);
    return p >= signs.pieces.size() || p >= share.piece_signs.size() ||
           signs.pieces[p] == share.piece_signs[p];
  };
  for (const TileVote& v : share.votes) {
    if (right(v.a) != right(v.b)) wrong += v.count;
  }
  return static_cast<double>(wrong) > kMost * static_cast<double>(points);
}

TileShare finishTile(const PointView& points, const std::vector<TileRole>& roles,
                     const std::vector<float>& whole, const TileOptions& options,
                     const TileSigns& signs) {
  return Tile(points, roles, whole, options.threads).finish(options, signs);
}

}  // namespace segorient
