// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <pcl/types.h>

#include <array>
#include <cstddef>
#include <cstdint>

namespace segorient::segmentation {

/// Flat points of a segment that its plane near a point is taken from.
constexpr std::size_t kWitnesses = 8;
/// Segments that are compared at one point; three meet at a corner.
constexpr std::size_t kCandidates = 6;

struct Vector {
  float x = 0.F, y = 0.F, z = 0.F;
  float dot(const Vector& o) const { return x * o.x + y * o.y + z * o.z; }
  Vector operator-(const Vector& o) const { return {x - o.x, y - o.y, z - o.z}; }
};

/// A regular segment near a point, with its flattest points near there and, in the end, their
/// mean plane.
struct Candidate {
  std::int32_t label;
  std::size_t count;
  std::array<pcl::index_t, kWitnesses> points;
  std::array<float, kWitnesses> curvature;  ///< ascending
  Vector center;                            ///< of the points' mean plane
  Vector normal;

  void start(std::int32_t of) {
    label = of;
    count = 0;
  }
  /// Takes a point if it is flatter than the flattest so far, each once.
  void offer(pcl::index_t point, float value) {
    if (count == kWitnesses && !(value < curvature[kWitnesses - 1])) return;
    for (std::size_t i = 0; i < count; ++i) {
      if (points[i] == point) return;
    }
    std::size_t at = count < kWitnesses ? count++ : count - 1;
    for (; at > 0 && value < curvature[at - 1]; --at) {
      curvature[at] = curvature[at - 1];
      points[at] = points[at - 1];
    }
    curvature[at] = value;
    points[at] = point;
  }
};
using Candidates = std::array<Candidate, kCandidates>;

}  // namespace segorient::segmentation
