// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
//
// What the all-points searches have in common: points next to each other are a group, which shares
// a block of candidates.

// Appends the points that are near a box to a block.
struct Gatherer {
  const LayoutView& view;
  const Corners& box;
  float reach;
  Block& out;
  std::size_t count;

  // \return false if there may be no room for all
  SEGORIENT_APART bool operator()(VectorList& list) {
    std::size_t n = count;
    const std::size_t vectors = list.count;
    if (n + kWidth * vectors > out.capacity) return false;
    const Vector low[3] = {broadcast(box.lo[0]), broadcast(box.lo[1]), broadcast(box.lo[2])};
    const Vector high[3] = {broadcast(box.hi[0]), broadcast(box.hi[1]), broadcast(box.hi[2])};
    const Vector limit = broadcast(reach);
    const Vector zero = broadcast(0.0F);
    const LayoutView from = view;
    float* const block[3] = {out.xyz[0], out.xyz[1], out.xyz[2]};
    std::uint32_t* const id = out.id;
    for (std::size_t v = 0; v < vectors; ++v) {
      const std::uint32_t i = list.first[v];
      const Vector x = load(from.x + i);
      const Vector y = load(from.y + i);
      const Vector z = load(from.z + i);
      const Vector dx = largestOf(largestOf(low[0] - x, x - high[0]), zero);
      const Vector dy = largestOf(largestOf(low[1] - y, y - high[1]), zero);
      const Vector dz = largestOf(largestOf(low[2] - z, z - high[2]), zero);
      const unsigned int mask = lessMask(squaredNorm(dx, dy, dz), limit) & list.lanes[v];
      compress(x, mask, block[0] + n);
      compress(y, mask, block[1] + n);
      compress(z, mask, block[2] + n);
      n += compressIds(from.id + i, mask, id + n);
    }
    count = n;
    list.count = 0;
    return true;
  }
};

// Fills a gathered block up to full steps of takeNear() with points that are never near.
inline void finishBlock(const Gatherer& scan) {
  for (std::size_t i = scan.count; i < scan.count + 2 * std::size_t{kWidth}; i += kWidth) {
    store(broadcast(kInfinity), scan.out.xyz[0] + i);
  }
  scan.out.count = scan.count;
}

// Calls visit(region) for regions that come nearer to a box than the square root of `limit`, until
// it returns false.
template <typename Visit>
inline bool forRegions(const LayoutView& view, const Corners& box, float limit, Visit&& visit) {
  std::size_t stack[64];
  std::size_t depth = 0;
  stack[depth++] = 1;
  while (depth > 0) {
    const std::size_t i = stack[--depth];
    if (!(squaredGap(cornersOf(view.boxes[i]), box) < limit)) continue;
    if (i < view.region_count) {
      stack[depth++] = 2 * i;
      stack[depth++] = 2 * i + 1;
    } else if (!visit(i - view.region_count)) {
      return false;
    }
  }
  return true;
}

bool gatherAround(const LayoutView& view, const Box& around, float reach, Block& out) {
  const Corners box = cornersOf(around);
  Gatherer scan{view, box, reach, out, 0};
  VectorList list;
  const auto add = [&](std::size_t region) {
    return addRanges(view, region, box, reach, list, scan);
  };
  if (!forRegions(view, box, reach, add) || !scan(list)) return false;
  finishBlock(scan);
  return true;
}

// Regions other than `region` that come nearer to its box than the square root of `limit`.
std::size_t listNeighbors(const LayoutView& view, std::size_t region, float limit,
                          std::uint32_t* out) {
  std::size_t count = 0;
  const Corners box = cornersOf(view.boxes[view.region_count + region]);
  forRegions(view, box, limit, [&](std::size_t other) {
    if (other != region) out[count++] = static_cast<std::uint32_t>(other);
    return true;
  });
  return count;
}

// Points of a group: enough to share the work of gathering, few enough to be near each other.
constexpr std::uint32_t kGroup = 16;
// A group may be smaller rather than longer than this many cells.
constexpr std::uint32_t kMostCells = 3;

// What is carried from group to group of a region.
struct RegionState {
  std::size_t region;
  Guess guess;
  float most;    // squared distance to the k-th neighbour, the largest of a group
  float listed;  // reach of the list of neighbouring regions
  std::size_t neighbors;
  float prune;  // factor on squared reaches, 1 where the search is exact
};

// Points next to each other in the layout that share a block, and the candidates of each.
struct Group {
  struct Member {
    std::uint32_t point;
    std::uint32_t count;  // of its candidates
    float* distance;
    std::uint32_t* id;
    float limit;  // their distances are less
  };
  Corners box;
  std::uint32_t waiting[2 * kGroup];  // points not yet searched for
  std::size_t waiting_count;
  Member found[2 * kGroup];
  std::size_t found_count;
};

inline void startGroup(const LayoutView& view, std::uint32_t begin, std::uint32_t end,
                       Group& group) {
  Quad lo{view.x[begin], view.y[begin], view.z[begin], 0.0F};
  Quad hi = lo;
  for (std::uint32_t i = begin + 1; i < end; ++i) {
    const Quad p{view.x[i], view.y[i], view.z[i], 0.0F};
    lo = smallestOf(lo, p);
    hi = largestOf(hi, p);
  }
  group.box = {lo, hi};
  group.waiting_count = end - begin;
  for (std::uint32_t i = begin; i < end; ++i) group.waiting[i - begin] = i;
}

// A point's candidates; what comes after them is for those of the next point.
inline void addMember(std::uint32_t point, float limit, Candidates& room, Group& group) {
  const auto count = static_cast<std::uint32_t>(room.count);
  group.found[group.found_count++] = {point, count, room.distance, room.id, limit};
  const std::size_t used = wholeLines(room.count + kSortRoom);
  room.distance += used;
  room.id += used;
}

// Fills the block with all points nearer to the group's box than the square root of `limit`.
// \return false if the block does not hold them
inline bool gather(const LayoutView& view, const Corners& box, float limit, RegionState& state,
                   GroupTask& task) {
  const float reach = limit * state.prune;
  Gatherer scan{view, box, reach, task.block, 0};
  VectorList list;
  if (!addRanges(view, state.region, box, reach, list, scan)) return false;
  if (!(reach <= state.listed)) {
    state.listed = 2.0F * reach;
    state.neighbors = listNeighbors(view, state.region, state.listed, task.neighbors);
  }
  for (std::size_t j = 0; j < state.neighbors; ++j) {
    const std::size_t other = task.neighbors[j];
    if (!(squaredGap(cornersOf(view.boxes[view.region_count + other]), box) < reach)) continue;
    if (!addRanges(view, other, box, reach, list, scan)) return false;
  }
  if (!scan(list)) return false;
  finishBlock(scan);
  return true;
}

inline float firstLimit(const Guess& guess, float reach) {
  return smallest(guess.margin * guess.typical, reach);
}

// From candidates nearer than the square root of `limit`, how near the k-th typically is.
inline float typicalOf(float limit, std::size_t k, std::size_t count) {
  return largest(limit * static_cast<float>(k) / static_cast<float>(count), 1e-44F);
}

// With candidates taken with a first limit, looks for a limit that lets through k and not many
// more. \return false if there are fewer in reach
inline bool settleLimit(const Block& block, const float* q, float reach, std::size_t k,
                        float& limit, Candidates& out) {
  const std::size_t enough = k + k / 2 + 8;
  float too_low = 0.0F;
  std::size_t count = out.count;
  for (int attempt = 0; count < k || (count > enough && attempt < 3); ++attempt) {
    const float factor = 1.25F * static_cast<float>(k) / static_cast<float>(count + 1);
    if (count < k) {
      if (limit == reach) return false;
      too_low = limit;
      limit = attempt > 4 ? reach : smallest(largest(factor, 1.2F) * limit, reach);
    } else {
      limit = largest(factor * limit, 0.5F * (too_low + limit));
    }
    count = takeNear(block, q, limit, out.distance, out.id);
  }
  if (count > 2 * enough + 64) {  // many are equally far
    keepNearest(out.distance, out.id, count, k);
    count = k;
  }
  padCandidates(out.distance, out.id, count);
  out.count = count;
  return true;
}

// Copies in steps of kStep, the last of which goes over entries of the one before it again.
// \param count at least kStep
template <std::size_t kStep, typename From, typename To>
inline void copySteps(const From* from, std::size_t count, To* to) {
  for (std::size_t i = 0; i + kStep < count; i += kStep) {
    copyBytes(to + i, from + i, kStep * sizeof(To));
  }
  copyBytes(to + count - kStep, from + count - kStep, kStep * sizeof(To));
}

template <typename From, typename To>
inline void copyEntries(const From* from, std::size_t count, To* to) {
  if constexpr (sizeof(From) == sizeof(To)) {
    if (count >= 8) return copySteps<8>(from, count, to);
    if (count >= 4) return copySteps<4>(from, count, to);
  }
  for (std::size_t i = 0; i < count; ++i) to[i] = static_cast<To>(from[i]);
}

bool nearestInBlock(const Block& block, const float* q, float reach, std::size_t k, Guess& guess,
                    Candidates& room, const SortScratch& scratch, pcl::index_t* indices,
                    float* distances) {
  float limit = firstLimit(guess, reach);
  room.count = takeNear(block, q, limit, room.distance, room.id);
  if (!settleLimit(block, q, reach, k, limit, room)) return false;
  guess.limit = limit;
  guess.typical = typicalOf(limit, k, room.count);
  if (room.count > kMostToSort) return false;
  sortNearest(room.distance, room.id, room.count, k, guess.limit, scratch);
  copyEntries(scratch.id, k, indices);
  copyEntries(scratch.distance, k, distances);
  return true;
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
    float* const distance = member.distance;
    std::uint32_t* const id = member.id;
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
