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

// The squared distance from the farthest point of a box to the farthest of another.
inline float squaredSpan(const Box& a, const Box& b) {
  const float dx = largest(b.hi[0] - a.lo[0], a.hi[0] - b.lo[0]);
  const float dy = largest(b.hi[1] - a.lo[1], a.hi[1] - b.lo[1]);
  const float dz = largest(b.hi[2] - a.lo[2], a.hi[2] - b.lo[2]);
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
  // The smallest squares are rounded away, hence the absolute part. Squares beyond all floats are
  // not collected.
  const float reach = squareRoot(smallest(squared_reach, kLargest)) * 1.000001F + 1e-22F;
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
                      Take& take) {
  const Region& region = view.regions[r];
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
      const Vector dx = x - load(v.x + i);
      const Vector dy = y - load(v.y + i);
      const Vector dz = z - load(v.z + i);
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
  return forRanges(view, region, pointBox(sphere.center), sphere.prune, take);
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
template <typename Take>
bool collectBelow(const LayoutView& view, std::size_t node, const Box& point, const Sphere& sphere,
                  Take& take) {
  std::size_t stack[64];
  std::size_t depth = 0;
  stack[depth++] = node;
  while (depth > 0) {
    const std::size_t i = stack[--depth];
    if (!(squaredGap(view.boxes[i], point) < sphere.prune)) continue;
    if (view.flat != nullptr && view.flat[i] != 0 && nodeSize(view, i) > sphere.most_equal) {
      const float distance = squaredGap(view.boxes[i], point);
      if (distance == squaredSpan(view.boxes[i], point)) {
        if (!takeFlat(view, i, distance, sphere, take.out)) return false;
        continue;
      }
    }
    if (i < view.region_count) {
      stack[depth++] = 2 * i;
      stack[depth++] = 2 * i + 1;
    } else if (!forRanges(view, i - view.region_count, point, sphere.prune, take)) {
      return false;
    }
  }
  return true;
}

bool collect(const LayoutView& view, const Path& path, const Sphere& sphere, Candidates& out) {
  CollectFromRange take = collector(view, sphere, out);
  const Box point = pointBox(sphere.center);
  if (view.regions[path.region].flat != 0) return collectBelow(view, 1, point, sphere, take);
  if (!forRanges(view, path.region, point, sphere.prune, take)) return false;
  for (std::size_t i = path.length; i-- > 0;) {
    if (path.squared_distance[i] < sphere.prune &&
        !collectBelow(view, path.other_side[i], point, sphere, take)) {
      return false;
    }
  }
  return true;
}
