// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "features/scan_scale.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <numeric>
#include <vector>

#include "common/every_nth.h"
#include "common/median.h"
#include "features/growing_scales.h"
#include "features/grown_planes.h"
#include "features/local_fit_job.h"
#include "features/sheet_fit.h"

namespace segorient::detail {
namespace {

using Rows = std::vector<pcl::index_t>;

constexpr Scales<4> kFew{kSheetScales};

// Fewer are on a line by chance now and then, more span two lines.
constexpr int kNearest = 18;
constexpr Scales<1> kOnLine{{kNearest}};
// A share of .01 is known to .0016 then.
constexpr std::size_t kLineSamples = 4096;

bool manyOnLines(const std::vector<Scales<1>::Fits>& fits) {
  // On surfaces that are sampled at random, evenly or by stripes, it is 0 to .003.
  constexpr double kMoreThanChance = 0.01;
  std::size_t on_lines = 0;
  for (const Scales<1>::Fits& f : fits) on_lines += std::isnan(f.noise2[0]) ? 1 : 0;
  return static_cast<double>(on_lines) > kMoreThanChance * static_cast<double>(fits.size());
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
    const Around near(nb, i);
    for (std::size_t j = 0; j < near.used; ++j) rows.push_back(near(j));
  }
  const std::size_t n = first.size();
  first.push_back(rows.size());
  const std::vector<Scales<4>::Fits> fits = kFew.fitRows(points, nb, rows, threads);
  std::vector<Scales<4>::Values> noise2(fits.size());
  for (std::size_t i = 0; i < fits.size(); ++i) noise2[i] = fits[i].noise2;
  const auto around = std::make_unique<PointsAround>();
  const auto medians = std::make_unique<MediansAround<4>>(noise2.data());
  std::size_t asking = 0;
  for (std::size_t s = 0; s < n; ++s) {
    const std::size_t at = s % GrownPlanes::kRows;
    if (at == 0) {
      around->clear();
      medians->restart(*around);
      for (std::size_t i = 0; i < GrownPlanes::kRows && s + i < n; ++i) {
        const auto self = static_cast<pcl::index_t>(first[s + i]);
        around->set(i, self, first[s + i + 1] - first[s + i] - 1,
                    [&](std::size_t j) { return self + 1 + static_cast<pcl::index_t>(j); });
      }
    }
    const std::size_t scale =
        kFew.choose(fits[first[s]].width2, [&](std::size_t size) { return (*medians)(at, size); });
    const auto k = static_cast<float>(kFew.sizes[scale]);
    asking += k > kClearly * static_cast<float>(smallest) ? 1 : 0;
  }
  return static_cast<double>(asking) > kManyAsk * static_cast<double>(n);
}

bool showsScanLines(const PointView& points, const Neighborhoods& nb, int threads) {
  if (nb.k() <= kNearest) return false;
  Rows rows;
  for (const std::size_t i : EveryNth(points.size, kLineSamples)) {
    rows.push_back(static_cast<pcl::index_t>(i));
  }
  return manyOnLines(kOnLine.fitRows(points, nb, rows, threads));
}

bool showsScanLines(const PointView& points, const search::MedianHashIndex& index, int threads) {
  if (points.size <= static_cast<std::size_t>(kNearest)) return false;
  std::vector<pcl::index_t> some;
  for (const std::size_t i : EveryNth(points.size, kLineSamples)) {
    some.push_back(static_cast<pcl::index_t>(i));
  }
  const std::vector<float> at = positionsOf(points, some);
  const PointView places{at.data(), 4, some.size()};
  const Neighborhoods nb = nearestOfPlaces(index, places, kNearest + 1, threads);
  Rows rows(some.size());
  std::iota(rows.begin(), rows.end(), 0);
  return manyOnLines(kOnLine.fitRows(places, points, nb, rows, threads));
}

bool isUneven(const PointView& points, const Neighborhoods& nb) {
  // The noise that asks for 18 neighbours is twice that which asks for 12.
  constexpr float kFactor = 2.F;
  // A tenth is known to .01 then.
  constexpr std::size_t kSamples = 1024;
  // Spacings of random points scatter by a fifth, medians of so many hardly.
  constexpr int kOthers = 12;
  std::vector<float> spacings;
  for (const std::size_t i : EveryNth(points.size, kSamples)) {
    std::vector<float> around;
    for (int j = 0; j < std::min(nb.count(i), kOthers + 1); ++j) {
      const auto q = static_cast<std::size_t>(nb.indices(i)[j]);
      around.push_back(meanDistance(points, nb, q, kFirstRing));
    }
    if (!around.empty()) spacings.push_back(median(around));
  }
  if (spacings.empty()) return false;
  std::sort(spacings.begin(), spacings.end());
  const std::size_t tenth = spacings.size() / 10;
  return spacings[spacings.size() - 1 - tenth] > kFactor * spacings[tenth];
}

}  // namespace segorient::detail
