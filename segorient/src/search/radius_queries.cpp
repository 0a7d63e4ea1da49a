// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <algorithm>
#include <limits>

#include "search/search_workspace.h"

namespace segorient::search {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr std::uint32_t kAll = std::numeric_limits<std::uint32_t>::max();

}  // namespace

// The nearest `most` points, as far as they are nearer than a squared limit.
int MedianHashIndex::Impl::nearestWithin(const float* q, float limit, std::size_t most,
                                         std::vector<pcl::index_t>& indices,
                                         std::vector<float>& distances) const {
  const std::size_t k = std::min(most, layout.size());
  indices.resize(k);
  distances.resize(k);
  search(q, k, 0.0F, indices.data(), distances.data());
  const auto end = std::lower_bound(distances.begin(), distances.end(), limit);
  indices.resize(static_cast<std::size_t>(end - distances.begin()));
  distances.erase(end, distances.end());
  return static_cast<int>(indices.size());
}

int MedianHashIndex::Impl::searchRadius(const float* query, double radius,
                                        std::vector<pcl::index_t>& indices,
                                        std::vector<float>& sqr_distances, unsigned int max_nn,
                                        bool sorted) const {
  const auto limit = squaredLimit(radius);
  Workspace& work = workspace();
  const LayoutView view(layout);
  const Path path(view, query);
  const Sphere sphere{{query[0], query[1], query[2]}, limit, limit, kAll};
  std::size_t capacity = max_nn > 0 ? std::min(mostCollected(max_nn), layout.size() + 1024) : 1024;
  Candidates* found = &work.candidates(capacity);
  while (!kernels->collect(view, path, sphere, *found)) {
    // Where there are many more than are wanted, the nearest are found without collecting all.
    if (max_nn > 0) return nearestWithin(query, limit, max_nn, indices, sqr_distances);
    capacity = std::max(4 * capacity, found->capacity + 1);
    found = &work.candidates(capacity);
  }
  std::size_t count = found->count;
  const bool cut = max_nn > 0 && count > max_nn;
  if (cut) count = max_nn;
  indices.resize(count);
  sqr_distances.resize(count);
  const float* distances = found->distance;
  const std::uint32_t* found_ids = found->id;
  const SortScratch sort = work.sort();
  if (sorted || cut) {
    if (found->count <= kMostToSort && limit < kInfinity) {
      padCandidates(found->distance, found->id, found->count);
      kernels->sortNearest(found->distance, found->id, found->count, count, limit, sort);
      distances = sort.distance;
      found_ids = sort.id;
    } else {
      sortMany(found->distance, found->id, found->count, found->distance, found->id);
    }
  }
  std::copy(distances, distances + count, sqr_distances.begin());
  for (std::size_t i = 0; i < count; ++i) indices[i] = static_cast<pcl::index_t>(found_ids[i]);
  work.shrink();
  return static_cast<int>(count);
}

}  // namespace segorient::search
