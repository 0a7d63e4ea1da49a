// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <string>
#include <vector>

#include "tiles/plan.h"

namespace segorient::program {

/// The clouds that the names stand for: files as they are, of folders all clouds in them, by name:
/// but for hidden ones, and for text unless there is nothing else.
std::vector<std::string> listClouds(const std::vector<std::string>& names);

/// Says how many text files of folders that leaves out.
void warnOfTextLeftOut(const std::vector<std::string>& names);

/// Fills inputs, outputs and run of a plan. Throws FileError and, where outputs make no sense,
/// UsageError.
void planFiles(const TileRequest& request, Plan& plan);

/// Makes copies in the folder of inputs that can't be read point by point, counts the points, and
/// looks for viewpoints; sets the plan's own where one file names one for all.
/// Points whose normals are known. \param path a cloud, or empty
void addSeeds(const std::string& path, Plan& plan);

void openInputs(const std::string& folder, Plan& plan);

}  // namespace segorient::program
