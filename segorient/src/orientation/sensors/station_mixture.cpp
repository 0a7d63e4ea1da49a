// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/sensors/station_mixture.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numeric>

#include "common/parallel_for.h"
#include "orientation/sensors/station_search.h"

namespace segorient::detail {
namespace {

using Position = std::array<double, 3>;

constexpr int kRounds = 200;
// By then weights of places without a sensor have fallen by orders of magnitude.
constexpr int kRoundsBeforePruning = 30;
constexpr float kNegligible = 1e-4F;  // of all weights
constexpr float kShare = 0.003F;      // of all weights, of a place that is looked at afterwards
constexpr double kTogether = 0.07;    // of the extent: the grid's cells are as wide
constexpr std::size_t kMostPlaces = 10;

// What each place would leave on each piece, over the density that is there.
void fillRows(const DensityPatches& patches, const Occupancy& occupancy,
              const std::vector<Position>& places, const Place& law, int threads, Mixture& out) {
  out.rows.resize(places.size());
  out.place.resize(places.size());
  std::iota(out.place.begin(), out.place.end(), std::size_t{0});
  const std::size_t n = patches.size();
  parallelFor(
      places.size(), threads, Occupancy::kTime * static_cast<double>(n),
      [n] { return std::vector<float>(n); },
      [&](std::size_t j, std::vector<float>& seen) {
        std::vector<float>& row = out.rows[j];
        ratios(patches, {places[j], law.axis, law.law}, row);
        occupancy.visibility(patches, places[j], seen.data());
        float sum = 0.F;
        for (std::size_t i = 0; i < n; ++i) {
          row[i] *= seen[i];
          sum += row[i];
        }
        const float mean = std::max(sum / static_cast<float>(n), 1e-30F);
        for (float& v : row) v /= mean;
      });
}

void prune(Mixture& mixture) {
  std::vector<float>& weights = mixture.weights;
  const float all = std::accumulate(weights.begin(), weights.end(), 0.F);
  std::size_t kept = 0;
  for (std::size_t j = 0; j < weights.size(); ++j) {
    if (weights[j] < kNegligible * all) continue;
    if (kept != j) {
      mixture.rows[kept] = std::move(mixture.rows[j]);
      mixture.place[kept] = mixture.place[j];
      weights[kept] = weights[j];
    }
    ++kept;
  }
  mixture.rows.resize(kept);
  mixture.place.resize(kept);
  weights.resize(kept);
}

// Multiplicative updates, as of maximum likelihood, a little overdone to be quicker. Each piece's
// mixture divides by what is there, so that dense and thin places count the same.
void weigh(std::size_t pieces, Mixture& mixture) {
  std::vector<float>& weights = mixture.weights;
  weights.assign(mixture.rows.size(), 1.F / static_cast<float>(mixture.rows.size()));
  std::vector<float> mixed(pieces);
  for (int round = 0; round < kRounds; ++round) {
    if (round == kRoundsBeforePruning) prune(mixture);
    std::fill(mixed.begin(), mixed.end(), 1e-30F);
    for (std::size_t j = 0; j < weights.size(); ++j) {
      const float w = weights[j];
      const float* row = mixture.rows[j].data();
      for (std::size_t i = 0; i < pieces; ++i) mixed[i] += w * row[i];
    }
    for (float& m : mixed) m = 1.F / m;
    for (std::size_t j = 0; j < weights.size(); ++j) {
      const float* row = mixture.rows[j].data();
      float sum = 0.F;
#pragma omp simd reduction(+ : sum)
      for (std::size_t i = 0; i < pieces; ++i) sum += row[i] * mixed[i];
      const float factor = sum / static_cast<float>(pieces);
      weights[j] *= factor * std::sqrt(factor);
    }
  }
}

struct Heap {
  Position sum{0.0, 0.0, 0.0};
  double weight = 0.0;

  Position mean() const { return {sum[0] / weight, sum[1] / weight, sum[2] / weight}; }
  void add(const Position& p, double w) {
    for (std::size_t a = 0; a < 3; ++a) sum[a] += w * p[a];
    weight += w;
  }
};

}  // namespace

Mixture mixtureOf(const DensityPatches& patches, const Occupancy& occupancy,
                  const std::vector<Position>& places, const Place& law, int threads) {
  Mixture out;
  fillRows(patches, occupancy, places, law, threads, out);
  weigh(patches.size(), out);
  return out;
}

std::vector<Position> mixturePlaces(const DensityPatches& patches, const Occupancy& occupancy,
                                    const Extent& extent, const Position& axis, int threads) {
  const std::vector<Position> places = placesAround(extent, kMixedInside);
  const Mixture mixture =
      mixtureOf(patches, occupancy, places, {{}, axis, SamplingLaw::ANGLE_GRID}, threads);
  const std::vector<float>& weights = mixture.weights;
  const float all = std::accumulate(weights.begin(), weights.end(), 0.F);
  std::vector<std::size_t> order(weights.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return weights[a] > weights[b]; });
  std::vector<Heap> heaps;
  for (const std::size_t j : order) {
    if (weights[j] < kShare * all) break;
    const Position& p = places[mixture.place[j]];
    const auto near = std::find_if(heaps.begin(), heaps.end(), [&](const Heap& h) {
      return distance(h.mean(), p) < kTogether * extent.diagonal();
    });
    Heap& heap = near == heaps.end() ? heaps.emplace_back() : *near;
    heap.add(p, static_cast<double>(weights[j]));
  }
  std::stable_sort(heaps.begin(), heaps.end(),
                   [](const Heap& a, const Heap& b) { return a.weight > b.weight; });
  std::vector<Position> out;
  for (const Heap& h : heaps) {
    if (out.size() < kMostPlaces) out.push_back(h.mean());
  }
  return out;
}

}  // namespace segorient::detail
