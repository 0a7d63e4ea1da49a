// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
//
// What a MedianHashIndex consists of: median_hash_index.cpp builds it, single_queries.cpp searches
// for one point at a time, all_points.cpp for all points of a region.
#pragma once

#include <segorient/search/median_hash_index.h>

#include <atomic>
#include <cstdint>
#include <functional>
#include <mutex>
#include <vector>

#include "search/box_tree.h"
#include "search/kernels.h"
#include "search/layout.h"

namespace segorient::search {

class Workspace;

struct MedianHashIndex::Impl {
  Options options;
  std::size_t rows = 0;
  Layout layout;
  const Kernels* kernels = &chooseKernels();
  std::uint64_t number = 0;  ///< tells one built index from another
  /// Whether points next to each other in the input are near each other, as in a scan.
  bool in_order = false;

  /// The k nearest, ascending, where there are as many; room for k entries is the caller's. Exact
  /// for any epsilon if the points are in order: queries that follow each other then share their
  /// candidates, which is faster than to look at fewer, but must not be seen in what is found.
  void search(const float* q, std::size_t k, float epsilon, pcl::index_t* indices,
              float* distances) const;
  /// The same for a point of the layout, itself in front of others in the same place.
  void searchSelf(std::size_t point, std::size_t k, float epsilon, pcl::index_t* indices,
                  float* distances) const;

  /// All points nearer than the radius, see MedianHashIndex::radius().
  int searchRadius(const float* q, double radius, std::vector<pcl::index_t>& indices,
                   std::vector<float>& sqr_distances, unsigned int max_nn, bool sorted) const;
  /// \param wanted neighbours, above 0 and no more than there are points
  using RegionSearch = std::function<void(std::size_t region, GroupTask& task_of_thread)>;
  void nearestOfRegions(GroupTask task, const RegionSearch& search) const;
  void nearestOfAll(std::size_t wanted, float epsilon, Neighborhoods& out) const;
  void nearestOfRegion(std::size_t region, GroupTask& task, Neighborhoods& out) const;
  void withinOfRegion(std::size_t region, double radius, GroupTask& task,
                      RadiusNeighborhoods& out) const;

  bool searchShared(const float* q, std::size_t k, Workspace& work, pcl::index_t* indices,
                    float* distances) const;
  void searchAlone(const float* q, std::size_t k, float epsilon, Workspace& work,
                   pcl::index_t* indices, float* distances) const;
  Candidates* guess(const LayoutView& view, const float* q, std::size_t k, float epsilon,
                    Workspace& work, float& limit) const;
  void nearestFirst(const LayoutView& view, const float* q, std::size_t k, float epsilon,
                    Workspace& work) const;
  int nearestWithin(const float* q, float limit, std::size_t most,
                    std::vector<pcl::index_t>& indices, std::vector<float>& distances) const;
  /// The k nearest through boxes, for queries away from the points.
  /// \param keys work space
  /// \return false if that is no way to find them
  bool searchBoxes(const float* q, std::size_t k, float prune, std::vector<std::uint64_t>& keys,
                   pcl::index_t* indices, float* distances) const;
  void addUnreachable(std::size_t k, Workspace& work) const;

  /// All ids in ascending order, made when first needed.
  const std::vector<std::uint32_t>& ascendingIds() const;
  mutable std::once_flag ids_made;
  mutable std::vector<std::uint32_t> ids;
  mutable std::atomic<std::size_t> ids_memory{0};

  /// Whether searchBoxes() finds k nearest, unless distances overflow.
  static bool boxesServe(std::size_t k) { return k <= kMostNeighborsInBoxes; }
  /// Made by the first query that is away from the points.
  BoxTree& boxTree() const;
  std::size_t boxesMemory() const;
  mutable std::atomic<BoxTree*> boxes{nullptr};
  ~Impl();
};

/// Moves an index to the front of a row, in place of the last if it is not there since so many
/// others are in the same place.
void putFirst(pcl::index_t self, pcl::index_t* indices, std::size_t count);

/// A squared radius as it is compared with.
inline float squaredLimit(double radius) {
  return static_cast<float>(radius < 1e150 ? radius * radius : 1e300);
}

/// Room for what SortScratch points to.
class SortRoom {
 public:
  SortRoom() : floats_(2 * kLength), ids_(2 * kLength) {}
  SortScratch scratch() {
    return {floats_.data(), ids_.data(), floats_.data() + kLength, ids_.data() + kLength};
  }

 private:
  static constexpr std::size_t kLength = kMostToSort + Layout::kPadding;
  std::vector<float> floats_;
  std::vector<std::uint32_t> ids_;
};

}  // namespace segorient::search
