// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include "io/errors.h"

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace segorient::program {

/// A regular file, read from its beginning to its end, by lines or by bytes. Every failure is a
/// FileError that names the file.
class InputFile {
 public:
  /// Throws if there is no such file, or it is a directory, device or pipe, or may not be read.
  /// \param buffer bytes that are read at once; small where it is read here and there
  explicit InputFile(std::string path, std::size_t buffer = std::size_t{1} << 20);

  const std::string& path() const { return path_; }
  std::uint64_t remaining() const { return size_ - position_; }  ///< bytes not yet read
  std::size_t lineNumber() const { return line_number_; }        ///< of the last line read

  /// The next line without its end (LF or CRLF) and without a byte order mark before it, valid
  /// until the next call; false at the end of the file. Throws if a line is longer than any text
  /// line can be.
  bool line(std::string_view& out);
  /// Exactly so many bytes; throws if the file ends before.
  void read(void* out, std::size_t bytes);
  void skip(std::uint64_t bytes);
  /// Goes on at any byte of the file; line numbers then mean nothing. From there on, what is read
  /// is read as it is, and nothing ahead.
  void seek(std::uint64_t position);

  [[noreturn]] void fail(const std::string& reason) const { throw FileError(path_, reason); }
  /// fail() with the number of the last line read.
  [[noreturn]] void failLine(const std::string& reason) const {
    fail("line " + std::to_string(line_number_) + ": " + reason);
  }

 private:
  bool fill();  // more bytes behind those not yet consumed; false at the end
  void skipByteOrderMark();

  struct Closer {
    void operator()(std::FILE* f) const { std::fclose(f); }
  };
  std::string path_;
  std::unique_ptr<std::FILE, Closer> file_;
  std::uint64_t size_ = 0;
  std::uint64_t position_ = 0;
  std::size_t line_number_ = 0;
  bool sought_ = false;
  std::vector<char> buffer_;
  std::size_t begin_ = 0;
  std::size_t end_ = 0;
};

}  // namespace segorient::program
