// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "io/cloud_table.h"
#include "render/page/sides.h"
#include "render/picture.h"

namespace segorient::program {

/// A point as a small disc across its normal, so that a cloud looks like the surface it was taken
/// from and its far side does not shine through.
struct Splat {
  static constexpr std::size_t kMostCutters = 4;

  std::array<float, 3> position;
  std::array<float, 3> normal;  ///< unit; NaN: the disc faces the viewer
  float radius = 0.F;
  float turn =
      0.F;  ///< sine of the angle by which the surface turns from the middle to its neighbours
  float noise = 0.F;  ///< how far the points around lie off its plane
  Side side = Side::Open;
  std::uint32_t front = 0;  ///< packed rgb of the true side: where the normal points, unless `side`
                            ///< says that it is wrong
  std::uint32_t back = 0;
  /// Splats across sharp edges: the disc ends at their planes.
  std::array<std::uint32_t, kMostCutters> cutters{};
  std::uint32_t cuts = 0;  ///< how many of them there are
};

/// A place that is marked, whatever lies before it.
struct Marker {
  enum class Kind {
    Sensor,  ///< a filled square on its corner
    Wrong    ///< a ring
  };
  std::array<float, 3> position;
  Kind kind = Kind::Sensor;
};

/// What is drawn: splats, triangles over vertices, and markers. A triangle's front is where its
/// corners turn counter-clockwise.
struct Scene {
  std::vector<Splat> splats;
  std::vector<std::uint32_t> rows;  ///< of splats in the cloud
  std::vector<std::array<float, 3>> vertices;
  std::vector<Triangle> triangles;
  std::vector<std::uint32_t> front;  ///< packed rgb of each triangle's front
  std::vector<std::uint32_t> back;
  std::vector<Marker> markers;
};

/// Where the viewer is: parallel projection, the whole scene in the picture.
struct View {
  double azimuth = 35.0;    ///< degrees about the vertical axis
  double elevation = 25.0;  ///< degrees above the horizon
  std::size_t width = 800;
  std::size_t height = 800;
  int threads = 0;  ///< 0 = all cores; the picture does not depend on it
};

/// Draws with a depth buffer of its own: needs no screen, no graphics card and no OpenGL, and gives
/// the same picture on every machine.
Picture drawScene(const Scene& scene, const View& view);

}  // namespace segorient::program
