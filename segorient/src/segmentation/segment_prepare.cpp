// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors

#include <array>
#include <cstring>
#include <limits>
#include <utility>

#include "common/box.h"
#include "common/every_nth.h"
#include "common/median.h"
#include "common/parallel_for.h"
#include "common/unit_vector.h"
#include "segmentation/growth_state.h"

namespace segorient::segmentation {
namespace {

/// On a surface with one random sample per square of side 1 the squared distance to the i-th
/// neighbour is i / pi in the mean, so over the first six it is 3.5 / pi.
constexpr float kSqrSpacingPerMean = 3.14159265F / 3.5F;
/// The same from the mean distance to the first six, which is .977 there.
constexpr float kSidePerMeanDistance = 1.0233F;
/// Points that the noise is estimated from.
constexpr std::size_t kNoiseSamples = 4096;

struct Scaling {
  std::array<float, 3> center{0.F, 0.F, 0.F};
  float scale = 1.F;
};

// A box leaves NaN out; infinite values only where asked for.
Box boxAround(const PointView& points, bool finite_only) {
  Box box;
  for (std::size_t i = 0; i < points.size; ++i) {
    if (!finite_only || isFinite(points[i])) box.add(points[i]);
  }
  return box;
}

// To the unit cube: squares of coordinates then neither overflow nor vanish.
Scaling scalingOf(const PointView& points) {
  Box b = boxAround(points, false);
  if (!isFinite(b.low.data()) || !isFinite(b.high.data())) b = boxAround(points, true);
  Scaling scaling;
  float extent = 0.F;
  for (std::size_t c = 0; c < 3; ++c) {
    if (b.high[c] < b.low[c]) return scaling;
    scaling.center[c] = 0.5F * b.low[c] + 0.5F * b.high[c];
    extent = std::max(extent, 0.5F * b.high[c] - 0.5F * b.low[c]);
  }
  int exponent = 0;
  std::frexp(extent, &exponent);
  // Both factors of a scale beyond 2^127 would not fit: such clouds are points for us anyway.
  if (extent > 0.F) scaling.scale = std::ldexp(1.F, std::clamp(-exponent, -126, 127));
  return scaling;
}

// Mean squared distance to the first ring, duplicates left out.
// \param sqrTo of neighbour j of a row
template <typename SqrTo>
float sqrSpacing(int count, const SqrTo& sqrTo) {
  float sum = 0.F;
  int found = 0;
  for (int j = 1; j < count && found < kRing; ++j) {
    const float d = sqrTo(j);
    if (d > 0.F) {
      sum += d;
      ++found;
    }
  }
  return found > 0 ? sum / static_cast<float>(found) : 0.F;
}

float sqrSpacing(const float* d, int count) {
  static_assert(kRing == 6, "the terms below");
  // Nearly always there are no duplicates, and nothing to look for.
  if (count > kRing && d[1] > 0.F && d[2] > 0.F && d[3] > 0.F && d[4] > 0.F && d[5] > 0.F &&
      d[6] > 0.F) {
    return (d[1] + d[2] + d[3] + d[4] + d[5] + d[6]) / static_cast<float>(kRing);
  }
  return sqrSpacing(count, [d](int j) { return d[j]; });
}

void packNodes(const PointView& points, const NormalView& normals, const Scaling& scaling,
               int threads, GrowthState& state) {
  const Neighborhoods& hood = *state.neighborhoods;
  state.nodes.resize(points.size);
  Node* nodes = state.nodes.data();
  const float square = scaling.scale * scaling.scale;
  // The table's own distances save the look-up of the neighbours, but may have over- or
  // underflowed.
  const bool use_table = hood.hasDistances() && square > 1e-24F && square < 1e24F;
  parallelFor(points.size, threads, 40.0, [&](std::size_t row) {
    const float* p = points[row];
    const float* m = normals[row];
    Node& node = nodes[row];
    node.x = (p[0] - scaling.center[0]) * scaling.scale;
    node.y = (p[1] - scaling.center[1]) * scaling.scale;
    node.z = (p[2] - scaling.center[2]) * scaling.scale;
    const float squares = m[0] * m[0] + m[1] * m[1] + m[2] * m[2];
    if (squares > 1e-30F && squares < 1e30F) {
      const float factor = 1.F / std::sqrt(squares);
      node.nx = m[0] * factor;
      node.ny = m[1] * factor;
      node.nz = m[2] * factor;
    } else {
      float unit[3];  // of what is zero NaN: not usable
      unitVector(m, unit);
      node.nx = unit[0];
      node.ny = unit[1];
      node.nz = unit[2];
    }
    const float curvature = m[normals.curvature];
    node.curvature = std::isnan(curvature) ? std::numeric_limits<float>::max() : curvature;
    if (!use_table) return;
    const float mean = sqrSpacing(hood.sqrDistances(row), hood.count(row)) * square;
    node.spacing = std::sqrt(mean * kSqrSpacingPerMean);
  });
  if (use_table) return;
  parallelFor(points.size, threads, 40.0, [&](std::size_t row) {
    const pcl::index_t* near = hood.indices(row);
    const float mean =
        sqrSpacing(hood.count(row), [&](int j) { return sqrDistance(nodes[row], nodes[near[j]]); });
    nodes[row].spacing = std::sqrt(mean * kSqrSpacingPerMean);
  });
}

// Typical offset of a neighbour from a tangent plane in spacings, as a standard deviation: medians
// of the first ring and over the cloud, which neither edges nor the far side of a thin wall pull
// up.
float typicalOffset(const GrowthState& state) {
  constexpr float kDeviationPerMedian = 1.4826F;
  std::vector<float> offsets;
  for (const std::size_t i : detail::EveryNth(state.nodes.size(), kNoiseSamples)) {
    const Node& p = state.nodes[i];
    const pcl::index_t* row = state.neighborhoods->indices(i);
    const int count = std::min(state.neighborhoods->count(i), kRing + 1);
    if (count < kRing || !(p.spacing > 0.F) || !std::isfinite(p.nx)) continue;
    std::array<float, kRing> ring{};
    for (int j = 1; j < count; ++j) {
      const Node& q = state.nodes[static_cast<std::size_t>(row[j])];
      ring[static_cast<std::size_t>(j - 1)] = residual(p, q);
    }
    std::sort(ring.begin(), ring.begin() + (count - 1));
    offsets.push_back(ring[static_cast<std::size_t>((count - 1) / 2)] / p.spacing);
  }
  return kDeviationPerMedian * median(std::move(offsets));
}

// Whether most points are far from their nearest neighbour in memory: then nothing that growing
// comes to is in a cache already.
bool isScattered(const Neighborhoods& hood) {
  constexpr std::size_t kSamples = 1024;
  constexpr std::size_t kFar = 4096;  // points whose labels alone fill half a first-level cache
  std::size_t seen = 0;
  std::size_t far = 0;
  for (const std::size_t i : detail::EveryNth(hood.size(), kSamples)) {
    if (hood.count(i) < 2) continue;
    const auto nearest = static_cast<std::size_t>(hood.indices(i)[1]);
    ++seen;
    far += (nearest > i ? nearest - i : i - nearest) > kFar ? 1U : 0U;
  }
  return 2 * far > seen;
}

}  // namespace

void prepare(const PointView& points, const NormalView& normals, const SegmentationOptions& options,
             GrowthState& state) {
  const Scaling scaling = scalingOf(points);
  state.scale = scaling.scale;
  packNodes(points, normals, scaling, options.threads, state);

  constexpr float kNoLimit = std::numeric_limits<float>::max();
  state.limits.gap_sqr = options.max_gap > 0.F ? options.max_gap * options.max_gap : kNoLimit;
  state.limits.offset = kNoLimit;
  state.typical_offset = typicalOffset(state);
  state.scattered = isScattered(*state.neighborhoods);
  if (options.max_offset > 0.F) {
    // Two deviations of a noisy neighbour, and never so much that a wall of one spacing would leak.
    state.limits.offset = std::clamp(2.F * state.typical_offset, options.max_offset,
                                     std::max(0.9F, options.max_offset));
  }
}

void prepare(const PointView& points, const SheetField& field, int threads, GrowthState& state) {
  // Seeds are told apart to a percent or so: near points one after the other.
  constexpr std::uint32_t kLeading = 0xffff0000U;
  state.nodes.resize(points.size);
  parallelFor(points.size, threads, 20.0, [&](std::size_t row) {
    const float* p = points[row];
    const float* m = field.normals + 4 * row;
    std::uint32_t bits = 0;
    std::memcpy(&bits, m + 3, sizeof bits);
    bits &= kLeading;
    Node& node = state.nodes[row];
    node = {p[0], p[1], p[2], kSidePerMeanDistance * field.spacing[row], m[0], m[1], m[2], 0.F};
    std::memcpy(&node.curvature, &bits, sizeof bits);
  });
  state.limits.gap_sqr = std::numeric_limits<float>::max();
  state.limits.offset = state.sheets->offset();
  state.typical_offset = typicalOffset(state);
  state.scattered = isScattered(*state.neighborhoods);
}

void setCurvature(const float* curvature, GrowthState& state) {
  for (std::size_t i = 0; i < state.nodes.size(); ++i) {
    state.nodes[i].curvature =
        std::isnan(curvature[i]) ? std::numeric_limits<float>::max() : curvature[i];
  }
}

}  // namespace segorient::segmentation
