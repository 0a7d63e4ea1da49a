// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/automatic/hand_down.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

#include "common/dot.h"
#include "common/parallel_for.h"

namespace segorient::detail {
namespace {

// Oriented points of the subset that a point hears: a ring and a little more.
constexpr int kHeard = 8;

// What the points of a level around a point say about its normal.
class Heard {
 public:
  // \return whether this is the weightiest voice so far
  bool add(const float* n, const float* m, float weight, float confidence) {
    const float vote = weight * dot(n, m);
    balance_ += vote;
    total_ += std::fabs(vote);
    sure_ += std::fabs(vote) * confidence;
    for (std::size_t a = 0; a < 3; ++a) sum_[a] += weight * m[a];
    weights_ += weight;
    if (std::fabs(vote) <= most_) return false;
    most_ = std::fabs(vote);
    return true;
  }

  bool against() const { return balance_ < 0.F; }
  float confidence() const {
    return total_ > 0.F ? std::fabs(balance_) / total_ * (sure_ / total_) : 0.F;
  }
  // The mean of the normals as a unit vector, and its length: the cosine of their spread.
  void mean(float* out) const {
    const float length = std::sqrt(dot(sum_.data(), sum_.data()));
    if (!(length > 0.F)) return;
    for (std::size_t a = 0; a < 3; ++a) out[a] = sum_[a] / length;
    out[3] = length / weights_;
  }

 private:
  float balance_ = 0.F;
  float total_ = 0.F;
  float sure_ = 0.F;
  float most_ = 0.F;
  std::array<float, 3> sum_{0.F, 0.F, 0.F};
  float weights_ = 0.F;
};

void listen(const PointView& points, CoarseLevel& level, float radius, int threads, Handed& out) {
  const search::MedianHashIndex& index = level.cloud.index();
  const float unit = level.cloud.unit();
  const float softening = (radius / unit) * (radius / unit);
  parallelFor(points.size, threads, 3000.0, [&](std::size_t i) {
    float* n = &out.found.normals[4 * i];
    if (!isFinite(n)) {
      out.found.confidences[i] = 0.F;
      return;
    }
    const float x[3] = {points[i][0] / unit, points[i][1] / unit, points[i][2] / unit};
    std::array<pcl::index_t, kHeard> near{};
    std::array<float, kHeard> squares{};
    const int count = index.nearestK(x, kHeard, near.data(), squares.data());
    Heard heard;
    for (std::size_t j = 0; j < static_cast<std::size_t>(count); ++j) {
      const auto q = static_cast<std::size_t>(near[j]);
      const float* m = &level.found.normals[4 * q];
      if (!isFinite(m)) continue;
      const float weight = 1.F / (squares[j] + softening);
      if (heard.add(n, m, weight, level.found.confidences[q])) {
        out.found.components[i] = level.found.components[q];
      }
    }
    heard.mean(&out.around[4 * i]);
    out.found.confidences[i] = heard.confidence();
    if (!heard.against()) return;
    for (std::size_t a = 0; a < 3; ++a) n[a] = -n[a];
  });
}

// What the level knows of its own points, in the cloud's unit and by all its points.
AutoOrientation inTermsOfTheCloud(CoarseLevel& level, const std::vector<std::int32_t>& components,
                                  const AutoOrientation& fine) {
  AutoOrientation out = std::move(level.found.orientation);
  out.sensors = fine.sensors;
  static_cast<SeenPoints&>(out) = fine;
  out.place_idle = fine.place_idle;
  for (Contradiction& c : out.contradictions) {
    for (float& v : c.where) v *= level.cloud.unit();
  }
  for (ComponentOrientationResult& c : out.result.components) c.points = 0;
  for (const std::int32_t c : components) {
    if (c >= 0) ++out.result.components[static_cast<std::size_t>(c)].points;
  }
  return out;
}

}  // namespace

Handed handDown(const PointView& points, CoarseLevel& level, float radius, int threads,
                const AutoNormals& fine) {
  Handed out;
  out.found.spacing = fine.spacing;
  out.found.normals = fine.normals;
  out.found.confidences = fine.confidences;
  out.found.components.assign(points.size, -1);
  out.around.assign(4 * points.size, 0.F);
  listen(points, level, radius, threads, out);
  out.found.orientation = inTermsOfTheCloud(level, out.found.components, fine.orientation);
  return out;
}

}  // namespace segorient::detail
