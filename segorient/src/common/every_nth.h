// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <algorithm>
#include <cstddef>

namespace segorient::detail {

/// Every n-th of some rows: about as many as are wanted, at most twice that. In an order that
/// depends on where points are (CompactCloud) that is a fair sample, the same for any order of the
/// input.
class EveryNth {
 public:
  EveryNth(std::size_t rows, std::size_t wanted)
      : step_(std::max<std::size_t>(1, rows / wanted)), size_((rows + step_ - 1) / step_) {}

  std::size_t size() const { return size_; }
  std::size_t operator[](std::size_t i) const { return i * step_; }

  struct Row {
    std::size_t row;
    std::size_t step;
    std::size_t operator*() const { return row; }
    void operator++() { row += step; }
    bool operator!=(const Row& o) const { return row != o.row; }
  };
  Row begin() const { return {0, step_}; }
  Row end() const { return {size_ * step_, step_}; }

 private:
  std::size_t step_;
  std::size_t size_;
};

}  // namespace segorient::detail
