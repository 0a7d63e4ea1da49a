// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
//
// Included once per instruction set, inside a namespace that defines Vector. Nothing from the
// standard library is called here: an inline function compiled for one instruction set could
// otherwise be linked into code that runs on machines without it.

// Squared distances as FLANN and any plain loop compute them: ((dx*dx + dy*dy) + dz*dz).
inline Vector squaredNorm(Vector dx, Vector dy, Vector dz) {
  return add(add(mul(dx, dx), mul(dy, dy)), mul(dz, dz));
}

inline float largest(float a, float b) {
  return a > b ? a : b;
}
inline float smallest(float a, float b) {
  return a < b ? a : b;
}
inline float absolute(float a) {
  return a < 0.0F ? -a : a;
}

// How far an interval is from another one; 0 if they meet.
inline float gap(float lo, float hi, float other_lo, float other_hi) {
  return largest(largest(other_lo - hi, lo - other_hi), 0.0F);
}

// Every rounding is monotone, so this is not above the rounded distance of any two of their points.
inline float squaredGap(const Box& a, const Box& b) {
  const float dx = gap(a.lo[0], a.hi[0], b.lo[0], b.hi[0]);
  const float dy = gap(a.lo[1], a.hi[1], b.lo[1], b.hi[1]);
  const float dz = gap(a.lo[2], a.hi[2], b.lo[2], b.hi[2]);
  return dx * dx + dy * dy + dz * dz;
}

// ---------------------------------------------------------------------------------------------------
// The cells of a region that come near a box

// In units of cells and relative to the region's corner.
struct CellRange {
  float lo[3], hi[3];  // the box
  float reach;
  int first[3], last[3];
};

// False where rounding would make cell numbers meaningless; then all points have to be looked at.
inline bool cellRange(const Region& region, const Box& bounds, const Box& box, float squared_reach,
                      CellRange& range) {
  // The smallest squares are rounded away, hence the absolute part.
  const float reach = squareRoot(squared_reach) * 1.000001F + 1e-22F;
  float magnitude = 0.0F;
  for (int a = 0; a < 3; ++a) {
    range.lo[a] = (box.lo[a] - bounds.lo[a]) * region.inverse_edge;
    range.hi[a] = (box.hi[a] - bounds.lo[a]) * region.inverse_edge;
    magnitude = largest(magnitude, largest(absolute(range.lo[a]), absolute(range.hi[a])));
    magnitude = largest(magnitude, static_cast<float>(region.counts[a]));
  }
  if (!(magnitude < 1e6F)) return false;
  // Covers the rounding of coordinates in units of cells, here and when points were sorted.
  const float margin = 1e-6F * magnitude;
  range.reach = reach * region.inverse_edge + 3.0F * margin;
  for (int a = 0; a < 3; ++a) {
    const auto most = static_cast<float>(region.counts[a] - 1);
    const float lo = range.lo[a] - range.reach;
    const float hi = range.hi[a] + range.reach;
    range.first[a] = static_cast<int>(smallest(largest(lo, 0.0F), most + 1.0F));
    range.last[a] = hi < 0.0F ? -1 : static_cast<int>(smallest(hi, most));
  }
  return true;
}

// Calls take(begin, end) with ranges of points that contain all those of the region that are nearer
// to the box than the square root of squared_reach. Stops where take returns false.
template <typename Take>
inline bool forRanges(const LayoutView& view, std::size_t r, const Box& box, float squared_reach,
                      std::uint32_t most_identical, Take& take) {
  const Region& region = view.regions[r];
  if (region.identical != 0) {
    const std::uint32_t count = region.end - region.begin;
    return take(region.begin, region.begin + (count < most_identical ? count : most_identical));
  }
  CellRange range;
  if (!cellRange(region, view.boxes[view.region_count + r], box, squared_reach, range)) {
    return take(region.begin, region.end);
  }
  const std::uint16_t* starts = view.starts + region.first_start;
  const float squared = range.reach * range.reach;
  const auto most = static_cast<float>(region.counts[0] - 1);
  for (int cz = range.first[2]; cz <= range.last[2]; ++cz) {
    const auto low_z = static_cast<float>(cz);
    const float dz = gap(low_z, low_z + 1.0F, range.lo[2], range.hi[2]);
    const float rest = squared - dz * dz;
    for (int cy = range.first[1]; cy <= range.last[1]; ++cy) {
      const auto low_y = static_cast<float>(cy);
      const float dy = gap(low_y, low_y + 1.0F, range.lo[1], range.hi[1]);
      const float squared_width = rest - dy * dy;
      if (squared_width < 0.0F) continue;
      const float width = squareRoot(squared_width);
      const float lo = range.lo[0] - width;
      const float hi = range.hi[0] + width;
      if (hi < 0.0F || lo > most + 1.0F) continue;
      const auto first = static_cast<std::uint32_t>(smallest(largest(lo, 0.0F), most));
      const auto last = static_cast<std::uint32_t>(smallest(hi, most));
      const std::uint16_t* row =
          starts + static_cast<std::size_t>(region.counts[0]) *
                       (static_cast<std::size_t>(cy) +
                        static_cast<std::size_t>(region.counts[1]) * static_cast<std::size_t>(cz));
      const std::uint32_t begin = region.begin + row[first];
      const std::uint32_t end = region.begin + row[last + 1];
      if (begin != end && !take(begin, end)) return false;
    }
  }
  return true;
}

// ---------------------------------------------------------------------------------------------------
// Collecting from a sphere

struct CollectFromRange {
  const LayoutView& view;
  Vector qx, qy, qz, limit;
  Candidates& out;

  // Copies in local variables, here and below: what is written could otherwise be what is read.
  inline bool operator()(std::uint32_t begin, std::uint32_t end) {
    std::size_t count = out.count;
    if (count + (end - begin) > out.capacity) return false;
    const LayoutView v = view;
    const Vector x = qx;
    const Vector y = qy;
    const Vector z = qz;
    const Vector bound = limit;
    float* const distance = out.distance;
    std::uint32_t* const id = out.id;
    for (std::uint32_t i = begin; i < end; i += kWidth) {
      const Vector dx = sub(x, load(v.x + i));
      const Vector dy = sub(y, load(v.y + i));
      const Vector dz = sub(z, load(v.z + i));
      const Vector d = squaredNorm(dx, dy, dz);
      unsigned int mask = lessMask(d, bound);
      if (end - i < kWidth) mask &= (1U << (end - i)) - 1U;
      compress(d, mask, distance + count);
      count += compressIds(v.id + i, mask, id + count);
    }
    out.count = count;
    return true;
  }
};

inline CollectFromRange collector(const LayoutView& view, const Sphere& sphere, Candidates& out) {
  return {view,
          broadcast(sphere.center[0]),
          broadcast(sphere.center[1]),
          broadcast(sphere.center[2]),
          broadcast(sphere.limit),
          out};
}

inline Box pointBox(const float* p) {
  return {{p[0], p[1], p[2]}, {p[0], p[1], p[2]}};
}

bool collectRegion(const LayoutView& view, std::size_t region, const Sphere& sphere,
                   Candidates& out) {
  CollectFromRange take = collector(view, sphere, out);
  return forRanges(view, region, pointBox(sphere.center), sphere.prune, sphere.most_identical,
                   take);
}

// The regions below a node.
template <typename Take>
bool collectBelow(const LayoutView& view, std::size_t node, const Box& point, const Sphere& sphere,
                  Take& take) {
  std::size_t stack[64];
  std::size_t depth = 0;
  stack[depth++] = node;
  while (depth > 0) {
    const std::size_t i = stack[--depth];
    if (!(squaredGap(view.boxes[i], point) < sphere.prune)) continue;
    if (i < view.region_count) {
      stack[depth++] = 2 * i;
      stack[depth++] = 2 * i + 1;
    } else if (!forRanges(view, i - view.region_count, point, sphere.prune, sphere.most_identical,
                          take)) {
      return false;
    }
  }
  return true;
}

bool collect(const LayoutView& view, const Path& path, const Sphere& sphere, Candidates& out) {
  CollectFromRange take = collector(view, sphere, out);
  const Box point = pointBox(sphere.center);
  if (!forRanges(view, path.region, point, sphere.prune, sphere.most_identical, take)) return false;
  for (std::size_t i = path.length; i-- > 0;) {
    if (path.squared_distance[i] < sphere.prune &&
        !collectBelow(view, path.other_side[i], point, sphere, take)) {
      return false;
    }
  }
  return true;
}

// ---------------------------------------------------------------------------------------------------
// Sorting

// Where equal distances stay in the order they have.
void rankStable(const float* distance, std::size_t count, std::uint32_t* rank) {
  for (std::size_t i = 0; i < count; ++i) {
    std::uint32_t before = 0;
    for (std::size_t j = 0; j < i; ++j) before += distance[j] <= distance[i] ? 1U : 0U;
    for (std::size_t j = i; j < count; ++j) before += distance[j] < distance[i] ? 1U : 0U;
    rank[i] = before;
  }
}

// For `kVectors` vectors of distances from vector number `first` on, how many of all are less.
template <std::size_t kVectors>
inline Counter rankVectors(const float* distance, std::size_t count, std::size_t first,
                           std::uint32_t* rank) {
  const float* const own = distance + first * kWidth;
  rank += first * kWidth;
  Vector v[kVectors];
  Counter c[kVectors];
  for (std::size_t i = 0; i < kVectors; ++i) {
    v[i] = load(own + i * kWidth);
    c[i] = zeroCounter();
  }
  for (std::size_t j = 0; j < count; ++j) {
    const Vector other = broadcast(distance[j]);
    for (std::size_t i = 0; i < kVectors; ++i) c[i] = countLess(c[i], other, v[i]);
  }
  Counter sum = zeroCounter();
  for (std::size_t i = 0; i < kVectors; ++i) {
    store(rank + i * kWidth, c[i]);
    sum = addCounters(sum, c[i]);
  }
  return sum;
}

// Writes the candidates in ascending order. Each one's place is the number of those before it,
// which takes quadratic but straight work: for some tens of candidates nothing else is as fast.
void sortByRank(float* distance, std::uint32_t* id, std::size_t count, const SortScratch& scratch,
                float* out_distance, std::uint32_t* out_id) {
  const std::size_t vectors = (count + kWidth - 1) / kWidth;
  const std::size_t padded = vectors * kWidth;
  for (std::size_t i = count; i < padded; ++i) distance[i] = kInfinity;
  std::uint32_t* const rank = scratch.rank;
  Counter sum = zeroCounter();
  std::size_t v = 0;
  for (; v + 4 <= vectors; v += 4) {
    sum = addCounters(sum, rankVectors<4>(distance, count, v, rank));
  }
  if (vectors - v == 3) sum = addCounters(sum, rankVectors<3>(distance, count, v, rank));
  if (vectors - v == 2) sum = addCounters(sum, rankVectors<2>(distance, count, v, rank));
  if (vectors - v == 1) sum = addCounters(sum, rankVectors<1>(distance, count, v, rank));
  // Without ties, ranks are 0, 1, 2 ...; each pad counts all the others.
  const bool ties = total(sum) != count * (count - 1) / 2 + (padded - count) * count;
  if (ties) rankStable(distance, count, rank);
  // As pairs, so that there is one write each.
  for (std::size_t i = 0; i < padded; i += kWidth) {
    interleave(distance + i, id + i, scratch.pairs + 2 * i);
  }
  for (std::size_t i = 0; i < count; ++i) {
    __builtin_memcpy(scratch.sorted_pairs + 2 * std::size_t{rank[i]}, scratch.pairs + 2 * i, 8);
  }
  for (std::size_t i = 0; i < padded; i += kWidth) {
    deinterleave(scratch.sorted_pairs + 2 * i, out_distance + i, out_id + i);
  }
  if (!ties) return;
  for (std::size_t i = 0; i + 1 < count;) {
    std::size_t end = i + 1;
    while (end < count && out_distance[end] == out_distance[i]) ++end;
    if (end - i > 1) sortIds(out_id + i, end - i);
    i = end;
  }
}

// Above this, candidates are first divided by distance.
constexpr std::size_t kMostToRank = 96;

// Copies the candidates of distances in [from, to).
std::size_t select(const Candidates& in, float from, float to, float* distance, std::uint32_t* id) {
  const Vector low = broadcast(from);
  const Vector high = broadcast(to);
  std::size_t count = 0;
  for (std::size_t i = 0; i < in.count; i += kWidth) {
    const Vector d = load(in.distance + i);
    unsigned int mask = lessMask(d, high) & ~lessMask(d, low);
    if (in.count - i < kWidth) mask &= (1U << (in.count - i)) - 1U;
    compress(d, mask, distance + count);
    count += compressIds(in.id + i, mask, id + count);
  }
  return count;
}

void sortNearest(Candidates& in, std::size_t k, float limit, const SortScratch& scratch) {
  if (in.count <= kMostToRank) {
    sortByRank(in.distance, in.id, in.count, scratch, scratch.distance, scratch.id);
    return;
  }
  const std::size_t parts = in.count / 32;
  const float step = limit / static_cast<float>(parts);
  std::size_t done = 0;
  float from = 0.0F;
  for (std::size_t part = 1; part <= parts && done < k; ++part) {
    const float to = part == parts ? limit : step * static_cast<float>(part);
    const std::size_t count = select(in, from, to, scratch.part_distance, scratch.part_id);
    if (count <= kMostToRank) {
      sortByRank(scratch.part_distance, scratch.part_id, count, scratch, scratch.distance + done,
                 scratch.id + done);
    } else {
      for (std::size_t i = 0; i < count; ++i) {
        scratch.distance[done + i] = scratch.part_distance[i];
        scratch.id[done + i] = scratch.part_id[i];
      }
      sortPairs(scratch.distance + done, scratch.id + done, count);
    }
    done += count;
    from = to;
  }
}

// ---------------------------------------------------------------------------------------------------
// All points of a region

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
