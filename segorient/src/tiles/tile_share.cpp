// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "tiles/tile_share.h"

#include <cmath>
#include <limits>

#include "common/at.h"
#include "orientation/automatic/coarse_levels.h"
#include "orientation/automatic/hand_down.h"
#include "orientation/automatic/stages.h"
#include "search/prepared_cloud.h"
#include "tiles/cloud_field.h"
#include "tiles/piece_graph.h"
#include "tiles/tile_scale.h"

namespace segorient {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

class Tile {
 public:
  Tile(const PointView& points, const std::vector<TileRole>& roles, const std::vector<float>& whole,
       const TileOptions& options)
      : options_(options),
        cloud_(points, nullptr, options.threads,
               options.frame.points > 0 ? &options.frame : nullptr),
        roles_(roles) {
    fine_.points = cloud_.points();
    fine_.unit = cloud_.unit();
    for (std::size_t i = 0; i < cloud_.size(); ++i) {
      const std::size_t row = cloud_.rowOf(i);
      fine_.rows.push_back(static_cast<std::uint32_t>(row));
      fine_.own.push_back(isOwn(roles[row]) ? 1 : 0);
      // Of its own points there is none better to say anything.
      fine_.whole.push_back(isOwn(roles[row]) ? std::numeric_limits<float>::infinity()
                                              : whole[row] / cloud_.unit());
    }
  }

  TileShare work() {
    // Filtered by signs of the tile's own, which are undone again.
    std::vector<float> filtered;
    std::vector<float> confidences;
    fine_.record.field = [&](const PointView&, const detail::AutoNormals& found) {
      if (!options_.traits.wantsFieldPoints(options_.patch_points) || !hints_.leaveSidesToField())
        return;
      filtered = found.normals;
      confidences = found.confidences;
    };
    run();
    joined().list(options_.patch_points, out_);
    if (!filtered.empty()) {
      followPieces(filtered);
      fine_.listFieldPoints(filtered, confidences, followed_, stages_.orientation.result.segments,
                            options_.patch_points, out_);
    }
    listSigns();
    followed_.assign(cloud_.size(), -1);
    if (!hasLevel()) {
      followPieces(stages_.normals);
      undoSigns();
    }
    scatter();
    listTies();
    return std::move(out_);
  }

  TileShare finish(const TileSigns& signs, const CloudField& field) {
    signs_ = &signs;
    fine_.record.field = [&](const PointView& points, detail::AutoNormals& found) {
      const PointView& at = field.noise != 0 ? cloud_.points() : points;
      detail::turnInsideOut(found);
      detail::takeField(at, cloud_.neighborhoods(), cloud_.unit(), field, options_.threads, found);
      detail::turnInsideOut(found);
    };
    run();
    followed_.assign(cloud_.size(), -1);
    scatter();
    listTies();
    return std::move(out_);
  }

 private:
  bool hasLevel() const { return options_.traits.level > 0.F; }
  // The scale that the join knows.
  detail::TileScale& joined() { return hasLevel() ? coarse_ : fine_; }
  PipelineOptions pipelineOptions() const;
  void run();
  void goByLevel(const PointView& points, const AutomaticOptions& settings,
                 detail::AutoNormals& fine);
  void listSigns();
  void followPieces(const std::vector<float>& normals);
  void undoSigns();
  void scatter();
  void listTies();
  std::int32_t followed(const float* normal, std::size_t i) const;

  const TileOptions& options_;
  PreparedCloud cloud_;
  const std::vector<TileRole>& roles_;
  const TileSigns* signs_ = nullptr;  // of the whole, where they are known
  PointHints hints_;
  detail::TileScale fine_;
  detail::CoarseLevel level_;
  detail::TileScale coarse_;  // of the level's points
  PointHints level_hints_;
  detail::AutoStages stages_;
  std::vector<std::int32_t> followed_;  // see TileShare
  TileShare out_;
};

PipelineOptions Tile::pipelineOptions() const {
  PipelineOptions pipeline;
  pipeline.k = options_.k;
  pipeline.threads = options_.threads;
  AutomaticOptions& automatic = pipeline.orientation.automatic;
  automatic.find_sensors = false;
  const auto set = [](float value, float& a, float& b) {
    if (value > 0.F) a = b = value;
  };
  set(options_.alpha, automatic.alpha, pipeline.segmentation.alpha);
  set(options_.beta, automatic.beta, pipeline.segmentation.beta);
  set(options_.epsilon, automatic.epsilon, pipeline.segmentation.epsilon);
  return pipeline;
}

void Tile::run() {
  const TileTraits& traits = options_.traits;
  detail::SheetRecord& record = fine_.record;
  record.traits.noise = {traits.noise, traits.wide_noise, traits.thin != 0};
  record.traits.residual = traits.residual;
  record.traits.scan_scales = traits.scan != 0;
  record.final_traits.surfaces.noise = {static_cast<double>(traits.surface_noise / cloud_.unit()),
                                        static_cast<double>(traits.surface_ratio)};
  record.final_traits.surfaces.analytic = traits.analytic != 0;
  record.final_traits.surfaces.cubic_edges = traits.cubic_edges != 0;
  record.traits.lines = record.final_traits.surfaces.lines = traits.lines != 0;
  record.final_traits.edges = traits.edges != 0;
  record.final_traits.edges_sampled = traits.edges_sampled != 0;
  record.typical_offset = traits.typical_offset;
  record.denoise = traits.denoise != 0;
  hints_ = resolveHints(options_.hints, cloud_);
  hints_.place = options_.place;
  const PipelineOptions pipeline = pipelineOptions();
  if (signs_ != nullptr && !hasLevel()) {
    fine_.prepareRecord(*signs_, options_.patch_points, hints_);
  } else {
    fine_.prepareRecord();
  }
  if (hasLevel()) {
    record.coarser = [&](const PointView& points, detail::AutoNormals& fine) {
      goByLevel(points, pipeline.orientation.automatic, fine);
    };
  }
  stages_ = detail::runAutoStages(
      cloud_, pipeline, hints_, [](const char*, double) {}, &record);
}

// As followCoarserLevels() does, at the radius that the whole cloud asks for.
void Tile::goByLevel(const PointView& points, const AutomaticOptions& settings,
                     detail::AutoNormals& fine) {
  const TileTraits& traits = options_.traits;
  const float radius = traits.level_radius / cloud_.unit();
  Bounds frame = options_.frame;
  for (auto* side : {&frame.low, &frame.high}) {
    for (double& x : *side) x /= static_cast<double>(cloud_.unit());
  }
  level_ = detail::makeLevel(points, radius, options_.threads, frame.points > 0 ? &frame : nullptr);
  if (level_.cloud.size() == 0) return;
  const float unit = level_.cloud.unit();
  coarse_.points = level_.cloud.points();
  coarse_.unit = unit * cloud_.unit();
  for (const std::uint32_t i : level_.point) {
    coarse_.rows.push_back(fine_.rows[i]);
    coarse_.own.push_back(fine_.own[i]);
    coarse_.whole.push_back(fine_.whole[i] / unit);
  }
  level_hints_.has_viewpoint = hints_.has_viewpoint;
  for (std::size_t a = 0; a < 3; ++a) level_hints_.viewpoint[a] = hints_.viewpoint[a] / unit;
  coarse_.record.traits.noise = {traits.level_noise, traits.level_wide_noise,
                                 traits.level_thin != 0};
  coarse_.record.traits.residual = traits.level_residual;
  if (signs_ != nullptr) {
    coarse_.prepareRecord(*signs_, options_.patch_points, level_hints_);
  } else {
    coarse_.prepareRecord();
  }
  detail::MoreNeighbors more(coarse_.points, options_.threads);
  level_.found = detail::orientPoints(more, level_.cloud.neighborhoods(), settings, PointHints(),
                                      options_.threads, {}, &coarse_.record);
  fine = detail::handDown(points, level_, radius, options_.threads, fine).found;
}

// The signs of pieces, as most of their points have them.
void Tile::listSigns() {
  const std::vector<SegmentOrientationResult>& found = stages_.orientation.result.segments;
  out_.piece_signs.reserve(found.size());
  for (const SegmentOrientationResult& piece : found) out_.piece_signs.push_back(piece.sign);
}

// The piece whose sign a point's normal follows: its own, unless the filter turned the normal as
// those around are, or the point is of no piece; -1 where there is none. Of a level, that of the
// nearest of its points.
std::int32_t Tile::followed(const float* n, std::size_t i) const {
  if (hasLevel()) {
    return level_.nearest.empty() ? -1 : coarse_.record.segments.labels[level_.nearest[i]];
  }
  const std::vector<std::int32_t>& pieces = fine_.record.segments.labels;
  const auto agrees = [&](std::size_t j) {
    const float* m = &fine_.record.sheets.normals[4 * j];
    const auto sign = static_cast<float>(stages_.orientation.result.point_signs[j]);
    return sign * (n[0] * m[0] + n[1] * m[1] + n[2] * m[2]) > 0.F;
  };
  const Neighborhoods& nb = cloud_.neighborhoods();
  for (int j = 0; j < nb.count(i); ++j) {  // itself first
    const auto q = static_cast<std::size_t>(nb.indices(i)[j]);
    if (agrees(q)) return pieces[q];
  }
  return pieces[i];
}

void Tile::followPieces(const std::vector<float>& normals) {
  followed_.assign(cloud_.size(), -1);
  for (std::size_t i = 0; i < cloud_.size(); ++i) {
    if (fine_.own[i] == 0 || !std::isfinite(normals[4 * i])) continue;
    followed_[i] = followed(&normals[4 * i], i);
  }
}

// The tile's own signs are taken back, so that each normal is turned as its piece is.
void Tile::undoSigns() {
  for (std::size_t i = 0; i < cloud_.size(); ++i) {
    if (followed_[i] < 0) continue;
    const auto sign =
        static_cast<float>(stages_.orientation.result.segments[at(followed_[i])].sign);
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
  out_.segment_borders = detail::labelBorders(cloud_.neighborhoods(), stages_.segmentation.labels);
}

void Tile::listTies() {
  const detail::TileScale& scale = joined();
  for (std::size_t row = 0; row < roles_.size(); ++row) {
    if (roles_[row] == TileRole::OWN || cloud_.pointOf(row) < 0) continue;
    const auto i = static_cast<std::size_t>(cloud_.pointOf(row));
    if (cloud_.rowOf(i) != row) continue;  // repeats another one
    TileTie tie;
    tie.row = static_cast<std::uint32_t>(row);
    // Of a level's points both tiles have others: what a point's nearest one is of stands for it.
    const std::size_t of = hasLevel() && !level_.nearest.empty() ? level_.nearest[i] : i;
    if (of < scale.record.segments.labels.size()) tie.piece = scale.record.segments.labels[of];
    if (tie.piece < 0 && fine_.own[i] == 0) continue;
    tie.label = stages_.segmentation.labels[i];
    if (tie.piece >= 0) scale.pieceNormal(of, tie.normal);
    out_.ties.push_back(tie);
  }
}

}  // namespace

TileShare workOnTile(const PointView& points, const std::vector<TileRole>& roles,
                     const std::vector<float>& whole, const TileOptions& options) {
  return Tile(points, roles, whole, options).work();
}

TileShare finishTile(const PointView& points, const std::vector<TileRole>& roles,
                     const std::vector<float>& whole, const TileOptions& options,
                     const TileSigns& signs, const CloudField& field) {
  return Tile(points, roles, whole, options).finish(signs, field);
}

}  // namespace segorient
