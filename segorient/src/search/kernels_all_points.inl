// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
//
// The all-points searches of a region, group by group.

// Asks for the memory of a row of the output.
inline void prefetchRow(const GroupTask& task, std::size_t at, std::size_t count) {
  for (std::size_t j = 0; j < count; j += 64 / sizeof(float)) {
    prefetchToWrite(task.indices + at + j);
    if (task.distances != nullptr) prefetchToWrite(task.distances + at + j);
  }
  // A row does not begin where a line does.
  prefetchToWrite(task.indices + at + count - 1);
  if (task.distances != nullptr) prefetchToWrite(task.distances + at + count - 1);
}

// ---------------------------------------------------------------------------------------------------
// The k nearest

inline void writeNearest(const LayoutView& view, Group& group, RegionState& state,
                         GroupTask& task) {
  sortMembers(group, task.k, task);
  for (std::size_t m = 0; m < group.found_count; ++m) {
    const Group::Member& member = group.found[m];
    state.most = largest(state.most, member.distance[task.k - 1]);
    const std::size_t at = task.rowOf(member.point) * task.row_length;
    copyRow(member.id, member.distance, view.id[member.point], task.k, task.indices + at,
            task.distances == nullptr ? nullptr : task.distances + at);
  }
}

// Searches within `reach` of the group; the points that this was too little for go on waiting.
// \return false if there was no room for all that is within reach
inline bool nearestWithin(const LayoutView& view, float reach, Group& group, RegionState& state,
                          GroupTask& task) {
  if (!gather(view, group.box, reach, state, task)) return false;
  const std::size_t half = task.candidate_capacity / 2;
  Candidates room[2] = {{task.candidate_distance, task.candidate_id, 0, half},
                        {task.candidate_distance + half, task.candidate_id + half, 0, half}};
  std::size_t left = 0;
  group.found_count = 0;
  for (std::size_t i = 0; i < group.waiting_count; i += 2) {
    const std::size_t points = i + 1 < group.waiting_count ? 2 : 1;
    const std::uint32_t point[2] = {group.waiting[i], group.waiting[i + points - 1]};
    const float q[2][3] = {{view.x[point[0]], view.y[point[0]], view.z[point[0]]},
                           {view.x[point[1]], view.y[point[1]], view.z[point[1]]}};
    const float first = firstLimit(state.guess, reach);
    takeNearTwo(task.block, q[0], q[1], first, room[0], room[1]);
    float typical = 0.0F;
    for (std::size_t j = 0; j < points; ++j) {
      float limit = first;
      if (settleLimit(task.block, q[j], reach, task.k, limit, room[j])) {
        typical += typicalOf(limit, task.k, room[j].count);
        addMember(point[j], limit, room[j], group);
      } else {
        typical += state.guess.typical;
        group.waiting[left++] = point[j];
      }
    }
    state.guess.typical = typical / static_cast<float>(points);
  }
  group.waiting_count = left;
  writeNearest(view, group, state, task);
  return true;
}

SEGORIENT_APART void nearestOfGroup(const LayoutView& view, std::uint32_t begin, std::uint32_t end,
                                    RegionState& state, GroupTask& task) {
  for (std::uint32_t i = begin; i < end; ++i) {
    prefetchRow(task, task.rowOf(i) * task.row_length, task.k);
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

// Moves a point to the front of its row, as copyRow() does.
inline void putSelfFirst(std::uint32_t* id, std::uint32_t self, std::size_t count) {
  if (id[0] == self) return;
  std::size_t at = 1;
  while (at < count && id[at] != self) ++at;
  for (std::size_t i = at < count ? at : count - 1; i > 0; --i) id[i] = id[i - 1];
  id[0] = self;
}

// Sorts a point's candidates to where its row begins; what is written beyond the row belongs to the
// next one.
inline void writeRow(const LayoutView& view, const Group::Member& member, std::size_t count,
                     GroupTask& task) {
  const RowBuffer& rows = task.rows;
  const std::uint32_t self = view.id[member.point];
  pcl::index_t* const indices = rows.indices + rows.used;
  float* const distances = rows.distances == nullptr ? nullptr : rows.distances + rows.used;
  if (member.count > kMostAtOnce) {
    sortNearest(member.distance, member.id, member.count, count, member.limit, task.sort);
    copyRow(task.sort.id, task.sort.distance, self, count, indices, distances);
    return;
  }
  float* const sorted = distances == nullptr ? member.distance : distances;
  if constexpr (sizeof(pcl::index_t) == sizeof(std::uint32_t)) {
    auto* const id = reinterpret_cast<std::uint32_t*>(indices);
    sortAtOnce(member.distance, member.id, member.count, sorted, id);
    putSelfFirst(id, self, count);
  } else {
    sortAtOnce(member.distance, member.id, member.count, sorted, member.id);
    copyRow(member.id, sorted, self, count, indices, nullptr);
  }
}

inline void writeWithin(const LayoutView& view, const Group& group, std::uint32_t region_begin,
                        GroupTask& task) {
  RowBuffer& rows = task.rows;
  for (std::size_t m = 0; m < group.found_count; ++m) {
    const Group::Member& member = group.found[m];
    const std::size_t needed = rows.used + member.count + kSortRoom;
    if (needed > rows.capacity) rows.grow(rows, needed);
    const std::uint32_t count = member.count < task.k ? member.count : task.k;
    writeRow(view, member, count, task);
    rows.begin[member.point - region_begin] = rows.used;
    rows.count[member.point - region_begin] = count;
    rows.used += count;
  }
}

SEGORIENT_APART void withinOfGroup(const LayoutView& view, std::uint32_t begin, std::uint32_t end,
                                   RegionState& state, GroupTask& task) {
  Group group;
  startGroup(view, begin, end, group);
  // Where there are many more than are wanted, the nearest are found without looking at all.
  const bool gathered = gather(view, group.box, task.limit, state, task) &&
                        task.block.count <= mostCollected(task.max_nn);
  group.found_count = 0;
  const std::size_t half = task.candidate_capacity / 2;
  // Whole vectors are taken, and what sorting needs behind them is filled.
  const std::size_t most = task.block.count + (kWidth > kSortRoom ? kWidth : kSortRoom);
  Candidates room[2] = {{task.candidate_distance, task.candidate_id, 0, half},
                        {task.candidate_distance + half, task.candidate_id + half, 0, half}};
  for (std::uint32_t i = begin; i < end; i += 2) {
    const std::uint32_t points = i + 1 < end ? 2 : 1;
    const std::uint32_t point[2] = {i, i + points - 1};
    bool enough = gathered;
    for (std::size_t j = 0; j < 2; ++j) {
      const float* const start = task.candidate_distance + j * half;
      const auto used = static_cast<std::size_t>(room[j].distance - start);
      enough = enough && used + most <= half;
    }
    if (enough) {
      const float q[2][3] = {{view.x[point[0]], view.y[point[0]], view.z[point[0]]},
                             {view.x[point[1]], view.y[point[1]], view.z[point[1]]}};
      takeNearTwo(task.block, q[0], q[1], task.limit, room[0], room[1]);
    }
    for (std::size_t j = 0; j < points; ++j) {
      if (!enough || room[j].count > kMostToSort) {
        task.failed[task.failed_count++] = point[j];
        continue;
      }
      padCandidates(room[j].distance, room[j].id, room[j].count);
      addMember(point[j], task.limit, room[j], group);
    }
  }
  writeWithin(view, group, view.regions[state.region].begin, task);
}

// ---------------------------------------------------------------------------------------------------
// Regions

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
  const float prune = task.epsilon > 0.0F ? 0.999999F / (bound * bound) : 1.0F;
  RegionState state{r, {task.margin, spacing, 0.0F}, spacing, -1.0F, 0, prune};
  forGroups(view, region, [&](std::uint32_t begin, std::uint32_t end) {
    nearestOfGroup(view, begin, end, state, task);
  });
}

void withinInRegion(const LayoutView& view, std::size_t r, GroupTask& task) {
  const Region& region = view.regions[r];
  task.failed_count = 0;
  if (!(task.limit < kInfinity)) return failAll(region, task);
  RegionState state{r, {1.0F, 0.0F, 0.0F}, 0.0F, -1.0F, 0, 1.0F};
  forGroups(view, region, [&](std::uint32_t begin, std::uint32_t end) {
    withinOfGroup(view, begin, end, state, task);
  });
}
