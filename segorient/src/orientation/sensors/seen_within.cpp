// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/sensors/seen_within.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>
#include <utility>

#include "common/median.h"
#include "orientation/sensors/sampling_law.h"
#include "orientation/sensors/station_mixture.h"

namespace segorient::detail {
namespace {

using Position = std::array<double, 3>;

// By how many standard errors places within have to explain the pieces better than places around.
constexpr double kSure = 3.0;
// What each piece got from one of its sides, less what it got from the other, as a part of both: of
// rooms, streets and tunnels .74 and more. Of bodies that a scanner was carried around close by it
// is .43 to .72, as places in them leave the same; of one that is built of bricks, all of whose
// faces have points, .71.
constexpr double kOneSided = 0.73;
// The same where places around may have left as well: of rooms, streets and yards that were thinned
// .90 and more; of balls with spikes, which hide each other, .80 and less.
constexpr double kOneSidedOfEither = 0.85;
// Where all of it comes from one side the surface is convex: nothing in it hides anything, and a
// body that was seen all around looks like that as well. Unless places do not see most of it, as
// behind the walls of a room.
constexpr double kConvex = 0.995;
constexpr double kBehindWalls = 0.5;

// What the same density everywhere loses against the densities there, as a mean logarithm: where
// bodies touch two layers lie in one place, which is .06 at most, and chance .02 more. Scans that
// were seen from within lose .17 and more.
constexpr double kTwoLayers = 0.1;
// Share of that which places within may leave: 60 scans .17 at most. Where edges are sampled ten
// times more densely than faces, or rows of vertices lie closer, .21 and more; depth cameras that
// look about in a room reach .20.
constexpr double kMostLeft = 0.2;

// Of the pieces, those around one that it is compared with: as far away as what was seen from
// within has changed, and on bodies most are of the same part.
constexpr std::size_t kPartBeside = 8;
// Median difference of density there, over that by chance: of bodies part of which is up to 25
// times as dense as the rest 1.6 at most, of those that places within explain 1.45; of 60 scenes
// seen from within 1.79 and more.
constexpr float kEvenBeside = 1.6F;

double lossOf(const std::vector<double>& logs) {
  return -std::accumulate(logs.begin(), logs.end(), 0.0) / static_cast<double>(logs.size());
}

// Densities over those there, to their logarithms without what all have in common.
void toLogs(std::vector<double>& densities) {
  double mean = 0.0;
  for (const double v : densities) mean += v / static_cast<double>(densities.size());
  for (double& v : densities) v = std::log(v / mean);
}

double lossOfConstant(const DensityPatches& patches) {
  std::vector<double> logs(patches.sparsity.begin(), patches.sparsity.end());
  toLogs(logs);
  return lossOf(logs);
}

// Whether the density is that of most pieces around, as on bodies part of which was sampled more
// densely: what sensors leave falls with distance and incidence everywhere. By a median, as steps
// between such parts are few.
bool isEvenBeside(const DensityPatches& patches, int threads) {
  const search::MedianHashIndex index = patches.index(threads);
  const std::size_t count = patches.size() / kPartBeside;
  if (count < 2) return true;  // too few to tell
  std::vector<pcl::index_t> near(count);
  std::vector<float> squared(count);
  std::vector<float> differences;
  differences.reserve(patches.size() * count);
  for (std::size_t i = 0; i < patches.size(); ++i) {
    const float center[3] = {patches.x[i], patches.y[i], patches.z[i]};
    const int found = index.nearestK(center, static_cast<int>(count), near.data(), squared.data());
    for (int k = 0; k < found; ++k) {
      const auto j = static_cast<std::size_t>(near[static_cast<std::size_t>(k)]);
      if (j == i) continue;
      differences.push_back(std::fabs(patches.log_density[i] - patches.log_density[j]));
    }
  }
  // Of normal values, the median difference of two is .954 deviations, the mean deviation .798.
  constexpr float kDifference = 0.954F / 0.798F;
  return median(differences) < kEvenBeside * kDifference * chanceDeviation(patches.k);
}

// A mixture of places whose rays nothing is known of.
struct Explained {
  std::vector<Position> places;
  Mixture mixture;
  std::vector<double> logs;  // of each piece: its density by the mixture over the one there

  Explained(const DensityPatches& patches, const Occupancy& occupancy, std::vector<Position> tried,
            int threads)
      : places(std::move(tried)),
        mixture(mixtureOf(patches, occupancy, places, Place{}, threads)),
        logs(patches.size(), 0.0) {
    for (std::size_t j = 0; j < mixture.size(); ++j) {
      const auto weight = static_cast<double>(mixture.weights[j]);
      const float* const row = mixture.row(j);
      for (std::size_t i = 0; i < logs.size(); ++i) {
        logs[i] += weight * static_cast<double>(row[i]);
      }
    }
    toLogs(logs);
  }
};

// Of the differences' mean, in standard errors.
double advantage(const std::vector<double>& mine, const std::vector<double>& other) {
  double sum = 0.0;
  double squares = 0.0;
  for (std::size_t i = 0; i < mine.size(); ++i) {
    const double d = mine[i] - other[i];
    sum += d;
    squares += d * d;
  }
  const auto n = static_cast<double>(mine.size());
  const double variance = squares / n - sum / n * (sum / n);
  return sum / n / std::sqrt(std::max(variance, 1e-30) / n);
}

// What each piece got from either side, and where from.
struct Sides {
  std::vector<float> directions;
  double one_sided = 0.0;  // mean share of one side less that of the other
};

Sides sidesOf(const DensityPatches& patches, const Explained& within) {
  const std::size_t n = patches.size();
  std::vector<double> balance(n, 0.0);
  std::vector<double> total(n, 0.0);
  std::vector<Position> direction(n, Position{0.0, 0.0, 0.0});
  for (std::size_t j = 0; j < within.mixture.size(); ++j) {
    const Position& place = within.places[within.mixture.place[j]];
    const std::vector<float> heights = patches.heightsOver(place);
    const float* const row = within.mixture.row(j);
    const auto weight = static_cast<double>(within.mixture.weights[j]);
    for (std::size_t i = 0; i < n; ++i) {
      const Position way{place[0] - static_cast<double>(patches.x[i]),
                         place[1] - static_cast<double>(patches.y[i]),
                         place[2] - static_cast<double>(patches.z[i])};
      const double square = way[0] * way[0] + way[1] * way[1] + way[2] * way[2];
      const double got = weight * static_cast<double>(row[i]);
      balance[i] += heights[i] < 0.F ? -got : got;
      total[i] += got;
      for (std::size_t a = 0; a < 3; ++a) {
        direction[i][a] += got * way[a] / std::sqrt(std::max(square, 1e-30));
      }
    }
  }
  Sides out;
  out.directions.assign(3 * n, 0.F);
  for (std::size_t i = 0; i < n; ++i) {
    const double all = std::max(total[i], 1e-30);
    for (std::size_t a = 0; a < 3; ++a) {
      out.directions[3 * i + a] = static_cast<float>(direction[i][a] / all);
    }
    out.one_sided += std::fabs(balance[i]) / all;
  }
  out.one_sided /= static_cast<double>(n);
  return out;
}

// Share of the pieces that the places do not see.
double shareHidden(const DensityPatches& patches, const Occupancy& occupancy,
                   const Explained& within) {
  std::vector<float> seen(patches.size());
  double hidden = 0.0;
  double all = 0.0;
  for (std::size_t j = 0; j < within.mixture.size(); ++j) {
    occupancy.visibility(patches, within.places[within.mixture.place[j]], seen.data());
    const auto weight = static_cast<double>(within.mixture.weights[j]);
    const auto behind = std::count_if(seen.begin(), seen.end(), [](float v) { return v < 1.F; });
    hidden += weight * static_cast<double>(behind);
    all += weight * static_cast<double>(seen.size());
  }
  return hidden / all;
}

std::vector<Position> heaviestOf(const Explained& within) {
  std::vector<std::size_t> order(within.mixture.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return within.mixture.weights[a] > within.mixture.weights[b];
  });
  std::vector<Position> out;
  out.reserve(order.size());
  for (const std::size_t j : order) out.push_back(within.places[within.mixture.place[j]]);
  return out;
}

}  // namespace

SeenWithin seenWithin(const DensityPatches& patches, const Occupancy& occupancy,
                      const Extent& extent, int threads) {
  const double of_constant = lossOfConstant(patches);
  if (of_constant < kTwoLayers || isEvenBeside(patches, threads)) return {};
  const Explained within(patches, occupancy, placesInside(extent, kMixedInside), threads);
  if (lossOf(within.logs) > kMostLeft * of_constant) return {};
  Sides sides = sidesOf(patches, within);
  if (sides.one_sided < kOneSided) return {};
  if (sides.one_sided > kConvex && shareHidden(patches, occupancy, within) < kBehindWalls)
    return {};
  const Explained around(patches, occupancy, placesOutside(extent), threads);
  const bool either = lossOf(around.logs) <= kMostLeft * of_constant;
  if (either && sides.one_sided < kOneSidedOfEither) return {};
  if (advantage(within.logs, around.logs) < kSure) return {};
  return {std::move(sides.directions), heaviestOf(within)};
}

}  // namespace segorient::detail
