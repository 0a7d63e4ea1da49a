// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
//
// Included once per instruction set, inside a namespace that defines Vector. Nothing from the
// standard library is called here: an inline function compiled for one instruction set could
// otherwise be linked into code that runs on machines without it.

// Squared distances as FLANN and any plain loop compute them: ((dx*dx + dy*dy) + dz*dz).
inline Vector squaredNorm(Vector dx, Vector dy, Vector dz) {
  return (dx * dx + dy * dy) + dz * dz;
}

inline float largest(float a, float b) {
  return a > b ? a : b;
}
inline float smallest(float a, float b) {
  return a < b ? a : b;
}

// How far an interval is from another one; 0 if they meet.
inline Vector gap(Vector lo, Vector hi, Vector other_lo, Vector other_hi) {
  return largestOf(largestOf(other_lo - hi, lo - other_hi), broadcast(0.0F));
}

// A box in registers. The last lanes are of no use.
struct Corners {
  Quad lo, hi;
};

inline Corners cornersOf(const Box& box) {
  const Quad hi = loadQuad(box.lo + 2);
  return {loadQuad(box.lo), Quad{hi[1], hi[2], hi[3], hi[3]}};
}
inline Corners pointCorners(const float* p) {
  const Quad q{p[0], p[1], p[2], 0.0F};
  return {q, q};
}

// Every rounding is monotone, so this is not above the rounded distance of any two of their points.
inline float squaredGap(const Corners& a, const Corners& b) {
  const Quad d = largestOf(largestOf(b.lo - a.hi, a.lo - b.hi), Quad{});
  const Quad squares = d * d;
  return squares[0] + squares[1] + squares[2];
}

// The squared distance from the farthest point of a box to the farthest of another.
inline float squaredSpan(const Corners& a, const Corners& b) {
  const Quad d = largestOf(b.hi - a.lo, a.hi - b.lo);
  const Quad squares = d * d;
  return squares[0] + squares[1] + squares[2];
}

// ---------------------------------------------------------------------------------------------------
// The cells of a region that come near a box

// In units of cells and relative to the region's corner; the last lane of each array is of no use.
struct CellRange {
  float lo[4], hi[4];  // the box
  float reach;
  int first[4], end[4];
};

// False where rounding would make cell numbers meaningless; then all points have to be looked at.
SEGORIENT_INLINE bool cellRange(const Region& region, const Box& bounds, const Corners& box,
                                float squared_reach, CellRange& range) {
  const Quad origin = loadQuad(bounds.lo);
  const Quad lo = (box.lo - origin) * region.inverse_edge;
  const Quad hi = (box.hi - origin) * region.inverse_edge;
  const Quad counts{static_cast<float>(region.counts[0]), static_cast<float>(region.counts[1]),
                    static_cast<float>(region.counts[2]), 0.0F};
  const Quad sizes = largestOf(largestOf(largestOf(lo, -lo), largestOf(hi, -hi)), counts);
  const float magnitude = largest(largest(sizes[0], sizes[1]), sizes[2]);
  if (!(magnitude < 1e6F)) return false;
  // Covers the rounding of coordinates in units of cells, here and when points were sorted.
  const float margin = 1e-6F * magnitude;
  // The smallest squares are rounded away, hence the absolute part. Squares beyond all floats are
  // not collected.
  const float reach = squareRoot(smallest(squared_reach, kLargest)) * 1.000001F + 1e-22F;
  range.reach = reach * region.inverse_edge + 3.0F * margin;
  const Quad zero{};
  storeQuad(lo, range.lo);
  storeQuad(hi, range.hi);
  storeInts(smallestOf(largestOf(lo - range.reach, zero), counts), range.first);
  storeInts(smallestOf(largestOf(hi + range.reach + 1.0F, zero), counts), range.end);
  return true;
}

// ---------------------------------------------------------------------------------------------------
// Points to look at

template <std::uint32_t kLanes>
struct LaneBitsOf {
  using Type = std::uint8_t;
};
template <>
struct LaneBitsOf<16> {
  using Type = std::uint16_t;
};
using LaneBits = LaneBitsOf<kWidth>::Type;

// Ranges of points as a list of vectors, so that going through many short ones is one loop, whose
// number of turns is the only thing that a processor cannot foresee.
struct VectorList {
  static constexpr std::uint32_t kAtOnce = 8;
  static constexpr std::size_t kMost = 64;
  static constexpr std::size_t kRoom = kMost + std::size_t{kWidth + 1} * kAtOnce;
  std::size_t count = 0;
  std::uint32_t first[kRoom];  // of each vector, its first point
  LaneBits lanes[kRoom];       // of each vector, a bit for each lane that counts
};

// By how many points are beyond whole vectors, the lanes of the last one.
struct LastLanes {
  LaneBits lanes[kWidth];
  constexpr LastLanes() : lanes() {
    for (std::uint32_t i = 0; i < kWidth; ++i) {
      lanes[i] = static_cast<LaneBits>((1U << (i > 0 ? i : kWidth)) - 1U);
    }
  }
};
constexpr LastLanes kLastLanes;

// As many as are appended at once, with all lanes.
struct WholeVectors {
  LaneBits lanes[VectorList::kAtOnce];
  constexpr WholeVectors() : lanes() {
    for (LaneBits& bits : lanes) bits = static_cast<LaneBits>((1U << kWidth) - 1U);
  }
};
constexpr WholeVectors kWholeVectors;

// Appends up to kAtOnce vectors. \return the new number of vectors
SEGORIENT_INLINE std::size_t append(VectorList& list, std::size_t at, std::uint32_t begin,
                                    std::uint32_t count) {
  using Eight = SEGORIENT_VECTOR(std::uint32_t, 8);
  const std::uint32_t vectors = (count + kWidth - 1) / kWidth;
  // More than needed, without a branch; the next range overwrites the rest.
  const Eight first = begin + Eight{0,          kWidth,     2 * kWidth, 3 * kWidth,
                                    4 * kWidth, 5 * kWidth, 6 * kWidth, 7 * kWidth};
  copyBytes(list.first + at, &first, sizeof(first));
  copyBytes(list.lanes + at, kWholeVectors.lanes, sizeof(kWholeVectors.lanes));
  at += vectors;
  // Of an empty range, what the next one overwrites.
  list.lanes[at - (count > 0 ? 1 : 0)] = kLastLanes.lanes[count % kWidth];
  return at;
}

// Adds ranges of any length. \return false where scan() did
template <typename Scan>
inline bool addRange(VectorList& list, std::uint32_t begin, std::uint32_t count, Scan& scan) {
  constexpr std::uint32_t kLongest = VectorList::kAtOnce * kWidth;
  for (; count > kLongest; begin += kLongest, count -= kLongest) {
    list.count = append(list, list.count, begin, kLongest);
    if (list.count >= VectorList::kMost && !scan(list)) return false;
  }
  list.count = append(list, list.count, begin, count);
  return list.count < VectorList::kMost || scan(list);
}

// Adds ranges of points that contain all those of the region that are nearer to the box than the
// square root of squared_reach. When the list is full, scan(list) looks at it and empties it.
// \return false where scan() did
template <typename Scan>
bool addRanges(const LayoutView& view, std::size_t r, const Corners& box, float squared_reach,
               VectorList& list, Scan& scan) {
  const Region& region = view.regions[r];
  CellRange range;
  if (!cellRange(region, view.boxes[view.region_count + r], box, squared_reach, range)) {
    return addRange(list, region.begin, region.end - region.begin, scan);
  }
  const int rows_y = range.end[1] - range.first[1];
  const int rows = rows_y * (range.end[2] - range.first[2]);
  if (rows_y <= 0) return true;
  const std::uint16_t* const starts = view.starts + region.first_start;
  const Vector zero = broadcast(0.0F);
  const Vector one = broadcast(1.0F);
  const Vector most = broadcast(static_cast<float>(region.counts[0] - 1));
  const Vector squared_reach_x = broadcast(range.reach * range.reach);
  const Vector length_y = broadcast(static_cast<float>(rows_y));
  const Vector inverse_y = broadcast(1.0F / static_cast<float>(rows_y));
  // As many rows at a time as a vector has lanes. Those out of reach and empty ones are common and
  // cannot be foreseen: no branches.
  for (int i = 0; i < rows; i += static_cast<int>(kWidth)) {
    const Vector number = broadcast(static_cast<float>(i)) + counting();
    const Vector layer = truncate((number + broadcast(0.5F)) * inverse_y);
    const Vector z = broadcast(static_cast<float>(range.first[2])) + layer;
    const Vector y = broadcast(static_cast<float>(range.first[1])) + (number - layer * length_y);
    const Vector dz = gap(z, z + one, broadcast(range.lo[2]), broadcast(range.hi[2]));
    const Vector dy = gap(y, y + one, broadcast(range.lo[1]), broadcast(range.hi[1]));
    const Vector squared_width = squared_reach_x - dz * dz - dy * dy;
    const Vector width = squareRoot(largestOf(squared_width, zero));
    const Vector from = truncate(smallestOf(largestOf(broadcast(range.lo[0]) - width, zero), most));
    const Vector to =
        truncate(smallestOf(largestOf(broadcast(range.hi[0]) + width, zero), most)) + one;
    // Cell numbers are small enough to be exact.
    const Vector row = (z * broadcast(region.counts[1]) + y) * broadcast(region.counts[0]);
    int first[kWidth];
    int end[kWidth];
    storeInts(row + from, first);
    storeInts(row + selectLess(squared_width, zero, from, to), end);
    const int left = rows - i < static_cast<int>(kWidth) ? rows - i : static_cast<int>(kWidth);
    std::size_t vectors = list.count;
    for (int j = 0; j < left; ++j) {
      const std::uint32_t begin = starts[first[j]];
      const std::uint32_t count = starts[end[j]] - begin;
      if (count <= VectorList::kAtOnce * kWidth) {
        vectors = append(list, vectors, region.begin + begin, count);
      } else {
        list.count = vectors;
        if (!addRange(list, region.begin + begin, count, scan)) return false;
        vectors = list.count;
      }
    }
    list.count = vectors;
    if (vectors >= VectorList::kMost && !scan(list)) return false;
  }
  return true;
}

// ---------------------------------------------------------------------------------------------------
// Collecting from a sphere

struct Collector {
  const LayoutView& view;
  const Sphere& sphere;
  Candidates& out;

  // Copies in local variables, here and below: what is written could otherwise be what is read.
  // \return false if there may be no room for all
  bool operator()(VectorList& list) {
    std::size_t count = out.count;
    const std::size_t vectors = list.count;
    if (count + kWidth * vectors > out.capacity) return false;
    const Vector qx = broadcast(sphere.center[0]);
    const Vector qy = broadcast(sphere.center[1]);
    const Vector qz = broadcast(sphere.center[2]);
    const Vector limit = broadcast(sphere.limit);
    const float* const x = view.x;
    const float* const y = view.y;
    const float* const z = view.z;
    const std::uint32_t* const ids = view.id;
    float* const distance = out.distance;
    std::uint32_t* const id = out.id;
    list.first[vectors] = 0;
    list.lanes[vectors] = 0;
    for (std::size_t v = 0; v < vectors; v += 2) {
      const std::uint32_t i = list.first[v];
      const std::uint32_t j = list.first[v + 1];
      const Vector d = squaredNorm(qx - load(x + i), qy - load(y + i), qz - load(z + i));
      const Vector e = squaredNorm(qx - load(x + j), qy - load(y + j), qz - load(z + j));
      const unsigned int mask = lessMask(d, limit) & list.lanes[v];
      const unsigned int next_mask = lessMask(e, limit) & list.lanes[v + 1];
      compress(d, mask, distance + count);
      count += compressIds(ids + i, mask, id + count);
      compress(e, next_mask, distance + count);
      count += compressIds(ids + j, next_mask, id + count);
    }
    out.count = count;
    list.count = 0;
    return true;
  }
};

bool collectRegion(const LayoutView& view, std::size_t region, const Sphere& sphere,
                   Candidates& out) {
  Collector scan{view, sphere, out};
  VectorList list;
  return addRanges(view, region, pointCorners(sphere.center), sphere.prune, list, scan) &&
         scan(list);
}

// Of a flat node whose points are all equally far, those of the least ids.
inline bool takeFlat(const LayoutView& view, std::size_t node, float distance, const Sphere& sphere,
                     Candidates& out) {
  if (!(distance < sphere.limit)) return true;
  if (out.count + sphere.most_equal > out.capacity) return false;
  const std::uint32_t* const id = view.flat_id + firstPoint(view, node);
  for (std::size_t i = 0; i < sphere.most_equal; ++i) {
    out.distance[out.count] = distance;
    out.id[out.count++] = id[i];
  }
  return true;
}

// The regions below a node.
bool collectBelow(const LayoutView& view, std::size_t node, const Corners& point,
                  const Sphere& sphere, VectorList& list, Collector& scan) {
  std::size_t stack[64];
  std::size_t depth = 0;
  stack[depth++] = node;
  while (depth > 0) {
    const std::size_t i = stack[--depth];
    if (!(squaredGap(cornersOf(view.boxes[i]), point) < sphere.prune)) continue;
    if (view.flat != nullptr && view.flat[i] != 0 && nodeSize(view, i) > sphere.most_equal) {
      const float distance = squaredGap(cornersOf(view.boxes[i]), point);
      if (distance == squaredSpan(cornersOf(view.boxes[i]), point)) {
        if (!takeFlat(view, i, distance, sphere, scan.out)) return false;
        continue;
      }
    }
    if (i < view.region_count) {
      stack[depth++] = 2 * i;
      stack[depth++] = 2 * i + 1;
    } else if (!addRanges(view, i - view.region_count, point, sphere.prune, list, scan)) {
      return false;
    }
  }
  return true;
}

bool collect(const LayoutView& view, const Path& path, const Sphere& sphere, Candidates& out) {
  Collector scan{view, sphere, out};
  VectorList list;
  const Corners point = pointCorners(sphere.center);
  if (view.regions[path.region].flat != 0) {
    return collectBelow(view, 1, point, sphere, list, scan) && scan(list);
  }
  if (!addRanges(view, path.region, point, sphere.prune, list, scan)) return false;
  for (std::size_t i = path.length; i-- > 0;) {
    if (path.squared_distance[i] < sphere.prune &&
        !collectBelow(view, path.other_side[i], point, sphere, list, scan)) {
      return false;
    }
  }
  return scan(list);
}
