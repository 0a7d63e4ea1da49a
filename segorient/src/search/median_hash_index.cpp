// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <segorient/common/threads.h>
#include <segorient/search/median_hash_index.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "kernels.h"
#include "layout.h"

namespace segorient::search {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr std::uint32_t kAll = std::numeric_limits<std::uint32_t>::max();
// In the all-points search, how many standard deviations of the k-th squared distance, which is
// about 1/sqrt(k) of it, are allowed for from one query to the next.
constexpr float kMargin = 0.7F;
// Most neighbours for which the all-points search shares candidates among queries.
constexpr std::size_t kMostShared = 256;

float squaredGap(const Box& box, const float* q) {
  float sum = 0.0F;
  for (int a = 0; a < 3; ++a) {
    const float d = std::max(std::max(box.lo[a] - q[a], q[a] - box.hi[a]), 0.0F);
    sum += d * d;
  }
  return sum;
}

constexpr std::size_t kSortLength = kMostToSort + Layout::kPadding;
constexpr std::size_t kSortFloats = 2 * kSortLength;
constexpr std::size_t kSortIds = 7 * kSortLength;

SortScratch sortScratch(float* f, std::uint32_t* i) {
  SortScratch sort{};
  sort.part_distance = f;
  sort.distance = f + kSortLength;
  sort.part_id = i;
  sort.id = i + kSortLength;
  sort.rank = i + 2 * kSortLength;
  sort.pairs = i + 3 * kSortLength;
  sort.sorted_pairs = i + 5 * kSortLength;
  return sort;
}

// What one thread needs for its queries; kept from query to query.
class Workspace {
 public:
  Workspace() : sort_floats_(kSortFloats), sort_ids_(kSortIds) {}

  // Empty candidates with room for `capacity`.
  Candidates& candidates(std::size_t capacity) {
    if (capacity > candidates_.capacity) {
      distance_.resize(capacity + Layout::kPadding);
      id_.resize(capacity + Layout::kPadding);
      candidates_ = {distance_.data(), id_.data(), 0, capacity};
    }
    candidates_.count = 0;
    return candidates_;
  }
  // Gives back what an unusually large result took.
  void shrink() {
    if (candidates_.capacity <= kMostKept) return;
    distance_ = {};
    id_ = {};
    candidates_ = {nullptr, nullptr, 0, 0};
  }
  SortScratch sort() { return sortScratch(sort_floats_.data(), sort_ids_.data()); }
  std::vector<std::pair<float, std::uint32_t>> pairs;

 private:
  static constexpr std::size_t kMostKept = std::size_t{1} << 18;
  std::vector<float> distance_;
  std::vector<std::uint32_t> id_;
  std::vector<float> sort_floats_;
  std::vector<std::uint32_t> sort_ids_;
  Candidates candidates_{nullptr, nullptr, 0, 0};
};

Workspace& workspace() {
  thread_local Workspace instance;
  return instance;
}

// The last query of a thread: if the next one is near, its radius is a good guess.
struct LastQuery {
  std::uint64_t index = 0;
  int k = 0;
  float point[3] = {0.0F, 0.0F, 0.0F};
  float limit = 0.0F;
};

LastQuery& lastQuery() {
  thread_local LastQuery instance;
  return instance;
}

// Only a number above 0 is a tolerance.
float pruneFactor(float epsilon) {
  if (!(epsilon > 0.0F)) return 1.0F;
  const float bound = 1.0F + epsilon;
  return 0.999999F / (bound * bound);
}

}  // namespace

namespace {

// The work space of one thread in an all-points search.
class AllPointsWork {
 public:
  AllPointsWork(const Layout& layout, std::size_t k) : task{} {
    const std::size_t capacity = 2048 + 16 * k;
    const std::size_t length = capacity + Layout::kPadding;
    floats_.resize(5 * length + kSortFloats);
    ids_.resize(2 * length + kSortIds + layout.regions.size());
    std::size_t most = 0;
    for (const Region& r : layout.regions) most = std::max<std::size_t>(most, r.end - r.begin);
    failed_.resize(most);
    float* f = floats_.data();
    std::uint32_t* i = ids_.data();
    task.k = static_cast<std::uint32_t>(k);
    // The relative deviation of the k-th squared distance falls with the root of k.
    task.margin = 1.0F + kMargin / std::sqrt(static_cast<float>(k));
    for (float*& coordinate : task.block) {
      coordinate = f;
      f += length;
    }
    task.block_distance = f;
    task.block_id = i;
    task.block_capacity = capacity;
    task.candidates = {f + length, i + length, 0, capacity};
    f += 2 * length;
    i += 2 * length;
    task.sort = sortScratch(f, i);
    task.neighbors = i + kSortIds;
    task.failed = failed_.data();
  }

  AllPointsTask task;

 private:
  std::vector<float> floats_;
  std::vector<std::uint32_t> ids_;
  std::vector<std::uint32_t> failed_;
};

}  // namespace

struct MedianHashIndex::Impl {
  Options options;
  std::size_t rows = 0;
  Layout layout;
  const Kernels* kernels = &chooseKernels();
  std::uint64_t number = 0;  // tells one built index from another

  void search(const float* q, std::size_t k, float epsilon, pcl::index_t* indices,
              float* distances) const;
  Candidates* guess(const LayoutView& view, const float* q, std::size_t k, float epsilon,
                    Workspace& work, float& limit) const;
  void nearestFirst(const LayoutView& view, const float* q, std::size_t k, float epsilon,
                    Workspace& work) const;
  void addUnreachable(const LayoutView& view, const float* q, std::size_t k, Workspace& work) const;
  void searchSelf(std::size_t point, std::size_t k, float epsilon, pcl::index_t* indices,
                  float* distances) const;
  void searchRegion(std::size_t region, AllPointsTask& task, Neighborhoods& out) const;
};

// Guesses a limit and collects everything below it: if that is k points or more, the nearest are
// among them. Null if no guess was right.
Candidates* MedianHashIndex::Impl::guess(const LayoutView& view, const float* q, std::size_t k,
                                         float epsilon, Workspace& work, float& limit) const {
  const Path path(view, q);
  const Region& region = view.regions[path.region];
  const float outside = squaredGap(view.boxes[view.region_count + path.region], q);
  const LastQuery& last = lastQuery();
  const float prune = pruneFactor(epsilon);
  float step = 1.3F * region.spacing16 * static_cast<float>(k) / 16.0F;
  limit = outside + step;
  // Not where results are approximate: they must not depend on what was asked before.
  if (last.index == number && last.k == static_cast<int>(k) && prune == 1.0F) {
    const float dx = q[0] - last.point[0];
    const float dy = q[1] - last.point[1];
    const float dz = q[2] - last.point[2];
    if (dx * dx + dy * dy + dz * dz < last.limit) limit = 1.3F * last.limit;
  }
  const std::size_t capacity = 4 * k + 4096;
  for (int attempt = 0; attempt < 4; ++attempt) {
    if (!(limit > 0.0F && limit < kInfinity)) return nullptr;
    Candidates& found = work.candidates(capacity);
    const Sphere sphere{{q[0], q[1], q[2]}, limit, limit * prune, static_cast<std::uint32_t>(k)};
    if (!kernels->collect(view, path, sphere, found)) return nullptr;
    if (found.count >= k) return found.count <= kMostToSort ? &found : nullptr;
    // Added, not multiplied: the part that leads to the surface does not grow.
    const float missing = 1.4F * static_cast<float>(k) / static_cast<float>(found.count + 1);
    step = std::max(step, 1e-3F * limit) * std::min(std::max(missing, 1.3F), 4.0F);
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
    Candidates& found = work.candidates(view.regions[region].end - view.regions[region].begin);
    const Sphere sphere{{q[0], q[1], q[2]}, limit, limit * prune, static_cast<std::uint32_t>(k)};
    kernels->collectRegion(view, region, sphere, found);
    for (std::size_t i = 0; i < found.count; ++i) {
      best.emplace_back(found.distance[i], found.id[i]);
    }
    if (best.size() < k) continue;
    const auto last = best.begin() + static_cast<std::ptrdiff_t>(k - 1);
    std::nth_element(best.begin(), last, best.end());
    best.resize(k);
    // Those as far as the k-th may still replace it by a smaller index.
    limit = std::nextafter(best.back().first, kInfinity);
  }
  if (best.size() < k) addUnreachable(view, q, k, work);
  std::sort(best.begin(), best.end());
}

// Distances that overflow are all equal.
void MedianHashIndex::Impl::addUnreachable(const LayoutView& view, const float* q, std::size_t k,
                                           Workspace& work) const {
  std::vector<std::uint32_t> ids;
  for (std::size_t i = 0; i < layout.size(); ++i) {
    const float dx = q[0] - view.x[i];
    const float dy = q[1] - view.y[i];
    const float dz = q[2] - view.z[i];
    if (!(dx * dx + dy * dy + dz * dz < kInfinity)) ids.push_back(view.id[i]);
  }
  const std::size_t missing = std::min(k - work.pairs.size(), ids.size());
  const auto end = ids.begin() + static_cast<std::ptrdiff_t>(missing);
  std::partial_sort(ids.begin(), end, ids.end());
  for (auto id = ids.begin(); id != end; ++id) work.pairs.emplace_back(kInfinity, *id);
}

void MedianHashIndex::Impl::search(const float* q, std::size_t k, float epsilon,
                                   pcl::index_t* indices, float* distances) const {
  Workspace& work = workspace();
  const LayoutView view(layout);
  float limit = 0.0F;
  if (Candidates* found = guess(view, q, k, epsilon, work, limit)) {
    const SortScratch sort = work.sort();
    kernels->sortNearest(*found, k, limit, sort);
    for (std::size_t i = 0; i < k; ++i) indices[i] = static_cast<pcl::index_t>(sort.id[i]);
    std::copy(sort.distance, sort.distance + k, distances);
  } else {
    nearestFirst(view, q, k, epsilon, work);
    for (std::size_t i = 0; i < k; ++i) {
      distances[i] = work.pairs[i].first;
      indices[i] = static_cast<pcl::index_t>(work.pairs[i].second);
    }
  }
  lastQuery() = {number, static_cast<int>(k), {q[0], q[1], q[2]}, distances[k - 1]};
}

// As search(), the point itself in front of others in the same place.
void MedianHashIndex::Impl::searchSelf(std::size_t point, std::size_t k, float epsilon,
                                       pcl::index_t* indices, float* distances) const {
  const float q[3] = {layout.x[point], layout.y[point], layout.z[point]};
  search(q, k, epsilon, indices, distances);
  const auto self = static_cast<pcl::index_t>(layout.id[point]);
  pcl::index_t* const at = std::find(indices, indices + k, self);
  if (at == indices + k) indices[k - 1] = self;  // so many in one place that it was left out
  std::rotate(indices, std::min(at, indices + k - 1), std::min(at + 1, indices + k));
}

void MedianHashIndex::Impl::searchRegion(std::size_t region, AllPointsTask& task,
                                         Neighborhoods& out) const {
  const LayoutView view(layout);
  const Region& r = view.regions[region];
  if (task.k <= kMostShared) {
    kernels->allInRegion(view, region, task);
  } else {
    task.failed_count = 0;
    for (std::uint32_t i = r.begin; i < r.end; ++i) task.failed[task.failed_count++] = i;
  }
  std::vector<float> unwanted(task.distances == nullptr ? task.k : 0);
  for (std::size_t i = 0; i < task.failed_count; ++i) {
    const std::size_t point = task.failed[i];
    const std::size_t row = view.row[point];
    float* distances = out.mutableSqrDistances(row);
    searchSelf(point, task.k, task.epsilon, out.mutableIndices(row),
               distances != nullptr ? distances : unwanted.data());
  }
  for (std::size_t i = r.begin; i < r.end; ++i) {
    out.setCount(view.row[i], static_cast<int>(task.k));
  }
}

MedianHashIndex::MedianHashIndex() : impl_(std::make_unique<Impl>()) {}
MedianHashIndex::~MedianHashIndex() = default;
MedianHashIndex::MedianHashIndex(MedianHashIndex&&) noexcept = default;
MedianHashIndex& MedianHashIndex::operator=(MedianHashIndex&&) noexcept = default;

void MedianHashIndex::build(const PointView& points, const std::vector<pcl::index_t>* indices,
                            const Options& options) {
  static std::atomic<std::uint64_t> built{0};
  impl_ = std::make_unique<Impl>();
  Impl& self = *impl_;
  self.options = options;
  self.rows = indices != nullptr ? indices->size() : points.size;
  self.number = ++built;
  const std::unique_ptr<BuildPoint[]> finite(new BuildPoint[self.rows]);
  std::size_t count = 0;
  for (std::size_t i = 0; i < self.rows; ++i) {
    const auto at = indices != nullptr ? static_cast<std::size_t>((*indices)[i]) : i;
    if (at >= points.size || !isFinite(points[at])) continue;
    const float* p = points[at];
    finite[count++] = {{p[0], p[1], p[2]}, static_cast<std::uint32_t>(i)};
  }
  const std::size_t region_size =
      std::min(std::max<std::size_t>(options.region_size, 8), kMostRegionSize);
  self.layout = buildLayout(finite.get(), count, region_size, resolveThreads(options.threads));
  if (indices != nullptr) self.layout.useIndices(*indices);
}

std::size_t MedianHashIndex::size() const {
  return impl_->layout.size();
}

std::size_t MedianHashIndex::memory() const {
  return sizeof(Impl) + impl_->layout.memory();
}

const char* MedianHashIndex::instructionSet() const {
  return impl_->kernels->name;
}

float MedianHashIndex::epsilon() const {
  return impl_->options.epsilon;
}

void MedianHashIndex::setNumberOfThreads(int threads) {
  impl_->options.threads = threads;
}

int MedianHashIndex::nearestK(const float* query, int k, pcl::index_t* indices,
                              float* sqr_distances, float epsilon) const {
  if (k <= 0 || size() == 0 || !isFinite(query)) return 0;
  const std::size_t wanted = std::min(static_cast<std::size_t>(k), size());
  impl_->search(query, wanted, epsilon, indices, sqr_distances);
  return static_cast<int>(wanted);
}

int MedianHashIndex::radius(const float* query, double radius, std::vector<pcl::index_t>& indices,
                            std::vector<float>& sqr_distances, unsigned int max_nn,
                            bool sorted) const {
  indices.clear();
  sqr_distances.clear();
  if (!(radius > 0.0) || size() == 0 || !isFinite(query)) return 0;
  const auto limit = static_cast<float>(std::min(radius * radius, 1e300));
  Workspace& work = workspace();
  const LayoutView view(impl_->layout);
  const Path path(view, query);
  const Sphere sphere{{query[0], query[1], query[2]}, limit, limit, kAll};
  std::size_t capacity = 1024;
  Candidates* found = &work.candidates(capacity);
  while (!impl_->kernels->collect(view, path, sphere, *found)) {
    capacity = std::max(4 * capacity, found->capacity + 1);
    found = &work.candidates(capacity);
  }
  std::size_t count = found->count;
  const bool cut = max_nn > 0 && count > max_nn;
  if (cut) count = max_nn;
  indices.resize(count);
  sqr_distances.resize(count);
  const float* distances = found->distance;
  const std::uint32_t* ids = found->id;
  const SortScratch sort = work.sort();
  if (sorted || cut) {
    if (found->count <= kMostToSort && limit < kInfinity) {
      impl_->kernels->sortNearest(*found, count, limit, sort);
      distances = sort.distance;
      ids = sort.id;
    } else {
      sortPairs(found->distance, found->id, found->count);
    }
  }
  std::copy(distances, distances + count, sqr_distances.begin());
  for (std::size_t i = 0; i < count; ++i) indices[i] = static_cast<pcl::index_t>(ids[i]);
  work.shrink();
  return static_cast<int>(count);
}

void MedianHashIndex::nearestKBatch(const PointView& queries, int k,
                                    std::vector<std::vector<pcl::index_t>>& indices,
                                    std::vector<std::vector<float>>& sqr_distances,
                                    float epsilon) const {
  const auto count = static_cast<std::int64_t>(queries.size);
  const int threads = resolveThreads(impl_->options.threads);
  const std::size_t wanted = std::min(static_cast<std::size_t>(std::max(k, 0)), size());
  indices.resize(queries.size);
  sqr_distances.resize(queries.size);
#pragma omp parallel for num_threads(threads) schedule(dynamic, 512) if (threads > 1)
  for (std::int64_t i = 0; i < count; ++i) {
    const auto at = static_cast<std::size_t>(i);
    const float* query = queries[at];
    const std::size_t found = isFinite(query) ? wanted : 0;
    indices[at].resize(found);
    sqr_distances[at].resize(found);
    nearestK(query, static_cast<int>(found), indices[at].data(), sqr_distances[at].data(), epsilon);
  }
}

void MedianHashIndex::radiusBatch(const PointView& queries, double radius,
                                  std::vector<std::vector<pcl::index_t>>& indices,
                                  std::vector<std::vector<float>>& sqr_distances,
                                  unsigned int max_nn, bool sorted) const {
  const auto count = static_cast<std::int64_t>(queries.size);
  const int threads = resolveThreads(impl_->options.threads);
  indices.resize(queries.size);
  sqr_distances.resize(queries.size);
#pragma omp parallel for num_threads(threads) schedule(dynamic, 512) if (threads > 1)
  for (std::int64_t i = 0; i < count; ++i) {
    const auto at = static_cast<std::size_t>(i);
    this->radius(queries[at], radius, indices[at], sqr_distances[at], max_nn, sorted);
  }
}

void MedianHashIndex::nearestKAll(int k, Neighborhoods& out, bool with_distances,
                                  float epsilon) const {
  const Impl& self = *impl_;
  const std::size_t wanted = std::min(static_cast<std::size_t>(std::max(k, 0)), size());
  out.reset(self.rows, k, with_distances);
  if (wanted == 0) return;
  const auto regions = static_cast<std::int64_t>(self.layout.regions.size());
  const int threads = resolveThreads(self.options.threads);
#pragma omp parallel num_threads(threads) if (threads > 1)
  {
    AllPointsWork work(self.layout, wanted);
    AllPointsTask& task = work.task;
    task.epsilon = epsilon > 0.0F ? epsilon : 0.0F;
    task.indices = out.mutableIndices(0);
    task.distances = out.mutableSqrDistances(0);
    task.row_length = static_cast<std::size_t>(k);
#pragma omp for schedule(dynamic, 4)
    for (std::int64_t r = 0; r < regions; ++r) {
      self.searchRegion(static_cast<std::size_t>(r), task, out);
    }
  }
}

}  // namespace segorient::search
