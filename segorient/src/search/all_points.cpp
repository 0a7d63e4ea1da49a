// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors

#include <omp.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <vector>

#include "common/parallel_for.h"
#include "search/index_impl.h"

namespace segorient::search {
namespace {

// About how long it takes, in ns, to find one more neighbour of a point, and a row of a radius
// search.
constexpr double kNeighborTime = 20.0;
constexpr double kRowTime = 500.0;

// Most points that a group of a radius search shares.
constexpr std::size_t kRadiusBlock = 8192;

// The work space of one thread.
class GroupWork {
 public:
  // \param wanted what to search for and where the results go
  // \param block most points that a group shares
  // \param candidates most candidates that the points of a group have in all
  GroupWork(const Layout& layout, const GroupTask& wanted, std::size_t block,
            std::size_t candidates)
      : task(wanted) {
    const std::size_t block_length = wholeLines(block + Layout::kPadding);
    const std::size_t length = wholeLines(candidates + Layout::kPadding);
    floats_.resize(3 * block_length + length + kLine);
    ids_.resize(block_length + length + layout.regions.size() + kLine);
    std::size_t most = 0;
    for (const Region& r : layout.regions) most = std::max<std::size_t>(most, r.end - r.begin);
    failed_.resize(most);
    begin_.resize(most);
    count_.resize(most);
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
    task.rows.begin = begin_.data();
    task.rows.count = count_.data();
  }

  GroupTask task;

 private:
  std::vector<float> floats_;
  std::vector<std::uint32_t> ids_;
  std::vector<std::uint32_t> failed_;
  std::vector<std::size_t> begin_;
  std::vector<std::uint32_t> count_;
  SortRoom sort_;
};

// Makes room in a part of the table.
void growPart(RowBuffer& rows, std::size_t capacity) {
  auto& part = *static_cast<RadiusNeighborhoods::Part*>(rows.owner);
  rows.capacity = std::max(capacity, 2 * rows.capacity);
  part.indices.resize(rows.capacity);
  part.distances.resize(rows.with_distances ? rows.capacity : 0);
  rows.indices = part.indices.data();
  rows.distances = rows.with_distances ? part.distances.data() : nullptr;
}

// Calls search(region, task) for all regions, each thread with a task of its own.
// \param nanoseconds a point, see resolveThreads()
template <typename Search>
void forAllRegions(const Layout& layout, int threads, double nanoseconds, const GroupTask& wanted,
                   std::size_t block, std::size_t candidates, Search&& search) {
  const std::size_t regions = layout.regions.size();
  parallelFor(
      regions, threads, timeOfEach(regions, layout.size(), nanoseconds),
      [&] { return GroupWork(layout, wanted, block, candidates); },
      [&](std::size_t r, GroupWork& work) { search(r, work.task); });
}

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
    const std::size_t row = task.rowOf(point);
    float* distances = out.mutableSqrDistances(row);
    searchSelf(point, task.k, task.epsilon, out.mutableIndices(row),
               distances != nullptr ? distances : unwanted.data());
  }
}

void MedianHashIndex::nearestKAll(int k, Neighborhoods& out, bool with_distances,
                                  float epsilon) const {
  const Impl& self = *impl_;
  const std::size_t wanted = std::min(static_cast<std::size_t>(std::max(k, 0)), size());
  try {
    if (size() == self.rows) {
      out.resetFull(self.rows, k, static_cast<int>(wanted), with_distances);
    } else {
      // Rows that are not finite stay empty.
      out.reset(self.rows, k, with_distances);
      const LayoutView view(self.layout);
      for (std::size_t i = 0; i < size(); ++i) {
        out.setCount(view.row[i], static_cast<int>(wanted));
      }
    }
    if (wanted > 0) self.nearestOfAll(wanted, epsilon, out);
  } catch (...) {
    out = Neighborhoods();
    throw;
  }
}

void MedianHashIndex::Impl::nearestOfRegions(GroupTask task, const RegionSearch& search) const {
  const std::size_t wanted = task.k;
  const std::size_t shared = std::min(wanted, kMostNeighborsShared);
  // The relative deviation of the k-th squared distance falls with the root of k.
  task.margin = 1.0F + kMargin / std::sqrt(static_cast<float>(wanted));
  // A group has up to 31 points with up to some 3 k + 104 candidates each, in two halves.
  const std::size_t block = 2048 + 16 * shared;
  const std::size_t half = block + Layout::kPadding + 16 * (3 * shared + 112);
  forAllRegions(layout, options.threads, kNeighborTime * static_cast<double>(wanted), task, block,
                2 * wholeLines(half), search);
}

void MedianHashIndex::Impl::nearestOfAll(std::size_t wanted, float epsilon,
                                         Neighborhoods& out) const {
  GroupTask task{};
  task.k = static_cast<std::uint32_t>(wanted);
  task.epsilon = epsilon > 0.0F ? epsilon : 0.0F;
  task.indices = out.mutableIndices(0);
  task.distances = out.mutableSqrDistances(0);
  task.row_length = static_cast<std::size_t>(out.k());
  task.row = LayoutView(layout).row;
  nearestOfRegions(task, [&](std::size_t region, GroupTask& of_thread) {
    nearestOfRegion(region, of_thread, out);
  });
}

void MedianHashIndex::nearestKByRegion(int k, const RegionTaker& take) const {
  const Impl& self = *impl_;
  const std::size_t wanted = std::min(static_cast<std::size_t>(std::max(k, 0)), size());
  if (wanted == 0) return;
  struct Room {
    Neighborhoods table;
    std::vector<std::uint32_t> ascending;
    std::vector<pcl::index_t> rows;
  };
  GroupTask task{};
  task.k = static_cast<std::uint32_t>(wanted);
  task.row_length = wanted;
  const LayoutView view(self.layout);
  std::vector<Room> rooms(static_cast<std::size_t>(resolveThreads(self.options.threads)));
  self.nearestOfRegions(task, [&](std::size_t region, GroupTask& of_thread) {
    Room& room = rooms[static_cast<std::size_t>(omp_get_thread_num())];
    const Region& r = view.regions[region];
    const std::size_t n = r.end - r.begin;
    room.table.resetFull(n, static_cast<int>(wanted), static_cast<int>(wanted), false);
    room.rows.assign(view.row + r.begin, view.row + r.end);
    for (std::size_t i = room.ascending.size(); i < n; ++i) {
      room.ascending.push_back(static_cast<std::uint32_t>(i));
    }
    of_thread.indices = room.table.mutableIndices(0);
    of_thread.row = room.ascending.data();
    of_thread.first = r.begin;
    self.nearestOfRegion(region, of_thread, room.table);
    take(room.rows, room.table);
  });
}

// Points that no group could search for are searched for one by one.
void MedianHashIndex::Impl::withinOfRegion(std::size_t region, double radius, GroupTask& task,
                                           RadiusNeighborhoods& out) const {
  const LayoutView view(layout);
  const Region& r = view.regions[region];
  RowBuffer& buffer = task.rows;
  kernels->withinInRegion(view, region, task);
  std::vector<pcl::index_t> indices;
  std::vector<float> distances;
  for (std::size_t i = 0; i < task.failed_count; ++i) {
    const std::size_t point = task.failed[i];
    const float q[3] = {view.x[point], view.y[point], view.z[point]};
    searchRadius(q, radius, indices, distances, task.max_nn, true);
    const std::size_t count = indices.size();
    putFirst(static_cast<pcl::index_t>(view.id[point]), indices.data(), count);
    if (buffer.used + count > buffer.capacity) buffer.grow(buffer, buffer.used + count);
    std::copy_n(indices.begin(), count, buffer.indices + buffer.used);
    if (buffer.distances != nullptr)
      std::copy_n(distances.begin(), count, buffer.distances + buffer.used);
    buffer.begin[point - r.begin] = buffer.used;
    buffer.count[point - r.begin] = static_cast<std::uint32_t>(count);
    buffer.used += count;
  }
  for (std::size_t i = r.begin; i < r.end; ++i) {
    out.setRow(view.row[i], region, buffer.begin[i - r.begin], buffer.count[i - r.begin]);
  }
}

void MedianHashIndex::radiusAll(double radius, RadiusNeighborhoods& out, unsigned int max_nn,
                                bool with_distances) const {
  const Impl& self = *impl_;
  const float limit = squaredLimit(radius);
  GroupTask task{};
  task.k = max_nn > 0 ? max_nn : std::numeric_limits<std::uint32_t>::max();
  task.max_nn = max_nn;
  task.limit = limit;
  task.rows.grow = growPart;
  task.rows.with_distances = with_distances;
  std::atomic<std::size_t> expected{1024};
  const auto search = [&](std::size_t region, GroupTask& of_thread) {
    RadiusNeighborhoods::Part& part = out.part(region);
    RowBuffer& buffer = of_thread.rows;
    buffer.owner = &part;
    buffer.used = 0;
    buffer.capacity = 0;
    growPart(buffer, part.indices.empty() ? expected.load() : part.indices.size());
    self.withinOfRegion(region, radius, of_thread, out);
    part.used = buffer.used;
    expected = buffer.used + buffer.used / 4;
  };
  try {
    out.reset(self.rows, self.layout.regions.size(), with_distances);
    if (!(radius > 0.0) || !(limit > 0.0F)) return;
    forAllRegions(self.layout, self.options.threads, kRowTime, task, kRadiusBlock, 4 * kRadiusBlock,
                  search);
  } catch (...) {
    out = RadiusNeighborhoods();
    throw;
  }
}

}  // namespace segorient::search
