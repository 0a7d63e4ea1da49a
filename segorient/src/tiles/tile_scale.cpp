// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "tiles/tile_scale.h"

#include <algorithm>
#include <cmath>

#include "common/at.h"
#include "common/median.h"
#include "orientation/sensors/height_field.h"

namespace segorient::detail {
namespace {

void normalize(float (&normal)[3]) {
  float length = 0.F;
  for (const float n : normal) length += n * n;
  length = std::sqrt(length);
  for (float& n : normal) n = length > 0.F ? n / length : 0.F;
}

void copyEvidence(const Evidence& from, float* to) {
  to[0] = from.weight;
  to[1] = from.absolute;
  to[2] = from.reliable;
}

// Of points of the halo: their own tile knows whether their sensors are to be believed; here it is
// the surroundings that they are for.
// \param open see openToTheSky(); empty where nothing says that what is open to it faces up
void towardSensor(const float* point, std::size_t i, const PointHints& hints,
                  const std::vector<std::uint8_t>& open, float* toward) {
  if (!open.empty() && open[i] != 0) toward[2] = 1.F;
  const bool own = !hints.sensors.empty();
  if (!own && !hints.has_viewpoint) return;
  float squares = 0.F;
  for (std::size_t a = 0; a < 3; ++a) {
    const float from = own ? hints.sensors[3 * i + a] : hints.viewpoint[a];
    toward[a] = from - point[a];
    squares += toward[a] * toward[a];
  }
  const float length = std::sqrt(squares);
  const bool known = std::isfinite(length) && length > 0.F;
  for (std::size_t a = 0; a < 3; ++a) toward[a] = known ? toward[a] / length : 0.F;
}

}  // namespace

void TileScale::prepareRecord(const TileSigns& signs, std::uint32_t patch_points,
                              const PointHints& hints) {
  prepareRecord();
  record.known = [this, &signs, &hints, patch_points](const Segmentation& pieces,
                                                      const std::vector<float>& spacing) {
    cutPatches(pieces, patch_points);
    return orientAsKnown(pieces, spacing, signs, hints);
  };
}

void TileScale::list(std::uint32_t patch_points, TileShare& out) {
  listVotes(out);
  cutPatches(record.segments, patch_points);
  makePatches(out);
}

AutoOrientation TileScale::orientAsKnown(const Segmentation& pieces,
                                         const std::vector<float>& spacing, const TileSigns& signs,
                                         const PointHints& hints) const {
  AutoOrientation out;
  // As they are to be turned for the field: as they are, and inside out.
  out.result.components.resize(2);
  out.inside_out = {0, 1};
  out.result.point_signs.assign(points.size, 0);
  out.result.point_confidences.assign(points.size, 0.F);
  out.result.point_components.assign(points.size, -1);
  if (!signs.toward.empty()) out.toward.assign(3 * points.size, 0.F);
  std::vector<std::uint8_t> open;
  if (hints.place.faces_up) open = openToTheSky(points, median(spacing));
  for (std::size_t i = 0; i < points.size; ++i) {
    const std::int32_t piece = pieces.labels[i];
    if (piece < 0 || at(piece) >= signs.pieces.size()) continue;
    std::int8_t sign = signs.pieces[at(piece)];
    const std::size_t patch = at(patch_of[i]);
    if (patch_of[i] >= 0 && patch < signs.patches.size()) {
      sign = signs.patches[patch];
      if (!signs.toward.empty()) std::copy_n(&signs.toward[3 * patch], 3, &out.toward[3 * i]);
    } else if (!signs.toward.empty()) {
      towardSensor(points[i], i, hints, open, &out.toward[3 * i]);
    }
    out.result.point_signs[i] = static_cast<std::int8_t>(sign * pieces.signs[i]);
    out.result.point_components[i] = signs.inside_out[at(piece)];
  }
  return out;
}

void TileScale::listVotes(TileShare& out) const {
  out.votes.reserve(record.votes.size());
  for (const BorderVote& v : record.votes) {
    TileVote vote;
    vote.a = v.a;
    vote.b = v.b;
    copyEvidence(v.sheet(), vote.sheet);
    copyEvidence(v.wall, vote.wall);
    vote.count = v.count;
    out.votes.push_back(vote);
  }
}

void TileScale::pieceNormal(std::size_t i, float* out) const {
  const auto sign = static_cast<float>(record.segments.signs[i]);
  for (std::size_t a = 0; a < 3; ++a) out[a] = sign * record.sheets.normals[4 * i + a];
}

// Points come in an order in which those near each other are side by side.
void TileScale::cutPatches(const Segmentation& pieces, std::uint32_t most) {
  std::vector<std::int32_t> open(pieces.segments.size(), -1);
  std::vector<std::uint32_t> filled(pieces.segments.size(), 0);
  std::int32_t count = 0;
  patch_of.assign(points.size, -1);
  for (std::size_t i = 0; i < points.size; ++i) {
    const std::int32_t piece = pieces.labels[i];
    if (piece < 0 || own[i] == 0) continue;
    if (open[at(piece)] < 0 || filled[at(piece)] >= most) {
      open[at(piece)] = count++;
      filled[at(piece)] = 0;
    }
    ++filled[at(piece)];
    patch_of[i] = open[at(piece)];
  }
}

void TileScale::listFieldPoints(const std::vector<float>& normals,
                                const std::vector<float>& confidences,
                                const std::vector<std::int32_t>& followed,
                                const std::vector<SegmentOrientationResult>& pieces,
                                std::uint32_t most, TileShare& out) {
  cutPatches(record.segments, most);
  std::vector<float> counts;
  for (std::size_t i = 0; i < points.size; ++i) {
    if (patch_of[i] < 0) continue;
    if (at(patch_of[i]) == out.field_points.size()) {
      out.field_points.emplace_back();
      counts.push_back(0.F);
    }
    FieldPoint& f = out.field_points[at(patch_of[i])];
    const float share = 1.F / ++counts[at(patch_of[i])];
    for (std::size_t a = 0; a < 3; ++a) {
      f.position[a] += share * (points[i][a] * unit - f.position[a]);
    }
    f.confidence += share * (confidences[i] - f.confidence);
    if (followed[i] < 0) continue;
    if (f.piece < 0) f.piece = followed[i];
    const auto sign = static_cast<float>(pieces[at(f.piece)].sign);
    for (std::size_t a = 0; a < 3; ++a) f.normal[a] += sign * normals[4 * i + a];
  }
  for (FieldPoint& f : out.field_points) normalize(f.normal);
}

void TileScale::makePatches(TileShare& out) const {
  out.piece_sizes.assign(record.segments.segments.size(), 0);
  for (std::size_t i = 0; i < points.size; ++i) {
    if (patch_of[i] < 0) continue;
    const std::int32_t piece = record.segments.labels[i];
    ++out.piece_sizes[at(piece)];
    if (at(patch_of[i]) == out.patch_list.size()) {
      out.patch_list.emplace_back();
      out.patch_list.back().piece = piece;
      out.patch_list.back().row = rows[i];
    }
    TilePatch& patch = out.patch_list[at(patch_of[i])];
    float normal[3];
    pieceNormal(i, normal);
    // Means as they grow: a single point stays exactly what it is.
    const float share = 1.F / static_cast<float>(++patch.points);
    const float* place = record.smoothed.empty() ? points[i] : &record.smoothed[4 * i];
    for (std::size_t a = 0; a < 3; ++a) {
      patch.position[a] += share * (place[a] * unit - patch.position[a]);
      patch.normal[a] += share * (normal[a] - patch.normal[a]);
    }
    const float h = record.sheets.spacing[i] * unit;
    patch.spacing = patch.points == 1 ? h : std::sqrt(patch.spacing * patch.spacing + h * h);
    patch.residual += share * (record.sheets.normals[4 * i + 3] - patch.residual);
    patch.reliable += record.sheets.reliable[i];
  }
  for (TilePatch& patch : out.patch_list) {
    if (patch.points > 1) normalize(patch.normal);
  }
}

}  // namespace segorient::detail
