// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
//
// Neighbourhoods of kLanes points at once, and their planes. Included once per instruction set.

/// Some points' neighbours as offsets from them: entry j of lane l at [j * kWidth + l]. Entries
/// beyond a lane's own count are zero, so they add nothing to any sum.
struct Batch {
  /// \param vectors whether each offset is also kept as four floats, for access by lane and entry
  Batch(std::size_t entries, bool vectors)
      : buffer(3 * entries * kWidth), vector_buffer(vectors ? 4 * entries * kWidth : 0) {
    x = buffer.data();
    y = x + entries * kWidth;
    z = y + entries * kWidth;
  }
  Lanes3 offset(int j) const {
    const std::size_t at = static_cast<std::size_t>(j) * kWidth;
    return {load(x + at), load(y + at), load(z + at)};
  }
  void setOffset(int j, const Lanes3& d) {
    const std::size_t at = static_cast<std::size_t>(j) * kWidth;
    store(x + at, d.x);
    store(y + at, d.y);
    store(z + at, d.z);
  }
  float* vector(std::size_t j, std::size_t lane) {
    return vector_buffer.data() + 4 * (j * kWidth + lane);
  }

  std::vector<float> buffer;
  std::vector<float> vector_buffer;
  float* x;
  float* y;
  float* z;
  std::size_t rows[kWidth];
  int counts[kWidth];
  double unit[kWidth];  ///< length that is 1 in the lane's offsets
  int count = 0;        ///< largest of counts
  bool even = false;    ///< all counts are equal
};

/// Reads the neighbours of rows first to first + kLanes - 1; beyond `last` the last row again.
inline void loadBatch(const LocalFitJob& job, std::size_t first, std::size_t last, Batch& batch) {
  const pcl::index_t* neighbors[kWidth];
  const float* points[kWidth];
  batch.count = 0;
  batch.even = true;
  for (std::size_t l = 0; l < kWidth; ++l) {
    const std::size_t row = job.row(first + l < last ? first + l : last - 1);
    batch.rows[l] = row;
    batch.counts[l] = job.count(row);
    batch.unit[l] = 1.0;
    batch.even = batch.even && batch.counts[l] == batch.counts[0];
    batch.count = batch.counts[l] > batch.count ? batch.counts[l] : batch.count;
    neighbors[l] = job.neighborhoods->indices(row);
  }
  float center_xyz[3][kWidth];
  for (std::size_t l = 0; l < kWidth; ++l) {
    for (std::size_t a = 0; a < 3; ++a) center_xyz[a][l] = job.queries[batch.rows[l]][a];
  }
  const Lanes3 center{load(center_xyz[0]), load(center_xyz[1]), load(center_xyz[2])};
  const auto setOffset = [&](int j, Mask present) __attribute__((always_inline)) {
    const Lanes3 p = loadPoints(points);
    const Lanes3 d{p.x - center.x, p.y - center.y, p.z - center.z};
    batch.setOffset(j, batch.even ? d : select(present, d, Lanes3{}));
    if (batch.vector_buffer.empty()) return;
    for (std::size_t l = 0; l < kWidth; ++l) {
      const Quad vector = loadQuad(points[l]) - Quad{center.x[l], center.y[l], center.z[l]};
      storeQuad(batch.vector(static_cast<std::size_t>(j), l),
                batch.even || present[l] ? vector : Quad{});
    }
  };
  if (batch.even) {
    for (int j = 0; j < batch.count; ++j) {
      for (std::size_t l = 0; l < kWidth; ++l) {
        points[l] = job.xyz + 4 * static_cast<std::size_t>(neighbors[l][j]);
      }
      setOffset(j, Mask{});
    }
    return;
  }
  for (int j = 0; j < batch.count; ++j) {
    Mask present{};
    for (std::size_t l = 0; l < kWidth; ++l) {
      present[l] = j < batch.counts[l] ? -1 : 0;
      points[l] = job.xyz + (present[l] ? 4 * static_cast<std::size_t>(neighbors[l][j]) : 0);
    }
    setOffset(j, present);
  }
}

/// Scales a lane's offsets to lengths around 1, where their squares would over- or underflow.
inline void rescaleLane(Batch& batch, std::size_t l) {
  float largest = 0.0F;
  for (int j = 0; j < batch.count; ++j) {
    const std::size_t at = static_cast<std::size_t>(j) * kWidth + l;
    for (const float* axis : {batch.x, batch.y, batch.z}) {
      largest = std::max(largest, std::abs(axis[at]));
    }
  }
  if (!(largest > 0.0F) || !std::isfinite(largest)) return;
  // A power of two rounds nothing.
  batch.unit[l] = std::ldexp(1.0, std::ilogb(largest));
  const auto scale = [&](float& x) {
    x = static_cast<float>(static_cast<double>(x) / batch.unit[l]);
  };
  for (int j = 0; j < batch.count; ++j) {
    const std::size_t at = static_cast<std::size_t>(j) * kWidth + l;
    for (float* axis : {batch.x, batch.y, batch.z}) scale(axis[at]);
    if (batch.vector_buffer.empty()) continue;
    for (std::size_t a = 0; a < 3; ++a) scale(batch.vector(static_cast<std::size_t>(j), l)[a]);
  }
}

struct Plane {
  Lanes3 normal;
  Lanes curvature;
  Lanes size;  ///< root mean square distance of the neighbours
  Mask valid;
};

/// Adjugate of a symmetric matrix; its largest column spans the null space of a singular one.
struct Adjugate {
  Lanes xx, xy, xz, yy, yz, zz;
  Lanes3 largestColumn() const {
    const Lanes3 first = select(xx >= yy, Lanes3{xx, xy, xz}, Lanes3{xy, yy, yz});
    return select(zz > larger(xx, yy), Lanes3{xz, yz, zz}, first);
  }
};
inline Adjugate adjugate(Lanes xx, Lanes xy, Lanes xz, Lanes yy, Lanes yz, Lanes zz) {
  return {yy * zz - yz * yz, xz * yz - xy * zz, xy * yz - xz * yy,
          xx * zz - xz * xz, xy * xz - xx * yz, xx * yy - xy * xy};
}

/// cos(2/3 acos(s)) for 0 <= s <= 1 to 3e-9: Chebyshev fit of degree 8.
inline Lanes cosTwoThirdsOfArc(Lanes s) {
  constexpr float kCoefficients[] = {3.70768637e-3F,  -1.03254929e-2F, 1.96757181e-2F,
                                     -3.19612954e-2F, 5.3288656e-2F,   -1.11095683e-1F,
                                     5.7734972e-1F,   5.00000003e-1F};
  Lanes sum = all(-6.3931434e-4F);
  for (const float c : kCoefficients) sum = sum * s + c;
  return sum;
}

/// Least-squares planes. The smallest eigenvalue in closed form (by the half angle, where the
/// cubic's root is a smooth function of a square root), its vector from the adjugate, and both once
/// more from the Rayleigh quotient, whose error is the square of the first one's. Slim or round
/// neighbourhoods, for which float is not enough, are done again in double.
inline Plane fitPlanes(const LocalFitJob& job, Batch& batch) {
  const Lanes zero{};
  Lanes3 sum{};
  Lanes xx = zero, xy = zero, xz = zero, yy = zero, yz = zero, zz = zero;
  for (int j = 0; j < batch.count; ++j) {
    const Lanes3 d = batch.offset(j);
    sum = {sum.x + d.x, sum.y + d.y, sum.z + d.z};
    xx += d.x * d.x;
    xy += d.x * d.y;
    xz += d.x * d.z;
    yy += d.y * d.y;
    yz += d.y * d.z;
    zz += d.z * d.z;
  }
  Lanes count{};
  for (std::size_t l = 0; l < kWidth; ++l) count[l] = static_cast<float>(batch.counts[l]);
  const Lanes weight = all(1.0F) / larger(count, all(1.0F));
  const Lanes second = xx + yy + zz;
  xx -= sum.x * sum.x * weight;
  xy -= sum.x * sum.y * weight;
  xz -= sum.x * sum.z * weight;
  yy -= sum.y * sum.y * weight;
  yz -= sum.y * sum.z * weight;
  zz -= sum.z * sum.z * weight;

  // Trace 1 from here on.
  const Lanes trace = xx + yy + zz;
  const Lanes scale = all(1.0F) / trace;
  xx *= scale;
  xy *= scale;
  xz *= scale;
  yy *= scale;
  yz *= scale;
  zz *= scale;
  const Lanes third = all(1.0F / 3.0F);
  const Lanes a = xx - third;
  const Lanes b = yy - third;
  const Lanes c = zz - third;
  const Lanes spread =
      (a * a + b * b + c * c + 2.0F * (xy * xy + xz * xz + yz * yz)) * (1.0F / 6.0F);
  const Lanes p = squareRoot(spread);
  const Lanes det = a * (b * c - yz * yz) - xy * (xy * c - yz * xz) + xz * (xy * yz - b * xz);
  const Lanes r = det / (spread * p);  // 2 cos(3 phi), eigenvalues 1/3 + 2 p cos(phi)
  const Lanes half = larger(zero, smaller(all(1.0F), 0.5F - 0.25F * r));
  Lanes lambda = third - 2.0F * p * cosTwoThirdsOfArc(squareRoot(half));

  Adjugate adj = adjugate(xx - lambda, xy, xz, yy - lambda, yz, zz - lambda);
  // (lambda1 - lambda0) (lambda2 - lambda0) of trace 1: how well the vector is determined.
  const Lanes gap = adj.xx + adj.yy + adj.zz;
  Lanes3 normal = unit(adj.largestColumn());
  const auto image = [&](const Lanes3& v) __attribute__((always_inline)) {
    return Lanes3{xx * v.x + xy * v.y + xz * v.z, xy * v.x + yy * v.y + yz * v.z,
                  xz * v.x + yz * v.y + zz * v.z};
  };
  lambda = dot(normal, image(normal));
  adj = adjugate(xx - lambda, xy, xz, yy - lambda, yz, zz - lambda);
  normal = unit(adj.largestColumn());
  lambda = dot(normal, image(normal));

  Plane plane;
  plane.size = squareRoot(second * weight);
  plane.normal = normal;
  plane.curvature = larger(zero, lambda);
  // Below 1 % float leaves errors of 1e-5 rad. Under- and overflow of the squares end here as well.
  const Mask in_range = (trace > 1e-30F) & (trace < 1e30F);
  const Mask good = (gap > 0.01F) & in_range & (count >= 3.0F) & (dot(normal, normal) > 0.5F);
  plane.valid = good;
  if (any(~good)) {
    for (std::size_t l = 0; l < kWidth; ++l) {
      if (good[l]) continue;
      float exact[4];
      plane.valid[l] = fitPlaneExactly(job, batch.rows[l], exact) ? -1 : 0;
      plane.normal.x[l] = exact[0];
      plane.normal.y[l] = exact[1];
      plane.normal.z[l] = exact[2];
      plane.curvature[l] = exact[3];
      if (in_range[l] || !plane.valid[l]) continue;
      rescaleLane(batch, l);
      double squares = 0.0;
      for (int j = 0; j < batch.counts[l]; ++j) {
        const std::size_t at = static_cast<std::size_t>(j) * kWidth + l;
        for (const float* axis : {batch.x, batch.y, batch.z}) {
          squares += static_cast<double>(axis[at]) * static_cast<double>(axis[at]);
        }
      }
      plane.size[l] = static_cast<float>(std::sqrt(squares / batch.counts[l]));
    }
  }
  return plane;
}
