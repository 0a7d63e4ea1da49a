// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include "io/cloud_table.h"
#include "io/input_file.h"

namespace segorient::program {

/// Points that follow one another in a file, each in as many bytes.
struct RowFormat {
  CloudTable layout;           ///< all but the rows; its size is 0
  std::uint64_t size = 0;      ///< points
  std::size_t file_bytes = 0;  ///< of a row in the file
  /// Fills the rows of a block, which has the layout and its size already.
  std::function<void(const std::uint8_t* from, CloudTable& block)> convert;
};

/// The rows of a file whose header was not yet read; the file then is at the first of them. None
/// where the file is of a kind that has to be read as a whole: text, compressed data, lists among a
/// point's properties. Throw as the readers do.
std::optional<RowFormat> plyRows(InputFile& file);
std::optional<RowFormat> pcdRows(InputFile& file);
/// Colours stay as they are stored, red16, green16, blue16.
std::optional<RowFormat> lasRows(InputFile& file);

/// A cloud that is read block by block, from its first point to its last.
class CloudStream {
 public:
  /// Whether that can be done with the file; throws where it is no cloud at all.
  static bool canRead(const std::string& path);

  /// Throws where canRead() is false.
  /// \param buffer see InputFile
  explicit CloudStream(const std::string& path, std::size_t buffer = std::size_t{1} << 20);

  const std::string& path() const { return file_.path(); }
  std::uint64_t size() const { return format_.size; }
  const CloudTable& layout() const { return format_.layout; }
  /// The next points, `most` at most. \return false behind the last one
  bool next(CloudTable& block, std::size_t most = std::size_t{1} << 16);
  /// Goes on at any point.
  void skipTo(std::uint64_t point);

 private:
  InputFile file_;
  std::uint64_t bytes_in_all_;
  RowFormat format_;
  std::uint64_t first_byte_;
  std::uint64_t read_ = 0;
  std::vector<std::uint8_t> bytes_;
};

}  // namespace segorient::program
