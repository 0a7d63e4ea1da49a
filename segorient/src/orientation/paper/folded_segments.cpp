// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/paper/folded_segments.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <tuple>
#include <vector>

#include "common/dot.h"
#include "common/parallel_for.h"

namespace segorient {
namespace {

using Eigen::Vector3f;

constexpr float kSquare = 4.F;       // edge of a square, in spacings
constexpr float kGap = 4.F;          // between two sheets, in spacings
constexpr float kMostDouble = 0.1F;  // of a segment's points

// A point over the plane.
struct Elevated {
  std::int32_t column;
  std::int32_t row;
  float height;
};

bool operator<(const Elevated& l, const Elevated& r) {
  return std::tie(l.column, l.row, l.height) < std::tie(r.column, r.row, r.height);
}

Vector3f pointAt(const PointView& points, std::size_t row) {
  const float* p = points[row];
  return {p[0], p[1], p[2]};
}

// Mean distance to the six nearest, averaged over some of the segment's points.
float spacingOf(const PointView& points, const Neighborhoods& neighborhoods,
                const Segmentation& segmentation, std::size_t segment) {
  constexpr std::uint32_t kSample = 16;
  const std::uint32_t size = segmentation.segments[segment].size;
  const std::uint32_t samples = std::min(size, kSample);
  double sum = 0.0;
  std::size_t count = 0;
  for (std::uint32_t i = 0; i < samples; ++i) {
    const std::size_t step = static_cast<std::size_t>(i) * size / samples;
    const auto row = static_cast<std::size_t>(segmentation.begin(segment)[step]);
    const int end = std::min(7, neighborhoods.count(row));
    for (int j = 1; j < end; ++j) {
      const auto neighbor = static_cast<std::size_t>(neighborhoods.indices(row)[j]);
      sum += static_cast<double>((pointAt(points, neighbor) - pointAt(points, row)).norm());
      ++count;
    }
  }
  return count > 0 ? static_cast<float>(sum / static_cast<double>(count)) : 0.F;
}

// The segment's points over the plane across its reference normal, unsorted.
std::vector<Elevated> elevate(const PointView& points, const Segmentation& segmentation,
                              std::size_t segment, float square) {
  const auto& reference = segmentation.segments[segment].reference_normal;
  const Vector3f up(reference[0], reference[1], reference[2]);
  const Vector3f u = up.unitOrthogonal();
  const Vector3f v = up.cross(u);
  const Vector3f origin = pointAt(points, static_cast<std::size_t>(*segmentation.begin(segment)));
  std::vector<Elevated> out;
  out.reserve(segmentation.segments[segment].size);
  for (const pcl::index_t* p = segmentation.begin(segment); p != segmentation.end(segment); ++p) {
    const Vector3f offset = pointAt(points, static_cast<std::size_t>(*p)) - origin;
    const float column = std::floor(offset.dot(u) / square);
    const float row = std::floor(offset.dot(v) / square);
    constexpr float kMost = 1e9F;  // fits into the integers; clouds that wide fold together there
    out.push_back({static_cast<std::int32_t>(std::clamp(column, -kMost, kMost)),
                   static_cast<std::int32_t>(std::clamp(row, -kMost, kMost)), offset.dot(up)});
  }
  return out;
}

// Whether the heights of the segment's points differ by more than a gap at all.
bool rangesOver(const PointView& points, const Segmentation& segmentation, std::size_t segment,
                float gap) {
  const auto& n = segmentation.segments[segment].reference_normal;
  float low = std::numeric_limits<float>::max();
  float high = std::numeric_limits<float>::lowest();
  for (const pcl::index_t* p = segmentation.begin(segment); p != segmentation.end(segment); ++p) {
    const float* x = points[static_cast<std::size_t>(*p)];
    const float height = dot(x, n.data());
    low = std::min(low, height);
    high = std::max(high, height);
  }
  return high - low > gap;
}

// Whether two sheets lie over one square: [begin, end) ascends by height.
bool isDouble(const Elevated* begin, const Elevated* end, float gap) {
  for (const Elevated* p = begin + 2; p + 1 < end; ++p) {
    if (p->height - (p - 1)->height > gap) return true;
  }
  return false;
}

bool isFolded(const PointView& points, const Neighborhoods& neighborhoods,
              const Segmentation& segmentation, std::size_t s) {
  const Segment& segment = segmentation.segments[s];
  if (segment.kind != SegmentKind::REGULAR || segment.size < 4) return false;
  const float spacing = spacingOf(points, neighborhoods, segmentation, s);
  if (!(spacing > 0.F) || !std::isfinite(spacing)) return false;
  if (!rangesOver(points, segmentation, s, kGap * spacing)) return false;  // flat, as most are
  std::vector<Elevated> elevated = elevate(points, segmentation, s, kSquare * spacing);
  std::sort(elevated.begin(), elevated.end());
  std::size_t doubled = 0;
  for (std::size_t i = 0; i < elevated.size();) {
    std::size_t j = i + 1;
    while (j < elevated.size() && elevated[j].column == elevated[i].column &&
           elevated[j].row == elevated[i].row) {
      ++j;
    }
    if (isDouble(elevated.data() + i, elevated.data() + j, kGap * spacing)) doubled += j - i;
    i = j;
  }
  return static_cast<float>(doubled) > kMostDouble * static_cast<float>(segment.size);
}

}  // namespace

std::vector<std::int32_t> findFoldedSegments(const PointView& points,
                                             const Neighborhoods& neighborhoods,
                                             const Segmentation& segmentation, int threads) {
  std::vector<std::uint8_t> folded(segmentation.segments.size());
  const double time = timeOfEach(folded.size(), segmentation.members.size(), 300.0);
  parallelFor(folded.size(), threads, time, [&](std::size_t s) {
    folded[s] = isFolded(points, neighborhoods, segmentation, s) ? 1 : 0;
  });
  std::vector<std::int32_t> out;
  for (std::size_t s = 0; s < folded.size(); ++s) {
    if (folded[s] != 0) out.push_back(static_cast<std::int32_t>(s));
  }
  return out;
}

}  // namespace segorient
