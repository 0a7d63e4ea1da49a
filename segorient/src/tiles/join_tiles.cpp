// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "tiles/join_tiles.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "common/at.h"
#include "common/median.h"
#include "orientation/automatic/noise_field.h"
#include "orientation/automatic/orient_sheets.h"
#include "orientation/automatic/stages.h"
#include "orientation/sensors/known_sensors.h"
#include "orientation/sensors/sensor_hints.h"
#include "search/prepared_cloud.h"
#include "tiles/cloud_field.h"
#include "tiles/piece_graph.h"

namespace segorient {
namespace {

using detail::PieceTie;

// Pairs of something that both tiles have numbers for, by the points that both have.
// \param of the number of a tie, -1 = none \param compare a pair of ties, from -1 to 1
template <typename Of, typename Compare>
void tally(const std::vector<TileTie>& in_a, std::int32_t first_a, const std::vector<TileTie>& in_b,
           std::int32_t first_b, const Of& of, const Compare& compare, std::vector<PieceTie>& out) {
  std::map<std::pair<std::int32_t, std::int32_t>, PieceTie> found;
  std::map<std::int32_t, std::uint32_t> all_a;
  std::map<std::int32_t, std::uint32_t> all_b;
  for (std::size_t i = 0; i < in_a.size(); ++i) {
    const std::int32_t a = of(in_a[i]);
    const std::int32_t b = of(in_b[i]);
    if (a < 0 || b < 0) continue;
    ++all_a[a];
    ++all_b[b];
    PieceTie& pair = found[{a, b}];
    const float agree = compare(in_a[i], in_b[i]);
    pair.weight += agree;
    pair.absolute += std::fabs(agree);
    ++pair.count;
  }
  for (auto& [numbers, pair] : found) {
    const auto [a, b] = numbers;
    pair.a = first_a + a;
    pair.b = first_b + b;
    pair.most = 2 * pair.count > std::max(all_a[a], all_b[b]);
    out.push_back(pair);
  }
}

// Neighbours are needed only to check sensors.
PointHints hintsOf(const OrientationHints& hints, const CloudPlace& place, PreparedCloud& cloud) {
  PointHints out = resolveHints(hints, cloud);
  out.place = place;
  out.even_sample = true;
  if (out.has_viewpoint || !out.sensors.empty()) {
    cloud.findNeighbors(kSheetNeighbors, false);
  }
  return out;
}

// Whether a piece is of a component that hints turned inside out.
bool isInsideOut(const AutoOrientation& orientation, std::size_t piece) {
  const std::int32_t component = orientation.result.segments[piece].component;
  return component >= 0 && orientation.inside_out[at(component)] != 0;
}

}  // namespace

struct TileJoiner::Impl {
  struct First {
    std::int32_t piece = 0;
    std::size_t patch = 0;
  };
  std::vector<First> first;  // of each tile, and behind the last one
  std::vector<std::uint32_t> piece_sizes;
  std::vector<TileVote> votes;
  std::vector<TilePatch> patches;
  std::vector<FieldPoint> field_points;
  std::vector<PieceTie> piece_ties;

  // Patches as a cloud whose points know their sheets.
  struct PatchCloud {
    PreparedCloud cloud;
    std::vector<float> normals;
    std::vector<float> spacing;
    std::vector<std::uint8_t> reliable;
    Segmentation segmentation;
  };
  PatchCloud makeCloud(const PointView& places, int threads) const;
  CloudField findField(const AutoOrientation& orientation, const PatchCloud& cloud,
                       const PointHints& hints, const JoinOptions& options) const;
  void distribute(const AutoOrientation& orientation, const PatchCloud& cloud,
                  JoinedTiles& out) const;
};

TileJoiner::Impl::PatchCloud TileJoiner::Impl::makeCloud(const PointView& places,
                                                         int threads) const {
  PatchCloud out;
  out.cloud = PreparedCloud(places, nullptr, threads);
  const std::size_t n = out.cloud.size();
  out.normals.resize(4 * n);
  out.spacing.resize(n);
  out.reliable.resize(n);
  out.segmentation.labels.resize(n);
  out.segmentation.signs.assign(n, 1);
  for (std::size_t i = 0; i < n; ++i) {
    const TilePatch& patch = patches[out.cloud.rowOf(i)];
    std::copy_n(patch.normal, 3, &out.normals[4 * i]);
    out.normals[4 * i + 3] = patch.residual;
    out.spacing[i] = patch.spacing / out.cloud.unit();
    out.reliable[i] = 2 * patch.reliable >= patch.points ? 1 : 0;
    out.segmentation.labels[i] = patch.piece;
  }
  out.segmentation.segments.resize(piece_sizes.size());
  for (std::size_t s = 0; s < piece_sizes.size(); ++s) {
    out.segmentation.segments[s].size = piece_sizes[s];
  }
  return out;
}

// As runAutoStages() does of a cloud in memory.
CloudField TileJoiner::Impl::findField(const AutoOrientation& orientation, const PatchCloud& cloud,
                                       const PointHints& hints, const JoinOptions& options) const {
  std::vector<float> normals = cloud.normals;
  for (std::size_t i = 0; i < cloud.cloud.size(); ++i) {
    const std::size_t piece = at(cloud.segmentation.labels[i]);
    const int sign = orientation.result.point_signs[i] * (isInsideOut(orientation, piece) ? -1 : 1);
    for (std::size_t a = 0; a < 3; ++a) normals[4 * i + a] *= static_cast<float>(sign);
  }
  const bool fine = !options.traits.hasField();
  const bool alone = orientation.toward.empty();
  if (fine && !alone) return {};
  if (alone && !(options.traits.level > 0.F)) {
    CloudField signs = detail::findSigns(cloud.cloud, normals, median(cloud.spacing), orientation,
                                         hints, options.traits.noisy != 0, options.threads);
    if (!signs.cells.empty()) return signs;
  }
  if (field_points.empty()) return {};  // tiles whose sensors were known did not ask
  std::vector<float> places;
  std::vector<float> of_rows;
  std::vector<float> confidences;
  for (const FieldPoint& p : field_points) {
    float sign = 0.F;
    if (p.piece >= 0) {
      sign = static_cast<float>(orientation.result.segments[at(p.piece)].sign);
      if (isInsideOut(orientation, at(p.piece))) sign = -sign;
    }
    places.insert(places.end(), p.position, p.position + 3);
    for (const float n : p.normal) of_rows.push_back(sign * n);
    of_rows.push_back(0.F);
    const float of_piece = p.piece < 0 ? 1.F : orientation.result.segments[at(p.piece)].confidence;
    confidences.push_back(std::min(p.confidence, of_piece));
  }
  const PointView points{places.data(), 3, field_points.size()};
  if (fine) return detail::findFine(points, of_rows, confidences, options.threads);
  const detail::KnownField known{options.traits.consistent != 0, options.traits.fine_field != 0};
  CloudField out = detail::findNoise(points, of_rows, confidences, known, options.threads);
  // Means of several points do not tell directions.
  if (options.patch_points == 1)
    out.averaged_below = options.traits.noisy != 0 ? 1.F : detail::kAcross;
  return out;
}

void TileJoiner::Impl::distribute(const AutoOrientation& orientation, const PatchCloud& cloud,
                                  JoinedTiles& out) const {
  for (std::size_t t = 0; t < out.tiles.size(); ++t) {
    TileSigns& tile = out.tiles[t];
    for (std::int32_t s = first[t].piece; s < first[t + 1].piece; ++s) {
      tile.pieces.push_back(orientation.result.segments[at(s)].sign);
      tile.inside_out.push_back(isInsideOut(orientation, at(s)) ? 1 : 0);
    }
    for (std::size_t p = first[t].patch; p < first[t + 1].patch; ++p) {
      // Patches in one place have one point, which is of one of their pieces.
      const pcl::index_t point = cloud.cloud.pointOf(p);
      const auto i = static_cast<std::size_t>(std::max<pcl::index_t>(point, 0));
      const bool own = point >= 0 && cloud.cloud.rowOf(i) == p;
      const SegmentOrientationResult& piece = orientation.result.segments[at(patches[p].piece)];
      tile.patches.push_back(own ? orientation.result.point_signs[i] : piece.sign);
      for (std::size_t a = 0; a < 3 && !orientation.toward.empty(); ++a) {
        tile.toward.push_back(own ? orientation.toward[3 * i + a] : 0.F);
      }
    }
  }
}

TileJoiner::TileJoiner() : impl_(std::make_unique<Impl>()) {
  impl_->first.emplace_back();
}
TileJoiner::~TileJoiner() = default;

void TileJoiner::addTile(const std::vector<std::uint32_t>& piece_sizes,
                         const std::vector<TileVote>& votes, const std::vector<TilePatch>& patches,
                         const std::vector<FieldPoint>& field_points,
                         const std::array<double, 3>& offset) {
  Impl& i = *impl_;
  const std::int32_t piece = i.first.back().piece;
  for (TileVote v : votes) {
    v.a += piece;
    v.b += piece;
    i.votes.push_back(v);
  }
  const auto move = [&](float(&position)[3]) {
    for (std::size_t a = 0; a < 3; ++a) {
      position[a] = static_cast<float>(static_cast<double>(position[a]) + offset[a]);
    }
  };
  for (TilePatch p : patches) {
    p.piece += piece;
    move(p.position);
    i.patches.push_back(p);
  }
  for (FieldPoint p : field_points) {
    if (p.piece >= 0) p.piece += piece;
    move(p.position);
    i.field_points.push_back(p);
  }
  i.piece_sizes.insert(i.piece_sizes.end(), piece_sizes.begin(), piece_sizes.end());
  i.first.push_back({static_cast<std::int32_t>(i.piece_sizes.size()), i.patches.size()});
}

void TileJoiner::tie(std::size_t tile_a, const std::vector<TileTie>& of_a, std::size_t tile_b,
                     const std::vector<TileTie>& of_b) {
  const auto cosine = [](const TileTie& a, const TileTie& b) {
    return a.normal[0] * b.normal[0] + a.normal[1] * b.normal[1] + a.normal[2] * b.normal[2];
  };
  const Impl::First& a = impl_->first[tile_a];
  const Impl::First& b = impl_->first[tile_b];
  tally(
      of_a, a.piece, of_b, b.piece, [](const TileTie& t) { return t.piece; }, cosine,
      impl_->piece_ties);
}

JoinedTiles TileJoiner::join(const JoinOptions& options) {
  Impl& i = *impl_;
  JoinedTiles out;
  out.tiles.resize(i.first.size() - 1);
  out.pieces = i.piece_sizes.size();
  if (i.patches.empty()) return out;
  std::vector<float> xyz;
  xyz.reserve(3 * i.patches.size());
  std::size_t count = 0;
  for (const TilePatch& p : i.patches) {
    xyz.insert(xyz.end(), p.position, p.position + 3);
    count += p.points;
  }
  Impl::PatchCloud patches = i.makeCloud({xyz.data(), 3, i.patches.size()}, options.threads);
  PointHints hints = hintsOf(options.hints, options.place, patches.cloud);
  SheetField field;
  field.normals = patches.normals.data();
  field.spacing = patches.spacing.data();
  field.reliable = patches.reliable.data();
  field.residual =
      options.traits.level > 0.F ? options.traits.level_residual : options.traits.residual;
  std::vector<BorderVote> votes = detail::gatherVotes(std::move(i.votes), i.piece_ties);
  // A border is near any point of one of its pieces.
  std::vector<pcl::index_t> some_point(i.piece_sizes.size(), 0);
  for (std::size_t p = patches.cloud.size(); p-- > 0;) {
    some_point[at(patches.segmentation.labels[p])] = static_cast<pcl::index_t>(p);
  }
  for (BorderVote& v : votes) v.where = some_point[at(v.a)];
  const auto orient = [&] {
    return orientSheets(patches.cloud.points(), patches.cloud.neighborhoods(), field,
                        patches.segmentation, votes, count, AutomaticOptions{}, hints,
                        options.threads);
  };
  AutoOrientation orientation = orient();
  // As in memory.
  const bool dropped = options.sensors_found ? detail::seeBothSides(orientation.sensors)
                                             : orientation.leavesAllToSurface();
  if (dropped) {
    hints = hintsOf(detail::withoutSensors(options.hints), {}, patches.cloud);
    orientation = orient();
    out.sensors_dropped = true;
  }
  i.distribute(orientation, patches, out);
  if (hints.leaveSidesToField()) out.field = i.findField(orientation, patches, hints, options);
  out.components = std::move(orientation.result.components);
  return out;
}

void LabelJoiner::addTile(const std::vector<std::uint32_t>& segment_sizes,
                          const std::vector<LabelBorder>& borders) {
  const auto first = static_cast<std::int32_t>(sizes_.size());
  for (const LabelBorder& b : borders) borders_.push_back({first + b.a, first + b.b});
  sizes_.insert(sizes_.end(), segment_sizes.begin(), segment_sizes.end());
  first_.push_back(sizes_.size());
}

void LabelJoiner::tie(std::size_t tile_a, const std::vector<TileTie>& of_a, std::size_t tile_b,
                      const std::vector<TileTie>& of_b) {
  tally(
      of_a, static_cast<std::int32_t>(first_[tile_a]), of_b,
      static_cast<std::int32_t>(first_[tile_b]), [](const TileTie& t) { return t.label; },
      [](const TileTie&, const TileTie&) { return 1.F; }, ties_);
}

std::vector<std::vector<std::uint32_t>> LabelJoiner::join(std::size_t& count) const {
  const std::vector<std::uint32_t> labels = detail::uniteLabels(sizes_, ties_, borders_, count);
  std::vector<std::vector<std::uint32_t>> out;
  for (std::size_t t = 0; t + 1 < first_.size(); ++t) {
    out.emplace_back(labels.begin() + static_cast<std::ptrdiff_t>(first_[t]),
                     labels.begin() + static_cast<std::ptrdiff_t>(first_[t + 1]));
  }
  return out;
}

}  // namespace segorient
