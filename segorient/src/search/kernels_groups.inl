// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
//
// The all-points searches of a region: points next to each other share a block of candidates.

// Appends the points of a range that are near a box to a block.
struct GatherFromRange {
  const LayoutView& view;
  GroupTask& task;
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
      const Vector dx = largestOf(largestOf(low[0] - x, x - high[0]), zero);
      const Vector dy = largestOf(largestOf(low[1] - y, y - high[1]), zero);
      const Vector dz = largestOf(largestOf(low[2] - z, z - high[2]), zero);
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

// Points next to each other in the layout that share a block, and the candidates of each.
struct Group {
  struct Member {
    std::uint32_t point;
    std::uint32_t count;  // of its candidates
    std::size_t first;    // where they are
    float limit;          // they are nearer than this
  };
  Box box;
  std::uint32_t waiting[2 * kGroup];  // points not yet searched for
  std::size_t waiting_count;
  Member found[2 * kGroup];
  std::size_t found_count;
};

inline void startGroup(const LayoutView& view, std::uint32_t begin, std::uint32_t end,
                       Group& group) {
  Box box{{view.x[begin], view.y[begin], view.z[begin]},
          {view.x[begin], view.y[begin], view.z[begin]}};
  for (std::uint32_t i = begin + 1; i < end; ++i) {
    const float p[3] = {view.x[i], view.y[i], view.z[i]};
    for (int a = 0; a < 3; ++a) {
      box.lo[a] = smallest(box.lo[a], p[a]);
      box.hi[a] = largest(box.hi[a], p[a]);
    }
  }
  group.box = box;
  group.waiting_count = end - begin;
  for (std::uint32_t i = begin; i < end; ++i) group.waiting[i - begin] = i;
}

// Fills the block with all points nearer to the group's box than the square root of `limit`.
// \return false if the block does not hold them
inline bool gather(const LayoutView& view, const Box& box, float limit, RegionState& state,
                   GroupTask& task) {
  const float reach = limit * state.prune;
  GatherFromRange take{view,
                       task,
                       {broadcast(box.lo[0]), broadcast(box.lo[1]), broadcast(box.lo[2])},
                       {broadcast(box.hi[0]), broadcast(box.hi[1]), broadcast(box.hi[2])},
                       broadcast(reach),
                       0};
  if (!forRanges(view, state.region, box, reach, take)) return false;
  if (!(reach <= state.listed)) {
    state.listed = 2.0F * reach;
    state.neighbors = listNeighbors(view, state.region, state.listed, task.neighbors);
  }
  for (std::size_t j = 0; j < state.neighbors; ++j) {
    const std::size_t other = task.neighbors[j];
    if (!(squaredGap(view.boxes[view.region_count + other], box) < reach)) continue;
    if (!forRanges(view, other, box, reach, take)) return false;
  }
  // Up to a full vector, points that are never near.
  for (std::size_t i = take.count; i < take.count + kWidth; ++i) {
    task.block[0][i] = kInfinity;
    task.block[1][i] = 0.0F;
    task.block[2][i] = 0.0F;
    task.block_id[i] = 0;
  }
  task.block_count = take.count;
  return true;
}

// Copies what is nearer to a point than the square root of `limit` out of the block.
// \return how many
inline std::size_t takeNear(const GroupTask& task, const float* q, float limit, float* out_distance,
                            std::uint32_t* out_id) {
  const Vector qx = broadcast(q[0]);
  const Vector qy = broadcast(q[1]);
  const Vector qz = broadcast(q[2]);
  const Vector bound = broadcast(limit);
  const float* const x = task.block[0];
  const float* const y = task.block[1];
  const float* const z = task.block[2];
  const std::uint32_t* const id = task.block_id;
  const std::size_t block = task.block_count;
  std::size_t count = 0;
  for (std::size_t i = 0; i < block; i += kWidth) {
    const Vector d = squaredNorm(qx - load(x + i), qy - load(y + i), qz - load(z + i));
    const unsigned int mask = lessMask(d, bound);
    compress(d, mask, out_distance + count);
    count += compressIds(id + i, mask, out_id + count);
  }
  return count;
}

template <typename From, typename To>
inline void copyEntries(const From* from, std::size_t count, To* to) {
  if constexpr (sizeof(From) == sizeof(To)) {
    constexpr std::size_t kStep = 8;
    if (count >= kStep) {
      // The last step goes over entries of the one before it again.
      for (std::size_t i = 0; i + kStep < count; i += kStep) {
        __builtin_memcpy(to + i, from + i, kStep * sizeof(To));
      }
      __builtin_memcpy(to + count - kStep, from + count - kStep, kStep * sizeof(To));
      return;
    }
  }
  for (std::size_t i = 0; i < count; ++i) to[i] = static_cast<To>(from[i]);
}

// Copies a row of a result; it begins with the point itself, also where others are in the same
// place and though it may not be among as many of those.
inline void copyRow(const std::uint32_t* id, const float* distance, std::uint32_t self,
                    std::size_t count, pcl::index_t* indices, float* distances) {
  if (id[0] == self) {
    copyEntries(id, count, indices);
  } else {
    std::size_t from = 0;
    indices[0] = static_cast<pcl::index_t>(self);
    bool skipped = false;
    for (std::size_t i = 1; i < count; ++i) {
      if (!skipped && id[from] == self) {
        skipped = true;
        ++from;
      }
      indices[i] = static_cast<pcl::index_t>(id[from++]);
    }
  }
  if (distances != nullptr) copyEntries(distance, count, distances);
}

// Sorts the candidates of all members, each in its place.
inline void sortMembers(Group& group, std::size_t k, GroupTask& task) {
  for (std::size_t m = 0; m < group.found_count; ++m) {
    const Group::Member& member = group.found[m];
    float* const distance = task.candidate_distance + member.first;
    std::uint32_t* const id = task.candidate_id + member.first;
    if (member.count <= kMostAtOnce) {
      sortAtOnce(distance, id, member.count, distance, id);
      continue;
    }
    const std::size_t kept = member.count < k ? member.count : k;
    sortNearest(distance, id, member.count, kept, member.limit, task.sort);
    copyEntries(task.sort.distance, kept, distance);
    copyEntries(task.sort.id, kept, id);
  }
}

// ---------------------------------------------------------------------------------------------------
// The k nearest

// Candidates of one point from a block that holds everything nearer than the square root of
// `reach`. Starting from a guess, looks for a limit that lets through k candidates and not many
// more.
// \return false if there are fewer in reach
inline bool takeNearest(const float* q, float reach, std::size_t first, RegionState& state,
                        GroupTask& task, Group::Member& member) {
  const std::size_t k = task.k;
  const std::size_t enough = k + k / 2 + 8;
  float* const distance = task.candidate_distance + first;
  std::uint32_t* const id = task.candidate_id + first;
  float limit = smallest(task.margin * state.typical, reach);
  float too_low = 0.0F;
  std::size_t count = takeNear(task, q, limit, distance, id);
  for (int attempt = 0; count < k || (count > enough && attempt < 3); ++attempt) {
    const float factor = 1.25F * static_cast<float>(k) / static_cast<float>(count + 1);
    if (count < k) {
      if (limit == reach) return false;
      too_low = limit;
      limit = attempt > 4 ? reach : smallest(largest(factor, 1.2F) * limit, reach);
    } else {
      limit = largest(factor * limit, 0.5F * (too_low + limit));
    }
    count = takeNear(task, q, limit, distance, id);
  }
  if (count > 2 * enough + 64) {  // many are equally far
    keepNearest(distance, id, count, k);
    count = k;
  }
  padCandidates(distance, id, count);
  member.first = first;
  member.count = static_cast<std::uint32_t>(count);
  member.limit = limit;
  state.typical = largest(limit * static_cast<float>(k) / static_cast<float>(count), 1e-44F);
  return true;
}

inline void writeNearest(const LayoutView& view, Group& group, RegionState& state,
                         GroupTask& task) {
  sortMembers(group, task.k, task);
  for (std::size_t m = 0; m < group.found_count; ++m) {
    const Group::Member& member = group.found[m];
    const float* const distance = task.candidate_distance + member.first;
    state.most = largest(state.most, distance[task.k - 1]);
    const std::size_t at = view.row[member.point] * task.row_length;
    copyRow(task.candidate_id + member.first, distance, view.id[member.point], task.k,
            task.indices + at, task.distances == nullptr ? nullptr : task.distances + at);
  }
}

// Searches within `reach` of the group; the points that this was too little for go on waiting.
// \return false if there was no room for all that is within reach
inline bool nearestWithin(const LayoutView& view, float reach, Group& group, RegionState& state,
                          GroupTask& task) {
  if (!gather(view, group.box, reach, state, task)) return false;
  std::size_t left = 0;
  std::size_t used = 0;
  group.found_count = 0;
  for (std::size_t i = 0; i < group.waiting_count; ++i) {
    const std::uint32_t point = group.waiting[i];
    const float q[3] = {view.x[point], view.y[point], view.z[point]};
    Group::Member& member = group.found[group.found_count];
    if (takeNearest(q, reach, used, state, task, member)) {
      member.point = point;
      ++group.found_count;
      used += member.count + kSortRoom;
    } else {
      group.waiting[left++] = point;
    }
  }
  group.waiting_count = left;
  writeNearest(view, group, state, task);
  return true;
}

void nearestOfGroup(const LayoutView& view, std::uint32_t begin, std::uint32_t end,
                    RegionState& state, GroupTask& task) {
  for (std::uint32_t i = begin; i < end; ++i) {
    const std::size_t row = view.row[i] * task.row_length;
    for (std::size_t j = 0; j < task.k; j += 64 / sizeof(float)) {
      __builtin_prefetch(task.indices + row + j, 1);
      if (task.distances != nullptr) __builtin_prefetch(task.distances + row + j, 1);
    }
  }
  Group group;
  startGroup(view, begin, end, group);
  float reach = task.margin * state.most;
  state.most = 0.0F;
  for (int attempt = 0; attempt < 3 && group.waiting_count > 0; ++attempt) {
    reach *= nearestWithin(view, reach, group, state, task) ? 1.6F : 0.4F;
  }
  for (std::size_t i = 0; i < group.waiting_count; ++i) {
    task.failed[task.failed_count++] = group.waiting[i];
  }
  if (group.waiting_count > 0) state.most = largest(state.most, 0.6F * reach);
  state.most = largest(state.most, 1e-44F);
}

// ---------------------------------------------------------------------------------------------------
// All within a radius

inline void writeWithin(const LayoutView& view, Group& group, RegionState& state, GroupTask& task) {
  sortMembers(group, task.k, task);
  const std::uint32_t region_begin = view.regions[state.region].begin;
  for (std::size_t m = 0; m < group.found_count; ++m) {
    const Group::Member& member = group.found[m];
    const std::size_t count = member.count < task.k ? member.count : task.k;
    RowBuffer& rows = *task.rows;
    if (rows.used + count > rows.capacity) rows.grow(rows, rows.used + count);
    copyRow(task.candidate_id + member.first, task.candidate_distance + member.first,
            view.id[member.point], count, rows.indices + rows.used,
            rows.distances == nullptr ? nullptr : rows.distances + rows.used);
    rows.begin[member.point - region_begin] = rows.used;
    rows.count[member.point - region_begin] = static_cast<std::uint32_t>(count);
    rows.used += count;
  }
}

void withinOfGroup(const LayoutView& view, std::uint32_t begin, std::uint32_t end,
                   RegionState& state, GroupTask& task) {
  Group group;
  startGroup(view, begin, end, group);
  const bool gathered = gather(view, group.box, task.limit, state, task);
  group.found_count = 0;
  std::size_t used = 0;
  for (std::uint32_t i = begin; i < end; ++i) {
    if (!gathered || used + task.block_count + kWidth > task.candidate_capacity) {
      task.failed[task.failed_count++] = i;
      continue;
    }
    const float q[3] = {view.x[i], view.y[i], view.z[i]};
    const std::size_t count =
        takeNear(task, q, task.limit, task.candidate_distance + used, task.candidate_id + used);
    if (count > kMostToSort) {
      task.failed[task.failed_count++] = i;
      continue;
    }
    padCandidates(task.candidate_distance + used, task.candidate_id + used, count);
    group.found[group.found_count++] = {i, static_cast<std::uint32_t>(count), used, task.limit};
    used += count + kSortRoom;
  }
  writeWithin(view, group, state, task);
}

// ---------------------------------------------------------------------------------------------------

// Calls search(begin, end) for groups of points that cover a region.
template <typename Search>
inline void forGroups(const LayoutView& view, const Region& region, Search&& search) {
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
        search(region.begin + begin, region.begin + begin + size);
        begin += size;
        first_cell = c + 1;
      }
    }
  }
}

inline void failAll(const Region& region, GroupTask& task) {
  for (std::uint32_t i = region.begin; i < region.end; ++i) task.failed[task.failed_count++] = i;
}

void nearestInRegion(const LayoutView& view, std::size_t r, GroupTask& task) {
  const Region& region = view.regions[r];
  const float bound = 1.0F + task.epsilon;
  const float relative = static_cast<float>(task.k) / 16.0F;
  const float spacing = largest(region.spacing16 * relative, 1e-44F);
  task.failed_count = 0;
  if (region.flat != 0 || !(spacing < kLargest)) return failAll(region, task);
  RegionState state{r,     spacing, spacing,
                    -1.0F, 0,       task.epsilon > 0.0F ? 0.999999F / (bound * bound) : 1.0F};
  forGroups(view, region, [&](std::uint32_t begin, std::uint32_t end) {
    nearestOfGroup(view, begin, end, state, task);
  });
}

void withinInRegion(const LayoutView& view, std::size_t r, GroupTask& task) {
  const Region& region = view.regions[r];
  task.failed_count = 0;
  if (!(task.limit < kInfinity)) return failAll(region, task);
  RegionState state{r, 0.0F, 0.0F, -1.0F, 0, 1.0F};
  forGroups(view, region, [&](std::uint32_t begin, std::uint32_t end) {
    withinOfGroup(view, begin, end, state, task);
  });
}
