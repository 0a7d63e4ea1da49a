// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <string>
#include <vector>

#include "scratch_directory.h"

namespace segorient::test {

/// What a run of the program left.
struct Outcome {
  int status = -1;  ///< exit status; 128 + signal if one ended it
  std::string out;
  std::string err;
};

/// Runs the program segorient with these words and waits for its end.
/// \param program another copy of it; empty = where it was built
Outcome runProgram(const std::vector<std::string>& words, const std::string& program = {});

/// One line of text that ends with a newline.
bool isOneLine(const std::string& text);

/// The shipped Fandisk.
std::string fandisk();

}  // namespace segorient::test
