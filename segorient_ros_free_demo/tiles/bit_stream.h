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
  for (const unsigned half : {32U, 16U, 8U, 4U, 2U, 1U}) {
    if (number >> half == 0) continue;
    bits += half;
    number >>= half;
  }
  return number != 0 ? bits + 1 : 0;
}

/// Numbers most of which are small, without any limit (Golomb codes of exponential size, Teuhola
/// 1978): how many bits they have beyond some, in single bits, and the bits.
class GolombCode {
 public:
  explicit GolombCode(unsigned bits = 0) : bits_(bits) {}
  /// That takes the fewest bits for these numbers. \param most bits looked at
  static GolombCode best(const std::vector<std::uint32_t>& numbers, unsigned most);
  unsigned bits() const { return bits_; }

  void put(std::uint32_t number, BitWriter& out) const {
    const std::uint64_t shifted = number + (std::uint64_t{1} << bits_);
    const unsigned more = bitsOf(shifted >> bits_) - 1;
    out.put((std::uint64_t{1} << more) - 1, more + 1);
    out.put(shifted & ((std::uint64_t{1} << (bits_ + more)) - 1), bits_ + more);
  }
  std::uint32_t get(BitReader& in) const {
    unsigned more = 0;
    while (more < kMost && in.get(1) != 0) ++more;
    const std::uint64_t low = in.get(bits_ + more);
    const std::uint64_t shifted = low | std::uint64_t{1} << (bits_ + more);
    return static_cast<std::uint32_t>(shifted - (std::uint64_t{1} << bits_));
  }

 private:
  static constexpr unsigned kMost = 32;  // of bits that a number of 32 bits can have more
  unsigned bits_;
};

inline GolombCode GolombCode::best(const std::vector<std::uint32_t>& numbers, unsigned most) {
  GolombCode best;
  std::uint64_t least = ~std::uint64_t{0};
  for (unsigned bits = 0; bits <= most; ++bits) {
    std::uint64_t sum = 0;
    for (const std::uint32_t n : numbers) sum += std::uint64_t{2} * bitsOf((n >> bits) + 1);
    sum += numbers.size() * bits;
    if (sum < least) best = GolombCode(bits);
    least = std::min(least, sum);
  }
  return best;
}

/// Whole numbers that may be negative as ones that are not: those near 0 stay small.
inline std::uint32_t foldSign(std::int32_t x) {
  return static_cast<std::uint32_t>(x) << 1U ^ (x < 0 ? ~std::uint32_t{0} : 0U);
}
inline std::int32_t unfoldSign(std::uint32_t x) {
  return static_cast<std::int32_t>(x >> 1U ^ ((x & 1U) != 0 ? ~std::uint32_t{0} : 0U));
}

}  // namespace segorient::program
