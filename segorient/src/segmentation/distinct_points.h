// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <pcl/types.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace segorient::segmentation {

/// The points of some rows of neighbours, in the order in which they were added. Rows next to each
/// other share most of their points, which come once; points that share a slot may come more often,
/// the more so the more points there are. Which of them are new nobody can guess: no branches.
class DistinctPoints {
 public:
  void restart() {
    ++turn_;
    size_ = 0;
  }
  /// Room for as many more calls of add().
  void reserve(std::size_t more) {
    if (points_.size() < size_ + more) points_.resize(2 * (size_ + more));
  }
  /// \param wanted false = nothing happens
  void add(pcl::index_t point, bool wanted) {
    std::uint64_t& last = last_[static_cast<std::size_t>(point) % kSlots];
    const std::uint64_t tag = turn_ << 32U | static_cast<std::uint32_t>(point);
    points_[size_] = point;
    size_ += (wanted & (last != tag)) ? 1U : 0U;
    last = wanted ? tag : last;
  }
  std::size_t size() const { return size_; }
  pcl::index_t operator[](std::size_t i) const { return points_[i]; }
  const pcl::index_t* begin() const { return points_.data(); }
  const pcl::index_t* end() const { return points_.data() + size_; }

 private:
  static constexpr std::size_t kSlots = 1024;

  std::array<std::uint64_t, kSlots> last_{};  ///< by slot: the last point that came, and its turn
  std::uint64_t turn_ = 1;
  std::vector<pcl::index_t> points_;
  std::size_t size_ = 0;
};

}  // namespace segorient::segmentation
