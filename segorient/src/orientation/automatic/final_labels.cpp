// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/automatic/final_labels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "common/dot.h"
#include "common/parallel_for.h"
#include "segmentation/segment_order.h"

namespace segorient::detail {
namespace {

// As many as normals without noise are made from: what is farther is not around the point.
constexpr int kAround = 10;
// 1 - cosine: 20 degrees, from which on borders are sharp ones (RecomputationOptions::edge_angle).
constexpr float kSameFace = 0.06F;
// Of 1 - cosine: half the angle.
constexpr float kNearer = 0.25F;

/// What a point sees of a segment.
struct Face {
  std::int32_t label = -1;
  std::array<float, 3> sum{};  ///< of the normals

  /// 1 - cosine to it; 2 where it has no direction.
  float angleTo(const float* normal) const {
    const float length = std::sqrt(dot(sum.data(), sum.data()));
    return length > 0.F ? 1.F - dot(sum.data(), normal) / length : 2.F;
  }
};

class Follower {
 public:
  Follower(const Neighborhoods& table, const std::vector<float>& normals,
           const std::vector<std::int32_t>& labels)
      : table_(table), normals_(normals), labels_(labels) {}

  /// The segment that a point's normal is of.
  std::int32_t labelOf(std::size_t i) {
    const std::int32_t own = labels_[i];
    const pcl::index_t* row = table_.indices(i);
    const int count = std::min(table_.count(i), kAround + 1);
    const bool at_border = std::any_of(row, row + count, [&](pcl::index_t q) {
      return labels_[static_cast<std::size_t>(q)] != own;
    });
    const float* n = &normals_[4 * i];
    if (own < 0 || !at_border || !std::isfinite(n[0])) return own;
    look(row, count);
    const auto at = std::find_if(faces_.begin(), faces_.end(),
                                 [&](const Face& face) { return face.label == own; });
    // A point by itself is what its segment is like.
    if (at == faces_.end()) return own;
    const float angle = at->angleTo(n);
    if (angle < kSameFace) return own;
    const auto nearest =
        std::min_element(faces_.begin(), faces_.end(), [&](const Face& a, const Face& b) {
          return std::make_pair(a.angleTo(n), a.label) < std::make_pair(b.angleTo(n), b.label);
        });
    return nearest->angleTo(n) < kNearer * angle ? nearest->label : own;
  }

 private:
  void look(const pcl::index_t* row, int count) {
    faces_.clear();
    for (int j = 1; j < count; ++j) {
      const auto q = static_cast<std::size_t>(row[j]);
      const float* n = &normals_[4 * q];
      if (labels_[q] < 0 || !std::isfinite(n[0])) continue;
      auto face = std::find_if(faces_.begin(), faces_.end(),
                               [&](const Face& f) { return f.label == labels_[q]; });
      if (face == faces_.end()) {
        faces_.push_back({labels_[q], {}});
        face = faces_.end() - 1;
      }
      for (std::size_t a = 0; a < 3; ++a) face->sum[a] += n[a];
    }
  }

  const Neighborhoods& table_;
  const std::vector<float>& normals_;
  const std::vector<std::int32_t>& labels_;
  std::vector<Face> faces_;
};

// Sizes and the order of labels anew; segments without points go.
void rankAgain(Segmentation& segmentation) {
  std::vector<std::uint32_t> sizes(segmentation.segments.size(), 0);
  for (const std::int32_t label : segmentation.labels) {
    if (label >= 0) ++sizes[static_cast<std::size_t>(label)];
  }
  std::vector<Segment> segments;
  for (const std::size_t s : segmentation::rankLabels(sizes, segmentation.labels)) {
    segments.push_back(segmentation.segments[s]);
    segments.back().size = sizes[s];
  }
  segmentation.segments = std::move(segments);
}

}  // namespace

void labelTheRest(const Neighborhoods& table, const std::vector<float>& normals,
                  Segmentation& segmentation) {
  const std::vector<std::int32_t> labels = segmentation.labels;
  bool any = false;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    if (labels[i] >= 0 || !std::isfinite(normals[4 * i])) continue;
    for (int j = 1; j < table.count(i) && segmentation.labels[i] < 0; ++j) {
      segmentation.labels[i] = labels[static_cast<std::size_t>(table.indices(i)[j])];
      any = any || segmentation.labels[i] >= 0;
    }
  }
  if (any) rankAgain(segmentation);
}

void followFinalNormals(const Neighborhoods& table, const std::vector<float>& normals, int threads,
                        Segmentation& segmentation) {
  const std::vector<std::int32_t> labels = segmentation.labels;
  parallelFor(
      labels.size(), threads, 30.0, [&] { return Follower(table, normals, labels); },
      [&](std::size_t i, Follower& follower) { segmentation.labels[i] = follower.labelOf(i); });
  if (segmentation.labels != labels) rankAgain(segmentation);
}

}  // namespace segorient::detail
