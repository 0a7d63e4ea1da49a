// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "search/search_workspace.h"

namespace segorient::search {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

// The squared distance to the farthest point of a box.
float squaredSpan(const Box& box, const float* q) {
  float sum = 0.0F;
  for (int a = 0; a < 3; ++a) {
    const float d = std::max(q[a] - box.lo[a], box.hi[a] - q[a]);
    sum += d * d;
  }
  return sum;
}

// Leaves the k nearest of what was found. \return what a point must be nearer than to be one of
// them
float keepBest(std::vector<std::pair<float, std::uint32_t>>& best, std::size_t k) {
  if (best.size() < k) return kInfinity;
  const auto last = best.begin() + static_cast<std::ptrdiff_t>(k - 1);
  std::nth_element(best.begin(), last, best.end());
  best.resize(k);
  // Those as far as the k-th may still replace it by a smaller index.
  return std::nextafter(best.back().first, kInfinity);
}

}  // namespace

// Region after region, nearest first, with the k-th distance so far as the limit. Needs no guess.
void MedianHashIndex::Impl::nearestFirst(const LayoutView& view, const float* q, std::size_t k,
                                         float epsilon, Workspace& work) const {
  auto& best = work.pairs;
  best.clear();
  const float prune = pruneFactor(epsilon);
  float limit = kInfinity;
  std::pair<float, std::size_t> stack[64];
  std::size_t depth = 0;
  stack[depth++] = {squaredGap(view.boxes[1], q), 1};
  while (depth > 0) {
    const auto [distance, node] = stack[--depth];
    if (!(distance < limit * prune)) continue;
    if (view.flat != nullptr && view.flat[node] != 0 &&
        distance == squaredSpan(view.boxes[node], q) && nodeSize(view, node) > k) {
      const std::uint32_t* const id = view.flat_id + firstPoint(view, node);
      for (std::size_t i = 0; i < k; ++i) best.emplace_back(distance, id[i]);
      limit = keepBest(best, k);
      continue;
    }
    if (node < view.region_count) {
      const float left = squaredGap(view.boxes[2 * node], q);
      const float right = squaredGap(view.boxes[2 * node + 1], q);
      const bool left_first = left <= right;
      stack[depth++] =
          left_first ? std::make_pair(right, 2 * node + 1) : std::make_pair(left, 2 * node);
      stack[depth++] =
          left_first ? std::make_pair(left, 2 * node) : std::make_pair(right, 2 * node + 1);
      continue;
    }
    const std::size_t region = node - view.region_count;
    const Sphere sphere{{q[0], q[1], q[2]}, limit, limit * prune, static_cast<std::uint32_t>(k)};
    Candidates* found = &work.candidates(view.regions[region].end - view.regions[region].begin);
    // Candidates are counted in whole vectors, which may be more than there are points.
    while (!kernels->collectRegion(view, region, sphere, *found)) {
      found = &work.candidates(2 * found->capacity + 1024);
    }
    for (std::size_t i = 0; i < found->count; ++i) {
      best.emplace_back(found->distance[i], found->id[i]);
    }
    limit = keepBest(best, k);
  }
  if (best.size() < k) addUnreachable(k, work);
  std::sort(best.begin(), best.end());
}

const std::vector<std::uint32_t>& MedianHashIndex::Impl::ascendingIds() const {
  std::call_once(ids_made, [this] {
    ids.assign(layout.id.begin(), layout.id.end() - Layout::kPadding);
    std::sort(ids.begin(), ids.end());
    ids_memory = ids.capacity() * sizeof(std::uint32_t);
  });
  return ids;
}

// Distances that overflow are all equal. Less than k were found that do not, so that there are not
// many ids to be left out here.
void MedianHashIndex::Impl::addUnreachable(std::size_t k, Workspace& work) const {
  std::vector<std::uint32_t> found;
  for (const auto& [distance, id] : work.pairs) found.push_back(id);
  std::sort(found.begin(), found.end());
  for (const std::uint32_t id : ascendingIds()) {
    if (work.pairs.size() == k) break;
    if (!std::binary_search(found.begin(), found.end(), id)) {
      work.pairs.emplace_back(kInfinity, id);
    }
  }
}

}  // namespace segorient::search
