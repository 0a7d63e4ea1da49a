// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "tiles/bit_stream.h"

namespace segorient::program {

/// How one coordinate of places near each other is stored: as a whole number of steps, which are
/// the largest power of two that all of them are multiples of.
struct PlaceAxis {
  double least = 0.0;
  std::int16_t step = 0;  ///< its exponent
  std::uint8_t bits = 0;  ///< of the numbers
};

/// Places near each other, in an order of their own: box by box, each halved along the axis along
/// which it has most steps. So the order takes no bits, and few are needed to tell where a point is
/// among its neighbours: of each box, how many of its points are in the lower half (Gandoin and
/// Devillers 2002), and of a box with a single one, the place in it. Exact, unless that takes more
/// than the 52 bits of a double.
class PlaceOrder {
 public:
  using Place = std::array<double, 3>;
  static constexpr int kMostBits = 52;

  /// \return false where they are axes that no file has
  static bool isValid(const std::array<PlaceAxis, 3>& axes);

  /// The next place to be ordered.
  void add(const Place& place) {
    places_.push_back({place, {}, static_cast<std::uint32_t>(places_.size())});
  }
  /// Orders what was added. Places that are equal keep the order in which they came.
  /// \param out gets the code behind what it holds; null = none is wanted
  void order(BitWriter* out);
  const std::array<PlaceAxis, 3>& axes() const { return axes_; }
  std::size_t size() const { return places_.size(); }
  /// Which of the places, counted as they were added, is the i-th of the order.
  std::uint32_t at(std::size_t i) const { return places_[i].number; }
  void clear() { places_.clear(); }

  /// The places of a code, in their order; appended. \param axes valid ones
  static void read(const std::array<PlaceAxis, 3>& axes, std::size_t count, BitReader& in,
                   std::vector<Place>& out);

 private:
  struct Entry {
    Place place;
    std::array<std::uint64_t, 3> steps;
    std::uint32_t number;
  };
  void findAxes();
  void split(std::size_t first, std::size_t last, std::array<std::uint8_t, 3> bits, BitWriter* out);

  std::array<PlaceAxis, 3> axes_;
  std::vector<Entry> places_;
};

}  // namespace segorient::program
