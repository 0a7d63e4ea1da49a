// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "io/cloud_table.h"
#include "render/palette.h"
#include "render/rasterizer.h"

namespace segorient::program {

/// The cloud's triangles if it has any, else its points as splats: as wide as the points around are
/// apart, so that surfaces look closed, and cut where a sharp edge is, so that they do not stick
/// out. Sensors and contradictions are marked.
/// \param normals 4 floats a point to draw instead of the table's own, or null
Scene makeScene(const CloudTable& table, const LocalPoints& points, const float* normals,
                Coloring coloring, int threads, const Facts& facts = {});

/// What a legend of the scene is to tell.
ShownSides shownSides(const Scene& scene);

/// The scene from one direction and, if `both`, beside it from the opposite one.
Picture drawViews(const Scene& scene, const View& view, bool both);

}  // namespace segorient::program
