// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
//
// The inner loops of MedianHashIndex on raw arrays, once per instruction set. All of them compute
// the same bits: one rounding an operation, no fused operations, no order of summation that depends
// on the width of a vector.
#pragma once

#include <pcl/types.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <vector>

#include "search/box_tree.h"
#include "search/layout.h"

namespace segorient::search {

/// Raw pointers into a Layout.
struct LayoutView {
  const float* x;
  const float* y;
  const float* z;
  const std::uint32_t* id;
  const std::uint32_t* row;
  const Region* regions;
  std::size_t region_count;
  const Box* boxes;
  const Split* splits;
  const std::uint16_t* starts;
  const std::uint8_t* flat;  ///< by node, or null
  const std::uint32_t* flat_id;

  explicit LayoutView(const Layout& layout)
      : x(layout.x.data()),
        y(layout.y.data()),
        z(layout.z.data()),
        id(layout.id.data()),
        row(layout.row.empty() ? layout.id.data() : layout.row.data()),
        regions(layout.regions.data()),
        region_count(layout.regions.size()),
        boxes(layout.boxes.data()),
        splits(layout.splits.data()),
        starts(layout.starts.data()),
        flat(layout.flat.empty() ? nullptr : layout.flat.data()),
        flat_id(layout.flat_id.data()) {}
};

/// The points of a node are those from its first region's on.
inline std::size_t firstPoint(const LayoutView& view, std::size_t node) {
  while (node < view.region_count) node = 2 * node;
  return view.regions[node - view.region_count].begin;
}
inline std::size_t nodeSize(const LayoutView& view, std::size_t node) {
  const std::size_t begin = firstPoint(view, node);
  while (node < view.region_count) node = 2 * node + 1;
  return view.regions[node - view.region_count].end - begin;
}

/// A sphere to collect from.
struct Sphere {
  float center[3];
  float limit;               ///< points of a squared distance below this are collected
  float prune;               ///< <= limit; parts of space not nearer than this may be left out
  std::uint32_t most_equal;  ///< of a flat node that is equally far everywhere, how many suffice
};

/// The way down the tree to the region that a point is in.
struct Path {
  std::size_t region;
  std::size_t length;
  std::uint32_t other_side[32];  ///< the nodes passed by ...
  float squared_distance[32];    ///< ... and bounds of how near they are

  Path(const LayoutView& view, const float* point) : region(0), length(0) {
    std::size_t node = 1;
    while (node < view.region_count) {
      // What lies beyond a split is at least as far as the split itself.
      const Split& split = view.splits[node];
      const float d = point[split.axis] - split.value;
      const std::size_t right = d > 0.0F ? 1 : 0;
      other_side[length] = static_cast<std::uint32_t>(2 * node + 1 - right);
      squared_distance[length++] = d * d;
      node = 2 * node + right;
    }
    region = node - view.region_count;
  }
};

/// Points found so far; `distance` and `id` have room for kPadding entries beyond `capacity`.
struct Candidates {
  float* distance;
  std::uint32_t* id;
  std::size_t count;
  std::size_t capacity;
};

/// Work space of sortNearest(), each of kMostToSort + Layout::kPadding entries.
struct SortScratch {
  float* part_distance;
  std::uint32_t* part_id;
  float* distance;    ///< where the result is left
  std::uint32_t* id;  ///< where the result is left
};

/// Most candidates that sortNearest() takes.
constexpr std::size_t kMostToSort = 1024;

/// Rows of a region's radius search, one after another as they are found.
struct RowBuffer {
  pcl::index_t* indices;
  float* distances;  ///< null if they are not wanted
  bool with_distances;
  std::size_t used;
  std::size_t capacity;  ///< of both arrays
  std::size_t* begin;    ///< of each point of the region, where its row is
  std::uint32_t* count;  ///< of each point of the region, how long its row is
  void (*grow)(RowBuffer&, std::size_t capacity);  ///< makes room for at least as many
  void* owner;                                     ///< for grow
};

/// Entries of a cache line. Arrays begin with one, so that no vector lies across two.
constexpr std::size_t kLine = 16;

/// The first element of an array of 4 byte entries that begins a cache line; there are up to
/// kLine - 1 before it.
template <typename T>
T* firstOfLine(std::vector<T>& array) {
  const auto at = reinterpret_cast<std::uintptr_t>(array.data()) / sizeof(T);
  return array.data() + (kLine - at % kLine) % kLine;
}

/// The least multiple of kLine that is not below a length.
inline std::size_t wholeLines(std::size_t length) {
  return (length + kLine - 1) / kLine * kLine;
}

/// Points that searches near each other pick theirs from; each array has room for
/// Layout::kPadding entries beyond `capacity`.
struct Block {
  float* xyz[3];
  std::uint32_t* id;
  std::size_t count;
  std::size_t capacity;
};

/// In the search for k nearest, how many standard deviations of the k-th squared distance, which is
/// about 1/sqrt(k) of it, are allowed for from one query to the next.
constexpr float kMargin = 1.2F;

/// Most neighbours for which it pays that queries next to each other share their candidates.
constexpr std::size_t kMostNeighborsShared = 256;

/// Where the k nearest of a point are sought, from what was found for points next to it.
struct Guess {
  float margin;   ///< above 1: how much more than the typical squared distance is tried first
  float typical;  ///< squared distance to the k-th neighbour
  float limit;    ///< output: the candidates are nearer than this
};

/// Most neighbours that are kept in order while boxes are searched.
constexpr std::size_t kMostNeighborsInBoxes = 256;

/// Everything that an all-points search of a region reads and writes besides the layout.
struct GroupTask {
  std::uint32_t k;  ///< how many neighbours: at most the number of points, or of a radius search
  // nearest k
  float epsilon;
  float margin;              ///< of Guess
  pcl::index_t* indices;     ///< output, k entries a row
  float* distances;          ///< output, or null
  std::size_t row_length;    ///< entries from one row of the output to the next
  const std::uint32_t* row;  ///< of the output for each point, ...
  std::size_t first;         ///< ... from this one of the layout on
  // radius
  float limit;          ///< squared radius
  unsigned int max_nn;  ///< as k, but 0 = all
  RowBuffer rows;
  // work space of one thread; each array with Layout::kPadding entries more
  Block block;                ///< points that a group may have as neighbours
  float* candidate_distance;  ///< of all points of a group, in two halves
  std::uint32_t* candidate_id;
  std::size_t candidate_capacity;
  SortScratch sort;
  std::uint32_t* neighbors;  ///< room for the number of regions
  std::uint32_t* failed;     ///< output: points without a result, to be searched for one by one
  std::size_t failed_count;

  std::size_t rowOf(std::size_t point) const { return row[point - first]; }
};

struct Kernels {
  const char* name;
  /// Appends what lies in the sphere. \return false if there was no room for all
  bool (*collect)(const LayoutView&, const Path&, const Sphere&, Candidates&);
  /// The same from one region only.
  bool (*collectRegion)(const LayoutView&, std::size_t region, const Sphere&, Candidates&);
  /// Fills a block with all points nearer to a box than the square root of `reach`.
  /// \return false if there was no room for all
  bool (*gatherAround)(const LayoutView&, const Box&, float reach, Block&);
  /// The k nearest of q, ascending, from a block that holds everything nearer than the square root
  /// of `reach`.
  /// \param room for as many candidates as the block has
  /// \return false if that is not enough
  bool (*nearestInBlock)(const Block&, const float* q, float reach, std::size_t k, Guess&,
                         Candidates& room, const SortScratch&, pcl::index_t* indices,
                         float* distances);
  /// Leaves the k nearest of `count` candidates in ascending order, ties by id, in the scratch. All
  /// are nearer than `limit`; there are at most kMostToSort, and the eight beyond the last were set
  /// by padCandidates().
  void (*sortNearest)(const float* distance, const std::uint32_t* id, std::size_t count,
                      std::size_t k, float limit, const SortScratch&);
  /// The k nearest of every point of a region.
  void (*nearestInRegion)(const LayoutView&, std::size_t region, GroupTask&);
  /// Everything within the radius of every point of a region.
  void (*withinInRegion)(const LayoutView&, std::size_t region, GroupTask&);
  /// The k nearest through the boxes below a node.
  void (*nearestInBoxes)(BoxSearch&, const BoxNode* root);
};

/// The kernels for instructionSet().
const Kernels& chooseKernels();

/// Candidates of a radius search that are looked at where only max_nn results are wanted, 0 = all.
inline std::size_t mostCollected(std::size_t max_nn) {
  return max_nn > 0 ? 4 * max_nn + 1024 : std::numeric_limits<std::size_t>::max();
}

/// Makes what lies beyond the last candidate come last in any order.
inline void padCandidates(float* distance, std::uint32_t* id, std::size_t count) {
  // Copied from constants, since that compiles to vector stores.
  constexpr float kFar = std::numeric_limits<float>::infinity();
  static constexpr float kDistances[8] = {kFar, kFar, kFar, kFar, kFar, kFar, kFar, kFar};
  static constexpr std::uint32_t kLast = 0xffffffffU;
  static constexpr std::uint32_t kIds[8] = {kLast, kLast, kLast, kLast, kLast, kLast, kLast, kLast};
  std::memcpy(distance + count, kDistances, sizeof(kDistances));
  std::memcpy(id + count, kIds, sizeof(kIds));
}

/// Sorts candidates by distance, ties by id; in place, too.
void sortMany(const float* distance, const std::uint32_t* id, std::size_t count,
              float* out_distance, std::uint32_t* out_id);

/// Moves the k nearest of more candidates, ties by id, to the front, in any order.
void keepNearest(float* distance, std::uint32_t* id, std::size_t count, std::size_t k);

}  // namespace segorient::search
