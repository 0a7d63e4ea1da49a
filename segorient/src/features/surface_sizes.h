// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <vector>

namespace segorient::detail {

// How many neighbours each kind of surface is fitted to, by the noise in spacings.

/// Up to this noise the smallest neighbourhood is the best one wherever it fits.
constexpr double kCleanNoise = 0.03;
/// Up to this noise local triangulations beat small surfaces at edges.
constexpr double kTriangulationNoise = 0.1;
/// Up to this noise cubic surfaces, which can bend at an edge, beat quadratic ones there. Beyond it
/// the faces at an edge cannot be told apart.
constexpr double kCubicNoise = 0.35;
/// The paper's number for clouds without noise.
constexpr int kTriangulationNeighbors = 10;
/// On surfaces without noise that a formula makes, cubic surfaces of so few neighbours leave less
/// than half of what quadratic ones do. Meshes and scans have such places, but nowhere near so
/// many.
constexpr int kCubicNeighbors = 12;

/// Neighbourhoods of the quadratic surfaces to try, largest first. \param available neighbours
std::vector<int> quadraticSizes(double noise, int available);

/// The neighbourhood of cubic surfaces at the edges of a noisy cloud, or 0.
int cubicSize(double noise, int available);

/// Neighbours that the widest of what is tried needs.
int widestSize(double noise);

}  // namespace segorient::detail
