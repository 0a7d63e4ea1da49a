// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
//
// The all-points searches of a region, group by group.

// ---------------------------------------------------------------------------------------------------
// The k nearest

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
    Candidates found{task.candidate_distance + used, task.candidate_id + used, 0, 0};
    if (takeNearest(task.block, q, reach, task.k, state.guess, found)) {
      group.found[group.found_count++] = {point, static_cast<std::uint32_t>(found.count), used,
                                          state.guess.limit};
      used += wholeLines(found.count + kSortRoom);
    } else {
      group.waiting[left++] = point;
    }
  }
  group.waiting_count = left;
  writeNearest(view, group, state, task);
  return true;
}

SEGORIENT_APART void nearestOfGroup(const LayoutView& view, std::uint32_t begin, std::uint32_t end,
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
    if (!gathered || used + task.block.count + kWidth > task.candidate_capacity) {
      task.failed[task.failed_count++] = i;
      continue;
    }
    const float q[3] = {view.x[i], view.y[i], view.z[i]};
    const std::size_t count = takeNear(task.block, q, task.limit, task.candidate_distance + used,
                                       task.candidate_id + used);
    if (count > kMostToSort) {
      task.failed[task.failed_count++] = i;
      continue;
    }
    padCandidates(task.candidate_distance + used, task.candidate_id + used, count);
    group.found[group.found_count++] = {i, static_cast<std::uint32_t>(count), used, task.limit};
    used += wholeLines(count + kSortRoom);
  }
  writeWithin(view, group, state, task);
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
