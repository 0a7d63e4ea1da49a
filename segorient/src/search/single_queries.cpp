// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <algorithm>
#include <cmath>
#include <utility>

#include "search/index_impl.h"
#include "search/shared_block.h"

namespace segorient::search {

// What one thread needs for its queries; kept from query to query.
class Workspace {
 public:
  // Empty candidates with room for `capacity`, and no more, though there may be some from earlier:
  // whether a guess does may decide what an approximate search finds.
  Candidates& candidates(std::size_t capacity) {
    if (capacity + Layout::kPadding > distance_.size()) {
      distance_.resize(capacity + Layout::kPadding);
      id_.resize(capacity + Layout::kPadding);
    }
    candidates_ = {distance_.data(), id_.data(), 0, capacity};
    return candidates_;
  }
  // Gives back what an unusually large result took.
  void shrink() {
    if (distance_.size() <= kMostKept) return;
    distance_ = {};
    id_ = {};
    candidates_ = {nullptr, nullptr, 0, 0};
  }
  SortScratch sort() { return sort_.scratch(); }
  std::vector<std::pair<float, std::uint32_t>> pairs;
  std::vector<std::uint64_t> keys;
  Recent& recent(std::uint64_t index) { return recent_.of(index); }

 private:
  static constexpr std::size_t kMostKept = std::size_t{1} << 18;
  RecentPair recent_;
  std::vector<float> distance_;
  std::vector<std::uint32_t> id_;
  SortRoom sort_;
  Candidates candidates_{nullptr, nullptr, 0, 0};
};

namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kLeast = std::numeric_limits<float>::denorm_min();
// Room for what the kernels look at in one go, see VectorList.
constexpr std::size_t kAtOnce = 1280;
constexpr std::uint32_t kAll = std::numeric_limits<std::uint32_t>::max();

float squaredGap(const Box& box, const float* q) {
  float sum = 0.0F;
  for (int a = 0; a < 3; ++a) {
    const float d = std::max(std::max(box.lo[a] - q[a], q[a] - box.hi[a]), 0.0F);
    sum += d * d;
  }
  return sum;
}

// The squared distance to the farthest point of a box.
float squaredSpan(const Box& box, const float* q) {
  float sum = 0.0F;
  for (int a = 0; a < 3; ++a) {
    const float d = std::max(q[a] - box.lo[a], box.hi[a] - q[a]);
    sum += d * d;
  }
  return sum;
}

Workspace& workspace() {
  thread_local Workspace instance;
  return instance;
}

// Only a number above 0 is a tolerance.
float pruneFactor(float epsilon) {
  if (!(epsilon > 0.0F)) return 1.0F;
  const float bound = 1.0F + epsilon;
  return 0.999999F / (bound * bound);
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
