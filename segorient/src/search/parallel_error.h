// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <atomic>
#include <exception>

namespace segorient::search {

/// The first exception of what runs in an OpenMP region, which none may leave.
class ParallelError {
 public:
  /// Calls work(), unless something has failed before.
  template <typename Work>
  void guard(Work&& work) {
    if (failed_) return;
    try {
      work();
    } catch (...) {
      if (!failed_.exchange(true)) error_ = std::current_exception();
    }
  }
  bool failed() const { return failed_; }

  /// Throws it again, after the region.
  void rethrow() const {
    if (error_) std::rethrow_exception(error_);
  }

 private:
  std::atomic<bool> failed_{false};
  std::exception_ptr error_;
};

}  // namespace segorient::search
