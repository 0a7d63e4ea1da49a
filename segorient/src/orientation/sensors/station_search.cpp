// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/sensors/station_search.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "common/by_size.h"
#include "common/directions.h"
#include "common/parallel_for.h"

namespace segorient::detail {
namespace {

using Position = std::array<double, 3>;

// The coarse search sees this many pieces: enough to tell which of the places is near.
constexpr std::size_t kCoarse = 400;
constexpr int kPlacesInside = 1000;  // so the truth is about 5 % of the extent from one of them
constexpr int kStarts = 6;           // valleys that are followed
constexpr double kApart = 0.08;      // of the extent, between starts
constexpr double kCoarseStep = 0.05;
constexpr double kFineStep = 0.01;
constexpr int kCoarseEvaluations = 100;
constexpr int kFineEvaluations = 250;
constexpr int kAxisEvaluations = 60;
// Of the constant's cost: what the best of the coarse places leaves at most, or the search ends
// there. Of objects of a few faces, seen from one place, it leaves up to 1.24, and what it leads to
// .17 at most (80 scans).
constexpr float kFarOff = 1.5F;

// The laws, those with a vertical once for each coordinate axis: people turn clouds so that up is
// y, too, and tilting scanners have a level one.
std::vector<Place> lawsAt(const Position& position) {
  std::vector<Place> out{{position, {0.0, 0.0, 1.0}, SamplingLaw::SOLID_ANGLE},
                         {position, {0.0, 0.0, 1.0}, SamplingLaw::PINHOLE}};
  for (std::size_t a = 0; a < 3; ++a) {
    Place grid{position, {0.0, 0.0, 0.0}, SamplingLaw::ANGLE_GRID};
    grid.axis[a] = 1.0;
    out.push_back(grid);
  }
  return out;
}

std::vector<Position> shells(const Position& middle, double extent) {
  constexpr std::size_t kDirections = 90;  // 20 degrees apart
  std::vector<Position> out;
  for (const double radius : {0.4, 0.6, 0.8, 1.1, 1.5, 2.1}) {
    for (std::size_t k = 0; k < kDirections; ++k) {
      Position place = evenDirection(k, kDirections);
      for (std::size_t a = 0; a < 3; ++a) place[a] = middle[a] + radius * extent * place[a];
      out.push_back(place);
    }
  }
  return out;
}

// Of one place, see resolveThreads().
double timeAt(const DensityPatches& patches) {
  constexpr double kTermTime = 10.0;  // ns a piece
  return kTermTime * static_cast<double>(patches.size());
}

// The best places for one law, apart from each other, the best first.
std::vector<FittedPlace> valleys(const DensityPatches& coarse, const std::vector<Position>& places,
                                 const Place& law, double extent, int threads) {
  std::vector<float> costs(places.size());
  parallelFor(
      places.size(), threads, timeAt(coarse), [] { return std::vector<float>(); },
      [&](std::size_t i, std::vector<float>& scratch) {
        Place place = law;
        place.position = places[i];
        if (law.law == SamplingLaw::PINHOLE) place.axis = meanView(coarse, places[i]);
        costs[i] = costOf(coarse, place, scratch);
      });
  const BySize by_cost(places.size(), [&](std::size_t i) { return -costs[i]; });
  std::vector<FittedPlace> starts;
  for (const std::size_t i : by_cost.order()) {
    const bool apart = std::all_of(starts.begin(), starts.end(), [&](const FittedPlace& s) {
      return distance(s.place.position, places[i]) > kApart * extent;
    });
    if (!apart) continue;
    Place place = law;
    place.position = places[i];
    starts.push_back({place, costs[i]});
    if (starts.size() == static_cast<std::size_t>(kStarts)) break;
  }
  return starts;
}

// Where the best of the valleys leads to.
FittedPlace follow(const DensityPatches& coarse, std::vector<FittedPlace> starts, double extent,
                   int threads) {
  parallelFor(starts.size(), threads, kCoarseEvaluations * timeAt(coarse), [&](std::size_t i) {
    starts[i].cost =
        refinePlace(coarse, kCoarseStep * extent, false, kCoarseEvaluations, starts[i].place);
  });
  return *std::min_element(starts.begin(), starts.end(),
                           [](const auto& a, const auto& b) { return a.cost < b.cost; });
}

}  // namespace

double distance(const Position& a, const Position& b) {
  return std::sqrt((a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]) +
                   (a[2] - b[2]) * (a[2] - b[2]));
}

double Extent::diagonal() const {
  return distance(low, high);
}

Position Extent::middle() const {
  return {0.5 * (low[0] + high[0]), 0.5 * (low[1] + high[1]), 0.5 * (low[2] + high[2])};
}

bool Extent::holds(const Position& place, double margin) const {
  for (std::size_t a = 0; a < 3; ++a) {
    if (!(place[a] > low[a] - margin && place[a] < high[a] + margin)) return false;
  }
  return true;
}

Extent extentOf(const DensityPatches& patches) {
  Extent out;
  const std::vector<float>* columns[3] = {&patches.x, &patches.y, &patches.z};
  for (std::size_t a = 0; a < 3; ++a) {
    if (columns[a]->empty()) continue;
    const auto [low, high] = rangeWithout(columns[a]->size() / 100, *columns[a]);
    out.low[a] = static_cast<double>(low);
    out.high[a] = static_cast<double>(high);
  }
  return out;
}

std::vector<Position> placesInside(const Extent& extent, int count_wanted) {
  const double diagonal = extent.diagonal();
  const Position middle = extent.middle();
  Position width{};
  double volume = 1.0;
  for (std::size_t a = 0; a < 3; ++a) {
    width[a] = std::max(extent.high[a] - extent.low[a], 0.05 * diagonal);
    volume *= width[a];
  }
  const double cell = std::cbrt(volume / count_wanted);
  std::array<int, 3> count{};
  for (std::size_t a = 0; a < 3; ++a)
    count[a] = std::max(3, static_cast<int>(std::ceil(width[a] / cell)));
  std::vector<Position> out;
  for (int i = 0; i < count[0]; ++i) {
    for (int j = 0; j < count[1]; ++j) {
      for (int k = 0; k < count[2]; ++k) {
        const double at[3] = {i + 0.5, j + 0.5, k + 0.5};
        Position place{};
        for (std::size_t a = 0; a < 3; ++a) {
          place[a] = middle[a] + width[a] * (at[a] / count[a] - 0.5);
        }
        out.push_back(place);
      }
    }
  }
  return out;
}

std::vector<Position> placesOutside(const Extent& extent) {
  return shells(extent.middle(), extent.diagonal());
}

std::vector<Position> placesAround(const Extent& extent, int inside) {
  std::vector<Position> out = placesInside(extent, inside);
  const std::vector<Position> around = placesOutside(extent);
  out.insert(out.end(), around.begin(), around.end());
  return out;
}

FittedPlace fitAt(const DensityPatches& patches, const Position& position) {
  FittedPlace best;
  for (const Place& law : lawsAt(position)) {
    FittedPlace fitted{law, 0.F};
    const bool camera = law.law == SamplingLaw::PINHOLE;
    fitted.cost = refinePlace(patches, 0.0, camera, kAxisEvaluations, fitted.place);
    if (law.law == SamplingLaw::SOLID_ANGLE || fitted.cost < best.cost) best = fitted;
  }
  return best;
}

FittedPlace fitBeside(const DensityPatches& patches, const FittedPlace& place) {
  constexpr double kStep = 0.02;     // of the extent: poses are off by less, mixed up ones by more
  constexpr int kEvaluations = 200;  // forty for each of five unknowns
  FittedPlace beside = place;
  beside.cost =
      refinePlace(patches, kStep * extentOf(patches).diagonal(), true, kEvaluations, beside.place);
  return beside;
}

std::size_t countTurned(const DensityPatches& patches, const FittedPlace& a, const FittedPlace& b) {
  const std::vector<float> over_a = patches.heightsOver(a.place.position);
  const std::vector<float> over_b = patches.heightsOver(b.place.position);
  std::size_t turned = 0;
  for (std::size_t i = 0; i < over_a.size(); ++i) turned += over_a[i] * over_b[i] < 0.F ? 1 : 0;
  return turned;
}

std::optional<FittedPlace> searchStation(const DensityPatches& patches, float constant,
                                         int threads) {
  const Extent extent = extentOf(patches);
  const double diagonal = extent.diagonal();
  const DensityPatches coarse = patches.thinned(kCoarse);
  const std::vector<Position> places = placesAround(extent, kPlacesInside);
  // The best of each law, of those with a vertical the best vertical.
  std::vector<FittedPlace> found;
  for (const Place& law : lawsAt({0.0, 0.0, 0.0})) {
    std::vector<FittedPlace> starts = valleys(coarse, places, law, diagonal, threads);
    // The other laws differ by what the device does to directions, which is less than this.
    if (found.empty() && starts.front().cost > kFarOff * constant) return std::nullopt;
    const FittedPlace fitted = follow(coarse, std::move(starts), diagonal, threads);
    const bool rival = !found.empty() && found.back().place.law == law.law;
    if (!rival) {
      found.push_back(fitted);
    } else if (fitted.cost < found.back().cost) {
      found.back() = fitted;
    }
  }
  parallelFor(found.size(), threads, kFineEvaluations * timeAt(patches), [&](std::size_t i) {
    found[i].cost =
        refinePlace(patches, kFineStep * diagonal, true, kFineEvaluations, found[i].place);
  });
  return *std::min_element(found.begin(), found.end(),
                           [](const auto& a, const auto& b) { return a.cost < b.cost; });
}

}  // namespace segorient::detail
