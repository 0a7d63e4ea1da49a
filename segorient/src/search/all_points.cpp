// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <segorient/common/threads.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "index_impl.h"

namespace segorient::search {
namespace {

// Most points that a group of a radius search shares.
constexpr std::size_t kRadiusBlock = 8192;

// The work space of one thread.
class GroupWork {
 public:
  // \param block most points that a group shares
  // \param candidates most candidates that the points of a group have in all
  GroupWork(const Layout& layout, std::size_t block, std::size_t candidates) : task{} {
    const std::size_t block_length = wholeLines(block + Layout::kPadding);
    const std::size_t length = wholeLines(candidates + Layout::kPadding);
    floats_.resize(3 * block_length + length + kLine);
    ids_.resize(block_length + length + layout.regions.size() + kLine);
    std::size_t most = 0;
    for (const Region& r : layout.regions) most = std::max<std::size_t>(most, r.end - r.begin);
    failed_.resize(most);
    float* const floats = firstOfLine(floats_);
    std::uint32_t* const ids = firstOfLine(ids_);
    for (std::size_t a = 0; a < 3; ++a) task.block.xyz[a] = floats + a * block_length;
    task.candidate_distance = floats + 3 * block_length;
    task.block.id = ids;
    task.candidate_id = ids + block_length;
    task.neighbors = task.candidate_id + length;
    task.block.capacity = block;
    task.candidate_capacity = candidates;
    task.sort = sort_.scratch();
    task.failed = failed_.data();
  }

  GroupTask task;

 private:
  std::vector<float> floats_;
  std::vector<std::uint32_t> ids_;
  std::vector<std::uint32_t> failed_;
  SortRoom sort_;
};

// The rows that a radius search finds for the points of one region.
class RegionRows {
 public:
  RowBuffer& start(const Region& region, std::size_t capacity, bool with_distances) {
    begin_.resize(region.end - region.begin);
    count_.resize(region.end - region.begin);
    indices_.resize(capacity);
    distances_.resize(with_distances ? capacity : 0);
    buffer_ = {indices_.data(),
               with_distances ? distances_.data() : nullptr,
               0,
               capacity,
               begin_.data(),
               count_.data(),
               &RegionRows::grow,
               this};
    return buffer_;
  }
  const RowBuffer& buffer() const { return buffer_; }
  void clear() { *this = RegionRows(); }

 private:
  static void grow(RowBuffer& buffer, std::size_t needed) {
    auto& self = *static_cast<RegionRows*>(buffer.owner);
    buffer.capacity = std::max(needed, 2 * buffer.capacity);
    self.indices_.resize(buffer.capacity);
    buffer.indices = self.indices_.data();
    if (buffer.distances == nullptr) return;
    self.distances_.resize(buffer.capacity);
    buffer.distances = self.distances_.data();
  }

  FastVector<pcl::index_t> indices_;
  FastVector<float> distances_;
  FastVector<std::size_t> begin_;
  FastVector<std::uint32_t> count_;
  RowBuffer buffer_{};
};

}  // namespace

void MedianHashIndex::Impl::nearestOfRegion(std::size_t region, GroupTask& task,
                                            Neighborhoods& out) const {
  const LayoutView view(layout);
  const Region& r = view.regions[region];
  if (task.k <= kMostNeighborsShared) {
    kernels->nearestInRegion(view, region, task);
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

void MedianHashIndex::nearestKAll(int k, Neighborhoods& out, bool with_distances,
                                  float epsilon) const {
  const Impl& self = *impl_;
  const std::size_t wanted = std::min(static_cast<std::size_t>(std::max(k, 0)), size());
  out.reset(self.rows, k, with_distances);
  if (wanted == 0) return;
  const auto regions = static_cast<std::int64_t>(self.layout.regions.size());
  const int threads = resolveThreads(self.options.threads);
  const std::size_t shared = std::min(wanted, kMostNeighborsShared);
#pragma omp parallel num_threads(threads) if (threads > 1)
  {
    // A group has up to 31 points with up to some 3 k + 104 candidates each, in two halves.
    const std::size_t block = 2048 + 16 * shared;
    const std::size_t half = block + Layout::kPadding + 16 * (3 * shared + 112);
    GroupWork work(self.layout, block, 2 * wholeLines(half));
    GroupTask& task = work.task;
    task.k = static_cast<std::uint32_t>(wanted);
    task.epsilon = epsilon > 0.0F ? epsilon : 0.0F;
    // The relative deviation of the k-th squared distance falls with the root of k.
    task.margin = 1.0F + kMargin / std::sqrt(static_cast<float>(wanted));
    task.indices = out.mutableIndices(0);
    task.distances = out.mutableSqrDistances(0);
    task.row_length = static_cast<std::size_t>(k);
#pragma omp for schedule(dynamic, 1)
    for (std::int64_t r = 0; r < regions; ++r) {
      self.nearestOfRegion(static_cast<std::size_t>(r), task, out);
    }
  }
}

// Points that no group could search for are searched for one by one.
void MedianHashIndex::Impl::withinOfRegion(std::size_t region, double radius,
                                           GroupTask& task) const {
  const LayoutView view(layout);
  kernels->withinInRegion(view, region, task);
  std::vector<pcl::index_t> indices;
  std::vector<float> distances;
  RowBuffer& buffer = *task.rows;
  for (std::size_t i = 0; i < task.failed_count; ++i) {
    const std::size_t point = task.failed[i];
    const float q[3] = {view.x[point], view.y[point], view.z[point]};
    searchRadius(q, radius, indices, distances, 0, true);
    const std::size_t count = std::min<std::size_t>(indices.size(), task.k);
    putFirst(static_cast<pcl::index_t>(view.id[point]), indices.data(), count);
    if (buffer.used + count > buffer.capacity) buffer.grow(buffer, buffer.used + count);
    std::copy_n(indices.begin(), count, buffer.indices + buffer.used);
    if (buffer.distances != nullptr)
      std::copy_n(distances.begin(), count, buffer.distances + buffer.used);
    buffer.begin[point - view.regions[region].begin] = buffer.used;
    buffer.count[point - view.regions[region].begin] = static_cast<std::uint32_t>(count);
    buffer.used += count;
  }
}

void MedianHashIndex::radiusAll(double radius, RadiusNeighborhoods& out, unsigned int max_nn,
                                bool with_distances) const {
  const Impl& self = *impl_;
  const Layout& layout = self.layout;
  out.reset(self.rows, with_distances);
  const float limit = squaredLimit(radius);
  if (!(radius > 0.0) || !(limit > 0.0F)) return out.finishCounts();
  const LayoutView view(layout);
  const auto regions = static_cast<std::int64_t>(layout.regions.size());
  const int threads = resolveThreads(self.options.threads);
  std::vector<RegionRows> found(layout.regions.size());
#pragma omp parallel num_threads(threads) if (threads > 1)
  {
    GroupWork work(layout, kRadiusBlock, 4 * kRadiusBlock);
    GroupTask& task = work.task;
    task.k = max_nn > 0 ? max_nn : std::numeric_limits<std::uint32_t>::max();
    task.limit = limit;
    std::size_t expected = 1024;
#pragma omp for schedule(dynamic, 1)
    for (std::int64_t i = 0; i < regions; ++i) {
      const auto r = static_cast<std::size_t>(i);
      const Region& region = layout.regions[r];
      task.rows = &found[r].start(region, expected, with_distances);
      self.withinOfRegion(r, radius, task);
      expected = task.rows->used + task.rows->used / 4 + 1024;
      for (std::size_t p = region.begin; p < region.end; ++p) {
        out.setCount(view.row[p], task.rows->count[p - region.begin]);
      }
    }
  }
  out.finishCounts();
#pragma omp parallel for num_threads(threads) schedule(dynamic, 1) if (threads > 1)
  for (std::int64_t i = 0; i < regions; ++i) {
    const auto r = static_cast<std::size_t>(i);
    const Region& region = layout.regions[r];
    const RowBuffer& rows = found[r].buffer();
    for (std::size_t p = region.begin; p < region.end; ++p) {
      const std::size_t from = rows.begin[p - region.begin];
      const std::size_t row = view.row[p];
      const std::size_t count = rows.count[p - region.begin];
      std::copy_n(rows.indices + from, count, out.mutableIndices(row));
      if (with_distances) std::copy_n(rows.distances + from, count, out.mutableSqrDistances(row));
    }
    found[r].clear();
  }
}

}  // namespace segorient::search
