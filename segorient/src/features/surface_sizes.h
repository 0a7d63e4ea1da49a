// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <vector>

namespace segorient::detail {

// How many neighbours each kind of surface is fitted to, by the noise in spacings.

/// Up to this noise cubic surfaces, which can bend at an edge, beat quadratic ones there. Beyond it
/// the faces at an edge cannot be told apart.
constexpr double kCubicNoise = 0.35;
/// The paper's number for clouds without noise.
constexpr int kTriangulationNeighbors = 10;
/// The fewest that leave as much freedom (3) as quadratic surfaces of kNoiseNeighbors do.
constexpr int kCubicNeighbors = 12;

/// Near edges, where a plane fits a few neighbours as well as noise lets it, they are all on one
/// side.
constexpr int kPlaneNeighbors = 6;

/// Whether noise leaves nothing to gain by more than the fewest neighbours.
bool isClean(double noise);

/// Whether noise turns the normals of the fewest neighbours little, so that triangulations, which
/// take the nearest few of these, tell more of edges than small surfaces.
bool fewTell(double noise);

/// Neighbourhoods of the quadratic surfaces to try, largest first. \param available neighbours
std::vector<int> quadraticSizes(double noise, int available);

/// The neighbourhood of cubic surfaces at the edges of a noisy cloud, or 0.
int cubicSize(double noise, int available);

/// Neighbours that the widest of what is tried needs.
int widestSize(double noise);

}  // namespace segorient::detail
