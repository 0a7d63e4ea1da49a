// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/paper/segment_relations.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "common/dot.h"
#include "common/parallel_for.h"
#include "orientation/paper/boundary_ballot.h"

namespace segorient {
namespace {

using Eigen::Vector3f;

Vector3f vectorAt(const PointView& view, pcl::index_t row) {
  const float* v = view[static_cast<std::size_t>(row)];
  return {v[0], v[1], v[2]};
}

// The normal of a point as its segment has it.
Vector3f segmentNormal(const PointView& normals, const Segmentation& segmentation,
                       pcl::index_t row) {
  return vectorAt(normals, row) *
         static_cast<float>(segmentation.signs[static_cast<std::size_t>(row)]);
}

float referenceCosine(const Segmentation& segmentation, const SegmentBorder& link) {
  const auto& a = segmentation.segments[static_cast<std::size_t>(link.a)].reference_normal;
  const auto& b = segmentation.segments[static_cast<std::size_t>(link.b)].reference_normal;
  return dot(a.data(), b.data());
}

// Of two walls that face each other across a gap, or around the edge of a thin plate, normals say
// nothing about each other: pairs whose connection leaves either tangent plane by more than this
// (sine) count as undecided.
constexpr float kMostOffPlane = 0.5F;

float borderCosine(const PointView& points, const PointView& normals,
                   const Segmentation& segmentation, const SegmentGraph& links,
                   const SegmentBorder& link) {
  float sum = 0.F;
  for (std::uint32_t i = link.first; i < link.first + link.size; ++i) {
    const BorderPair& pair = links.pairs[i];
    const Vector3f chord = vectorAt(points, pair.in_b) - vectorAt(points, pair.in_a);
    const Vector3f in_a = segmentNormal(normals, segmentation, pair.in_a);
    const Vector3f in_b = segmentNormal(normals, segmentation, pair.in_b);
    const float off_plane = std::max(std::abs(chord.dot(in_a)), std::abs(chord.dot(in_b)));
    if (off_plane <= kMostOffPlane * chord.norm()) sum += in_a.dot(in_b);
  }
  return sum / (static_cast<float>(link.size) + kUndecidedPairs);
}

// A border point of a segment, and how its neighbours lie about it.
struct BorderPoint {
  pcl::index_t row = 0;
  Vector3f position = Vector3f::Zero();
  Vector3f normal = Vector3f::Zero();  // as its segment has it
  Vector3f own = Vector3f::Zero();     // mean offset of the neighbours on its own side, and itself
  Vector3f other = Vector3f::Zero();   // sum of offsets of those on the other side
  float other_count = 0.F;
  float reach = 0.F;  // distance of the farthest neighbour

  // Direction of the walk along the border, the other side being where q and `other` are: at most 1
  // long, shorter in the midst of the segment and where the way across the border leaves the
  // tangent plane.
  Vector3f walkTowards(const Vector3f& q) const {
    const Vector3f across = (other + (q - position)) / (other_count + 1.F) - own;
    const float length = across.norm();
    if (!(length > 0.F) || !(reach > 0.F)) return Vector3f::Zero();
    // Away from the own side, and over to the other: the first is right for blades, too, whose
    // other side folds back over this one; the second is steadier. The centre of a half disc, which
    // is what lies on the own side at a border, is 4 / (3 pi) radii from its middle.
    constexpr float kHalfDisc = 0.4244132F;
    const Vector3f out = across / length - own / (kHalfDisc * reach);
    return normal.cross(0.5F * out);
  }
};

class LocalBoundary {
 public:
  LocalBoundary(const PointView& points, const PointView& normals,
                const Neighborhoods& neighborhoods, const Segmentation& segmentation)
      : points_(points),
        normals_(normals),
        neighborhoods_(neighborhoods),
        segmentation_(segmentation) {}

  BoundaryVote vote(const SegmentGraph& links, const SegmentBorder& link) const {
    const BorderPair* begin = links.pairs.data() + link.first;
    const BorderPair* end = begin + link.size;
    const std::vector<BorderPoint> side_a = borderPoints(begin, end, &BorderPair::in_a, link.b);
    const std::vector<BorderPoint> side_b = borderPoints(begin, end, &BorderPair::in_b, link.a);
    BoundaryBallot ballot;
    for (const BorderPair* pair = begin; pair != end; ++pair) {
      const BorderPoint& a = find(side_a, pair->in_a);
      const BorderPoint& b = find(side_b, pair->in_b);
      ballot.add(-a.walkTowards(b.position).dot(b.walkTowards(a.position)));
    }
    return ballot.count(std::min(side_a.size(), side_b.size()));
  }

 private:
  // The distinct points of one side, ascending by row.
  std::vector<BorderPoint> borderPoints(const BorderPair* begin, const BorderPair* end,
                                        pcl::index_t BorderPair::*side,
                                        std::int32_t other_label) const {
    std::vector<pcl::index_t> rows;
    for (const BorderPair* pair = begin; pair != end; ++pair) {
      if (rows.empty() || rows.back() != pair->*side) rows.push_back(pair->*side);
    }
    keepDistinct(rows);
    std::vector<BorderPoint> out;
    out.reserve(rows.size());
    for (const pcl::index_t row : rows) out.push_back(describe(row, other_label));
    return out;
  }

  BorderPoint describe(pcl::index_t p, std::int32_t other_label) const {
    const auto row = static_cast<std::size_t>(p);
    BorderPoint out;
    out.row = p;
    out.position = vectorAt(points_, p);
    out.normal = segmentNormal(normals_, segmentation_, p);
    const std::int32_t own_label = segmentation_.labels[row];
    const pcl::index_t* neighbors = neighborhoods_.indices(row);
    const int count = neighborhoods_.count(row);
    float own_count = 1.F;
    float squared_reach = 0.F;
    for (int j = 1; j < count; ++j) {
      const Vector3f offset = vectorAt(points_, neighbors[j]) - out.position;
      const std::int32_t label = segmentation_.labels[static_cast<std::size_t>(neighbors[j])];
      squared_reach = std::max(squared_reach, offset.squaredNorm());
      if (label == own_label) {
        out.own += offset;
        own_count += 1.F;
      } else if (label == other_label) {
        out.other += offset;
        out.other_count += 1.F;
      }
    }
    out.own /= own_count;
    out.reach = std::sqrt(squared_reach);
    return out;
  }

  static const BorderPoint& find(const std::vector<BorderPoint>& side, pcl::index_t row) {
    return *std::lower_bound(side.begin(), side.end(), row,
                             [](const BorderPoint& p, pcl::index_t r) { return p.row < r; });
  }

  const PointView& points_;
  const PointView& normals_;
  const Neighborhoods& neighborhoods_;
  const Segmentation& segmentation_;
};

}  // namespace

std::vector<float> segmentCosines(const PointView& points, const PointView& normals,
                                  const Segmentation& segmentation, const SegmentGraph& links,
                                  SegmentAngle angle, int threads) {
  std::vector<float> out(links.borders.size());
  parallelFor(out.size(), threads, 3000.0, [&](std::size_t i) {
    const SegmentBorder& link = links.borders[i];
    const float cosine = angle == SegmentAngle::REFERENCE_NORMALS
                             ? referenceCosine(segmentation, link)
                             : borderCosine(points, normals, segmentation, links, link);
    out[i] = std::clamp(cosine, -1.F, 1.F);
  });
  return out;
}

std::vector<BoundaryVote> localBoundaryVotes(const PointView& points, const PointView& normals,
                                             const Neighborhoods& neighborhoods,
                                             const Segmentation& segmentation,
                                             const SegmentGraph& links, int threads) {
  const LocalBoundary boundary(points, normals, neighborhoods, segmentation);
  std::vector<BoundaryVote> out(links.borders.size());
  parallelFor(out.size(), threads, 3000.0,
              [&](std::size_t l) { out[l] = boundary.vote(links, links.borders[l]); });
  return out;
}

}  // namespace segorient
