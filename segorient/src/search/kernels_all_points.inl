// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
//
// The all-points search of a region; included after kernels.inl and under the same rules.

// Appends the points of a range that are near a box to a block.
struct GatherFromRange {
  const LayoutView& view;
  AllPointsTask& task;
  Vector lo[3], hi[3], limit;
  std::size_t count;

  inline bool operator()(std::uint32_t begin, std::uint32_t end) {
    if (count + (end - begin) > task.block_capacity) return false;
    const LayoutView v = view;
    float* const block[3] = {task.block[0], task.block[1], task.block[2]};
    std::uint32_t* const id = task.block_id;
    const Vector low[3] = {lo[0], lo[1], lo[2]};
    const Vector high[3] = {hi[0], hi[1], hi[2]};
    const Vector bound = limit;
    const Vector zero = broadcast(0.0F);
    std::size_t n = count;
    for (std::uint32_t i = begin; i < end; i += kWidth) {
      const Vector x = load(v.x + i);
      const Vector y = load(v.y + i);
      const Vector z = load(v.z + i);
      const Vector dx = largestOf(largestOf(sub(low[0], x), sub(x, high[0])), zero);
      const Vector dy = largestOf(largestOf(sub(low[1], y), sub(y, high[1])), zero);
      const Vector dz = largestOf(largestOf(sub(low[2], z), sub(z, high[2])), zero);
      unsigned int mask = lessMask(squaredNorm(dx, dy, dz), bound);
      if (end - i < kWidth) mask &= (1U << (end - i)) - 1U;
      compress(x, mask, block[0] + n);
      compress(y, mask, block[1] + n);
      compress(z, mask, block[2] + n);
      n += compressIds(v.id + i, mask, id + n);
    }
    count = n;
    return true;
  }
};

// Regions other than `region` that come nearer to its box than the square root of `limit`.
std::size_t listNeighbors(const LayoutView& view, std::size_t region, float limit,
                          std::uint32_t* out) {
  const Box& box = view.boxes[view.region_count + region];
  std::size_t stack[64];
  std::size_t depth = 0;
  std::size_t count = 0;
  stack[depth++] = 1;
  while (depth > 0) {
    const std::size_t i = stack[--depth];
    if (!(squaredGap(view.boxes[i], box) < limit)) continue;
    if (i < view.region_count) {
      stack[depth++] = 2 * i;
      stack[depth++] = 2 * i + 1;
    } else if (i - view.region_count != region) {
      out[count++] = static_cast<std::uint32_t>(i - view.region_count);
    }
  }
  return count;
}

// Points of a group: enough to share the work of gathering, few enough to be near each other.
constexpr std::uint32_t kGroup = 16;
// A group may be smaller rather than longer than this many cells.
constexpr std::uint32_t kMostCells = 3;

// What is carried from group to group of a region.
struct RegionState {
  std::size_t region;
  float typical;  // squared distance to the k-th neighbour, lately
  float most;     // the same, the largest of a group
  float listed;   // reach of the list of neighbouring regions
  std::size_t neighbors;
  float prune;  // factor on squared reaches, 1 where the search is exact
};

// Fills the block with all points nearer to the group's box than the square root of `limit`.
// \return how many, or more than the block holds
inline std::size_t gather(const LayoutView& view, const Box& box, float limit, RegionState& state,
                          AllPointsTask& task) {
  const float reach = limit * state.prune;
  GatherFromRange take{view,
                       task,
                       {broadcast(box.lo[0]), broadcast(box.lo[1]), broadcast(box.lo[2])},
                       {broadcast(box.hi[0]), broadcast(box.hi[1]), broadcast(box.hi[2])},
                       broadcast(reach),
                       0};
  const std::size_t too_many = task.block_capacity + 1;
  if (!forRanges(view, state.region, box, reach, task.k, take)) return too_many;
  if (!(reach <= state.listed)) {
    state.listed = 2.0F * reach;
    state.neighbors = listNeighbors(view, state.region, state.listed, task.neighbors);
  }
  for (std::size_t j = 0; j < state.neighbors; ++j) {
    const std::size_t other = task.neighbors[j];
    if (!(squaredGap(view.boxes[view.region_count + other], box) < reach)) continue;
    if (!forRanges(view, other, box, reach, task.k, take)) return too_many;
  }
  return take.count;
}

// Distances of one query to the whole block; returns how many are below `limit`.
inline std::size_t blockDistances(const AllPointsTask& task, std::size_t block, const float* q,
                                  float limit) {
  const Vector qx = broadcast(q[0]);
  const Vector qy = broadcast(q[1]);
  const Vector qz = broadcast(q[2]);
  const Vector threshold = broadcast(limit);
  const float* const x = task.block[0];
  const float* const y = task.block[1];
  const float* const z = task.block[2];
  float* const distance = task.block_distance;
  Counter counter = zeroCounter();
  for (std::size_t i = 0; i < block; i += kWidth) {
    const Vector dx = sub(qx, load(x + i));
    const Vector dy = sub(qy, load(y + i));
    const Vector dz = sub(qz, load(z + i));
    const Vector d = squaredNorm(dx, dy, dz);
    store(distance + i, d);
    counter = countLess(counter, d, threshold);
  }
  return total(counter);
}

inline std::size_t countBelow(const AllPointsTask& task, std::size_t block, float limit) {
  const Vector threshold = broadcast(limit);
  const float* const distance = task.block_distance;
  Counter counter = zeroCounter();
  for (std::size_t i = 0; i < block; i += kWidth) {
    counter = countLess(counter, load(distance + i), threshold);
  }
  return total(counter);
}

// Copies the distances below `limit` and their ids out of the block.
inline void takeBelow(AllPointsTask& task, std::size_t block, float limit) {
  const Vector threshold = broadcast(limit);
  const float* const distance = task.block_distance;
  const std::uint32_t* const id = task.block_id;
  float* const out_distance = task.candidates.distance;
  std::uint32_t* const out_id = task.candidates.id;
  std::size_t count = 0;
  for (std::size_t i = 0; i < block; i += kWidth) {
    const Vector d = load(distance + i);
    const unsigned int mask = lessMask(d, threshold);
    compress(d, mask, out_distance + count);
    count += compressIds(id + i, mask, out_id + count);
  }
  task.candidates.count = count;
}

// A row begins with the point itself, also where others are in the same place.
inline void writeRow(const AllPointsTask& task, std::uint32_t row, std::uint32_t self) {
  const std::uint32_t* id = task.sort.id;
  pcl::index_t* indices = task.indices + row * task.row_length;
  if (id[0] == self) {
    for (std::size_t i = 0; i < task.k; ++i) indices[i] = static_cast<pcl::index_t>(id[i]);
  } else {
    std::size_t from = 0;
    indices[0] = static_cast<pcl::index_t>(self);
    bool skipped = false;
    for (std::size_t i = 1; i < task.k; ++i) {
      if (!skipped && id[from] == self) {
        skipped = true;
        ++from;
      }
      indices[i] = static_cast<pcl::index_t>(id[from++]);
    }
  }
  if (task.distances != nullptr) {
    float* distances = task.distances + row * task.row_length;
    for (std::size_t i = 0; i < task.k; ++i) distances[i] = task.sort.distance[i];
  }
}

// One query over a block that holds everything nearer than the square root of `reach`. Starting
// from a guess, looks for a threshold that lets through k candidates and not many more. \return
// false if fewer than k are in reach
inline bool searchBlock(const LayoutView& view, std::uint32_t point, std::size_t block, float reach,
                        RegionState& state, AllPointsTask& task) {
  const float q[3] = {view.x[point], view.y[point], view.z[point]};
  const std::size_t k = task.k;
  const std::size_t enough = k + k / 2 + 8;
  float threshold = smallest(task.margin * state.typical, reach);
  std::size_t count = blockDistances(task, block, q, threshold);
  float too_low = 0.0F;
  for (int attempt = 0; count < k || (count > enough && attempt < 3); ++attempt) {
    if (count < k) {
      if (threshold == reach) return false;
      too_low = threshold;
      const float factor = 1.25F * static_cast<float>(k) / static_cast<float>(count + 1);
      threshold = attempt > 4 ? reach : smallest(largest(factor, 1.2F) * threshold, reach);
    } else {
      const float factor = 1.25F * static_cast<float>(k) / static_cast<float>(count);
      const float lower = largest(factor * threshold, 0.5F * (too_low + threshold));
      const std::size_t fewer = countBelow(task, block, lower);
      if (fewer < k) break;
      threshold = lower;
      count = fewer;
      continue;
    }
    count = countBelow(task, block, threshold);
  }
  if (count > kMostToSort) return false;
  takeBelow(task, block, threshold);
  sortNearest(task.candidates, k, threshold, task.sort);
  state.typical = largest(task.sort.distance[k - 1], 1e-44F);
  state.most = largest(state.most, state.typical);
  writeRow(task, view.row[point], view.id[point]);
  return true;
}

// One group: points next to each other in the layout that share a block of candidates.
struct Group {
  std::uint32_t points[2 * kGroup];
  std::size_t count;
};

inline Box groupBox(const LayoutView& view, const Group& group) {
  const float* coordinates[3] = {view.x, view.y, view.z};
  Box box;
  for (int a = 0; a < 3; ++a) {
    const float* c = coordinates[a];
    float lo = c[group.points[0]];
    float hi = lo;
    for (std::size_t i = 1; i < group.count; ++i) {
      lo = smallest(lo, c[group.points[i]]);
      hi = largest(hi, c[group.points[i]]);
    }
    box.lo[a] = lo;
    box.hi[a] = hi;
  }
  return box;
}

// Searches what is within `reach` of the group; leaves in it the points that this was too little
// for.
// \return false if there was no room for all that is within reach
inline bool searchWithin(const LayoutView& view, float reach, Group& group, RegionState& state,
                         AllPointsTask& task) {
  const std::size_t block = gather(view, groupBox(view, group), reach, state, task);
  if (block > task.block_capacity) return false;
  for (std::size_t i = 0; i < kWidth; ++i) {
    task.block[0][block + i] = kInfinity;
    task.block[1][block + i] = 0.0F;
    task.block[2][block + i] = 0.0F;
    task.block_id[block + i] = 0;
  }
  std::size_t left = 0;
  for (std::size_t i = 0; i < group.count; ++i) {
    if (!searchBlock(view, group.points[i], block, reach, state, task)) {
      group.points[left++] = group.points[i];
    }
  }
  group.count = left;
  return true;
}

void searchGroup(const LayoutView& view, std::uint32_t begin, std::uint32_t end, RegionState& state,
                 AllPointsTask& task) {
  Group group;
  group.count = end - begin;
  for (std::uint32_t i = begin; i < end; ++i) {
    group.points[i - begin] = i;
    const pcl::index_t* row = task.indices + view.row[i] * task.row_length;
    for (std::size_t j = 0; j < task.k; j += 64 / sizeof(pcl::index_t)) prefetchForWrite(row + j);
  }
  float reach = task.margin * state.most;
  state.most = 0.0F;
  for (int attempt = 0; attempt < 3 && group.count > 0; ++attempt) {
    reach *= searchWithin(view, reach, group, state, task) ? 1.6F : 0.4F;
  }
  for (std::size_t i = 0; i < group.count; ++i) task.failed[task.failed_count++] = group.points[i];
  if (group.count > 0) state.most = largest(state.most, 0.6F * reach);
  state.most = largest(state.most, 1e-44F);
}

void allInRegion(const LayoutView& view, std::size_t r, AllPointsTask& task) {
  const Region& region = view.regions[r];
  const float bound = 1.0F + task.epsilon;
  const float relative = static_cast<float>(task.k) / 16.0F;
  const float spacing = largest(region.spacing16 * relative, 1e-44F);
  RegionState state{r,     spacing, spacing,
                    -1.0F, 0,       task.epsilon > 0.0F ? 0.999999F / (bound * bound) : 1.0F};
  task.failed_count = 0;
  if (region.identical != 0) {
    for (std::uint32_t i = region.begin; i < region.end; ++i) task.failed[task.failed_count++] = i;
    return;
  }
  const std::uint16_t* starts = view.starts + region.first_start;
  const std::uint32_t row_length = region.counts[0];
  const std::size_t rows = static_cast<std::size_t>(region.counts[1]) * region.counts[2];
  for (std::size_t row = 0; row < rows; ++row) {
    const std::uint16_t* cells = starts + row * row_length;
    std::uint32_t begin = cells[0];
    std::uint32_t first_cell = 0;
    for (std::uint32_t c = 0; c < row_length; ++c) {
      const std::uint32_t end = cells[c + 1];
      if (begin == end) first_cell = c + 1;
      const bool last = c + 1 == row_length || c + 1 == first_cell + kMostCells;
      while (end - begin >= kGroup || (last && begin != end)) {
        const std::uint32_t size = end - begin < 2 * kGroup ? end - begin : kGroup;
        searchGroup(view, region.begin + begin, region.begin + begin + size, state, task);
        begin += size;
        first_cell = c + 1;
      }
    }
  }
}
