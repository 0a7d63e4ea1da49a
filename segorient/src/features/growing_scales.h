// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/neighborhoods.h>
#include <segorient/common/point_view.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <vector>

#include "common/parallel_for.h"
#include "features/grown_planes.h"
#include "features/local_fit_job.h"
#include "features/scan_scale.h"

namespace segorient::detail {

/// Residuals of a curved surface grow with the square of the number of neighbours, from one scale
/// to the next by 2.2; those of noise do not grow.
constexpr float kFlat = 1.7F;
/// Clearly larger: two scales.
constexpr float kClearly = 1.6F;
/// Points around whose residuals count: a sheet's worth, every third of some more than the largest
/// neighbourhoods have.
constexpr std::size_t kAround = 22;
constexpr int kVoters = 3 * static_cast<int>(kAround);

/// ns a point, see resolveThreads().
constexpr double kFitTime = 100.0;

/// Neighbourhoods of growing size, and their planes.
template <std::size_t kCount>
struct Scales {
  std::array<int, kCount> sizes;

  static constexpr float kNoPlane = std::numeric_limits<float>::quiet_NaN();
  using Values = std::array<float, kCount>;
  struct Fits {
    Values noise2;  // variance across the plane; NaN for one line
    Values width2;  // variance along its shorter side; 0 for one line
  };
  using Planes = std::array<GrownPlanes, kCount>;

  // Of some rows of a table.
  std::vector<Fits> fitRows(const PointView& points, const Neighborhoods& nb,
                            const std::vector<pcl::index_t>& rows, int threads) const {
    return fitRows(points, points, nb, rows, threads);
  }
  // \param at a point for each row of the table, which speaks of `points`
  std::vector<Fits> fitRows(const PointView& at, const PointView& points, const Neighborhoods& nb,
                            const std::vector<pcl::index_t>& rows, int threads) const {
    std::vector<Fits> out(rows.size());
    const FourFloats xyz(points);
    LocalFitJob job = jobOf(at, xyz, nb, sizes.back());
    job.rows = rows.data();
    const std::size_t blocks = (rows.size() + GrownPlanes::kRows - 1) / GrownPlanes::kRows;
    parallelFor(
        blocks, threads, kFitTime * GrownPlanes::kRows, [] { return std::make_unique<Planes>(); },
        [&](std::size_t b, std::unique_ptr<Planes>& planes) {
          const std::size_t begin = b * GrownPlanes::kRows;
          const std::size_t end = std::min(rows.size(), begin + GrownPlanes::kRows);
          fitGrownPlanes(job, sizes.data(), kCount, begin, end, planes->data());
          for (std::size_t i = begin; i < end; ++i) out[i] = fitsAt(*planes, i - begin);
        });
    return out;
  }

  static Fits fitsAt(const Planes& planes, std::size_t i) {
    Fits out;
    for (std::size_t s = 0; s < kCount; ++s) {
      const GrownPlanes& p = planes[s];
      const float n = p.n[i];
      const bool wide =
          n > 3.F && p.lambda[1][i] > 0.F && p.lambda[1][i] >= kOneLine * p.lambda[2][i];
      const float unit2 = p.unit[i] * p.unit[i];
      out.noise2[s] = wide ? p.lambda[0][i] * n / (n - 3.F) * unit2 : kNoPlane;
      out.width2[s] = wide ? p.lambda[1][i] * unit2 : 0.F;
    }
    return out;
  }

  // \param width2 of the point's fits \param median of a scale's variances, over the points around
  // \return the number of a scale
  template <typename Median>
  std::size_t choose(const Values& width2, const Median& median) const {
    const float noise2 = saturation(median);
    for (std::size_t s = 0; s < kCount; ++s) {
      const float w = width2[s];
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
    float next = s + 1 < kCount ? median(s + 1) : kNoPlane;
    for (; s + 2 < kCount; ++s) {
      const float last = median(s + 2);
      if (next <= kFlat * here && last <= kFlat * here) return here;
      here = next;
      next = last;
    }
    return first;
  }
};

/// A point's neighbours around whose residuals count, spread over all that a table has.
struct Around {
  const pcl::index_t* row;
  std::size_t count;
  std::size_t used = std::min(count, kAround);
  std::size_t step = used > 0 && count % used == 0 ? count / used : 0;  // 0 = not always the same

  Around(const Neighborhoods& nb, std::size_t i)
      : row(nb.indices(i)), count(static_cast<std::size_t>(std::max(nb.count(i) - 1, 0))) {}
  pcl::index_t operator()(std::size_t j) const {
    return row[1 + (step > 0 ? j * step : j * count / used)];
  }
};

/// Of some points, the points around each, these themselves first.
class PointsAround {
 public:
  static constexpr pcl::index_t kNobody = -1;

  /// Begins anew with none.
  void clear() { around_.fill(kNobody); }
  /// \param i less than GrownPlanes::kRows \param around `count` points, kAround at most
  template <typename Points>
  void set(std::size_t i, pcl::index_t self, std::size_t count, const Points& around) {
    around_[i] = self;
    for (std::size_t j = 0; j < count; ++j) around_[(1 + j) * GrownPlanes::kRows + i] = around(j);
  }
  /// The j-th of point i at [j * GrownPlanes::kRows + i].
  pcl::index_t operator[](std::size_t at) const { return around_[at]; }
  std::size_t size() const { return around_.size(); }

 private:
  std::array<pcl::index_t, (1 + kAround) * GrownPlanes::kRows> around_;
};

/// Of some points, medians over each and the points around it, found when asked for: few points ask
/// for those of the larger scales.
template <std::size_t kCount>
class MediansAround {
 public:
  using Values = typename Scales<kCount>::Values;

  /// \param noise2 of all points that there are
  explicit MediansAround(const Values* noise2) : noise2_(noise2) {}

  /// Begins anew. \param around must outlive what is asked from now on
  void restart(const PointsAround& around) {
    around_ = &around;
    found_ = 0;
  }
  float operator()(std::size_t i, std::size_t scale) {
    for (; found_ <= scale; ++found_) {
      for (std::size_t v = 0; v < values_.size(); ++v) {
        const pcl::index_t point = (*around_)[v];
        values_[v] = point == PointsAround::kNobody
                         ? Scales<kCount>::kNoPlane
                         : noise2_[static_cast<std::size_t>(point)][found_];
      }
      findMedians(values_.data(), 1 + kAround, medians_[found_].data());
    }
    return medians_[scale][i];
  }

 private:
  const Values* noise2_;
  const PointsAround* around_ = nullptr;
  std::array<float, (1 + kAround) * GrownPlanes::kRows> values_;
  std::array<std::array<float, GrownPlanes::kRows>, kCount> medians_;
  std::size_t found_ = 0;
};

}  // namespace segorient::detail
