// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
//
// Normals from local triangulations, LCT and LDT (paper, section 2.2). Included once per
// instruction set.

/// Comparisons that sort so many entries whatever they are: Batcher's odd-even merge sort. Without
/// branches, all points of a batch are sorted at once.
class SortingNetwork {
 public:
  void sort(float* keys, int count) {
    if (count != count_) build(count);
    for (const Comparison& c : comparisons_) {
      const Twice a = loadTwice(keys + c.low);
      const Twice b = loadTwice(keys + c.high);
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
            comparisons_.push_back({static_cast<std::size_t>(i) * kBatchRows,
                                    static_cast<std::size_t>(i + k) * kBatchRows});
          }
        }
      }
    }
  }
  int count_ = 0;
  std::vector<Comparison> comparisons_;
};

/// Neighbours other than the point itself and what lies on it: of their coordinates, some have more
/// bits than a sign.
inline Mask isNeighbor(const Lanes3& d) {
  const Mask bits =
      SEGORIENT_BITS_AS(Mask, d.x) | SEGORIENT_BITS_AS(Mask, d.y) | SEGORIENT_BITS_AS(Mask, d.z);
  return (bits & 0x7fffffff) != 0;
}

/// How many bits the number of one of so many neighbours takes.
inline int numberBits(int neighbors) {
  int bits = 1;
  while ((1 << bits) < neighbors) ++bits;
  return bits;
}

/// The neighbours of one register's points in order of angle.
struct FanOrder {
  float* keys;          ///< of entry j at [j * kBatchRows]: the number of the neighbour in the last
                        ///< bits of what is sorted
  Mask counts{};        ///< of neighbours; keys of what is none come last
  Mask number_masks{};  ///< the bits of a key that are a number
};

/// The keys of one register's points, as yet in the order of the neighbours.
inline FanOrder fanKeys(const Batch& batch, std::size_t half, int count, const Plane& plane,
                        float* keys) {
  FanOrder order;
  order.keys = keys + half * kWidth;
  const Frame<Lanes> frame = frameOf(plane.normal);
  Mask around{};
  for (int j = batch.first; j < batch.count; ++j) around -= isNeighbor(batch.offset(j, half));
  const Lanes3 center =
      scaled(plane.sum, 1.0F / larger(SEGORIENT_CONVERTED(around, Lanes), all(1.0F)));
  const Lanes center_u = dot(center, frame.u);
  const Lanes center_v = dot(center, frame.v);

  // As many bits as each point's own number of neighbours takes: what the others have is no matter.
  if (batch.even) {
    const std::int32_t bits = (1 << numberBits(count)) - 1;
    for (std::size_t l = 0; l < kWidth; ++l) order.number_masks[l] = bits;
  } else {
    for (std::size_t l = 0; l < kWidth; ++l) {
      const int listed = batch.counts[half * kWidth + l];
      order.number_masks[l] = (1 << numberBits(listed < count ? listed : count)) - 1;
    }
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
    order.counts -= present;
    const Lanes key = select(present, 1.0F + 0.125F * angle, all(1.75F));
    // What is no neighbour goes last and is numbered 0, which every row has: rows may be shorter.
    const Mask numbered = (SEGORIENT_BITS_AS(Mask, key) & ~order.number_masks) | (present & j);
    store(order.keys + static_cast<std::size_t>(j - batch.first) * kBatchRows,
          SEGORIENT_BITS_AS(Lanes, numbered));
  }
  return order;
}

/// \param corner gives the neighbours of given numbers, one a lane
template <typename Corner>
inline Lanes3 fanArea(const FanOrder& order, int sorted, const Corner& corner) {
  const auto cornerAt = [&](int j) SEGORIENT_INLINED {
    const Lanes key = load(order.keys + static_cast<std::size_t>(j) * kBatchRows);
    const Mask numbers = SEGORIENT_BITS_AS(Mask, key) & order.number_masks;
    std::uint32_t number[kWidth];
    copyBytes(number, &numbers, sizeof(number));
    return corner(number);
  };
  const Lanes3 start = cornerAt(0);
  Lanes3 previous = start;
  Lanes3 area{};
  for (int j = 1; j <= sorted; ++j) {
    const Mask inside = order.counts > j;
    const Lanes3 next = j < sorted ? select(inside, cornerAt(j), start) : start;
    area = sum(area, cross(previous, next));
    previous = next;
  }
  return area;
}

/// Local centre triangulation. The fan's triangles, weighted by their areas, sum up to the vector
/// area of the polygon through the neighbours, whatever the centre: only their angular order
/// depends on it.
SEGORIENT_APART void fanNormals(const LocalFitJob& job, const Batch& batch,
                                const Plane (&planes)[2], SortingNetwork& network, float* keys,
                                Lanes3 (&normals)[2]) {
  const int count = batch.count < 4096 ? batch.count : 4096;
  const int sorted = count - batch.first;
  if (sorted == 0) return;  // no neighbours in any lane, and no plane
  FanOrder orders[2];
  for (std::size_t half = 0; half < 2; ++half) {
    orders[half] = fanKeys(batch, half, count, planes[half], keys);
  }
  network.sort(keys, sorted);
  for (std::size_t half = 0; half < 2; ++half) {
    const Plane& plane = planes[half];
    // Corners come from the points anew: that costs less than offsets that can be had lane by lane.
    const pcl::index_t* const* rows = batch.neighbors + half * kWidth;
    const auto corner = [&](const std::uint32_t* number) SEGORIENT_INLINED {
      const float* points[kWidth];
      for (std::size_t l = 0; l < kWidth; ++l) {
        points[l] = job.xyz + 4 * static_cast<std::size_t>(rows[l][number[l]]);
      }
      return difference(loadPoints(points), batch.centers[half]);
    };
    const auto rescaledCorner = [&](const std::uint32_t* number) {
      return batch.offsetsAt(number, half);
    };
    Lanes3 area = batch.rescaled ? fanArea(orders[half], sorted, rescaledCorner)
                                 : fanArea(orders[half], sorted, corner);
    // In units of the neighbourhood: squares of areas leave float's range early.
    area = scaled(area, 1.0F / (plane.size * plane.size));
    // Collinear in projection: no area, no normal of its own.
    normals[half] = select(dot(area, plane.normal) > 1e-6F, unit(area), plane.normal);
  }
}

/// Local Delaunay triangulation. Of the triangulation only the star of the point is needed. Under
/// inversion about the point its Delaunay neighbours become the vertices of the convex hull of all
/// inverted neighbours, together with the origin where the point lies on the neighbours' hull. All
/// points of a batch walk around their hulls in step (Jarvis), from the nearest neighbour on.
SEGORIENT_APART void starNormals(const Batch& batch, const Plane (&planes)[2], float* inverted,
                                 Lanes3 (&normals)[2]) {
  const Twice3 plane_normal = both(planes[0].normal, planes[1].normal);
  const Frame<Twice> frame = frameOf(plane_normal);
  const Twice unit_length = 1.0F / Twice{planes[0].size, planes[1].size};
  const auto at = [inverted](int j) SEGORIENT_INLINED {
    return inverted + 3 * static_cast<std::size_t>(j) * kBatchRows;
  };
  // Inverted x, y in the frame, and the height as it is.
  Twice3 start{};
  Twice start_norm{};
  for (int j = batch.first; j < batch.count; ++j) {
    const Twice3 d = scaled(batch.offsets(j), unit_length);
    const Twice x = dot(d, frame.u);
    const Twice y = dot(d, frame.v);
    const Twice norm = x * x + y * y;
    // The point itself, and what lies on its normal, become the origin, which is no triangle's
    // corner.
    const Twice inverse = select(norm > 1e-8F, 1.0F / norm, Twice{});
    const Twice3 image{x * inverse, y * inverse, dot(d, frame.n)};
    store(at(j), image.x);
    store(at(j) + kBatchRows, image.y);
    store(at(j) + 2 * kBatchRows, image.z);
    const TwiceMask nearer = inverse > start_norm;
    start = select(nearer, image, start);
    start_norm = select(nearer, inverse, start_norm);
  }

  // A corner times the square of its inverted distance, which turns no plane through the point.
  const auto corner = [](const Twice3& image) SEGORIENT_INLINED {
    return Twice3{image.x, image.y, image.z * (image.x * image.x + image.y * image.y)};
  };
  Twice3 total{};
  Twice3 current = start;
  Twice3 corner_now = corner(start);
  TwiceMask walking = start_norm > 0.0F;
  const Twice most_steps = batch.allCounts();
  for (int step = 0; step <= batch.count && any(walking); ++step) {
    // The origin is a candidate like the others, except where the walk stands on it.
    const TwiceMask at_origin = (current.x == 0.0F) & (current.y == 0.0F);
    Twice3 next = select(at_origin, start, Twice3{});
    // The way to it is kept beside it: it is what the next comparison waits for.
    Twice way_x = next.x - current.x;
    Twice way_y = next.y - current.y;
    for (int j = batch.first; j < batch.count; ++j) {
      const Twice3 image{loadTwice(at(j)), loadTwice(at(j) + kBatchRows),
                         loadTwice(at(j) + 2 * kBatchRows)};
      const Twice x = image.x - current.x;
      const Twice y = image.y - current.y;
      const TwiceMask right = way_x * y < way_y * x;
      way_x = select(right, x, way_x);
      way_y = select(right, y, way_y);
      next = select(right, image, next);
    }
    const Twice3 corner_next = corner(next);
    const Twice3 triangle = cross(corner_now, corner_next);
    const Twice doubled_area = squareRoot(dot(triangle, triangle));
    const TwiceMask counts = walking & (doubled_area > 0.0F);
    total = sum(total, select(counts, scaled(triangle, 1.0F / doubled_area), Twice3{}));
    walking = walking & ((next.x != start.x) | (next.y != start.y)) &
              (most_steps > static_cast<float>(step));
    current = next;
    corner_now = corner_next;
  }
  const Twice3 normal =
      sum(sum(scaled(frame.u, total.x), scaled(frame.v, total.y)), scaled(frame.n, total.z));
  const Twice3 found = select(total.z > 1e-3F, unit(normal), plane_normal);
  normals[0] = firstOf(found);
  normals[1] = secondOf(found);
}
