// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <memory>
#include <new>
#include <vector>

#include "common/parallel_for.h"
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

  /// \param threads see resolveThreads()
  SmallAdjacency(const GrowthState& state, std::size_t small_size, int threads);

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

  /// visit(point, neighbour) for each neighbour of a small segment's points in another segment.
  template <typename Visit>
  void forEachAround(std::int32_t label, Visit&& visit) const {
    for (std::uint32_t s = heads_[static_cast<std::size_t>(label)]; s != kNone; s = next_[s]) {
      const std::size_t p = point(s);
      forEachNeighbor(s, [&](std::size_t q) {
        if (state_.labels[q] != label) visit(p, q);
      });
    }
  }

  /// Marks the neighbours of slots' points that a condition holds for, which must not change while
  /// they are asked for. \param condition (point, neighbour), from several threads
  template <typename Condition>
  void mark(int threads, const Condition& condition) {
    constexpr double kSlotTime = 400.0;  // ns, see resolveThreads()
    marks_.resize(words() * points_.size());
    reverse_marks_.resize(reverse_.size());
    parallelFor(points_.size(), threads, kSlotTime, [&](std::size_t at) {
      const auto slot = static_cast<std::uint32_t>(at);
      const std::size_t p = point(slot);
      const pcl::index_t* row = state_.neighborhoods->indices(p);
      const int count = state_.rowSize(p);
      std::fill_n(marks_.begin() + static_cast<std::ptrdiff_t>(words() * slot), words(), 0U);
      const auto holds = [&](pcl::index_t index) {
        bool found = false;
        visitNear(p, index, [&](std::size_t q) { found = condition(p, q); });
        return found;
      };
      for (int j = 1; j < count; ++j) {
        const auto bit = static_cast<std::size_t>(j - 1);
        const std::uint32_t one = holds(row[j]) ? 1U : 0U;
        marks_[words() * slot + bit / kBits] |= one << bit % kBits;
      }
      for (std::size_t i = reverse_starts_[slot]; i < reverse_starts_[slot + 1]; ++i) {
        reverse_marks_[i] = holds(reverse_[i]) ? 1 : 0;
      }
    });
  }
  /// visit(point) for each marked one in the row of a slot's point.
  template <typename Visit>
  void forEachMarkedInRow(std::uint32_t slot, Visit&& visit) const {
    const pcl::index_t* row = state_.neighborhoods->indices(point(slot)) + 1;
    for (std::size_t w = 0; w < words(); ++w) {
      for (std::uint32_t open = marks_[words() * slot + w]; open != 0; open &= open - 1) {
        visit(static_cast<std::size_t>(row[kBits * w + lowestBit(open)]));
      }
    }
  }
  /// The same in both directions.
  template <typename Visit>
  void forEachMarked(std::uint32_t slot, Visit&& visit) const {
    forEachMarkedInRow(slot, visit);
    for (std::size_t i = reverse_starts_[slot]; i < reverse_starts_[slot + 1]; ++i) {
      if (reverse_marks_[i] != 0) visit(static_cast<std::size_t>(reverse_[i]));
    }
  }

  /// The points of one small segment become another one's; nothing to do for a regular one.
  void append(std::int32_t from, std::int32_t into);

 private:
  static constexpr std::size_t kBits = 32;

  std::size_t words() const {
    return (static_cast<std::size_t>(std::max(state_.neighbors - 1, 0)) + kBits - 1) / kBits;
  }
  void listReverse(int threads);
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
  std::vector<std::uint32_t> marks_;  ///< words() a slot: bit j for the j-th of its row
  std::vector<std::uint8_t> reverse_marks_;
};

}  // namespace segorient::segmentation
