// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/sensors/several_stations.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "common/parallel_for.h"
#include "orientation/sensors/sampling_law.h"
#include "orientation/sensors/simplex.h"
#include "orientation/sensors/station_mixture.h"
#include "orientation/sensors/station_search.h"

namespace segorient::detail {
namespace {

using Position = std::array<double, 3>;

constexpr std::size_t kPieces = 600;       // while stations are sought
constexpr std::size_t kFinePieces = 1500;  // for those that were found
constexpr double kStep = 0.02;             // of the extent
constexpr double kFineStep = 0.005;
constexpr int kEvaluations = 50;
constexpr int kFineRounds = 2;
constexpr int kRelocations = 3;  // at most, for each number of stations
constexpr int kAlternatives = 200;
constexpr std::size_t kMostRelocated = 6;  // more stations than that find places by their number

// What stations leave on the pieces, by the side that they see. Of a surface nobody sees both.
struct SideSums {
  std::vector<float> front;
  std::vector<float> back;

  explicit SideSums(std::size_t pieces) : front(pieces, 0.F), back(pieces, 0.F) {}

  // \param densities those of what is seen from behind negative
  void add(const std::vector<float>& densities) {
    const float* const density = densities.data();
    float* const in_front = front.data();
    float* const behind = back.data();
    for (std::size_t i = 0, n = front.size(); i < n; ++i) {
      in_front[i] += std::max(density[i], 0.F);
      behind[i] += std::max(-density[i], 0.F);
    }
  }

  // With those of one more station.
  void logsWith(const std::vector<float>& densities, std::vector<float>& out) const {
    out.resize(front.size());
    const float* const density = densities.data();
    const float* const in_front = front.data();
    const float* const behind = back.data();
    float* const sum = out.data();
    for (std::size_t i = 0, n = front.size(); i < n; ++i) {
      sum[i] =
          std::max(in_front[i] + std::max(density[i], 0.F), behind[i] + std::max(-density[i], 0.F));
    }
    takeLogs(out);
  }
};

// Some stations and what each leaves on the pieces. Weights are equal: one scanner, one setting.
class Sum {
 public:
  // \param rays of all of them: a Place whose position is unused
  Sum(const DensityPatches& patches, const Occupancy& occupancy, const Place& rays,
      std::vector<Position> positions)
      : patches_(patches),
        occupancy_(occupancy),
        rays_(rays),
        positions_(std::move(positions)),
        seen_(positions_.size()),
        densities_(positions_.size()) {
    look();
  }

  // Each station in turn to where the cost is least, what it can see left as it was meanwhile.
  void refine(double step) {
    for (std::size_t j = 0; j < positions_.size(); ++j) refineOne(j, step);
    look();
  }

  void refineOne(std::size_t j, double step) {
    const SideSums others = sumWithout(j);
    const auto cost = [&](const std::vector<double>& v) {
      densityAt({v[0], v[1], v[2]}, seen_[j], trial_);
      return static_cast<double>(costWith(others, trial_));
    };
    std::vector<double> values(positions_[j].begin(), positions_[j].end());
    minimize(cost, {step, step, step}, kEvaluations, values);
    positions_[j] = {values[0], values[1], values[2]};
    densityAt(positions_[j], seen_[j], densities_[j]);
  }

  // Places that a station might be put to, all at once.
  void setAlternatives(std::vector<Position> places, int threads) {
    alternatives_ = std::move(places);
    alternative_densities_.resize(alternatives_.size());
    parallelFor(
        alternatives_.size(), threads, Occupancy::kTime * static_cast<double>(patches_.size()),
        [&] { return std::vector<float>(patches_.size()); },
        [&](std::size_t c, std::vector<float>& seen) {
          occupancy_.visibility(patches_, alternatives_[c], seen.data());
          densityAt(alternatives_[c], seen, alternative_densities_[c]);
        });
  }

  // Puts one station to one of the alternatives and lets all settle, if that is better: a mirror
  // image behind a wall does not find the way by small steps.
  bool relocate(double step) {
    const float before = cost();
    float least = before;
    std::size_t moved = 0;
    std::size_t to = 0;
    for (std::size_t j = 0; j < positions_.size(); ++j) {
      const SideSums others = sumWithout(j);
      for (std::size_t c = 0; c < alternatives_.size(); ++c) {
        const float value = costWith(others, alternative_densities_[c]);
        if (value >= least) continue;
        least = value;
        moved = j;
        to = c;
      }
    }
    if (least >= before) return false;
    positions_[moved] = alternatives_[to];
    look();
    refine(step);
    return true;
  }

  // Each station to its image across the surface next to it, if that is better. Over level ground
  // both leave the same where nothing hides anything, and no small step leads through the ground.
  void reflect(double step) {
    for (std::size_t j = 0; j < positions_.size(); ++j) {
      const float before = cost();
      const Position position = positions_[j];
      std::vector<float> seen = seen_[j];
      std::vector<float> density = densities_[j];
      positions_[j] = patches_.imageOf(position);
      lookFrom(j);
      refineOne(j, step);
      lookFrom(j);
      if (cost() < before) continue;
      positions_[j] = position;
      seen_[j] = std::move(seen);
      densities_[j] = std::move(density);
    }
  }

  // All that have a higher image to that at once, unless it is worse. Of stations on either side of
  // the ground each saw pieces of its own, and no single one can go through it.
  void raise(double step) {
    const float before = cost();
    const std::vector<Position> positions = positions_;
    for (Position& position : positions_) {
      const Position image = patches_.imageOf(position);
      if (image[2] > position[2]) position = image;
    }
    if (positions_ == positions) return;
    look();
    refine(step);
    if (cost() <= kSameCost * before) return;
    positions_ = positions;
    look();
  }

  // The one that is missed least goes.
  void dropOne() {
    std::size_t least = 0;
    float cost = 0.F;
    for (std::size_t j = 0; j < positions_.size(); ++j) {
      const float without = costWithout(j);
      if (j == 0 || without < cost) {
        least = j;
        cost = without;
      }
    }
    const auto at = static_cast<std::ptrdiff_t>(least);
    positions_.erase(positions_.begin() + at);
    seen_.erase(seen_.begin() + at);
    densities_.erase(densities_.begin() + at);
  }

  float cost() { return costWithout(positions_.size()); }

  PieceOrigins strongest() const {
    std::vector<std::vector<float>> left = densities_;
    for (std::vector<float>& row : left) {
      for (float& v : row) v = std::fabs(v);
    }
    return strongestPlaces(patches_, positions_, left);
  }

  const std::vector<Position>& positions() const { return positions_; }

 private:
  void look() {
    for (std::size_t j = 0; j < positions_.size(); ++j) lookFrom(j);
  }

  void lookFrom(std::size_t j) {
    seen_[j].resize(patches_.size());
    occupancy_.visibility(patches_, positions_[j], seen_[j].data());
    densityAt(positions_[j], seen_[j], densities_[j]);
  }

  // Over the density that is there; negative where the piece is seen from behind.
  void densityAt(const Position& position, const std::vector<float>& seen,
                 std::vector<float>& out) const {
    Place place = rays_;
    place.position = position;
    ratios(patches_, place, out);
    const std::vector<float> heights = patches_.heightsOver(position);
    const float* const height = heights.data();
    const float* const share = seen.data();
    float* const density = out.data();
    for (std::size_t i = 0, n = out.size(); i < n; ++i) {
      density[i] *= height[i] < 0.F ? -share[i] : share[i];
    }
  }

  SideSums sumWithout(std::size_t left_out) const {
    SideSums sum(patches_.size());
    for (std::size_t j = 0; j < densities_.size(); ++j) {
      if (j != left_out) sum.add(densities_[j]);
    }
    return sum;
  }

  float costWithout(std::size_t left_out) {
    const std::vector<float> nothing(patches_.size(), 0.F);
    return costWith(sumWithout(left_out), nothing);
  }

  float costWith(const SideSums& others, const std::vector<float>& densities) {
    others.logsWith(densities, logs_);
    return deviation(logs_);
  }

  const DensityPatches& patches_;
  const Occupancy& occupancy_;
  Place rays_;
  std::vector<Position> positions_;
  std::vector<std::vector<float>> seen_;
  std::vector<std::vector<float>> densities_;
  std::vector<Position> alternatives_;
  std::vector<std::vector<float>> alternative_densities_;
  std::vector<float> trial_;
  std::vector<float> logs_;
};

void settle(const DensityPatches& patches, const Occupancy& occupancy, const Extent& extent,
            Stations& stations) {
  const double step = kFineStep * extent.diagonal();
  const DensityPatches fine = patches.thinned(kFinePieces);
  Sum sum(fine, occupancy, stations.rays, stations.positions);
  for (int round = 0; round < kFineRounds; ++round) {
    sum.reflect(step);
    sum.refine(step);
  }
  sum.raise(step);
  stations.positions = sum.positions();
  stations.cost = sum.cost();
}

}  // namespace

std::optional<Stations> searchStations(const DensityPatches& patches, const Occupancy& occupancy,
                                       const Place& rays, std::size_t most, int threads) {
  const Extent extent = extentOf(patches);
  const double step = kStep * extent.diagonal();
  const DensityPatches some = patches.thinned(kPieces);
  Sum sum(some, occupancy, rays, mixturePlaces(some, occupancy, extent, rays, most, threads));
  if (sum.positions().empty()) return std::nullopt;
  sum.refine(step);
  sum.setAlternatives(placesInside(extent, kAlternatives), threads);
  std::vector<Stations> tried;
  float least = std::numeric_limits<float>::infinity();
  while (true) {
    sum.refine(step);
    const bool few = sum.positions().size() <= kMostRelocated;
    for (int i = 0; few && i < kRelocations && sum.relocate(step); ++i) {
    }
    sum.reflect(step);
    tried.push_back({sum.positions(), rays, sum.cost()});
    least = std::min(least, tried.back().cost);
    if (sum.positions().size() == 1) break;
    sum.dropOne();
  }
  const float enough = least + kGain * deviation(some.log_density);
  const auto fewest = std::find_if(tried.rbegin(), tried.rend(),
                                   [&](const Stations& t) { return t.cost <= enough; });
  if (fewest == tried.rend()) return std::nullopt;  // costs are no numbers
  Stations out = *fewest;
  settle(patches, occupancy, extent, out);
  return out;
}

PieceOrigins originsOf(const DensityPatches& patches, const Occupancy& occupancy,
                       const Stations& stations) {
  return Sum(patches, occupancy, stations.rays, stations.positions).strongest();
}

}  // namespace segorient::detail
