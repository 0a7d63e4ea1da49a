// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <array>
#include <string>
#include <vector>

#include "io/cloud_table.h"

namespace segorient::program {

/// Surfaces of pcl::Poisson from PCL's normals and from ours: writes PREFIX_pcl.ply,
/// PREFIX_ours.ply and a picture of both, PREFIX.png, and prints how far each surface is from the
/// points. \param normals PCL's and ours, 4 floats a point
void comparePoisson(const LocalPoints& points, const std::array<std::vector<float>, 2>& normals,
                    int depth, const std::string& prefix);

}  // namespace segorient::program
