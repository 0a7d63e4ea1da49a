// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace segorient::program {

/// Numbers of few bits, one behind the other.
class BitWriter {
 public:
  /// \param out bytes are appended to it, the last ones by flush()
  explicit BitWriter(std::vector<std::uint8_t>& out) : out_(out) {}

  /// \param bits of the number, 0 to 56
  void put(std::uint64_t number, unsigned bits) {
    held_ |= number << count_;
    for (count_ += bits; count_ >= 8; count_ -= 8, held_ >>= 8) {
      out_.push_back(static_cast<std::uint8_t>(held_));
    }
  }
  void flush() {
    if (count_ > 0) out_.push_back(static_cast<std::uint8_t>(held_));
    held_ = 0;
    count_ = 0;
  }

 private:
  std::vector<std::uint8_t>& out_;
  std::uint64_t held_ = 0;
  unsigned count_ = 0;  // bits held, fewer than 8 between calls
};

/// Reads what a BitWriter wrote; behind the end all bits are 0.
class BitReader {
 public:
  BitReader(const std::uint8_t* begin, std::size_t bytes) : at_(begin), end_(begin + bytes) {}

  std::uint64_t get(unsigned bits) {
    while (count_ < bits) {
      held_ |= static_cast<std::uint64_t>(at_ < end_ ? *at_++ : 0) << count_;
      count_ += 8;
    }
    const std::uint64_t number = held_ & ((std::uint64_t{1} << bits) - 1);
    held_ >>= bits;
    count_ -= bits;
    return number;
  }

 private:
  const std::uint8_t* at_;
  const std::uint8_t* end_;
  std::uint64_t held_ = 0;
  unsigned count_ = 0;  // bits held, fewer than 64
};

/// How many bits a number takes.
inline unsigned bitsOf(std::uint64_t number) {
  unsigned bits = 0;
  for (; number != 0; number >>= 1) ++bits;
  return bits;
}

/// Ascending numbers by what each adds to the one before, less one bit each than by as many bits as
/// the mean has (Rice 1979): what is above that counts in single bits, and what is far above is
/// written as it is.
class RiceCode {
 public:
  /// \param span last number less the first \param count of numbers
  RiceCode(std::uint64_t span, std::size_t count)
      : bits_(std::min(kMostBits, bitsOf(span / std::max<std::size_t>(1, count) / 2))) {}

  void put(std::uint64_t step, BitWriter& out) const {
    const std::uint64_t above = step >> bits_;
    if (above >= kFar) {
      out.put((std::uint64_t{1} << kFar) - 1, kFar);
      out.put(step & 0xffffffffU, 32);
      out.put(step >> 32, 32);
      return;
    }
    out.put((std::uint64_t{1} << above) - 1, static_cast<unsigned>(above) + 1);
    out.put(step & ((std::uint64_t{1} << bits_) - 1), bits_);
  }
  std::uint64_t get(BitReader& in) const {
    std::uint64_t above = 0;
    while (above < kFar && in.get(1) != 0) ++above;
    if (above == kFar) {
      const std::uint64_t low = in.get(32);
      return in.get(32) << 32 | low;
    }
    return above << bits_ | in.get(bits_);
  }

 private:
  static constexpr unsigned kMostBits = 40;
  static constexpr unsigned kFar = 24;
  unsigned bits_;
};

}  // namespace segorient::program
