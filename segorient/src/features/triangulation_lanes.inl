// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
//
// Normals from local triangulations, LCT and LDT (paper, section 2.2). Included once per
// instruction set.

/// Comparisons that sort so many entries whatever they are: Batcher's odd-even merge sort. Without
/// branches, all lanes are sorted at once.
class SortingNetwork {
 public:
  void sort(float* keys, int count) {
    if (count != count_) build(count);
    for (const Comparison& c : comparisons_) {
      const Lanes a = load(keys + c.low);
      const Lanes b = load(keys + c.high);
      store(keys + c.low, smaller(a, b));
      store(keys + c.high, larger(a, b));
    }
  }

 private:
  struct Comparison {
    std::size_t low, high;  ///< floats from the first key
  };
  void build(int count) {
    count_ = count;
    comparisons_.clear();
    for (int p = 1; p < count; p *= 2) {
      for (int k = p; k >= 1; k /= 2) {
        for (int j = k % p; j + k < count; j += 2 * k) {
          for (int i = j; i < j + k && i + k < count; ++i) {
            if (i / (2 * p) != (i + k) / (2 * p)) continue;
            comparisons_.push_back(
                {static_cast<std::size_t>(i) * kWidth, static_cast<std::size_t>(i + k) * kWidth});
          }
        }
      }
    }
  }
  int count_ = 0;
  std::vector<Comparison> comparisons_;
};

/// The neighbours other than the point itself, counted.
inline Mask isNeighbor(const Lanes3& d) {
  return (d.x != 0.0F) | (d.y != 0.0F) | (d.z != 0.0F);
}

/// The neighbours of one register's points in order of angle: their numbers in the last bits of
/// sorted keys.
struct FanOrder {
  const float* keys;
  int sorted = 0;       ///< keys of each point; those of no neighbour come last
  Lanes neighbors{};    ///< how many are of neighbours
  Mask number_masks{};  ///< the bits of a key that are a number

  std::size_t number(int j, std::size_t l) const {
    std::int32_t key;
    __builtin_memcpy(&key, keys + static_cast<std::size_t>(j) * kWidth + l, sizeof(key));
    return static_cast<std::size_t>(key & number_masks[l]);
  }
};

inline FanOrder sortFan(const Batch& batch, std::size_t half, int count, const Frame& frame,
                        SortingNetwork& network, float* keys) {
  FanOrder order;
  order.keys = keys;
  order.sorted = count - batch.first;
  Lanes3 center{};
  for (int j = batch.first; j < count; ++j) {
    const Lanes3 d = batch.offset(j, half);
    center = sum(center, d);
    order.neighbors += select(isNeighbor(d), all(1.0F), Lanes{});
  }
  center = scaled(center, 1.0F / larger(order.neighbors, all(1.0F)));
  const Lanes center_u = dot(center, frame.u);
  const Lanes center_v = dot(center, frame.v);

  // As many bits as each point's own number of neighbours takes: what the others have is no matter.
  for (std::size_t l = 0; l < kWidth; ++l) {
    const int listed = batch.counts[half * kWidth + l];
    const int own = listed < count ? listed : count;
    int bits = 1;
    while ((1 << bits) < own) ++bits;
    order.number_masks[l] = (1 << bits) - 1;
  }
  // The angle is that of a square instead of a circle: it has the same order, and needs one
  // division.
  for (int j = batch.first; j < count; ++j) {
    const Lanes3 d = batch.offset(j, half);
    const Lanes x = dot(d, frame.u) - center_u;
    const Lanes y = dot(d, frame.v) - center_v;
    const Lanes size = absolute(x) + absolute(y);
    const Lanes slope = y / select(size > 0.0F, size, all(1.0F));
    const Lanes angle = select(x < 0.0F, 2.0F - slope, select(y < 0.0F, 4.0F + slope, slope));
    const Mask present = isNeighbor(d);
    const Lanes key = select(present, 1.0F + 0.125F * angle, all(1.75F));
    // What is no neighbour goes last and is numbered 0, which every row has: rows may be shorter.
    const Mask numbered = (reinterpret_cast<Mask>(key) & ~order.number_masks) | (present & j);
    store(keys + static_cast<std::size_t>(j - batch.first) * kWidth,
          reinterpret_cast<Lanes>(numbered));
  }
  network.sort(keys, order.sorted);
  return order;
}

/// \param corner gives the neighbours at one place of the order
template <typename Corner>
inline Lanes3 fanArea(const FanOrder& order, const Corner& corner) {
  const Lanes3 start = corner(0);
  Lanes3 previous = start;
  Lanes3 area{};
  for (int j = 1; j <= order.sorted; ++j) {
    const Mask inside = all(static_cast<float>(j)) < order.neighbors;
    const Lanes3 next = j < order.sorted ? select(inside, corner(j), start) : start;
    area = sum(area, cross(previous, next));
    previous = next;
  }
  return area;
}

/// Local centre triangulation. The fan's triangles, weighted by their areas, sum up to the vector
/// area of the polygon through the neighbours, whatever the centre: only their angular order
/// depends on it.
inline Lanes3 fanNormals(const LocalFitJob& job, const Batch& batch, std::size_t half,
                         const Plane& plane, SortingNetwork& network, float* keys) {
  const Frame frame = frameOf(plane.normal);
  const int count = batch.count < 4096 ? batch.count : 4096;
  if (count == batch.first) return plane.normal;  // no neighbours in any lane, and no plane
  const FanOrder order = sortFan(batch, half, count, frame, network, keys);

  // Corners come from the points anew: that costs less than offsets that can be had lane by lane.
  const auto corner = [&](int j) __attribute__((always_inline)) {
    const float* points[kWidth];
    for (std::size_t l = 0; l < kWidth; ++l) {
      const pcl::index_t* row = batch.neighbors[half * kWidth + l];
      points[l] = job.xyz + 4 * static_cast<std::size_t>(row[order.number(j, l)]);
    }
    return difference(loadPoints(points), batch.centers[half]);
  };
  const auto rescaledCorner = [&](int j) {
    return batch.offsetsAt([&](std::size_t l) { return order.number(j, l); }, half);
  };
  const double* units = batch.unit + half * kWidth;
  bool rescaled = false;
  for (std::size_t l = 0; l < kWidth; ++l) rescaled = rescaled || units[l] != 1.0;
  Lanes3 area = rescaled ? fanArea(order, rescaledCorner) : fanArea(order, corner);
  // In units of the neighbourhood: squares of areas leave float's range early.
  area = scaled(area, 1.0F / (plane.size * plane.size));
  // Collinear in projection: no area, no normal of its own.
  return select(dot(area, frame.n) > 1e-6F, unit(area), plane.normal);
}

/// Local Delaunay triangulation. Of the triangulation only the star of the point is needed. Under
/// inversion about the point its Delaunay neighbours become the vertices of the convex hull of all
/// inverted neighbours, together with the origin where the point lies on the neighbours' hull. All
/// lanes walk around their hulls in step (Jarvis), from the nearest neighbour on.
inline Lanes3 starNormals(const Batch& batch, std::size_t half, const Plane& plane,
                          float* inverted) {
  const Frame frame = frameOf(plane.normal);
  const Lanes unit_length = 1.0F / plane.size;
  const auto at = [inverted](int j) __attribute__((always_inline)) {
    return inverted + 3 * static_cast<std::size_t>(j) * kWidth;
  };
  // Inverted x, y in the frame, and the height as it is.
  Lanes3 start{};
  Lanes start_norm{};
  for (int j = batch.first; j < batch.count; ++j) {
    const Lanes3 d = scaled(batch.offset(j, half), unit_length);
    const Lanes x = dot(d, frame.u);
    const Lanes y = dot(d, frame.v);
    const Lanes norm = x * x + y * y;
    // The point itself, and what lies on its normal, become the origin, which is no triangle's
    // corner.
    const Lanes inverse = select(norm > 1e-8F, 1.0F / norm, Lanes{});
    const Lanes3 image{x * inverse, y * inverse, dot(d, frame.n)};
    store(at(j), image.x);
    store(at(j) + kWidth, image.y);
    store(at(j) + 2 * kWidth, image.z);
    const Mask nearer = inverse > start_norm;
    start = select(nearer, image, start);
    start_norm = select(nearer, inverse, start_norm);
  }

  const auto corner = [](const Lanes3& image) __attribute__((always_inline)) {
    const Lanes norm = image.x * image.x + image.y * image.y;
    const Mask real = norm > 0.0F;
    const Lanes inverse = 1.0F / norm;
    return select(real, Lanes3{image.x * inverse, image.y * inverse, image.z}, Lanes3{});
  };
  Lanes3 total{};
  Lanes3 current = start;
  Lanes3 corner_now = corner(start);
  Mask walking = start_norm > 0.0F;
  const Lanes most_steps = batch.countsOf(half);
  for (int step = 0; step <= batch.count && any(walking); ++step) {
    // The origin is a candidate like the others, except where the walk stands on it.
    const Mask at_origin = (current.x == 0.0F) & (current.y == 0.0F);
    Lanes3 next = select(at_origin, start, Lanes3{});
    // The way to it is kept beside it: it is what the next comparison waits for.
    Lanes way_x = next.x - current.x;
    Lanes way_y = next.y - current.y;
    for (int j = batch.first; j < batch.count; ++j) {
      const Lanes3 image{load(at(j)), load(at(j) + kWidth), load(at(j) + 2 * kWidth)};
      const Lanes x = image.x - current.x;
      const Lanes y = image.y - current.y;
      const Mask right = way_x * y < way_y * x;
      way_x = select(right, x, way_x);
      way_y = select(right, y, way_y);
      next = select(right, image, next);
    }
    const Lanes3 corner_next = corner(next);
    const Lanes3 triangle = cross(corner_now, corner_next);
    const Lanes doubled_area = squareRoot(dot(triangle, triangle));
    const Mask counts = walking & (doubled_area > 0.0F);
    total = sum(total, select(counts, scaled(triangle, 1.0F / doubled_area), Lanes3{}));
    walking &= (next.x != start.x) | (next.y != start.y);
    walking &= all(static_cast<float>(step)) < most_steps;
    current = next;
    corner_now = corner_next;
  }
  const Lanes3 normal{total.x * frame.u.x + total.y * frame.v.x + total.z * frame.n.x,
                      total.x * frame.u.y + total.y * frame.v.y + total.z * frame.n.y,
                      total.x * frame.u.z + total.y * frame.v.z + total.z * frame.n.z};
  return select(total.z > 1e-3F, unit(normal), plane.normal);
}
