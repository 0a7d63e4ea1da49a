// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <string>

#include "tiles/steps.h"

namespace segorient::program {

/// All steps on this machine, one tile after another on all cores. Goes on where a run with the
/// same inputs and options was interrupted, and removes the folder's files at the end. \param
/// folder to work in; empty = the output's name and .work
/// \param report where what was done is written as JSON; empty = nowhere
void runAllSteps(const TileRequest& request, const std::string& folder, const std::string& report,
                 bool quiet);

/// \param folder that was asked for; empty = the output's name and .work
std::string workFolderOf(std::string output, const std::string& folder);

/// The least that a step can do with.
constexpr std::uint64_t kLeastMemory = 200'000'000;

/// "2G", "500M" or a number of bytes; throws UsageError for anything else, and what is too little.
std::uint64_t parseMemory(const std::string& text);

}  // namespace segorient::program
