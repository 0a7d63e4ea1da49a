// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "support/stages.h"

#include <segorient/features/local_normals.h>
#include <segorient/features/recompute_normals.h>
#include <segorient/search/median_hash_index.h>
#include <segorient/segmentation/region_growing.h>

#include <algorithm>
#include <cstdio>
#include <limits>

namespace segorient::program {
namespace {

constexpr int kDefaultNeighbors = 12;

}  // namespace

// Adds the time from its construction to its end.
class Stages::Timer {
 public:
  Timer(Stages& stages, const char* stage, double fraction) : stages_(stages), stage_(stage) {
    stages_.bar_.update(stage, fraction);
  }
  ~Timer() {
    const auto passed = std::chrono::steady_clock::now() - begin_;
    stages_.times_.push_back({stage_, std::chrono::duration<double>(passed).count()});
  }
  Timer(const Timer&) = delete;
  Timer& operator=(const Timer&) = delete;

 private:
  Stages& stages_;
  const char* stage_;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

Stages::Stages(const PointView& points, const PipelineOptions& options, bool progress)
    : options_(options), bar_(progress, points.size) {
  const Timer timer(*this, "search", 0.0);
  cloud_ = compactCloud(points, nullptr, options_.threads);
  search::MedianHashIndex index;
  search::MedianHashIndex::Options search_options;
  search_options.threads = options_.threads;
  index.build(cloud_.view(), nullptr, search_options);
  k_ = options_.k > 0 ? options_.k : kDefaultNeighbors;
  const std::size_t others = cloud_.size() > 0 ? cloud_.size() - 1 : 0;
  k_ = static_cast<int>(std::min<std::size_t>(static_cast<std::size_t>(k_), others));
  index.nearestKAll(k_ + 1, neighborhoods_);
}

void Stages::findNormals() {
  const Timer timer(*this, "normals", 0.4);
  normals_.resize(4 * cloud_.size());
  LocalNormalOptions options = options_.normals;
  options.k = 0;
  options.threads = options_.threads;
  estimateNormals(cloud_.view(), neighborhoods_, options, normals_.data());
}

void Stages::findSegments() {
  const Timer timer(*this, "segmentation", 0.6);
  SegmentationOptions options = options_.segmentation;
  options.threads = options_.threads;
  segmentation_ = segmentByNormals(cloud_.view(), compactNormals(), neighborhoods_, options);
}

void Stages::recomputeNormals(int rounds, float delta) {
  const Timer timer(*this, "recomputation", 0.8);
  RecomputationOptions options;
  options.threads = options_.threads;
  options.estimator = options_.normals.estimator;
  if (delta > 0.F) {
    options.rule = RecomputationRule::ModifiedNeighborhoods;
    options.delta = delta;
  }
  std::vector<std::uint8_t> regular;
  for (const Segment& s : segmentation_.segments) {
    regular.push_back(s.kind == SegmentKind::Regular ? 1 : 0);
  }
  std::vector<std::int32_t> labels = segmentation_.labels;
  for (int i = 0; i < rounds; ++i) {
    segorient::recomputeNormals(cloud_.view(), neighborhoods_, regular, options, labels, normals_);
  }
}

std::vector<float> Stages::normals() const {
  std::vector<float> out(4 * cloud_.row_of.size(), std::numeric_limits<float>::quiet_NaN());
  for (std::size_t row = 0; row < cloud_.row_of.size(); ++row) {
    const pcl::index_t i = cloud_.row_of[row];
    if (i >= 0) std::copy_n(&normals_[4 * static_cast<std::size_t>(i)], 4, &out[4 * row]);
  }
  return out;
}

Segmentation Stages::segmentation() const {
  Segmentation out;
  out.segments = segmentation_.segments;
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

std::size_t Stages::nonFinite() const {
  return static_cast<std::size_t>(
      std::count(cloud_.row_of.begin(), cloud_.row_of.end(), pcl::index_t{-1}));
}

std::size_t Stages::duplicates() const {
  return cloud_.row_of.size() - nonFinite() - cloud_.size();
}

std::string timesText(const std::vector<StageTime>& times) {
  std::string text;
  for (const StageTime& t : times) {
    char part[64];
    std::snprintf(part, sizeof(part), "%s%s %.2f", text.empty() ? "" : "  ", t.stage.c_str(),
                  t.seconds);
    text += part;
  }
  return text;
}

}  // namespace segorient::program
