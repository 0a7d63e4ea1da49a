// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "segmentation/sheet_grower.h"

#include <cstring>
#include <numeric>

namespace segorient::detail {
namespace {

constexpr float kDegree = 0.01745329F;

float dot(const float* a, const float* b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

// 15 degrees where residuals are those of curvature, 20 where they are noise.
float automaticAlpha(float residual) {
  const float t = std::clamp((residual - 0.05F) / 0.2F, 0.F, 1.F);
  return (15.F + 5.F * t) * kDegree;
}

}  // namespace

SheetGrower::SheetGrower(const PointView& points, const Neighborhoods& neighborhoods,
                         const SheetField& field, const std::vector<std::uint32_t>& admissible,
                         const SheetSegmentationOptions& options)
    : points_(points),
      nb_(neighborhoods),
      field_(field),
      admissible_(admissible),
      options_(options),
      cos_alpha_(std::cos(options.alpha > 0.F ? options.alpha : automaticAlpha(field.residual))),
      cos_beta_(std::cos(options.beta)),
      cos_relaxed_(std::cos(options.beta + options.epsilon)),
      labels_(points.size, -1),
      signs_(points.size, 1) {}

// By residual to a percent or so (the leading 16 bits of a float that is not negative order it that
// far), then by index: near points one after the other.
std::vector<pcl::index_t> SheetGrower::seedOrder() const {
  const auto key = [&](std::size_t i) {
    std::uint32_t bits = 0;
    std::memcpy(&bits, normal(i) + 3, sizeof bits);
    return bits >> 16;
  };
  std::vector<std::uint32_t> start(65537, 0);
  for (std::size_t i = 0; i < points_.size; ++i) {
    if (std::isfinite(normal(i)[3])) ++start[key(i) + 1];
  }
  std::partial_sum(start.begin(), start.end(), start.begin());
  std::vector<pcl::index_t> seeds(start.back());
  for (std::size_t i = 0; i < points_.size; ++i) {
    if (std::isfinite(normal(i)[3])) seeds[start[key(i)]++] = static_cast<pcl::index_t>(i);
  }
  return seeds;
}

// The sign with which q joins the segment coming from p, or 0 where it may not: too steep, or the
// parent and the reference normal disagree about its sign.
int SheetGrower::accepts(std::size_t p, std::size_t q, const SheetSegment& segment,
                         float cos_beta) const {
  const float* n = normal(q);
  const float from_parent = dot(n, normal(p));
  if (std::fabs(from_parent) < cos_alpha_) return 0;
  const float to_reference = n[0] * segment.x + n[1] * segment.y + n[2] * segment.z;
  const float least = cos_beta * cos_beta * segment.squaredLength();
  if (to_reference * to_reference < least) return 0;
  const int by_parent = from_parent * static_cast<float>(signs_[p]) >= 0.F ? 1 : -1;
  const int by_reference = to_reference >= 0.F ? 1 : -1;
  return by_parent == by_reference ? by_parent : 0;
}

bool SheetGrower::supported(std::size_t q, std::int32_t label, std::uint32_t size) const {
  if (!options_.require_support) return true;
  constexpr std::uint32_t kYoung = 6;  // a segment that small has no three neighbours to offer
  const int wanted = size <= kYoung ? 0 : 3;
  const pcl::index_t* row = neighbors(q);
  const int last = degree(q);
  int good = 0;
  int bad = 0;
  // Most points have one sheet around them, so that nothing can speak against it.
  const bool one_sheet = admissible_[q] == (1U << last) - 1U;
  for (int j = 0; j < last && !(one_sheet && good >= wanted); ++j) {
    if (labels_[at(row[j])] != label) continue;
    (admits(q, j) ? good : bad) += 1;
  }
  return bad <= good && good >= wanted;
}

void SheetGrower::add(std::size_t q, std::int32_t label, int sign) {
  labels_[q] = label;
  signs_[q] = static_cast<std::int8_t>(sign);
  SheetSegment& segment = segments_[static_cast<std::size_t>(label)];
  const float* n = normal(q);
  const auto s = static_cast<float>(sign);
  segment.x += s * n[0];
  segment.y += s * n[1];
  segment.z += s * n[2];
  ++segment.size;
}

void SheetGrower::visit(std::size_t p, bool reliable_only) {
  const std::int32_t label = labels_[p];
  const pcl::index_t* row = neighbors(p);
  for (int j = 0; j < degree(p); ++j) {
    const std::size_t q = at(row[j]);
    if (labels_[q] >= 0 || !admits(p, j) || (reliable_only && field_.reliable[q] == 0)) continue;
    const SheetSegment& segment = segments_[static_cast<std::size_t>(label)];
    const int sign = accepts(p, q, segment, cos_beta_);
    if (sign == 0 || !supported(q, label, segment.size)) continue;
    add(q, label, sign);
    queue_.push_back(static_cast<pcl::index_t>(q));
  }
}

void SheetGrower::grow(pcl::index_t seed, bool reliable_only) {
  const auto label = static_cast<std::int32_t>(segments_.size());
  segments_.emplace_back();
  add(at(seed), label, 1);
  queue_.assign(1, seed);
  for (std::size_t head = 0; head < queue_.size(); ++head) {
    // Fetches ahead: rows, and the rows and normals of the points in the farther half of a row,
    // where growing has not been yet. Not in a function of its own, which compilers leave out.
    constexpr std::size_t kRowsAhead = 10;
    constexpr std::size_t kPointsAhead = 3;
    if (head + kRowsAhead < queue_.size()) {
      __builtin_prefetch(neighbors(at(queue_[head + kRowsAhead])));
      __builtin_prefetch(&admissible_[at(queue_[head + kRowsAhead])]);
    }
    if (head + kPointsAhead < queue_.size()) {
      const std::size_t p = at(queue_[head + kPointsAhead]);
      const pcl::index_t* row = neighbors(p);
      for (int last = degree(p), j = last / 2; j < last; ++j) {
        __builtin_prefetch(&labels_[at(row[j])]);
        __builtin_prefetch(normal(at(row[j])));
        __builtin_prefetch(neighbors(at(row[j])));
      }
    }
    visit(at(queue_[head]), reliable_only);
  }
}

void SheetGrower::growAll() {
  const std::vector<pcl::index_t> seeds = seedOrder();
  for (const pcl::index_t s : seeds) {
    if (labels_[at(s)] < 0 && field_.reliable[at(s)] != 0) grow(s, true);
  }
  queue_.clear();
  for (std::size_t i = 0; i < points_.size; ++i) {
    if (labels_[i] >= 0) queue_.push_back(static_cast<pcl::index_t>(i));
  }
  for (std::size_t head = 0; head < queue_.size(); ++head) visit(at(queue_[head]), false);
  for (const pcl::index_t s : seeds) {
    if (labels_[at(s)] < 0) grow(s, false);
  }
}

Segmentation SheetGrower::finish() const {
  std::vector<pcl::index_t> first(segments_.size(), -1);
  for (std::size_t i = points_.size; i-- > 0;) {
    if (labels_[i] >= 0) first[static_cast<std::size_t>(labels_[i])] = static_cast<pcl::index_t>(i);
  }
  std::vector<std::size_t> order(segments_.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  order.erase(std::remove_if(order.begin(), order.end(),
                             [&](std::size_t s) { return segments_[s].size == 0; }),
              order.end());
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return segments_[a].size != segments_[b].size ? segments_[a].size > segments_[b].size
                                                  : first[a] < first[b];
  });

  Segmentation out;
  out.segments.resize(order.size());
  std::vector<std::int32_t> renamed(segments_.size(), -1);
  std::uint32_t start = 0;
  for (std::size_t s = 0; s < order.size(); ++s) {
    const SheetSegment& from = segments_[order[s]];
    renamed[order[s]] = static_cast<std::int32_t>(s);
    Segment& to = out.segments[s];
    to.kind = from.size >= options_.small ? SegmentKind::Regular : SegmentKind::Isolated;
    to.first = start;
    to.size = from.size;
    start += from.size;
    const float l = from.length();
    if (l > 0.F) to.reference_normal = {from.x / l, from.y / l, from.z / l};
  }
  out.signs = signs_;
  out.labels.resize(points_.size);
  out.members.resize(start);
  std::vector<std::uint32_t> next(order.size());
  for (std::size_t s = 0; s < order.size(); ++s) next[s] = out.segments[s].first;
  for (std::size_t i = 0; i < points_.size; ++i) {
    const std::int32_t old = labels_[i];
    out.labels[i] = old < 0 ? -1 : renamed[static_cast<std::size_t>(old)];
    if (old >= 0) {
      out.members[next[static_cast<std::size_t>(out.labels[i])]++] = static_cast<pcl::index_t>(i);
    }
  }
  return out;
}

}  // namespace segorient::detail
