// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <string>

#include "tiles/steps.h"

namespace segorient::program {

/// All steps on this machine, one tile after another on all cores. Goes on where a run with the
/// same inputs and options was interrupted, and removes the folder's files at the end. \param
/// folder to work in; empty = the output's name and .work
void runAllSteps(const TileRequest& request, std::string folder, bool quiet);

/// "2G", "500M" or a number of bytes; throws UsageError for anything else, and what is too little.
std::uint64_t parseMemory(const std::string& text);

}  // namespace segorient::program
