// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "features/surface_sizes.h"

#include <algorithm>
#include <array>
#include <cstddef>

#include "features/automatic_normals.h"

namespace segorient::detail {
namespace {

// Neighbourhoods of the quadratic surfaces that are tried.
constexpr std::array<int, 6> kSizes{10, 16, 24, 32, 48, kMostAutomaticNeighbors};
// Neighbourhoods that are worth trying, per unit of noise over spacing. Noise turns the normals of
// k neighbours by about noise / (spacing k): with 400 it has sunk to a fraction of a degree, below
// 100 it is several degrees, more than what the larger neighbourhood costs at an edge.
constexpr double kLargestPerNoise = 400.0;
constexpr double kSmallestPerNoise = 100.0;
// Beyond this noise a few neighbours are a ball of points, whose residual hardly grows with the
// noise and says nothing of the surface: then only the largest neighbourhood is left.
constexpr double kSaturatedNoise = 0.45;
// Neighbourhoods of cubic surfaces, per unit of noise over spacing: they have nearly twice the
// coefficients.
constexpr double kCubicPerNoise = 150.0;
// Points for each coefficient as with the smallest quadratic surfaces of noisy clouds.
constexpr int kSmallestCubic = 24;

}  // namespace

bool isClean(double noise) {
  return kLargestPerNoise * noise < kSizes[1];
}

bool fewTell(double noise) {
  return kSmallestPerNoise * noise < kSizes.front();
}

std::vector<int> quadraticSizes(double noise, int available) {
  std::vector<int> sizes;
  const double largest = kLargestPerNoise * noise;
  const double smallest = std::max<double>(kSizes.front(), kSmallestPerNoise * noise);
  for (std::size_t s = kSizes.size(); s-- > 0;) {
    const bool enough = s > 0 && !sizes.empty() && kSizes[s] < smallest;
    if (enough) break;
    if (s == 0 || (kSizes[s] <= largest && kSizes[s] <= available)) sizes.push_back(kSizes[s]);
  }
  if (sizes.size() > 1 && sizes.back() < smallest) sizes.pop_back();
  if (noise > kSaturatedNoise) sizes.resize(1);
  return sizes;
}

int cubicSize(double noise, int available) {
  if (noise > kCubicNoise) return 0;
  for (const int k : kSizes) {
    if (k >= kSmallestCubic && k >= kCubicPerNoise * noise) return k <= available ? k : 0;
  }
  return 0;
}

int widestSize(double noise) {
  const std::vector<int> sizes = quadraticSizes(noise, kMostAutomaticNeighbors);
  return std::max({sizes.front(), kTriangulationNeighbors, kCubicNeighbors});
}

}  // namespace segorient::detail
