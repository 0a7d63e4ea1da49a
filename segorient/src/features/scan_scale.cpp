// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "features/scan_scale.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>

#include "common/every_nth.h"
#include "common/threads.h"
#include "features/grown_planes.h"
#include "features/local_fit_job.h"

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
// Points around whose residuals count: a sheet's worth, every third of some more than the largest
// neighbourhoods have.
constexpr std::size_t kAround = 22;
constexpr int kVoters = 3 * static_cast<int>(kAround);

using Rows = std::vector<pcl::index_t>;

// ns a point, see resolveThreads().
constexpr double kFitTime = 100.0;

// Neighbourhoods of growing size, and their planes.
template <std::size_t kCount>
struct Scales {
  std::array<int, kCount> sizes;

  struct Fits {
    std::array<float, kCount> noise2;  // variance across the plane; NaN for one line
    std::array<float, kCount> width2;  // variance along its shorter side; 0 for one line
  };
  using Planes = std::array<GrownPlanes, kCount>;

  // \param put takes the number of each of the job's rows and its fits
  template <typename Put>
  void fit(const LocalFitJob& job, std::size_t count, Planes& planes, const Put& put) const {
    for (std::size_t begin = 0; begin < count; begin += GrownPlanes::kRows) {
      const std::size_t end = std::min(count, begin + GrownPlanes::kRows);
      fitGrownPlanes(job, sizes.data(), kCount, begin, end, planes.data());
      for (std::size_t i = begin; i < end; ++i) put(i, fitsAt(planes, i - begin));
    }
  }

  // Of some rows of a table.
  std::vector<Fits> fitRows(const PointView& points, const Neighborhoods& nb, const Rows& rows,
                            int threads) const {
    std::vector<Fits> out(rows.size());
    const FourFloats xyz(points);
    LocalFitJob job = jobOf(points, xyz, nb, sizes.back());
    const auto blocks =
        static_cast<std::ptrdiff_t>((rows.size() + GrownPlanes::kRows - 1) / GrownPlanes::kRows);
    const int t = resolveThreads(threads, rows.size(), kFitTime);
#pragma omp parallel for num_threads(t) firstprivate(job)
    for (std::ptrdiff_t b = 0; b < blocks; ++b) {
      const std::size_t begin = static_cast<std::size_t>(b) * GrownPlanes::kRows;
      const auto planes = std::make_unique<Planes>();
      job.rows = rows.data() + begin;
      fit(job, std::min(rows.size() - begin, GrownPlanes::kRows), *planes,
          [&](std::size_t i, const Fits& fits) { out[begin + i] = fits; });
    }
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
      out.noise2[s] = wide ? p.lambda[0][i] * n / (n - 3.F) * unit2 : kNone;
      out.width2[s] = wide ? p.lambda[1][i] * unit2 : 0.F;
    }
    return out;
  }

  // \param median of a scale's variances, over the points around
  // \return the number of a scale
  template <typename Median>
  std::size_t choose(const Fits& own, const Median& median) const {
    const float noise2 = saturation(median);
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

// A point's neighbours around whose residuals count, spread over all that a table has.
struct Around {
  const pcl::index_t* row;
  std::size_t count;
  std::size_t used = std::min(count, kAround);

  Around(const Neighborhoods& nb, std::size_t i)
      : row(nb.indices(i)), count(static_cast<std::size_t>(std::max(nb.count(i) - 1, 0))) {}
  pcl::index_t operator()(std::size_t j) const { return row[1 + j * count / used]; }
};

// Of some points, medians over each and the points around it, found when asked for: few points ask
// for those of the larger scales.
template <std::size_t kCount>
class MediansAround {
 public:
  using Fits = typename Scales<kCount>::Fits;

  // \param fits of the points that rows speak of
  explicit MediansAround(const Fits* fits) : fits_(fits) {}

  // Begins anew with none.
  void clear() {
    around_.fill(kNobody);
    found_ = 0;
  }
  // \param i less than GrownPlanes::kRows \param around `count` points, kAround at most
  template <typename Around>
  void setPoint(std::size_t i, pcl::index_t self, std::size_t count, const Around& around) {
    around_[i] = self;
    for (std::size_t j = 0; j < count; ++j) around_[(1 + j) * GrownPlanes::kRows + i] = around(j);
  }
  float operator()(std::size_t i, std::size_t scale) {
    for (; found_ <= scale; ++found_) {
      for (std::size_t v = 0; v < values_.size(); ++v) {
        const pcl::index_t point = around_[v];
        values_[v] =
            point == kNobody ? kNone : fits_[static_cast<std::size_t>(point)].noise2[found_];
      }
      findMedians(values_.data(), 1 + kAround, medians_[found_].data());
    }
    return medians_[scale][i];
  }

 private:
  static constexpr pcl::index_t kNobody = -1;
  const Fits* fits_;
  std::array<pcl::index_t, (1 + kAround) * GrownPlanes::kRows> around_;
  std::array<float, (1 + kAround) * GrownPlanes::kRows> values_;
  std::array<std::array<float, GrownPlanes::kRows>, kCount> medians_;
  std::size_t found_ = 0;
};

// Fits planes of a size to some rows of a table.
// \param rows of the table \param take see fitScanPlanes(), but of the table's row
template <typename Take>
void fitSome(LocalFitJob job, int size, const Rows& rows, const Take& take) {
  job.rows = rows.data();
  const auto planes = std::make_unique<GrownPlanes>();
  for (std::size_t begin = 0; begin < rows.size(); begin += GrownPlanes::kRows) {
    const std::size_t end = std::min(rows.size(), begin + GrownPlanes::kRows);
    fitGrownPlanes(job, &size, 1, begin, end, planes.get());
    for (std::size_t i = begin; i < end; ++i) take(rows[i], *planes, i - begin);
  }
}

}  // namespace

bool needsScanScales(const PointView& points, const Neighborhoods& nb, int smallest, int threads) {
  // A share of .15 is known to about .01 then.
  constexpr std::size_t kSamples = 1024;
  // Edges make up to a sixth of the points of even clouds ask, rings and near surfaces a quarter to
  // three quarters of those of scans.
  constexpr double kManyAsk = 0.15;
  // Noise that leaves the largest of them no say asks for more everywhere.
  if (smallest >= kSheetNeighbors) return true;
  // Each sample, and behind it the points around.
  Rows rows;
  std::vector<std::size_t> first;
  for (const std::size_t i : EveryNth(points.size, kSamples)) {
    first.push_back(rows.size());
    rows.push_back(static_cast<pcl::index_t>(i));
    const Around around(nb, i);
    for (std::size_t j = 0; j < around.used; ++j) rows.push_back(around(j));
  }
  const std::size_t n = first.size();
  first.push_back(rows.size());
  const std::vector<Scales<4>::Fits> fits = kFew.fitRows(points, nb, rows, threads);
  const auto medians = std::make_unique<MediansAround<4>>(fits.data());
  std::size_t asking = 0;
  for (std::size_t s = 0; s < n; ++s) {
    const std::size_t at = s % GrownPlanes::kRows;
    if (at == 0) {
      medians->clear();
      for (std::size_t i = 0; i < GrownPlanes::kRows && s + i < n; ++i) {
        const auto self = static_cast<pcl::index_t>(first[s + i]);
        medians->setPoint(i, self, first[s + i + 1] - first[s + i] - 1,
                          [&](std::size_t j) { return self + 1 + static_cast<pcl::index_t>(j); });
      }
    }
    const std::size_t scale =
        kFew.choose(fits[first[s]], [&](std::size_t size) { return (*medians)(at, size); });
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
  Rows rows;
  for (const std::size_t i : EveryNth(points.size, kSamples)) {
    rows.push_back(static_cast<pcl::index_t>(i));
  }
  std::size_t on_lines = 0;
  for (const Scales<1>::Fits& fits : scale.fitRows(points, nb, rows, threads)) {
    on_lines += std::isnan(fits.noise2[0]) ? 1 : 0;
  }
  return static_cast<double>(on_lines) > kMoreThanChance * static_cast<double>(rows.size());
}

void fitScanPlanes(MoreNeighbors& more, int smallest, const ScanPlaneTaker& take) {
  const PointView& points = more.points();
  const FourFloats xyz(points);
  FastVector<Scales<6>::Fits> fits(points.size);
  more.index().nearestKByRegion(kVoters + 1, [&](const Rows& rows, const Neighborhoods& table) {
    const std::vector<float> at = positionsOf(points, rows);
    const auto planes = std::make_unique<Scales<6>::Planes>();
    kMany.fit(jobOf({at.data(), 4, rows.size()}, xyz, table, kMany.sizes.back()), rows.size(),
              *planes, [&](std::size_t i, const Scales<6>::Fits& found) {
                fits[static_cast<std::size_t>(rows[i])] = found;
              });
  });
  more.index().nearestKByRegion(kVoters + 1, [&](const Rows& rows, const Neighborhoods& table) {
    std::array<Rows, kMany.sizes.size()> of_scale;
    const auto medians = std::make_unique<MediansAround<6>>(fits.data());
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const std::size_t in_block = i % GrownPlanes::kRows;
      if (in_block == 0) {
        medians->clear();
        for (std::size_t j = 0; j < GrownPlanes::kRows && i + j < rows.size(); ++j) {
          const Around around(table, i + j);
          medians->setPoint(j, rows[i + j], around.used, around);
        }
      }
      const std::size_t scale =
          kMany.choose(fits[static_cast<std::size_t>(rows[i])],
                       [&](std::size_t size) { return (*medians)(in_block, size); });
      of_scale[scale].push_back(static_cast<pcl::index_t>(i));
    }
    const std::vector<float> at = positionsOf(points, rows);
    for (std::size_t s = 0; s < of_scale.size(); ++s) {
      const int k = kMany.sizes[s];
      if (static_cast<float>(k) <= kClearly * static_cast<float>(smallest)) continue;
      fitSome(jobOf({at.data(), 4, rows.size()}, xyz, table, k), k, of_scale[s],
              [&](pcl::index_t i, const GrownPlanes& planes, std::size_t in_block) {
                const auto row = static_cast<std::size_t>(rows[static_cast<std::size_t>(i)]);
                if (planes.at(in_block).valid) take(row, planes, in_block);
              });
    }
  });
}

}  // namespace segorient::detail
