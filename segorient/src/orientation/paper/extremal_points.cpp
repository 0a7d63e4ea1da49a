// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/paper/extremal_points.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "common/parallel_for.h"
#include "orientation/paper/box_subdivision.h"

namespace segorient {
namespace {

pcl::index_t extremalPoint(const PointView& points, const BoxSubdivision& space,
                           const BoxSubdivision::Box& box, BoxSubdivision::Direction direction) {
  pcl::index_t best = -1;
  float best_value = 0.F;
  for (std::uint32_t i = box.first; i < box.first + box.size; ++i) {
    const pcl::index_t row = space.points()[i];
    const float x = points[static_cast<std::size_t>(row)][direction.axis];
    const float value = direction.positive ? x : -x;
    if (best < 0 || value > best_value || (value == best_value && row < best)) {
      best = row;
      best_value = value;
    }
  }
  return best;
}

}  // namespace

std::vector<ExtremalPoint> findExtremalPoints(const PointView& points, const PointView& normals,
                                              const std::vector<pcl::index_t>& rows,
                                              std::size_t max_box_points, int threads) {
  const BoxSubdivision space(points, rows, max_box_points);
  std::vector<std::array<pcl::index_t, 6>> found(space.boxes().size());  // by side, -1 = none
  parallelFor(found.size(), threads, 500.0, [&](std::size_t b) {
    const BoxSubdivision::Box& box = space.boxes()[b];
    for (int side = 0; side < 6; ++side) {
      const BoxSubdivision::Direction direction{side / 2, side % 2 == 1};
      const bool full_leaf = box.children == 0 && box.size != 0;
      found[b][static_cast<std::size_t>(side)] = full_leaf && space.isFree(box, direction)
                                                     ? extremalPoint(points, space, box, direction)
                                                     : -1;
    }
  });
  std::vector<ExtremalPoint> out;
  for (const std::array<pcl::index_t, 6>& of_box : found) {
    for (std::size_t side = 0; side < 6; ++side) {
      if (of_box[side] < 0) continue;
      const float along = normals[static_cast<std::size_t>(of_box[side])][side / 2];
      const float outward = side % 2 == 1 ? along : -along;
      ExtremalPoint point;
      point.point = of_box[side];
      point.sign = outward < 0.F ? std::int8_t{-1} : std::int8_t{1};
      point.angle = std::acos(std::min(1.F, std::abs(outward)));
      out.push_back(point);
    }
  }
  return out;
}

std::vector<ExtremalEvidence> gatherExtremalEvidence(const std::vector<ExtremalPoint>& extremal,
                                                     const Segmentation& segmentation,
                                                     float gamma) {
  const std::size_t segments = segmentation.segments.size();
  std::vector<ExtremalEvidence> out(segments);
  std::vector<float> balance(segments, 0.F);
  std::vector<float> total(segments, 0.F);
  for (ExtremalEvidence& evidence : out) evidence.angle = gamma;
  for (const ExtremalPoint& found : extremal) {
    const auto p = static_cast<std::size_t>(found.point);
    const std::int32_t label = segmentation.labels[p];
    if (label < 0 || !(found.angle < gamma)) continue;
    const auto s = static_cast<std::size_t>(label);
    if (segmentation.segments[s].kind != SegmentKind::REGULAR) continue;
    const int sign = found.sign * segmentation.signs[p];
    const float weight = std::cos(found.angle);
    balance[s] += static_cast<float>(sign) * weight;
    total[s] += weight;
    ++out[s].votes;
    if (found.angle < out[s].angle) {
      out[s].angle = found.angle;
      out[s].sign = static_cast<std::int8_t>(sign);
    }
  }
  for (std::size_t s = 0; s < segments; ++s) {
    if (total[s] > 0.F) {
      out[s].agreement = static_cast<float>(out[s].sign) * balance[s] / total[s];
    }
  }
  return out;
}

}  // namespace segorient
