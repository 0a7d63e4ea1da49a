// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "render/picture.h"
#include "render/rasterizer.h"
#include "render/text_line.h"

namespace segorient::program {

/// A mesh.
struct PoissonSurface {
  std::vector<std::array<float, 3>> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
};

/// What the program takes from VTK, and from those libraries of PCL that bring it in.
///
/// These are a hundred libraries, and to load them takes longer than to orient a small cloud. So
/// they are linked to a module of their own, which is loaded when it is first asked for.
struct VtkModule {
  /// Sets text in VTK's own sans-serif font: no font need be installed, and the pixels are the same
  /// everywhere. The size is that of the font, in pixels.
  TextLine (*text_line)(const std::string& text, int size);
  /// The bytes of a PNG.
  std::vector<std::uint8_t> (*png)(const Picture& picture);
  /// Whether the screen that DISPLAY names can be reached. VTK ends the program if it can't.
  bool (*has_screen)();
  /// Shows a scene in a window until that is closed.
  /// `every`: a line at one of so many normals, 0 = none; `length` of these
  void (*show)(const Scene& scene, int every, double length);
  /// The surface that pcl::Poisson makes of at least one point.
  /// `points`, `normals`: finite, 3 floats each
  PoissonSurface (*poisson)(const std::vector<std::array<float, 3>>& points,
                            const std::vector<std::array<float, 3>>& normals, int depth);
};

/// The name of the function that hands it out.
constexpr const char* kVtkModuleEntry = "segorientVtkModule";

/// Loads the module at the first call. Throws FileError if it is not where the program was built or
/// installed with it, or does not load.
const VtkModule& vtkModule();

}  // namespace segorient::program
