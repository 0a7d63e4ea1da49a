// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <string>

namespace segorient::program {

/// The ending of a file's name in lower case with its dot, or nothing.
std::string fileEnding(const std::string& path);

}  // namespace segorient::program
