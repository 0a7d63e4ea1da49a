// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include "render/vtk/vtk_module.h"

// What the module consists of: one function a file, see VtkModule.
namespace segorient::program::vtk {

TextLine textLine(const std::string& text, int size);
std::vector<std::uint8_t> png(const Picture& picture);
bool hasScreen();
void show(const Scene& scene, int every, double length);
PoissonSurface poisson(const std::vector<std::array<float, 3>>& points,
                       const std::vector<std::array<float, 3>>& normals, int depth);

}  // namespace segorient::program::vtk
