// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "io/cloud_table.h"
#include "render/picture.h"

namespace segorient::program {

/// Half of space: where dot (normal, x) >= offset.
struct HalfSpace {
  std::array<float, 3> normal;
  float offset = 0.F;
};

/// A point as a small disc across its normal, so that a cloud looks like the surface it was taken
/// from and its far side does not shine through.
struct Splat {
  std::array<float, 3> position;
  std::array<float, 3> normal;  ///< unit; NaN: the disc faces the viewer
  float radius = 0.F;
  std::uint32_t front = 0;  ///< packed rgb of the side that the normal points to
  std::uint32_t back = 0;
  std::uint32_t first_cut = 0;  ///< the disc ends at Scene::cuts[first_cut, first_cut + cuts)
  std::uint32_t cuts = 0;
};

/// What is drawn: splats, and triangles over vertices. A triangle's front is where its corners turn
/// counter-clockwise.
struct Scene {
  std::vector<Splat> splats;
  std::vector<HalfSpace> cuts;
  std::vector<std::array<float, 3>> vertices;
  std::vector<Triangle> triangles;
  std::vector<std::uint32_t> front;  ///< packed rgb of each triangle's front
  std::vector<std::uint32_t> back;
};

/// Where the viewer is: parallel projection, the whole scene in the picture.
struct View {
  double azimuth = 35.0;    ///< degrees about the vertical axis
  double elevation = 25.0;  ///< degrees above the horizon
  std::size_t width = 800;
  std::size_t height = 800;
};

/// Draws with a depth buffer of its own: needs no screen, no graphics card and no OpenGL, and gives
/// the same picture on every machine.
Picture drawScene(const Scene& scene, const View& view);

}  // namespace segorient::program
