// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <type_traits>
#include <vector>

#include "tiles/tile_file.h"

// Files of a work folder that are read in parts: each part has a checksum of its own, and a list of
// all of them, with whatever else belongs to the file, stands at its end.
namespace segorient::program {

/// Where a part of a file is.
struct FilePart {
  std::uint64_t offset = 0;
  std::uint64_t bytes = 0;
  std::uint64_t checksum = 0;
};

/// Numbers and lists one after the other, as they are in memory.
class ListWriter {
 public:
  template <typename T>
  void list(const std::vector<T>& v) {
    static_assert(std::is_trivially_copyable_v<T>);
    const std::uint64_t size = v.size();
    put(&size, sizeof(size));
    put(v.data(), v.size() * sizeof(T));
  }
  const std::vector<std::uint8_t>& bytes() const { return bytes_; }

 private:
  void put(const void* data, std::size_t bytes) {
    const auto* from = static_cast<const std::uint8_t*>(data);
    bytes_.insert(bytes_.end(), from, from + bytes);
  }
  std::vector<std::uint8_t> bytes_;
};

/// The last bytes of a file in parts.
struct PartsEnd {
  std::uint64_t offset = 0;  ///< of the list
  std::uint64_t checksum = 0;
};

/// Writes one: aside, and moved to its place by commit().
class PartsWriter {
 public:
  PartsWriter(const std::string& path, TileFileKind kind, std::uint64_t run, std::uint32_t tile);
  FilePart add(const std::vector<std::uint8_t>& bytes);
  void commit(const ListWriter& lists);

 private:
  OutputFile file_;
  std::uint64_t offset_ = 0;
};

/// Reads one; the file is not kept open. Throws FileError for what is not what was written.
class PartsReader {
 public:
  PartsReader(std::string path, TileFileKind kind, std::uint64_t run, std::uint32_t tile);
  /// The lists at the end in the order in which they were written.
  template <typename T>
  std::vector<T> list() {
    std::uint64_t size = 0;
    take(&size, sizeof(size));
    if (size > (lists_.size() - at_) / sizeof(T)) fail();
    std::vector<T> v(static_cast<std::size_t>(size));
    take(v.data(), v.size() * sizeof(T));
    return v;
  }
  std::vector<std::uint8_t> part(const FilePart& part) const;
  [[noreturn]] void fail() const;

 private:
  void take(void* to, std::size_t bytes) {
    if (bytes > lists_.size() - at_) fail();
    if (bytes > 0) std::memcpy(to, lists_.data() + at_, bytes);
    at_ += bytes;
  }
  std::string path_;
  std::vector<std::uint8_t> lists_;
  std::size_t at_ = 0;
};

/// Checksum of so many bytes.
std::uint64_t checksumOf(const void* data, std::size_t bytes);

}  // namespace segorient::program
