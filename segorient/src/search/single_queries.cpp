// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <algorithm>

#include "search/index_impl.h"
#include "search/search_workspace.h"

namespace segorient::search {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kLeast = std::numeric_limits<float>::denorm_min();
// Room for what the kernels look at in one go, see VectorList.
constexpr std::size_t kAtOnce = 1280;

}  // namespace

// From the block that queries near each other share. \return false if that does not do
bool MedianHashIndex::Impl::searchShared(const float* q, std::size_t k, Workspace& work,
                                         pcl::index_t* indices, float* distances) const {
  if (k > kMostNeighborsShared) return false;
  SharedBlock& shared = work.recent(number).shared;
  const LastQuery& last = work.recent(number).last;
  if (!shared.covers(number, q, k)) {
    if (last.index != number || last.k != k || !last.isNear(q)) return false;
    if (!shared.refill(*kernels, layout, number, q, last.limit, k)) return false;
  }
  return shared.nearest(*kernels, q, work.candidates(shared.capacity()), work.sort(), indices,
                        distances);
}

// Guesses a limit and collects everything below it: if that is k points or more, the nearest are
// among them. Null if no guess was right.
Candidates* MedianHashIndex::Impl::guess(const LayoutView& view, const float* q, std::size_t k,
                                         float epsilon, Workspace& work, float& limit) const {
  const float prune = pruneFactor(epsilon);
  // Not where results are approximate: they must not depend on what was asked before.
  LastQuery& last = work.recent(number).last;
  const bool near = last.index == number && last.k == k && prune == 1.0F && last.isNear(q);
  const Path path(view, q);
  const Region& region = view.regions[path.region];
  last.spacing16 = region.spacing16;
  const float outside = squaredGap(view.boxes[view.region_count + path.region], q);
  // Not 0, where many points are in one place.
  float step = std::max(1.3F * region.spacing16 * static_cast<float>(k) / 16.0F, kLeast);
  // From afar, a sphere that reaches the region cuts all of it at a grazing angle.
  constexpr float kFar = 16.0F;
  if (boxesServe(k) && outside > kFar * step) return nullptr;
  limit = near ? 1.3F * last.limit : outside + step;
  // More than these are many equally far, or the place is much denser.
  const std::size_t most = 4 * k + 64;
  const std::size_t capacity = most + (boxesServe(k) ? kAtOnce : 4096);
  // Away from the points, or where they get much sparser, boxes lead there sooner.
  const int attempts = boxesServe(k) ? 2 : 8;
  for (int attempt = 0; attempt < attempts; ++attempt) {
    if (!(limit > 0.0F && limit < kInfinity)) return nullptr;
    Candidates& found = work.candidates(capacity);
    const Sphere sphere{{q[0], q[1], q[2]}, limit, limit * prune, static_cast<std::uint32_t>(k)};
    if (!kernels->collect(view, path, sphere, found)) return nullptr;
    if (found.count >= k) {
      if (found.count > most) {
        if (boxesServe(k)) return nullptr;
        keepNearest(found.distance, found.id, found.count, k);
        found.count = k;
      }
      if (found.count > kMostToSort) return nullptr;
      padCandidates(found.distance, found.id, found.count);
      return &found;
    }
    // Added, not multiplied: the part that leads to the surface does not grow.
    const float missing = 1.4F * static_cast<float>(k) / static_cast<float>(found.count + 1);
    // The spacing may be that of a denser place.
    const float growth = attempt < 2 ? 4.0F : 64.0F;
    step = std::max(step, 1e-3F * limit) * std::min(std::max(missing, 1.3F), growth);
    limit += step;
  }
  return nullptr;
}

void MedianHashIndex::Impl::search(const float* q, std::size_t k, float epsilon,
                                   pcl::index_t* indices, float* distances) const {
  Workspace& work = workspace();
  Recent& recent = work.recent(number);
  // What is approximate must not depend on what was asked before.
  if (pruneFactor(epsilon) != 1.0F && !in_order) {
    searchAlone(q, k, epsilon, work, indices, distances);
  } else if (recent.away.isLikely() && searchBoxes(q, k, 1.0F, work.keys, indices, distances)) {
    // The queries before were away from the points.
  } else if (!searchShared(q, k, work, indices, distances) &&
             !recent.crowded.answer(number, q, k, indices, distances)) {
    searchAlone(q, k, 0.0F, work, indices, distances);
    const bool crowded = k <= kMostNeighborsShared && distances[0] == distances[k - 1];
    if (crowded) recent.crowded.remember(number, q, k, indices, *distances);
  }
  recent.last = {number, k, {q[0], q[1], q[2]}, distances[k - 1], recent.last.spacing16};
}

void MedianHashIndex::Impl::searchAlone(const float* q, std::size_t k, float epsilon,
                                        Workspace& work, pcl::index_t* indices,
                                        float* distances) const {
  const LayoutView view(layout);
  float limit = 0.0F;
  Candidates* const found = guess(view, q, k, epsilon, work, limit);
  work.recent(number).away.was(found == nullptr);
  if (found != nullptr) {
    const SortScratch sort = work.sort();
    kernels->sortNearest(found->distance, found->id, found->count, k, limit, sort);
    for (std::size_t i = 0; i < k; ++i) indices[i] = static_cast<pcl::index_t>(sort.id[i]);
    std::copy(sort.distance, sort.distance + k, distances);
  } else if (!searchBoxes(q, k, pruneFactor(epsilon), work.keys, indices, distances)) {
    nearestFirst(view, q, k, epsilon, work);
    for (std::size_t i = 0; i < k; ++i) {
      distances[i] = work.pairs[i].first;
      indices[i] = static_cast<pcl::index_t>(work.pairs[i].second);
    }
  }
}

void putFirst(pcl::index_t self, pcl::index_t* indices, std::size_t count) {
  pcl::index_t* const end = indices + count;
  pcl::index_t* const at = std::find(indices, end, self);
  if (at == end) indices[count - 1] = self;
  std::rotate(indices, std::min(at, end - 1), std::min(at + 1, end));
}

void MedianHashIndex::Impl::searchSelf(std::size_t point, std::size_t k, float epsilon,
                                       pcl::index_t* indices, float* distances) const {
  const float q[3] = {layout.x[point], layout.y[point], layout.z[point]};
  search(q, k, epsilon, indices, distances);
  putFirst(static_cast<pcl::index_t>(layout.id[point]), indices, k);
}

}  // namespace segorient::search
