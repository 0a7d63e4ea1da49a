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
