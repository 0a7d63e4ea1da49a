// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
//
// Neighbourhoods of twice kWidth points at once, and their planes. Included once per instruction
// set.

/// Points that are worked on at once: two registers full.
constexpr std::size_t kBatchRows = 2 * kWidth;

/// The row of points without neighbours: its first entry can be read as any other's.
constexpr pcl::index_t kNoNeighbors[1] = {0};

/// Some points' neighbours as offsets from them: entry j of point l at [j * kBatchRows + l], from
/// `first` on. Entries beyond a point's own count are zero, so they add nothing to any sum.
struct Batch {
  explicit Batch(std::size_t entries) : buffer(3 * entries * kBatchRows) {
    x = buffer.data();
    y = x + entries * kBatchRows;
    z = y + entries * kBatchRows;
  }
  Lanes3 offset(int j, std::size_t half) const {
    const std::size_t at = static_cast<std::size_t>(j) * kBatchRows + half * kWidth;
    return {load(x + at), load(y + at), load(z + at)};
  }
  void setOffset(int j, std::size_t half, const Lanes3& d) {
    const std::size_t at = static_cast<std::size_t>(j) * kBatchRows + half * kWidth;
    store(x + at, d.x);
    store(y + at, d.y);
    store(z + at, d.z);
  }
  /// Of both registers' points.
  Twice3 offsets(int j) const { return both(offset(j, 0), offset(j, 1)); }
  /// Of each of one register's points the neighbour of that point's number.
  Lanes3 offsetsAt(const std::uint32_t* number, std::size_t half) const {
    Lanes3 result{};
    for (std::size_t l = 0; l < kWidth; ++l) {
      const std::size_t at = number[l] * kBatchRows + half * kWidth + l;
      result.x[l] = x[at];
      result.y[l] = y[at];
      result.z[l] = z[at];
    }
    return result;
  }
  /// The numbers of neighbours of one register's points.
  Lanes countsOf(std::size_t half) const {
    Lanes result{};
    for (std::size_t l = 0; l < kWidth; ++l) {
      result[l] = static_cast<float>(counts[half * kWidth + l]);
    }
    return result;
  }

  Twice allCounts() const { return {countsOf(0), countsOf(1)}; }

  std::vector<float> buffer;
  float* x;
  float* y;
  float* z;
  std::size_t rows[kBatchRows];
  const pcl::index_t* neighbors[kBatchRows];
  int counts[kBatchRows];
  double unit[kBatchRows];  ///< length that is 1 in the point's offsets
  Lanes3 centers[2];        ///< the points themselves
  int first = 0;            ///< 1 where each row begins with the point itself, whose offset is zero
  int count = 0;            ///< largest of counts
  bool even = false;        ///< all counts are equal
  bool rescaled = false;    ///< some units are not 1
};

/// The neighbours of one register's points.
inline void loadHalf(const LocalFitJob& job, std::size_t half, Batch& batch) {
  const std::size_t base = half * kWidth;
  const float* points[kWidth];
  float center_xyz[3][kWidth];
  for (std::size_t l = 0; l < kWidth; ++l) {
    for (std::size_t a = 0; a < 3; ++a) {
      center_xyz[a][l] = job.queries[batch.rows[base + l]][a];
    }
  }
  const Lanes3 center{load(center_xyz[0]), load(center_xyz[1]), load(center_xyz[2])};
  batch.centers[half] = center;
  if (batch.even) {
    for (int j = batch.first; j < batch.count; ++j) {
      for (std::size_t l = 0; l < kWidth; ++l) {
        points[l] = job.xyz + 4 * static_cast<std::size_t>(batch.neighbors[base + l][j]);
      }
      batch.setOffset(j, half, difference(loadPoints(points), center));
    }
    return;
  }
  for (int j = batch.first; j < batch.count; ++j) {
    Mask present{};
    for (std::size_t l = 0; l < kWidth; ++l) {
      present[l] = j < batch.counts[base + l] ? -1 : 0;
      points[l] =
          job.xyz + (present[l] ? 4 * static_cast<std::size_t>(batch.neighbors[base + l][j]) : 0);
    }
    batch.setOffset(j, half, select(present, difference(loadPoints(points), center), Lanes3{}));
  }
}

/// Asks for what the rows from `begin` on are going to read: their farthest neighbours, which are
/// the least likely to be near in memory to those of the rows before, and the table itself further
/// ahead, as processors do not at the ends of pages.
inline void prefetchRows(const LocalFitJob& job, std::size_t begin, std::size_t end) {
  constexpr int kFarthest = 3;
  constexpr std::size_t kTableAhead = 128;
  for (std::size_t i = begin; i < begin + kBatchRows && i < end; ++i) {
    const std::size_t row = job.row(i);
    const int count = job.count(row);
    const pcl::index_t* neighbors = job.neighborhoods->indices(row);
    for (int j = count > kFarthest ? count - kFarthest : 0; j < count; ++j) {
      prefetch(job.xyz + 4 * static_cast<std::size_t>(neighbors[j]));
    }
    if (i + kTableAhead < end) {
      prefetch(job.neighborhoods->indices(job.row(i + kTableAhead)));
    }
  }
}

/// Reads the neighbours of rows begin to begin + kBatchRows - 1; from `end` on the last row again.
inline void loadBatch(const LocalFitJob& job, std::size_t begin, std::size_t end, Batch& batch) {
  bool selves = job.same_points;
  batch.count = 0;
  batch.even = true;
  batch.rescaled = false;
  for (std::size_t l = 0; l < kBatchRows; ++l) {
    const std::size_t row = job.row(begin + l < end ? begin + l : end - 1);
    batch.rows[l] = row;
    batch.counts[l] = job.count(row);
    batch.unit[l] = 1.0;
    batch.even = batch.even && batch.counts[l] == batch.counts[0];
    batch.count = batch.counts[l] > batch.count ? batch.counts[l] : batch.count;
    batch.neighbors[l] = batch.counts[l] > 0 ? job.neighborhoods->indices(row) : kNoNeighbors;
    selves =
        selves && batch.counts[l] > 0 && static_cast<std::size_t>(batch.neighbors[l][0]) == row;
  }
  batch.first = selves ? 1 : 0;
  for (std::size_t half = 0; half < 2; ++half) loadHalf(job, half, batch);
  prefetchRows(job, begin + 2 * kBatchRows, end);
}

/// Scales a point's offsets to lengths around 1, where their squares would over- or underflow.
inline void rescalePoint(Batch& batch, std::size_t l) {
  float largest = 0.0F;
  for (int j = batch.first; j < batch.count; ++j) {
    const std::size_t at = static_cast<std::size_t>(j) * kBatchRows + l;
    for (const float* axis : {batch.x, batch.y, batch.z}) {
      largest = std::max(largest, std::abs(axis[at]));
    }
  }
  if (!(largest > 0.0F) || !std::isfinite(largest)) return;
  // A power of two rounds nothing.
  batch.unit[l] = std::ldexp(1.0, std::ilogb(largest));
  batch.rescaled = true;
  for (int j = batch.first; j < batch.count; ++j) {
    const std::size_t at = static_cast<std::size_t>(j) * kBatchRows + l;
    for (float* axis : {batch.x, batch.y, batch.z}) {
      axis[at] = static_cast<float>(static_cast<double>(axis[at]) / batch.unit[l]);
    }
  }
}

struct Plane {
  Lanes3 normal;
  Lanes curvature;
  Lanes size;  ///< root mean square distance of the neighbours
  Lanes3 sum;  ///< of their offsets
  Mask valid;
};

/// Sums over neighbours' offsets.
template <typename V>
struct Scatter {
  Vector3<V> sum;
  V xx, xy, xz, yy, yz, zz;
};
inline Scatter<Lanes> scatterOf(const Batch& batch, std::size_t half) {
  Scatter<Lanes> s{};
  for (int j = batch.first; j < batch.count; ++j) {
    const Lanes3 d = batch.offset(j, half);
    s.sum = sum(s.sum, d);
    s.xx += d.x * d.x;
    s.xy += d.x * d.y;
    s.xz += d.x * d.z;
    s.yy += d.y * d.y;
    s.yz += d.y * d.z;
    s.zz += d.z * d.z;
  }
  return s;
}
inline Scatter<Twice> scatterOf(const Batch& batch) {
  const Scatter<Lanes> a = scatterOf(batch, 0);
  const Scatter<Lanes> b = scatterOf(batch, 1);
  return {{{a.sum.x, b.sum.x}, {a.sum.y, b.sum.y}, {a.sum.z, b.sum.z}},
          {a.xx, b.xx},
          {a.xy, b.xy},
          {a.xz, b.xz},
          {a.yy, b.yy},
          {a.yz, b.yz},
          {a.zz, b.zz}};
}

/// Adjugate of a symmetric matrix; its largest column spans the null space of a singular one.
template <typename V>
struct Adjugate {
  V xx, xy, xz, yy, yz, zz;
  Vector3<V> largestColumn() const {
    const auto first = select(xx >= yy, Vector3<V>{xx, xy, xz}, Vector3<V>{xy, yy, yz});
    return select(zz > larger(xx, yy), Vector3<V>{xz, yz, zz}, first);
  }
};
template <typename V>
inline Adjugate<V> adjugate(V xx, V xy, V xz, V yy, V yz, V zz) {
  return {yy * zz - yz * yz, xz * yz - xy * zz, xy * yz - xz * yy,
          xx * zz - xz * xz, xy * xz - xx * yz, xx * yy - xy * xy};
}

/// cos(2/3 acos(s)) for 0 <= s <= 1 to 3e-9: Chebyshev fit of degree 8.
template <typename V>
inline V cosTwoThirdsOfArc(V s) {
  constexpr float kCoefficients[] = {3.70768637e-3F,  -1.03254929e-2F, 1.96757181e-2F,
                                     -3.19612954e-2F, 5.3288656e-2F,   -1.11095683e-1F,
                                     5.7734972e-1F,   5.00000003e-1F};
  V result = V{} - 6.3931434e-4F;
  for (const float c : kCoefficients) result = result * s + c;
  return result;
}

/// The direction of least variance of a scatter.
template <typename V>
struct Flattest {
  Vector3<V> normal;
  V lambda;  ///< variance along it, of a trace of 1
  V first;   ///< the same without the vector, which may be undefined: less exact
  V minors;  ///< sum of the products of two variances
  V gap;     ///< (lambda1 - lambda0) (lambda2 - lambda0): how well the vector is determined
  V trace;   ///< of the scatter about its mean
  V second;  ///< of the scatter about the point, by number of neighbours
};

/// The smallest eigenvalue in closed form (by the half angle, where the cubic's root is a smooth
/// function of a square root), its vector from the adjugate, and both once more from the Rayleigh
/// quotient, whose error is the square of the first one's.
template <typename V>
inline Flattest<V> flattestDirection(const Scatter<V>& s, V count) {
  Flattest<V> result;
  const V zero{};
  const V weight = 1.0F / larger(count, zero + 1.0F);
  result.second = (s.xx + s.yy + s.zz) * weight;
  V xx = s.xx - s.sum.x * s.sum.x * weight;
  V xy = s.xy - s.sum.x * s.sum.y * weight;
  V xz = s.xz - s.sum.x * s.sum.z * weight;
  V yy = s.yy - s.sum.y * s.sum.y * weight;
  V yz = s.yz - s.sum.y * s.sum.z * weight;
  V zz = s.zz - s.sum.z * s.sum.z * weight;

  // Trace 1 from here on.
  result.trace = xx + yy + zz;
  const V scale = 1.0F / result.trace;
  xx = xx * scale;
  xy = xy * scale;
  xz = xz * scale;
  yy = yy * scale;
  yz = yz * scale;
  zz = zz * scale;
  const V third = zero + 1.0F / 3.0F;
  const V a = xx - third;
  const V b = yy - third;
  const V c = zz - third;
  const V spread = (a * a + b * b + c * c + 2.0F * (xy * xy + xz * xz + yz * yz)) * (1.0F / 6.0F);
  const V p = squareRoot(spread);
  const V det = a * (b * c - yz * yz) - xy * (xy * c - yz * xz) + xz * (xy * yz - b * xz);
  const V r = det / (spread * p);  // 2 cos(3 phi), eigenvalues 1/3 + 2 p cos(phi)
  const V half = larger(zero, smaller(zero + 1.0F, 0.5F - 0.25F * r));
  V lambda = third - 2.0F * p * cosTwoThirdsOfArc(squareRoot(half));
  result.first = lambda;
  result.minors = xx * (yy + zz) + yy * zz - (xy * xy + xz * xz + yz * yz);

  Adjugate<V> adj = adjugate<V>(xx - lambda, xy, xz, yy - lambda, yz, zz - lambda);
  result.gap = adj.xx + adj.yy + adj.zz;
  Vector3<V> normal = unit(adj.largestColumn());
  const auto image = [&](const Vector3<V>& v) SEGORIENT_INLINED {
    return Vector3<V>{xx * v.x + xy * v.y + xz * v.z, xy * v.x + yy * v.y + yz * v.z,
                      xz * v.x + yz * v.y + zz * v.z};
  };
  lambda = dot(normal, image(normal));
  adj = adjugate<V>(xx - lambda, xy, xz, yy - lambda, yz, zz - lambda);
  result.normal = unit(adj.largestColumn());
  result.lambda = dot(result.normal, image(result.normal));
  return result;
}

/// A plane that float was not enough for, again in double.
inline void fitAgain(const LocalFitJob& job, std::size_t l, std::size_t lane, bool in_range,
                     Batch& batch, Plane& plane) {
  float exact[4];
  plane.valid[lane] = fitPlaneExactly(job, batch.rows[l], exact) ? -1 : 0;
  plane.normal.x[lane] = exact[0];
  plane.normal.y[lane] = exact[1];
  plane.normal.z[lane] = exact[2];
  plane.curvature[lane] = exact[3];
  if (in_range || !plane.valid[lane]) return;
  rescalePoint(batch, l);
  double squares = 0.0;
  float sums[3] = {0.0F, 0.0F, 0.0F};
  for (int j = batch.first; j < batch.counts[l]; ++j) {
    const std::size_t at = static_cast<std::size_t>(j) * kBatchRows + l;
    const float d[3] = {batch.x[at], batch.y[at], batch.z[at]};
    for (std::size_t a = 0; a < 3; ++a) {
      squares += static_cast<double>(d[a]) * static_cast<double>(d[a]);
      sums[a] += d[a];
    }
  }
  plane.sum.x[lane] = sums[0];
  plane.sum.y[lane] = sums[1];
  plane.sum.z[lane] = sums[2];
  plane.size[lane] = static_cast<float>(std::sqrt(squares / batch.counts[l]));
}

/// Least-squares planes. Slim or round neighbourhoods, for which float is not enough, are done
/// again in double.
inline void fitPlanes(const LocalFitJob& job, Batch& batch, Plane (&planes)[2]) {
  const Twice counts = batch.allCounts();
  const Scatter<Twice> scatter = scatterOf(batch);
  const Flattest<Twice> found = flattestDirection(scatter, counts);
  const Twice size = squareRoot(found.second);
  const Twice curvature = larger(Twice{}, found.lambda);
  // Below 1 % float leaves errors of 1e-5 rad. Under- and overflow of the squares end here as well.
  const TwiceMask in_range = (found.trace > 1e-30F) & (found.trace < 1e30F);
  const TwiceMask good =
      (found.gap > 0.01F) & in_range & (counts >= 3.0F) & (dot(found.normal, found.normal) > 0.5F);
  const Twice3& n = found.normal;
  planes[0] = {firstOf(n), curvature.first, size.first, firstOf(scatter.sum), good.first};
  planes[1] = {secondOf(n), curvature.second, size.second, secondOf(scatter.sum), good.second};
  if (!any(~(good.first & good.second))) return;
  for (std::size_t l = 0; l < kBatchRows; ++l) {
    const std::size_t lane = l % kWidth;
    const Mask& fits = l < kWidth ? in_range.first : in_range.second;
    if (!planes[l / kWidth].valid[lane]) {
      fitAgain(job, l, lane, fits[lane] != 0, batch, planes[l / kWidth]);
    }
  }
}
