// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/automatic/sheet_filter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <utility>

#include "common/compiler.h"
#include "common/instruction_set.h"
#include "common/parallel_for.h"
#include "common/vectors.h"
#include "orientation/automatic/contrary_patches.h"
#include "orientation/automatic/sheet_choice.h"

namespace segorient {
namespace {

struct Kernel {
  float inverse_tolerance;  // of the distance to a plane, in spacings
  float inverse_residual;   // at which a plane counts half
};

struct Mean {
  float x = 0.F, y = 0.F, z = 0.F;
  float total = 0.F;
  // In double: far from all neighbours the weights are so small that squares leave float's range.
  double length() const {
    const auto square = [](float v) { return static_cast<double>(v) * static_cast<double>(v); };
    return std::sqrt(square(x) + square(y) + square(z));
  }
};

using Quad = SEGORIENT_VECTOR(float, 4);

Quad loadQuad(const float* from) {
  Quad q;
  std::memcpy(&q, from, sizeof q);
  return q;
}

// Four rows become four columns.
void transpose(Quad& a, Quad& b, Quad& c, Quad& d) {
  const Quad low_ab = SEGORIENT_SHUFFLED(a, b, 0, 4, 1, 5);
  const Quad low_cd = SEGORIENT_SHUFFLED(c, d, 0, 4, 1, 5);
  const Quad high_ab = SEGORIENT_SHUFFLED(a, b, 2, 6, 3, 7);
  const Quad high_cd = SEGORIENT_SHUFFLED(c, d, 2, 6, 3, 7);
  a = SEGORIENT_SHUFFLED(low_ab, low_cd, 0, 1, 4, 5);
  b = SEGORIENT_SHUFFLED(low_ab, low_cd, 2, 3, 6, 7);
  c = SEGORIENT_SHUFFLED(high_ab, high_cd, 0, 1, 4, 5);
  d = SEGORIENT_SHUFFLED(high_ab, high_cd, 2, 3, 6, 7);
}

constexpr std::size_t kLanes = 8;
constexpr std::size_t kBlock = 40;  // a default neighbourhood and the point itself, in whole lanes

// Some neighbours: offsets in spacings and normals, as separate arrays; unused entries weigh 0.
struct Block {
  alignas(32) std::array<float, kBlock> dx;
  alignas(32) std::array<float, kBlock> dy;
  alignas(32) std::array<float, kBlock> dz;
  alignas(32) std::array<float, kBlock> nx;
  alignas(32) std::array<float, kBlock> ny;
  alignas(32) std::array<float, kBlock> nz;
  alignas(32) std::array<float, kBlock> fit;
  alignas(32) std::array<float, kBlock> used;

  void set(std::size_t j, const float* p, const float* q, float per_h, const float* n) {
    dx[j] = (q[0] - p[0]) * per_h;
    dy[j] = (q[1] - p[1]) * per_h;
    dz[j] = (q[2] - p[2]) * per_h;
    nx[j] = n[0];
    ny[j] = n[1];
    nz[j] = n[2];
    fit[j] = n[3];
    used[j] = 1.F;
  }
  // Four neighbours at once, of rows of at least four floats. \return false where one has no normal
  bool setFour(std::size_t j, const PointView& points, const std::vector<float>& normals,
               std::size_t p, const pcl::index_t* row, float per_h) {
    Quad n[4];
    Quad q[4];
    for (std::size_t i = 0; i < 4; ++i) {
      const auto at = static_cast<std::size_t>(row[i]);
      n[i] = loadQuad(normals.data() + 4 * at);
      q[i] = loadQuad(points[at]);
    }
    transpose(n[0], n[1], n[2], n[3]);
    for (int i = 0; i < 4; ++i) {
      if (!std::isfinite(n[0][i])) return false;
    }
    transpose(q[0], q[1], q[2], q[3]);
    const float* const own = points[p];
    store((q[0] - own[0]) * per_h, dx, j);
    store((q[1] - own[1]) * per_h, dy, j);
    store((q[2] - own[2]) * per_h, dz, j);
    store(n[0], nx, j);
    store(n[1], ny, j);
    store(n[2], nz, j);
    store(n[3], fit, j);
    store(Quad{1.F, 1.F, 1.F, 1.F}, used, j);
    return true;
  }
  static void store(Quad q, std::array<float, kBlock>& to, std::size_t j) {
    std::memcpy(to.data() + j, &q, sizeof q);
  }
  void clear(std::size_t j) {
    dx[j] = dy[j] = dz[j] = nx[j] = ny[j] = nz[j] = fit[j] = used[j] = 0.F;
  }
};

// Sums by lane, so that compilers can use vectors without changing the order of any sum.
struct Sums {
  alignas(32) std::array<float, kLanes> x;
  alignas(32) std::array<float, kLanes> y;
  alignas(32) std::array<float, kLanes> z;
  alignas(32) std::array<float, kLanes> total;
};

SEGORIENT_INLINE void addLanes(const Block& b, std::size_t filled, const Kernel& kernel,
                               Sums& sums) {
  for (std::size_t first = 0; first < filled; first += kLanes) {
    for (std::size_t l = 0; l < kLanes; ++l) {
      const std::size_t j = first + l;
      const float off =
          (b.dx[j] * b.nx[j] + b.dy[j] * b.ny[j] + b.dz[j] * b.nz[j]) * kernel.inverse_tolerance;
      const float fit = b.fit[j] * kernel.inverse_residual;
      const float far2 = b.dx[j] * b.dx[j] + b.dy[j] * b.dy[j] + b.dz[j] * b.dz[j];
      // A Gaussian of the offset, to a few hundredths: (1 + t / 16)^16 for exp(t).
      const float base = 1.F + off * off * (0.5F / 16.F);
      const float base2 = base * base;
      const float base4 = base2 * base2;
      const float base8 = base4 * base4;
      // Half weight at two spacings.
      const float w = b.used[j] / (base8 * base8 * (1.F + fit * fit) * (1.F + 0.25F * far2));
      sums.x[l] += w * b.nx[j];
      sums.y[l] += w * b.ny[j];
      sums.z[l] += w * b.nz[j];
      sums.total[l] += w;
    }
  }
}

using AddBlock = void (*)(const Block&, std::size_t, const Kernel&, Sums&);

void addPortably(const Block& b, std::size_t filled, const Kernel& kernel, Sums& sums) {
  addLanes(b, filled, kernel, sums);
}
#if SEGORIENT_X86
SEGORIENT_TARGET_BEGIN("avx2")
void addByAvx2(const Block& b, std::size_t filled, const Kernel& kernel, Sums& sums) {
  addLanes(b, filled, kernel, sums);
}
SEGORIENT_TARGET_END
#endif

AddBlock chooseAddBlock() {
#if SEGORIENT_X86
  if (instructionSet() >= InstructionSet::Avx2) return &addByAvx2;
#endif
  return &addPortably;
}

Mean meanNormal(const PointView& points, const Neighborhoods& nb, const std::vector<float>& normals,
                float h, std::size_t p, const Kernel& kernel, AddBlock addBlock) {
  const pcl::index_t* row = nb.indices(p);
  constexpr float kMost = 1e36F;  // finite, and so is what distances in the cloud's unit give by it
  const float per_h = h > 0.F ? std::min(1.F / h, kMost) : 0.F;
  const auto count = static_cast<std::size_t>(nb.count(p));
  const bool fours = points.stride >= 4;
  Block block;
  Sums sums{};
  for (std::size_t first = 0; first < count; first += kBlock) {
    const std::size_t end = std::min(count, first + kBlock);
    std::size_t filled = 0;
    std::size_t j = first;
    for (; fours && j + 4 <= end; j += 4, filled += 4) {
      if (!block.setFour(filled, points, normals, p, row + j, per_h)) break;
    }
    for (; j < end; ++j) {
      const auto q = static_cast<std::size_t>(row[j]);
      const float* n = normals.data() + 4 * q;
      if (std::isfinite(n[0])) block.set(filled++, points[p], points[q], per_h, n);
    }
    while (filled % kLanes != 0) block.clear(filled++);
    addBlock(block, filled, kernel, sums);
  }
  Mean mean;
  for (std::size_t l = 0; l < kLanes; ++l) {
    mean.x += sums.x[l];
    mean.y += sums.y[l];
    mean.z += sums.z[l];
    mean.total += sums.total[l];
  }
  return mean;
}

}  // namespace

FilteredNormals filterOrientedNormals(const PointView& points, const Neighborhoods& nb,
                                      std::vector<float> oriented,
                                      const std::vector<float>& spacing, float residual, int rounds,
                                      bool wedges, int threads) {
  // A tenth of a spacing is what curvature explains at one spacing's distance, beside the noise.
  const float half_fit = 0.03F + residual;
  const Kernel kernel{1.F / std::sqrt(0.01F + residual * residual), 1.F / half_fit};
  const AddBlock addBlock = chooseAddBlock();
  FilteredNormals out;
  out.normals = std::move(oriented);
  out.confidences.assign(points.size, 0.F);
  std::vector<float> next;
  for (int round = 0; round < rounds; ++round) {
    next = out.normals;
    parallelFor(points.size, threads, 500.0, [&](std::size_t p) {
      if (out.confidences[p] > kAllAgree) return;
      const Mean mean = meanNormal(points, nb, out.normals, spacing[p], p, kernel, addBlock);
      const double l = mean.length();
      const auto total = static_cast<double>(mean.total);
      if (!(total > 0.0) || !(l > 1e-4 * total)) return;
      float* n = next.data() + 4 * p;
      if (!std::isfinite(n[0])) n[3] = half_fit;
      n[0] = static_cast<float>(static_cast<double>(mean.x) / l);
      n[1] = static_cast<float>(static_cast<double>(mean.y) / l);
      n[2] = static_cast<float>(static_cast<double>(mean.z) / l);
      out.confidences[p] = static_cast<float>(std::min(l / total, 1.0));  // rounding may exceed 1
    });
    out.normals.swap(next);
    if (wedges) detail::turnContraryPatches(points, nb, spacing, residual, threads, out);
  }
  if (wedges) detail::chooseSheets(points, nb, spacing, residual, threads, out);
  return out;
}

}  // namespace segorient
