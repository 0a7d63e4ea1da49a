// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>

namespace segorient::test {

/// Takes numbers from the front of a fuzzer's bytes; zeros once they are used up.
class ByteReader {
 public:
  ByteReader(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}

  bool empty() const { return size_ == 0; }
  std::uint8_t byte() {
    if (size_ == 0) return 0;
    --size_;
    return *data_++;
  }
  /// 0 to count - 1.
  std::size_t below(std::size_t count) { return byte() % count; }
  /// A small whole number, -128 to 127.
  float whole() { return static_cast<float>(static_cast<int>(byte()) - 128); }
  /// Any float at all.
  float any() {
    std::uint8_t bytes[4];
    for (std::uint8_t& b : bytes) b = byte();
    float value = 0.F;
    std::memcpy(&value, bytes, sizeof(value));
    return value;
  }

 private:
  const std::uint8_t* data_;
  std::size_t size_;
};

}  // namespace segorient::test
