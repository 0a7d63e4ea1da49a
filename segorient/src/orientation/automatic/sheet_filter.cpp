// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/automatic/sheet_filter.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <utility>

#include "common/parallel_for.h"
#include "common/vectors.h"
#include "common/widest.h"
#include "features/local_fit_job.h"
#include "orientation/automatic/contrary_patches.h"
#include "orientation/automatic/sheet_choice.h"

namespace segorient {
namespace {

// In place of a row that is empty.
constexpr pcl::index_t kNobody = 0;

// What the means are made of.
struct NormalsAround {
  const float* xyz;         // 4 floats a point
  const float* normals;     // likewise: oriented, residual in spacings
  float inverse_tolerance;  // of the distance to a plane, in spacings
  float inverse_residual;   // at which a plane counts half
};

// Some points, their neighbours, and the means of these.
struct MeanBlock {
  static constexpr std::size_t kPoints = 16;  // as many as the widest registers hold

  const pcl::index_t* rows[kPoints];
  const float* own[kPoints];        // the points themselves
  std::size_t counts[kPoints];      // of neighbours
  std::size_t least = 0, most = 0;  // of these
  float per_h[kPoints];             // of a spacing
  float mean_x[kPoints], mean_y[kPoints], mean_z[kPoints], total[kPoints];
};

#define SEGORIENT_KERNELS "orientation/automatic/filter_lanes.inl"
#include "common/each_width.inl"
#undef SEGORIENT_KERNELS

using FindMeans = void (*)(const NormalsAround&, MeanBlock&);

// One round of means.
struct Round {
  const Neighborhoods& nb;
  const std::vector<float>& spacing;
  NormalsAround around;
  float half_fit;
  FindMeans findMeans;

  // Of some points, MeanBlock::kPoints at most; the first fills the lanes that are left.
  void run(const std::size_t* points, std::size_t count, float* normals, float* confidences) const {
    MeanBlock block;
    for (std::size_t l = 0; l < MeanBlock::kPoints; ++l) {
      const std::size_t p = points[l < count ? l : 0];
      constexpr float kMost = 1e36F;  // finite, and so is what distances give by it
      block.rows[l] = nb.count(p) > 0 ? nb.indices(p) : &kNobody;
      block.own[l] = around.xyz + 4 * p;
      block.counts[l] = static_cast<std::size_t>(nb.count(p));
      block.per_h[l] = spacing[p] > 0.F ? std::min(1.F / spacing[p], kMost) : 0.F;
    }
    block.least = *std::min_element(std::begin(block.counts), std::end(block.counts));
    block.most = *std::max_element(std::begin(block.counts), std::end(block.counts));
    findMeans(around, block);
    for (std::size_t l = 0; l < count; ++l) {
      const std::array<float, 3> mean{block.mean_x[l], block.mean_y[l], block.mean_z[l]};
      set(mean, block.total[l], normals + 4 * points[l], confidences[points[l]]);
    }
  }

 private:
  void set(const std::array<float, 3>& mean, float total, float* n, float& confidence) const {
    // In double: far from all neighbours the weights are so small that squares leave float's range.
    double square = 0.0;
    for (const float v : mean) square += static_cast<double>(v) * static_cast<double>(v);
    const double l = std::sqrt(square);
    const auto sum = static_cast<double>(total);
    if (!(sum > 0.0) || !(l > 1e-4 * sum)) return;
    if (!std::isfinite(n[0])) n[3] = half_fit;
    for (std::size_t a = 0; a < 3; ++a) n[a] = static_cast<float>(static_cast<double>(mean[a]) / l);
    confidence = static_cast<float>(std::min(l / sum, 1.0));  // rounding may exceed 1
  }
};

// Points that a thread takes at once: those of them that still have something to gain fill blocks.
constexpr std::size_t kTaken = 256;

}  // namespace

FilteredNormals filterOrientedNormals(const PointView& points, const Neighborhoods& nb,
                                      std::vector<float> oriented,
                                      const std::vector<float>& spacing, float residual, int rounds,
                                      bool wedges, int threads) {
  // What curvature explains beside the noise: .03 of a spacing of how well a plane fits, and a
  // tenth, the root of .01, of how far a neighbour lies off it at one spacing's distance.
  const float half_fit = 0.03F + residual;
  const detail::FourFloats xyz(points);
  Round round{nb,
              spacing,
              {xyz.data(), nullptr, 1.F / std::sqrt(0.01F + residual * residual), 1.F / half_fit},
              half_fit,
              SEGORIENT_WIDEST(findMeans)};
  FilteredNormals out;
  out.normals = std::move(oriented);
  out.confidences.assign(points.size, 0.F);
  std::vector<float> next(out.normals.size());
  for (int i = 0; i < rounds; ++i) {
    round.around.normals = out.normals.data();
    parallelFor((points.size + kTaken - 1) / kTaken, threads, 100.0 * kTaken, [&](std::size_t b) {
      const std::size_t begin = b * kTaken;
      const std::size_t end = std::min(points.size, begin + kTaken);
      std::copy(&out.normals[4 * begin], &out.normals[4 * begin] + 4 * (end - begin),
                &next[4 * begin]);
      std::size_t todo[kTaken];
      std::size_t count = 0;
      for (std::size_t p = begin; p < end; ++p) {
        if (!(out.confidences[p] > kAllAgree)) todo[count++] = p;
      }
      for (std::size_t at = 0; at < count; at += MeanBlock::kPoints) {
        round.run(todo + at, std::min(MeanBlock::kPoints, count - at), next.data(),
                  out.confidences.data());
      }
    });
    out.normals.swap(next);
    if (wedges) detail::turnContraryPatches(points, nb, spacing, residual, threads, out);
  }
  if (wedges) detail::chooseSheets(points, nb, spacing, residual, threads, out);
  return out;
}

}  // namespace segorient
