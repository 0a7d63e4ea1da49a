// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

#include "io/input_file.h"
#include "io/output_file.h"
#include "tiles/checksum.h"

namespace segorient::program {

/// What a file of a work folder holds.
enum class TileFileKind : std::uint32_t {
  PLAN = 1,
  POINTS,
  ROWS,
  SHARE,
  TIES,
  SIGNS,
  JOIN,
  LABELS,
  PATCHES,
  FIELD
};

/// The first bytes of every file of a work folder.
struct TileFileHeader {
  std::array<char, 8> magic{};
  std::array<char, 24> version{};  ///< of the program
  TileFileKind kind{};
  std::uint32_t tile = 0;
  std::uint64_t run = 0;  ///< which inputs and options it is for
};

TileFileHeader makeHeader(TileFileKind kind, std::uint64_t run, std::uint32_t tile);
/// Reads a header; throws FileError if it is another one. \param run 0 = any
TileFileHeader requireHeader(InputFile& file, TileFileKind kind, std::uint64_t run,
                             std::uint32_t tile);

/// Appended to the contents of every file but those in parts, see tile_parts.h.
struct TileFileEnd {
  std::uint64_t length = 0;
  std::uint64_t checksum = 0;
};

/// Writes a file of a work folder: aside, and moved to its place by commit(). Numbers and lists of
/// plain structures as they are in memory.
class TileFileWriter {
 public:
  TileFileWriter(const std::string& path, TileFileKind kind, std::uint64_t run,
                 std::uint32_t tile = 0);
  void bytes(const void* data, std::size_t size) {
    checksum_.add(data, size);
    file_.write(data, size);
  }
  template <typename T>
  void value(const T& v) {
    static_assert(std::is_trivially_copyable_v<T>);
    bytes(&v, sizeof(T));
  }
  template <typename T>
  void list(const std::vector<T>& v) {
    static_assert(std::is_trivially_copyable_v<T>);
    value<std::uint64_t>(v.size());
    if (!v.empty()) bytes(v.data(), v.size() * sizeof(T));
  }
  void text(const std::string& s) { list(std::vector<char>(s.begin(), s.end())); }
  void commit();

 private:
  OutputFile file_;
  Checksum checksum_;
};

/// Reads one; every way in which it is not what was written is a FileError, at end() at the latest.
class TileFileReader {
 public:
  TileFileReader(const std::string& path, TileFileKind kind, std::uint64_t run,
                 std::uint32_t tile = 0);
  std::uint64_t run() const { return header_.run; }
  std::uint64_t remaining() const;  ///< bytes of contents
  void bytes(void* to, std::size_t size);
  template <typename T>
  T value() {
    T v{};
    bytes(&v, sizeof(T));
    return v;
  }
  template <typename T>
  std::vector<T> list() {
    const auto size = value<std::uint64_t>();
    if (size > remaining() / sizeof(T)) fail();
    std::vector<T> v(static_cast<std::size_t>(size));
    if (!v.empty()) bytes(v.data(), v.size() * sizeof(T));
    return v;
  }
  std::string text() {
    const std::vector<char> v = list<char>();
    return {v.begin(), v.end()};
  }
  void end();

 private:
  [[noreturn]] void fail() const;

  InputFile file_;
  TileFileHeader header_;
  Checksum checksum_;
};

/// What FileError says of a damaged file of a work folder.
constexpr const char* kDamaged =
    "is damaged: remove it, with all that was made from it, or the whole work folder";

}  // namespace segorient::program
