// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "features/scan_scale.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <tuple>

#include "common/threads.h"

namespace segorient::detail {
namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

// Neighbours spread in one direction only, as on a ring: their plane is any plane through it.
constexpr float kOneLine = 0.15F;
// Residuals of a curved surface grow with the square of the number of neighbours, from one scale to
// the next by 2.2; those of noise do not grow.
constexpr float kFlat = 1.7F;
// Clearly larger: two scales.
constexpr float kClearly = 1.6F;
// Points around whose residuals count: a sheet's worth, beyond the larger neighbourhoods.
constexpr std::size_t kAround = 22;

// Room for those and the point's own, in whole vectors, and an entry that is written in vain.
using Values = std::array<float, 32>;
static_assert(kAround + 2 <= std::tuple_size<Values>::value);

// The value that n / 2 others are less than, as sorting would find it; NaN where there is none. By
// counting, which branches nowhere: so few are counted sooner than they are parted.
float middleOf(Values& values, std::size_t n) {
  if (n == 0) return kNone;
  std::fill(values.begin() + static_cast<std::ptrdiff_t>(n), values.end(),
            std::numeric_limits<float>::infinity());
  std::array<std::int32_t, std::tuple_size<Values>::value> less{};
  for (std::size_t j = 0; j < n; ++j) {
    const float v = values[j];
    for (std::size_t i = 0; i < values.size(); ++i) less[i] += v < values[i] ? 1 : 0;
  }
  const auto half = static_cast<std::int32_t>(n / 2);
  float middle = -std::numeric_limits<float>::infinity();
  for (std::size_t i = 0; i < n; ++i) {
    middle = less[i] <= half ? std::max(middle, values[i]) : middle;
  }
  return middle;
}

template <std::size_t kCount>
struct Scales {
  std::array<int, kCount> sizes;

  struct Fits {
    std::array<float, kCount> noise2;  // variance across the plane; NaN for one line
    std::array<float, kCount> width2;  // variance along its shorter side; 0 for one line
  };

  // \param h unit of the offsets
  Fits fit(const PointView& points, const Neighborhoods& nb, std::size_t i, float h) const {
    Fits out;
    Moments m;
    m.addOrigin();
    const pcl::index_t* row = nb.indices(i);
    const int count = nb.count(i);
    const float* p = points[i];
    const float per_h = h > 0.F ? 1.F / h : 0.F;
    int j = 1;
    for (std::size_t s = 0; s < kCount; ++s) {
      for (; j <= sizes[s] && j < count; ++j) {
        const float* q = points[static_cast<std::size_t>(row[j])];
        m.add((q[0] - p[0]) * per_h, (q[1] - p[1]) * per_h, (q[2] - p[2]) * per_h);
      }
      const Eigen::Vector3f lambda = planeVariances(m);
      const bool wide = m.n > 3.F && lambda[1] > 0.F && lambda[1] >= kOneLine * lambda[2];
      out.noise2[s] = wide ? lambda[0] * m.n / (m.n - 3.F) * h * h : kNone;
      out.width2[s] = wide ? lambda[1] * h * h : 0.F;
    }
    return out;
  }

  // \param around fits of the points around, which the medians are taken of
  // \param noise2 the variance that was found
  // \return the number of a scale
  template <typename FitOf>
  std::size_t choose(const Fits& own, std::size_t around, const FitOf& fit_of,
                     float& noise2) const {
    noise2 = saturation([&](std::size_t s) {
      Values values;
      std::size_t n = 0;
      if (std::isfinite(own.noise2[s])) values[n++] = own.noise2[s];
      for (std::size_t j = 0; j < around; ++j) {
        const float v = fit_of(j, s);
        values[n] = v;
        n += std::isfinite(v) ? 1 : 0;
      }
      return middleOf(values, n);
    });
    for (std::size_t s = 0; s < kCount; ++s) {
      const float w = own.width2[s];
      if (!(noise2 < 0.5F * w)) continue;
      const float rest = w - noise2;
      const auto n = static_cast<float>(sizes[s] + 1);
      if (noise2 * w < kMostNormalError * kMostNormalError * n * rest * rest) return s;
    }
    return kCount - 1;
  }

  // The first of the variances from which the next two stay flat; without one, the first.
  // \param median of a scale: most stay flat from the smallest on, and no others are asked for
  template <typename Median>
  static float saturation(const Median& median) {
    std::size_t s = 0;
    float here = median(s);
    while (s + 1 < kCount && !std::isfinite(here)) here = median(++s);
    const float first = std::isfinite(here) ? here : 0.F;
    float next = s + 1 < kCount ? median(s + 1) : kNone;
    for (; s + 2 < kCount; ++s) {
      const float last = median(s + 2);
      if (next <= kFlat * here && last <= kFlat * here) return here;
      here = next;
      next = last;
    }
    return first;
  }
};

constexpr Scales<4> kFew{kSheetScales};
// Half as many again each time, up to where planes are nearly free of noise.
constexpr Scales<6> kMany{{8, 12, 18, 27, 40, 60}};
// ns a point, see resolveThreads().
constexpr double kVoteTime = 20000.0;
constexpr double kFitTime = 2000.0;

}  // namespace

bool needsScanScales(const PointView& points, const Neighborhoods& nb, int smallest, int threads) {
  // A share of .15 is known to about .01 then.
  constexpr std::size_t kSamples = 1024;
  // Edges make up to a sixth of the points of even clouds ask, rings and near surfaces a quarter to
  // three quarters of those of scans.
  constexpr double kManyAsk = 0.15;
  // Noise that leaves the largest of them no say asks for more everywhere.
  if (smallest >= kSheetNeighbors) return true;
  const std::size_t step = std::max<std::size_t>(1, points.size / kSamples);
  const std::size_t n = (points.size + step - 1) / step;
  std::size_t asking = 0;
#pragma omp parallel for num_threads(resolveThreads(threads, n, kVoteTime)) schedule(dynamic, 32) \
    reduction(+ : asking)
  for (std::size_t s = 0; s < n; ++s) {
    const std::size_t i = s * step;
    const auto fitsOf = [&](std::size_t p) {
      return kFew.fit(points, nb, p, meanDistance(points, nb, p, 6));
    };
    const Scales<4>::Fits own = fitsOf(i);
    std::array<Scales<4>::Fits, kAround> others;
    const auto count = static_cast<std::size_t>(std::max(nb.count(i) - 1, 0));
    const std::size_t around = std::min(count, kAround);
    for (std::size_t j = 0; j < around; ++j) {
      others[j] = fitsOf(static_cast<std::size_t>(nb.indices(i)[1 + j * count / around]));
    }
    float noise2 = 0.F;
    const std::size_t scale = kFew.choose(
        own, around, [&](std::size_t j, std::size_t k) { return others[j].noise2[k]; }, noise2);
    const auto k = static_cast<float>(kFew.sizes[scale]);
    asking += k > kClearly * static_cast<float>(smallest) ? 1 : 0;
  }
  return static_cast<double>(asking) > kManyAsk * static_cast<double>(n);
}

bool showsScanLines(const PointView& points, const Neighborhoods& nb, int threads) {
  // A share of .01 is known to .0016 then.
  constexpr std::size_t kSamples = 4096;
  constexpr int kNearest = 18;
  // On surfaces that are sampled at random, evenly or by stripes, it is 0 to .003.
  constexpr double kMoreThanChance = 0.01;
  if (nb.k() <= kNearest) return false;
  const Scales<1> scale{{kNearest}};
  const std::size_t step = std::max<std::size_t>(1, points.size / kSamples);
  const std::size_t n = (points.size + step - 1) / step;
  std::size_t on_lines = 0;
#pragma omp parallel for num_threads(resolveThreads(threads, n, kFitTime)) schedule(static) \
    reduction(+ : on_lines)
  for (std::size_t s = 0; s < n; ++s) {
    const float h = meanDistance(points, nb, s * step, 6);
    on_lines += std::isnan(scale.fit(points, nb, s * step, h).noise2[0]) ? 1 : 0;
  }
  return static_cast<double>(on_lines) > kMoreThanChance * static_cast<double>(n);
}

std::vector<ScanPlane> fitScanPlanes(MoreNeighbors& more, const std::vector<float>& spacing,
                                     int smallest, int threads) {
  const PointView& points = more.points();
  const Neighborhoods& nb = more.ofAll();
  const std::size_t n = points.size;
  FastVector<Scales<6>::Fits> fits(n);
  const int t = resolveThreads(threads, n, kFitTime);
#pragma omp parallel for num_threads(t) schedule(dynamic, 512)
  for (std::size_t i = 0; i < n; ++i) fits[i] = kMany.fit(points, nb, i, spacing[i]);
  std::vector<ScanPlane> out(n);
#pragma omp parallel for num_threads(t) schedule(dynamic, 512)
  for (std::size_t i = 0; i < n; ++i) {
    const auto count = static_cast<std::size_t>(std::max(nb.count(i) - 1, 0));
    const std::size_t around = std::min(count, kAround);
    float noise2 = 0.F;
    const std::size_t scale = kMany.choose(
        fits[i], around,
        [&](std::size_t j, std::size_t s) {
          return fits[static_cast<std::size_t>(nb.indices(i)[1 + j * count / around])].noise2[s];
        },
        noise2);
    const int k = kMany.sizes[scale];
    if (static_cast<float>(k) <= kClearly * static_cast<float>(smallest)) continue;
    if (!(spacing[i] > 0.F)) continue;
    Moments m;
    m.addOrigin();
    const float* p = points[i];
    for (int j = 1; j <= k && j < nb.count(i); ++j) {
      const float* q = points[static_cast<std::size_t>(nb.indices(i)[j])];
      m.add((q[0] - p[0]) / spacing[i], (q[1] - p[1]) / spacing[i], (q[2] - p[2]) / spacing[i]);
    }
    out[i].plane = fitPlane(m);
    if (!out[i].plane.valid) continue;
    out[i].scale = k;
    out[i].noise = std::sqrt(noise2) / spacing[i];
  }
  return out;
}

}  // namespace segorient::detail
