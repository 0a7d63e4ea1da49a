// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/sensors/station_mixture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numeric>

#include "common/by_size.h"
#include "common/compiler.h"
#include "common/parallel_for.h"
#include "common/vectors.h"
#include "common/widest.h"
#include "orientation/sensors/station_search.h"

namespace segorient::detail {
namespace {

using Position = std::array<double, 3>;

// Plain updates of m weights leave the mean logarithm log(m) / rounds below the best at most: .03.
constexpr int kRounds = 200;
// By then weights of places without a sensor have fallen by orders of magnitude.
constexpr int kRoundsBeforePruning = 30;
constexpr float kNegligible = 1e-4F;  // of all weights
constexpr float kShare = 0.003F;      // of all weights, of a place that is looked at afterwards
constexpr double kTogether = 0.07;    // of the extent: the grid's cells are as wide
// As many as the widest registers hold, whatever the machine's are: the same sums everywhere.
constexpr std::size_t kSums = 16;

}  // namespace

#define SEGORIENT_KERNELS "orientation/sensors/mixture_lanes.inl"
#include "common/each_width.inl"
#undef SEGORIENT_KERNELS

namespace {

struct Kernels {
  void (*add)(const float*, float, std::size_t, float*) = SEGORIENT_WIDEST(addRow);
  void (*multiply)(const float*, const float*, std::size_t,
                   float*) = SEGORIENT_WIDEST(multiplyRows);
};

const Kernels& kernels() {
  static const Kernels chosen;
  return chosen;
}

float product(const float* a, const float* b, std::size_t length) {
  std::array<float, kSums> parts{};
  kernels().multiply(a, b, length, parts.data());
  return std::accumulate(parts.begin(), parts.end(), 0.F);
}

// Of one thread.
struct Scratch {
  std::vector<float> seen;
  std::vector<float> left;
};

// What each place would leave on each piece, over the density that is there.
void fillRows(const DensityPatches& patches, const Occupancy& occupancy,
              const std::vector<Position>& places, const Place& law, int threads, Mixture& out) {
  const std::size_t n = patches.size();
  out.length = (n + kSums - 1) / kSums * kSums;
  out.rows.assign(places.size() * out.length, 0.F);
  out.place.resize(places.size());
  std::iota(out.place.begin(), out.place.end(), std::size_t{0});
  parallelFor(
      places.size(), threads, Occupancy::kTime * static_cast<double>(n),
      [n] {
        return Scratch{std::vector<float>(n), {}};
      },
      [&](std::size_t j, Scratch& scratch) {
        Place place = law;
        place.position = places[j];
        ratios(patches, place, scratch.left);
        occupancy.visibility(patches, places[j], scratch.seen.data());
        float* const row = out.row(j);
        float sum = 0.F;
        for (std::size_t i = 0; i < n; ++i) {
          row[i] = scratch.left[i] * scratch.seen[i];
          sum += row[i];
        }
        const float mean = std::max(sum / static_cast<float>(n), kNothing);
        for (std::size_t i = 0; i < n; ++i) row[i] /= mean;
      });
}

void prune(Mixture& mixture) {
  std::vector<float>& weights = mixture.weights;
  const float all = std::accumulate(weights.begin(), weights.end(), 0.F);
  std::size_t kept = 0;
  for (std::size_t j = 0; j < weights.size(); ++j) {
    if (weights[j] < kNegligible * all) continue;
    if (kept != j) {
      std::copy_n(mixture.row(j), mixture.length, mixture.row(kept));
      mixture.place[kept] = mixture.place[j];
      weights[kept] = weights[j];
    }
    ++kept;
  }
  mixture.rows.resize(kept * mixture.length);
  mixture.place.resize(kept);
  weights.resize(kept);
}

std::vector<float> mixed(const Mixture& mixture) {
  std::vector<float> out(mixture.length, kNothing);
  for (std::size_t j = 0; j < mixture.size(); ++j) {
    kernels().add(mixture.row(j), mixture.weights[j], mixture.length, out.data());
  }
  return out;
}

// Multiplicative updates, as of maximum likelihood, a little overdone to be quicker. Each piece's
// mixture divides by what is there, so that dense and thin places count the same. A row's share of
// the next round's sum is added while the row is at hand.
void weigh(std::size_t pieces, Mixture& mixture) {
  std::vector<float>& weights = mixture.weights;
  weights.assign(mixture.size(), 1.F / static_cast<float>(mixture.size()));
  std::vector<float> inverse(mixture.length);
  std::vector<float> sum = mixed(mixture);
  for (int round = 0; round < kRounds; ++round) {
    // The sum still has what is dropped, which is as good as nothing.
    if (round == kRoundsBeforePruning) prune(mixture);
    std::transform(sum.begin(), sum.end(), inverse.begin(), [](float m) { return 1.F / m; });
    std::fill(sum.begin(), sum.end(), kNothing);
    for (std::size_t j = 0; j < weights.size(); ++j) {
      const float factor =
          product(mixture.row(j), inverse.data(), mixture.length) / static_cast<float>(pieces);
      weights[j] *= factor * std::sqrt(factor);
      kernels().add(mixture.row(j), weights[j], mixture.length, sum.data());
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
                                    const Extent& extent, const Place& rays, std::size_t most,
                                    int threads) {
  const std::vector<Position> places = placesAround(extent, kMixedInside);
  const Mixture mixture = mixtureOf(patches, occupancy, places, rays, threads);
  const std::vector<float>& weights = mixture.weights;
  const float all = std::accumulate(weights.begin(), weights.end(), 0.F);
  const BySize by_weight(weights.size(), [&](std::size_t j) { return weights[j]; });
  std::vector<Heap> heaps;
  for (const std::size_t j : by_weight.order()) {
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
    if (out.size() < most) out.push_back(h.mean());
  }
  return out;
}

}  // namespace segorient::detail
