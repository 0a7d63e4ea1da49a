// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <array>
#include <string>
#include <vector>

#include "io/cloud_table.h"
#include "support/progress_bar.h"
#include "support/true_surface.h"

namespace segorient::program {

/// Surfaces of pcl::Poisson from PCL's normals and from ours: writes PREFIX_pcl.ply,
/// PREFIX_ours.ply and a picture of both, PREFIX.png.
/// \param normals PCL's and ours, 4 floats a point
/// \param truth in the frame of `points`; may be empty
/// \param bar told what is under way
/// \return lines that say how far each surface is from the points and from the truth
std::string comparePoisson(const LocalPoints& points,
                           const std::array<std::vector<float>, 2>& normals, int depth,
                           const std::string& prefix, const TrueSurface& truth, ProgressBar& bar);

}  // namespace segorient::program
