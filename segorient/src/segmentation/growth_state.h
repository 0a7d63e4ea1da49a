// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/neighborhoods.h>
#include <segorient/common/point_view.h>
#include <segorient/common/impl/fast_vector.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "common/at.h"
#include "common/compiler.h"
#include "segmentation/region_growing.h"
#include "segmentation/sheet_edges.h"

namespace segorient::segmentation {

/// Neighbours of the first ring, as on a hexagonal grid.
constexpr int kRing = 6;
constexpr float kRightAngle = 1.5707963F;

/// What one comparison of two neighbours needs, in half a cache line. Coordinates are scaled to the
/// unit cube by a power of two; the normal takes on its segment's sign when the point is accepted.
struct alignas(32) Node {
  float x, y, z;
  float spacing;  ///< 0 where unknown
  float nx, ny, nz;
  float curvature;

  void turn() {
    nx = -nx;
    ny = -ny;
    nz = -nz;
  }
};

/// Sum of signed normals; in double, so that millions of points do not wear it out.
struct NormalSum {
  double x = 0, y = 0, z = 0;

  void add(const Node& p, double sign = 1.0) {
    x += sign * static_cast<double>(p.nx);
    y += sign * static_cast<double>(p.ny);
    z += sign * static_cast<double>(p.nz);
  }
  void add(const NormalSum& o, double sign) {
    x += sign * o.x;
    y += sign * o.y;
    z += sign * o.z;
  }
  double dot(const NormalSum& o) const { return x * o.x + y * o.y + z * o.z; }
  double dot(const Node& p) const {
    return x * static_cast<double>(p.nx) + y * static_cast<double>(p.ny) +
           z * static_cast<double>(p.nz);
  }
  double squaredNorm() const { return dot(*this); }
};

/// A segment in the making.
struct Cluster {
  NormalSum normal;
  std::uint32_t size = 0;
};

inline float dotNormals(const Node& p, const Node& q) {
  return p.nx * q.nx + p.ny * q.ny + p.nz * q.nz;
}

inline float sqrDistance(const Node& p, const Node& q) {
  const float dx = q.x - p.x;
  const float dy = q.y - p.y;
  const float dz = q.z - p.z;
  return dx * dx + dy * dy + dz * dz;
}

/// How far q is off the tangent plane of p.
inline float residual(const Node& p, const Node& q) {
  return std::abs((q.x - p.x) * p.nx + (q.y - p.y) * p.ny + (q.z - p.z) * p.nz);
}

/// The two geometric conditions on neighbours.
struct PairLimits {
  float gap_sqr = 0.F;  ///< squared, in units of the product of both spacings
  float offset = 0.F;   ///< in units of the mean spacing

  bool near(const Node& p, const Node& q) const {
    return sqrDistance(p, q) <= gap_sqr * p.spacing * q.spacing;
  }
  /// Whether two points look at each other across a thin wall: each lies along the other's normal.
  static bool facing(const Node& p, const Node& q) {
    constexpr float kSqrCosine = 0.5F;  // within 45 degrees
    const float dx = q.x - p.x;
    const float dy = q.y - p.y;
    const float dz = q.z - p.z;
    const float along_p = dx * p.nx + dy * p.ny + dz * p.nz;
    const float along_q = dx * q.nx + dy * q.ny + dz * q.nz;
    const float limit = kSqrCosine * (dx * dx + dy * dy + dz * dz);
    return along_p * along_p > limit && along_q * along_q > limit;
  }
  /// Whether q lies in the surface around p: p's tangent plane alone, as the normal of a candidate
  /// near an edge leans over.
  bool admissible(const Node& p, const Node& q) const {
    return near(p, q) && residual(p, q) <= offset * 0.5F * (p.spacing + q.spacing);
  }
};

/// Which of some points, 32 at most, have a label: bit j for the j-th. Which of them have is
/// nothing that a processor could guess: no branches.
inline std::uint32_t labelledAmong(const std::int32_t* labels, const pcl::index_t* points,
                                   int count, std::int32_t label) {
  std::uint32_t found = 0;
  const auto has = [&](int j) { return static_cast<std::uint32_t>(labels[points[j]] == label); };
  int j = 0;
  for (; j + 4 <= count; j += 4) {
    found |= (has(j) | has(j + 1) << 1 | has(j + 2) << 2 | has(j + 3) << 3) << j;
  }
  for (; j < count; ++j) found |= has(j) << j;
  return found;
}

/// The state that growing and the clean-up passes work on.
struct GrowthState {
  const Neighborhoods* neighborhoods = nullptr;
  int neighbors = 0;  ///< entries of each row to use, the first one (the point itself) included
  float scale = 1.F;  ///< coordinates of the nodes for one unit of the cloud
  PairLimits limits;
  const SheetEdges* sheets = nullptr;  ///< where not null, these decide in place of the limits
  int support = 0;  ///< neighbours in a segment that a point needs to join it, see supports()
  /// By point, where `sheets` decide: see SheetEdges::list(). Empty = not listed.
  std::vector<std::uint32_t> joined;
  bool scattered = false;      ///< neighbours are far from each other in memory
  float typical_offset = 0.F;  ///< of a neighbour from a tangent plane, in spacings: the noise
  FastVector<Node> nodes;
  std::vector<std::int32_t> labels;  ///< -1 = none
  std::vector<std::int8_t> signs;
  /// Ascending: all labelled points that had a neighbour in another segment, or in none, when
  /// growing ended, and some that had none any more. The clean-up moves points across these borders
  /// only, and leaves the list as it is.
  std::vector<pcl::index_t> border;
  std::vector<Cluster> clusters;
  std::vector<std::uint8_t> strips;  ///< by cluster: 1 = has no inside, see findStrips()
  std::vector<SegmentKind> kinds;    ///< by cluster, after the clean-up

  /// Whether a cluster is one that points can be moved to and others be measured by.
  bool isFace(std::int32_t label, std::size_t small_size) const {
    return clusters[at(label)].size >= small_size && strips[at(label)] == 0;
  }
  /// Whether q, a neighbour of p, lies in the surface around p.
  bool joins(std::size_t p, std::size_t q) const {
    return sheets != nullptr ? sheets->join(p, q) : limits.admissible(nodes[p], nodes[q]);
  }
  /// Whether a segment has enough of p's neighbours, not more of them outside of p's surface than
  /// in it.
  bool supports(std::size_t p, std::int32_t label) const {
    if (support == 0) return true;
    int good = 0;
    int bad = 0;
    const pcl::index_t* row = neighborhoods->indices(p);
    if (!joined.empty()) {
      const std::uint32_t members = membersAmong(p, label);
      good = countBits(members & joined[p]);
      bad = countBits(members & ~joined[p]);
      return good >= support && bad <= good;
    }
    for (int j = 1; j < rowSize(p); ++j) {
      const auto q = static_cast<std::size_t>(row[j]);
      if (labels[q] == label) (joins(p, q) ? good : bad) += 1;
    }
    return good >= support && bad <= good;
  }
  /// Which of p's neighbours, 32 at most, a segment has: bit j for the j-th, itself not counted.
  std::uint32_t membersAmong(std::size_t p, std::int32_t label) const {
    return labelledAmong(labels.data(), neighborhoods->indices(p) + 1, rowSize(p) - 1, label);
  }
  /// Gives a point the other sign.
  void turn(std::size_t p) {
    nodes[p].turn();
    signs[p] = static_cast<std::int8_t>(-signs[p]);
  }
  /// Takes a point out of its segment into another one, whose sign it gets.
  void move(std::size_t p, std::int32_t into) {
    Cluster& source = clusters[at(labels[p])];
    Cluster& target = clusters[at(into)];
    source.normal.add(nodes[p], -1.0);
    --source.size;
    if (target.normal.dot(nodes[p]) < 0.0) turn(p);
    target.normal.add(nodes[p]);
    ++target.size;
    labels[p] = into;
  }
  /// Asks the memory for a row of the table that is looked at soon.
  void fetchRow(std::size_t row) const { prefetch(neighborhoods->indices(row)); }
  int rowSize(std::size_t row) const { return std::min(neighborhoods->count(row), neighbors); }
};

/// Normals without signs are at right angles at most.
inline float cosineOf(float angle) {
  return std::cos(std::min(angle, kRightAngle));
}

/// The largest residual that growing passes, in the unit of the nodes.
inline float scaledResidual(const SegmentationOptions& options, const GrowthState& state) {
  const bool limited = options.max_residual < std::numeric_limits<float>::max();
  return limited ? options.max_residual * state.scale : options.max_residual;
}

/// Scales and packs the points, finds the local spacing and the limits.
void prepare(const PointView& points, const NormalView& normals, const SegmentationOptions& options,
             GrowthState& state);

/// The same for sheets, whose normals and spacings are what they are.
void prepare(const PointView& points, const SheetField& field, int threads, GrowthState& state);

/// Growing over sheets went by residuals; the clean-up goes by curvatures.
void setCurvature(const float* curvature, GrowthState& state);

/// Region growing.
void grow(const SegmentationOptions& options, GrowthState& state);

/// Region growing over the edges of `state.sheets`: from and over reliable points first, then over
/// what is left around these, then from what is left at all.
void growSheets(const SegmentationOptions& options, GrowthState& state);

/// Moves points along sharp borders to the segment whose surface passes nearest to them.
/// \return how many moved
std::size_t settleEdges(const SegmentationOptions& options, GrowthState& state);

/// Unites regular segments whose common border is smooth. Signs follow.
/// \return how many segments became part of another one
std::size_t uniteSmooth(const SegmentationOptions& options, GrowthState& state);

/// Segments by descending size, with their reference normals; members are not listed yet, see
/// collectMembers().
/// \param labels those of the state, or a copy of them if it goes on being used; signs likewise
Segmentation rank(const GrowthState& state, std::vector<std::int32_t> labels,
                  std::vector<std::int8_t> signs);

/// The same with centroids, areas and deviations from planes.
Segmentation finish(const PointView& points, const GrowthState& state,
                    std::vector<std::int32_t> labels, std::vector<std::int8_t> signs);

}  // namespace segorient::segmentation
