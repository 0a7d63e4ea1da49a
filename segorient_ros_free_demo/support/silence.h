// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <array>

namespace segorient::program {

/// While it lives, nothing that is written to standard output and standard error gets there: for
/// code of others that writes remarks past all loggers. One at a time.
class Silence {
 public:
  Silence();
  ~Silence();
  Silence(const Silence&) = delete;
  Silence& operator=(const Silence&) = delete;

 private:
  // Where output and errors go otherwise; below 0 where that could not be kept.
  std::array<int, 2> kept_{-1, -1};
};

}  // namespace segorient::program
