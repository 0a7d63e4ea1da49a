// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <cstdlib>
#include <limits>
#include <memory>
#include <new>

#include "segmentation/growth_state.h"

namespace segorient::segmentation {

/// Numbers that are 0 until they are set. As large arrays come straight from the system, whole
/// pages that nobody looks at take neither memory nor time: most points of most clouds are nowhere
/// near a small segment.
class ZeroedArray {
 public:
  explicit ZeroedArray(std::size_t size)
      : numbers_(static_cast<std::uint32_t*>(std::calloc(size + 1, sizeof(std::uint32_t)))) {
    if (numbers_ == nullptr) throw std::bad_alloc();
  }
  std::uint32_t& operator[](std::size_t i) { return numbers_.get()[i]; }
  std::uint32_t operator[](std::size_t i) const { return numbers_.get()[i]; }

 private:
  struct Free {
    void operator()(std::uint32_t* numbers) const { std::free(numbers); }
  };
  std::unique_ptr<std::uint32_t, Free> numbers_;
};

/// The points of small segments and strips ("slots"), their neighbours in both directions (two
/// points are neighbours if either is among the other's), and the small segments as lists of
/// points.
class SmallAdjacency {
 public:
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

  SmallAdjacency(const GrowthState& state, std::size_t small_size);

  std::uint32_t size() const { return static_cast<std::uint32_t>(points_.size()); }
  std::size_t point(std::uint32_t slot) const { return static_cast<std::size_t>(points_[slot]); }
  /// Slot of a point, kNone for points of segments that were regular from the start.
  std::uint32_t slot(std::size_t point) const { return slots_[point] - 1; }

  /// visit(point) for each labelled neighbour of a slot's point that no gap parts from it.
  /// Neighbours in both directions come twice.
  template <typename Visit>
  void forEachNeighbor(std::uint32_t slot, Visit&& visit) const {
    forEachInRow(slot, visit);
    for (std::size_t i = reverse_starts_[slot]; i < reverse_starts_[slot + 1]; ++i) {
      visitNear(point(slot), reverse_[i], visit);
    }
  }
  /// The same for those in the point's own row only.
  template <typename Visit>
  void forEachInRow(std::uint32_t slot, Visit&& visit) const {
    const std::size_t p = point(slot);
    const pcl::index_t* row = state_.neighborhoods->indices(p);
    const int count = state_.rowSize(p);
    for (int j = 1; j < count; ++j) visitNear(p, row[j], visit);
  }

  /// visit(point) for the points of a small segment.
  template <typename Visit>
  void forEachPoint(std::int32_t label, Visit&& visit) const {
    for (std::uint32_t s = heads_[static_cast<std::size_t>(label)]; s != kNone; s = next_[s]) {
      visit(point(s));
    }
  }

  /// visit(point, admissible) once for each point around a small segment; `admissible` if it lies
  /// in the surface of at least one point of the segment.
  template <typename Visit>
  void forEachAround(std::int32_t label, Visit&& visit) {
    around_.clear();
    if (first_stamp_ > kMostStamps) {
      stamps_ = ZeroedArray(state_.nodes.size());
      first_stamp_ = 1;
    }
    for (std::uint32_t s = heads_[static_cast<std::size_t>(label)]; s != kNone; s = next_[s]) {
      const std::size_t p = point(s);
      forEachNeighbor(s, [&](std::size_t q) {
        if (state_.labels[q] == label) return;
        if (stamps_[q] < first_stamp_) {
          stamps_[q] = first_stamp_ + static_cast<std::uint32_t>(around_.size());
          around_.push_back({q, false});
        }
        Around& entry = around_[stamps_[q] - first_stamp_];
        entry.admissible = entry.admissible || state_.joins(q, p);
      });
    }
    first_stamp_ += static_cast<std::uint32_t>(around_.size());
    for (const Around& a : around_) visit(a.point, a.admissible);
  }

  /// The points of one small segment become another one's; nothing to do for a regular one.
  void append(std::int32_t from, std::int32_t into);

 private:
  /// Room above for the points around one segment.
  static constexpr std::uint32_t kMostStamps = 1U << 31U;

  struct Around {
    std::size_t point;
    bool admissible;
  };
  void listReverse();
  template <typename Visit>
  void visitNear(std::size_t p, pcl::index_t index, Visit&& visit) const {
    const auto q = static_cast<std::size_t>(index);
    if (state_.labels[q] >= 0 && state_.limits.near(state_.nodes[p], state_.nodes[q])) visit(q);
  }

  const GrowthState& state_;
  std::vector<pcl::index_t> points_;
  ZeroedArray slots_;  ///< by point: its slot + 1
  std::vector<std::uint32_t> heads_, tails_, next_;
  std::vector<std::size_t> reverse_starts_;
  std::vector<pcl::index_t> reverse_;
  /// By point: where it is in around_, plus first_stamp_; less = not in it.
  ZeroedArray stamps_;
  std::uint32_t first_stamp_ = 1;
  std::vector<Around> around_;
};

}  // namespace segorient::segmentation
