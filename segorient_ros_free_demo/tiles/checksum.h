// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>

namespace segorient::program {

/// A checksum of 64 bits over bytes in order, whatever pieces they come in. Against damage, not
/// against malice.
class Checksum {
 public:
  void add(const void* data, std::size_t bytes) {
    const auto* from = static_cast<const std::uint8_t*>(data);
    length_ += bytes;
    if (held_ > 0) {
      const std::size_t take = std::min(bytes, sizeof(word_) - held_);
      std::memcpy(reinterpret_cast<std::uint8_t*>(&word_) + held_, from, take);
      held_ += take;
      from += take;
      bytes -= take;
      if (held_ < sizeof(word_)) return;
      mix(word_);
      held_ = 0;
    }
    for (; bytes >= sizeof(word_); from += sizeof(word_), bytes -= sizeof(word_)) {
      std::memcpy(&word_, from, sizeof(word_));
      mix(word_);
    }
    word_ = 0;
    std::memcpy(&word_, from, bytes);
    held_ = bytes;
  }
  template <typename T>
  void addValue(const T& value) {
    add(&value, sizeof(T));
  }
  std::uint64_t length() const { return length_; }
  std::uint64_t value() const {
    Checksum end = *this;
    if (end.held_ > 0) end.mix(end.word_);
    end.mix(length_);
    return end.state_ ^ end.state_ >> 29;
  }

 private:
  // A product with an odd number keeps all that was there, and the shift brings the upper half,
  // which depends on all of it, down.
  void mix(std::uint64_t word) {
    state_ = (state_ ^ word) * 0x9e3779b97f4a7c15ULL;
    state_ ^= state_ >> 32;
  }

  std::uint64_t state_ = 0x243f6a8885a308d3ULL;
  std::uint64_t word_ = 0;
  std::size_t held_ = 0;  // bytes of word_ that are filled
  std::uint64_t length_ = 0;
};

}  // namespace segorient::program
