// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace segorient::program {

/// So many points stand for any cloud: shares of a thousandth are told to some hundredths, and of a
/// smaller cloud it is all of them.
constexpr std::size_t kSamplePoints = std::size_t{1} << 20;

/// A fair sample of points that come one by one, by their number: the same for any order of work.
class PointSample {
 public:
  using Place = std::array<double, 3>;

  void add(std::uint64_t row, const Place& place) {
    if (scatter(row) > limit_) return;
    rows_.push_back(row);
    places_.push_back(place);
    if (places_.size() > kSamplePoints) halve();
  }
  const std::vector<Place>& places() const { return places_; }
  const std::vector<std::uint64_t>& rows() const { return rows_; }  ///< of the places

  // Numbers without a pattern from numbers in a row (the finalizer of MurmurHash3).
  static std::uint64_t scatter(std::uint64_t x) {
    x = (x ^ x >> 33) * 0xff51afd7ed558ccdULL;
    x = (x ^ x >> 33) * 0xc4ceb9fe1a85ec53ULL;
    return x ^ x >> 33;
  }

 private:
  void halve() {
    limit_ /= 2;
    std::size_t kept = 0;
    for (std::size_t i = 0; i < places_.size(); ++i) {
      if (scatter(rows_[i]) > limit_) continue;
      rows_[kept] = rows_[i];
      places_[kept++] = places_[i];
    }
    rows_.resize(kept);
    places_.resize(kept);
  }

  std::uint64_t limit_ = ~std::uint64_t{0};
  std::vector<std::uint64_t> rows_;
  std::vector<Place> places_;
};

}  // namespace segorient::program
