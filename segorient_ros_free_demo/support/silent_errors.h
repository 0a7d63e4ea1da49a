// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

namespace segorient::program {

/// While it lives, nothing that is written to standard error gets there: for code of others that
/// writes remarks past all loggers. One at a time.
class SilentErrors {
 public:
  SilentErrors();
  ~SilentErrors();
  SilentErrors(const SilentErrors&) = delete;
  SilentErrors& operator=(const SilentErrors&) = delete;

 private:
  int kept_ = -1;  // where standard error goes otherwise; below 0 where that could not be kept
};

}  // namespace segorient::program
