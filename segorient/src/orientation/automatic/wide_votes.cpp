// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/automatic/wide_votes.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

namespace segorient::detail {
namespace {

// Steps from neighbour to neighbour, of about two spacings each.
constexpr int kSteps = 4;
// Fewer points are what noise has carried across.
constexpr float kLeastPoints = 24.F;
// A sum of unit normals is this much of their number where the surface is hardly bent.
constexpr float kHardlyBent = 0.9F;
// Of planes within 18 degrees of each other one may as well lie behind the other.
constexpr float kOneBehindTheOther = 0.95F;
// In spacings: what is nearer to a plane is on neither side of it.
constexpr float kClear = 0.5F;
// Points that are asked; half of them have to know something.
constexpr std::size_t kAsked = 16;

bool isBent(const SheetGroup& sum) {
  const float least = kHardlyBent * sum.count;
  return dot(sum.normal, sum.normal) < least * least;
}

// Of parallel planes: by how much b is higher than a, in spacings, where each goes on to its own
// side of the border, as terraces do; 0 where one lies above the other, as the sides of a wall do.
float terraceOver(const SheetGroup& a, const SheetGroup& b) {
  const Vec3 chord{b.mean[0] - a.mean[0], b.mean[1] - a.mean[1], b.mean[2] - a.mean[2]};
  const float above = dot(a.normal, chord);
  const float beside = std::sqrt(std::max(0.F, dot(chord, chord) - above * above));
  const float a_along = dot(a.mean, chord) - dot(a.mean, a.normal) * above;
  const float b_along = dot(b.mean, chord) - dot(b.mean, a.normal) * above;
  const bool apart = a_along < 0.F && b_along > 0.F && beside - std::fabs(above) >= kClear;
  return apart && std::fabs(above) >= kClear ? above : 0.F;
}

// Where two planes meet, with consistent normals, each is behind the other (a ridge) or before it
// (a valley). \return by how much in spacings, below 0 if one is behind and one before, 0 if that
// says nothing
float compareSides(const SheetGroup& a, const SheetGroup& b) {
  const float cosine = dot(a.normal, b.normal);
  if (std::fabs(cosine) > kOneBehindTheOther) return 0.F;
  const Vec3 chord{b.mean[0] - a.mean[0], b.mean[1] - a.mean[1], b.mean[2] - a.mean[2]};
  const float before_a = dot(a.normal, chord);
  const float before_b = -dot(b.normal, chord);
  const float least = std::min(std::fabs(before_a), std::fabs(before_b));
  if (!(least >= kClear)) return 0.F;
  return (before_a < 0.F) == (before_b < 0.F) ? least : -least;
}

}  // namespace

WideVoter::WideVoter(const PointView& points, const Neighborhoods& neighborhoods,
                     const SheetField& field, const Segmentation& segmentation)
    : points_(points), nb_(neighborhoods), field_(field), segmentation_(segmentation) {}

// The points of a segment that few steps lead to, and their rows in `front`.
SheetGroup WideVoter::gather(std::size_t from, std::int32_t label,
                             std::vector<std::uint32_t>& front) {
  SheetGroup group;
  ++gatherings_;
  front.clear();
  const auto take = [&](std::size_t q) {
    if (segmentation_.labels[q] != label || seen_[q] == gatherings_) return;
    seen_[q] = gatherings_;
    front.push_back(static_cast<std::uint32_t>(q));
  };
  const auto takeNeighbors = [&](std::size_t q) {
    const pcl::index_t* row = nb_.indices(q) + 1;
    const int degree = std::min(nb_.count(q) - 1, kSheetDegree);
    for (int j = 0; j < degree; ++j) take(static_cast<std::size_t>(row[j]));
  };
  take(from);
  if (front.empty()) takeNeighbors(from);
  std::size_t begin = 0;
  for (int step = 0; step < kSteps; ++step) {
    const std::size_t end = front.size();
    for (; begin < end; ++begin) takeNeighbors(front[begin]);
  }
  const float h = field_.spacing[from];
  const float* p = points_[from];
  for (const std::uint32_t q : front) {
    const float* x = points_[q];
    group.add({(x[0] - p[0]) / h, (x[1] - p[1]) / h, (x[2] - p[2]) / h},
              field_.normals + std::size_t{4} * q, segmentation_.signs[q]);
  }
  return group;
}

// Whether most of these points have neighbours beyond half of that height, in spacings: then
// something lies above the plane, or below it, all over.
bool WideVoter::hasOther(const std::vector<std::uint32_t>& rows, const Vec3& normal, float height,
                         float h) const {
  std::size_t count = 0;
  for (const std::uint32_t q : rows) {
    const pcl::index_t* row = nb_.indices(q) + 1;
    const int degree = std::min(nb_.count(q) - 1, kSheetDegree);
    count += std::any_of(row, row + degree, [&](pcl::index_t r) {
      const float* x = points_[static_cast<std::size_t>(r)];
      const float* y = points_[q];
      const float off = dot({(x[0] - y[0]) / h, (x[1] - y[1]) / h, (x[2] - y[2]) / h}, normal);
      return height > 0.F ? off > 0.5F * height : off < 0.5F * height;
    });
  }
  return 2 * count > rows.size();
}

// \return as compareSides(), of terraces: consistent normals of both point to the same side. Of
// walls in noise, parts of both sides lie beside each other, too, but each with more of the other
// side above or below it.
float WideVoter::compareTerraces(const SheetGroup& a, const SheetGroup& b, float h) const {
  const float cosine = dot(a.normal, b.normal);
  if (std::fabs(cosine) <= kOneBehindTheOther) return 0.F;
  const float height = terraceOver(a, b);
  if (height == 0.F || hasOther(first_, a.normal, height, h) ||
      hasOther(second_, a.normal, -height, h)) {
    return 0.F;
  }
  return std::copysign(height, cosine);
}

float WideVoter::vote(const std::vector<pcl::index_t>& border, std::int32_t a, std::int32_t b) {
  for (const std::int32_t s : {a, b}) {
    const auto size = segmentation_.segments[static_cast<std::size_t>(s)].size;
    if (static_cast<float>(size) < kLeastPoints) return 0.F;
  }
  seen_.resize(points_.size, 0);
  float sum = 0.F;
  float absolute = 0.F;
  std::size_t voters = 0;
  const std::size_t asked = std::min(border.size(), kAsked);
  for (std::size_t i = 0; i < asked; ++i) {
    const auto p = static_cast<std::size_t>(border[i * border.size() / asked]);
    SheetGroup first = gather(p, a, first_);
    SheetGroup second = gather(p, b, second_);
    if (std::min(first.count, second.count) < kLeastPoints || isBent(first) || isBent(second)) {
      continue;
    }
    first.finish();
    second.finish();
    float value = compareSides(first, second);
    if (value == 0.F) value = compareTerraces(first, second, field_.spacing[p]);
    if (!(std::fabs(value) < std::numeric_limits<float>::max())) continue;
    sum += value;
    absolute += std::fabs(value);
    voters += value != 0.F ? 1 : 0;
  }
  return 2 * voters >= asked && absolute > 0.F ? sum / absolute : 0.F;
}

}  // namespace segorient::detail
