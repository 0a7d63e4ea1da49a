// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <segorient/features/recompute_normals.h>
#include <segorient/orientation/first_stages.h>
#include <segorient/segmentation/region_growing.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <limits>
#include <utility>

#include "unoriented_normals.h"

namespace segorient {

// Says which stage begins, and adds the time from its construction to its end, also where a stage
// comes twice.
class FirstStages::Timer {
 public:
  Timer(FirstStages& stages, const char* stage, double fraction) : stages_(stages), stage_(stage) {
    if (stages_.progress_) stages_.progress_(stage, fraction);
  }
  ~Timer() {
    const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - begin_;
    std::vector<StageTime>& times = stages_.times_;
    auto own = std::find_if(times.begin(), times.end(),
                            [&](const StageTime& time) { return time.stage == stage_; });
    if (own == times.end()) own = times.insert(own, {stage_, 0.0});
    own->seconds += passed.count();
  }
  Timer(const Timer&) = delete;
  Timer& operator=(const Timer&) = delete;

 private:
  FirstStages& stages_;
  const char* stage_;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

FirstStages::FirstStages(const PointView& points, const PipelineOptions& options,
                         PipelineProgress progress)
    : options_(options), progress_(std::move(progress)) {
  const Timer timer(*this, "search", 0.0);
  cloud_ = compactCloud(points, nullptr, options_.threads);
  normalizeUnit(cloud_);
  search::MedianHashIndex::Options search_options;
  search_options.threads = options_.threads;
  index_.build(cloud_.view(), nullptr, search_options);
  // More than there are would only cost memory.
  const std::size_t others = cloud_.size() > 0 ? cloud_.size() - 1 : 0;
  const int wanted = options_.k > 0 ? options_.k : kDefaultNeighbors;
  k_ = static_cast<int>(std::min(static_cast<std::size_t>(wanted), others));
  index_.nearestKAll(k_ + 1, neighborhoods_);
}

void FirstStages::findNormals() {
  {
    const Timer timer(*this, "normals", 0.4);
    normals_chosen_ =
        detail::findUnorientedNormals(cloud_.view(), index_, neighborhoods_, options_, normals_);
  }
  if (options_.recomputations <= 0) return;
  segment(0.5, nullptr);
  recomputeNormals();
}

void FirstStages::findSegments(bool split) {
  if (split) {
    segment(0.8, nullptr);
    return;
  }
  Segmentation faces;
  segment(0.8, &faces);
  segmentation_ = std::move(faces);
}

void FirstStages::segment(double done, Segmentation* faces) {
  const Timer timer(*this, "segmentation", done);
  SegmentationOptions options = options_.segmentation;
  options.threads = options_.threads;
  segmentation_ = segmentByNormals(cloud_.view(), {normals_.data(), 4, cloud_.size()},
                                   neighborhoods_, options, nullptr, faces);
}

void FirstStages::recomputeNormals() {
  const Timer timer(*this, "recomputation", 0.65);
  RecomputationOptions options = options_.recomputation;
  options.estimator = options_.normals.estimator;
  options.k = 0;
  options.threads = options_.threads;
  std::vector<std::uint8_t> regular;
  for (const Segment& s : segmentation_.segments) {
    regular.push_back(s.kind == SegmentKind::Regular ? 1 : 0);
  }
  std::vector<std::int32_t> labels = segmentation_.labels;
  for (int i = 0; i < options_.recomputations; ++i) {
    segorient::recomputeNormals(cloud_.view(), neighborhoods_, regular, options, labels, normals_);
  }
}

std::vector<float> FirstStages::normals() const {
  std::vector<float> out(4 * cloud_.row_of.size(), std::numeric_limits<float>::quiet_NaN());
  for (std::size_t row = 0; row < cloud_.row_of.size(); ++row) {
    const pcl::index_t i = cloud_.row_of[row];
    if (i >= 0) std::copy_n(&normals_[4 * static_cast<std::size_t>(i)], 4, &out[4 * row]);
  }
  return out;
}

std::vector<float> FirstStages::normalsBySegment() const {
  std::vector<float> out = normals();
  for (std::size_t row = 0; row < cloud_.row_of.size(); ++row) {
    const pcl::index_t i = cloud_.row_of[row];
    if (i < 0 || segmentation_.signs[static_cast<std::size_t>(i)] >= 0) continue;
    for (std::size_t a = 0; a < 3; ++a) out[4 * row + a] *= -1.F;
  }
  return out;
}

Segmentation FirstStages::segmentation() const {
  Segmentation out;
  out.segments = segmentation_.segments;
  for (Segment& s : out.segments) {
    for (float& v : s.centroid) v *= cloud_.unit;
    s.area *= cloud_.unit * cloud_.unit;
    s.rms *= cloud_.unit;
  }
  out.labels.assign(cloud_.row_of.size(), -1);
  out.signs.assign(cloud_.row_of.size(), 0);
  for (std::size_t row = 0; row < cloud_.row_of.size(); ++row) {
    const pcl::index_t i = cloud_.row_of[row];
    if (i < 0) continue;
    out.labels[row] = segmentation_.labels[static_cast<std::size_t>(i)];
    out.signs[row] = segmentation_.signs[static_cast<std::size_t>(i)];
  }
  return out;
}

std::size_t FirstStages::nonFinite() const {
  return static_cast<std::size_t>(
      std::count(cloud_.row_of.begin(), cloud_.row_of.end(), pcl::index_t{-1}));
}

std::size_t FirstStages::duplicates() const {
  return cloud_.row_of.size() - nonFinite() - cloud_.size();
}

}  // namespace segorient
