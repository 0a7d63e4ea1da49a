// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "features/one_sided_patch.h"

#include <algorithm>

namespace segorient::detail {
namespace {

// Points that a surface is fitted to: some seven for each coefficient, so that noise of a quarter
// of the spacing averages out. On one side of an edge the neighbours' neighbours are about as many.
constexpr std::size_t kMostPoints = 40;

}  // namespace

/// The neighbours and their neighbours, the middle included.
void OneSidedPatch::collect(std::size_t middle) {
  seen_.clear();
  around_.clear();
  const float* center = scene_.points[middle];
  for (int j = 0; j < scene_.count(middle); ++j) {
    const std::size_t q = scene_.neighbor(middle, j);
    const pcl::index_t* row = scene_.neighborhoods.indices(q);
    const int count = scene_.count(q);
    for (int k = 0; k < count; ++k) {
      const auto r = static_cast<std::size_t>(row[k]);
      if (!seen_.insert(r)) continue;
      Candidate candidate{{}, r, scene_.labels[r]};
      for (std::size_t a = 0; a < 3; ++a) {
        const double d = static_cast<double>(scene_.points[r][a]) - static_cast<double>(center[a]);
        candidate.near.offset[a] = d;
        candidate.near.sqr_distance += d * d;
      }
      around_.push_back(candidate);
    }
  }
}

template <typename Accept>
void OneSidedPatch::fitNearest(const Accept& accept, OneSidedFit& fit) {
  chosen_.clear();
  for (const Candidate& c : around_) {
    if (accept(c.label)) chosen_.push_back(&c);
  }
  if (chosen_.size() > kMostPoints) {
    std::nth_element(chosen_.begin(), chosen_.begin() + kMostPoints, chosen_.end(),
                     [](const Candidate* a, const Candidate* b) {
                       return a->near.sqr_distance != b->near.sqr_distance
                                  ? a->near.sqr_distance < b->near.sqr_distance
                                  : a->point < b->point;
                     });
    chosen_.resize(kMostPoints);
  }
  points_.clear();
  for (const Candidate* c : chosen_) points_.push_back(c->near);
  fit.fit(points_.data(), points_.size());
}

void OneSidedPatch::addNormals(Side& side) const {
  for (const Candidate* c : chosen_) {
    const float* n = &scene_.normals[4 * c->point];
    if (!isFinite(n)) continue;
    for (std::size_t a = 0; a < 3; ++a) side.toward[a] += static_cast<double>(n[a]);
  }
}

void OneSidedPatch::build(std::size_t middle) {
  collect(middle);
  whole_known_ = false;
  sides_.clear();
  for (const Candidate& c : around_) {
    const bool known = std::any_of(sides_.begin(), sides_.end(),
                                   [&](const Side& s) { return s.label == c.label; });
    if (known || !scene_.isRegular(c.label)) continue;
    sides_.emplace_back();
    sides_.back().label = c.label;
    fitNearest([&](std::int32_t label) { return label == c.label; }, sides_.back().fit);
    addNormals(sides_.back());
  }
}

const OneSidedFit& OneSidedPatch::whole() {
  if (!whole_known_) fitNearest([](std::int32_t) { return true; }, whole_);
  whole_known_ = true;
  return whole_;
}

}  // namespace segorient::detail
