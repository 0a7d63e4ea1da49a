// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "io/cloud_stream.h"

#include <algorithm>
#include <utility>

#include "io/file_endings.h"

namespace segorient::program {
namespace {

std::optional<RowFormat> rowsOf(InputFile& file) {
  const std::string ending = fileEnding(file.path());
  std::optional<RowFormat> rows;
  if (ending == ".ply") rows = plyRows(file);
  if (ending == ".pcd") rows = pcdRows(file);
  if (ending == ".las" || ending == ".laz") rows = lasRows(file);
  if (!rows) return rows;
  for (const Field* f : rows->layout.xyz()) {
    if (f == nullptr) file.fail("has no fields x, y, z");
    // Whole numbers as coordinates, or several, ask for a look at all of them.
    if (f->type != 'F' || f->count != 1) return std::nullopt;
  }
  if (rows->size > file.remaining() / std::max<std::size_t>(1, rows->file_bytes)) {
    file.fail("is cut short: it is too small for its " + std::to_string(rows->size) + " points");
  }
  return rows;
}

RowFormat requireRows(InputFile& file) {
  std::optional<RowFormat> rows = rowsOf(file);
  if (!rows) file.fail("can't be read point by point");
  return std::move(*rows);
}

}  // namespace

bool CloudStream::canRead(const std::string& path) {
  InputFile file(path);
  return rowsOf(file).has_value();
}

CloudStream::CloudStream(const std::string& path, std::size_t buffer)
    : file_(path, buffer),
      bytes_in_all_(file_.remaining()),
      format_(requireRows(file_)),
      first_byte_(bytes_in_all_ - file_.remaining()) {}

void CloudStream::skipTo(std::uint64_t point) {
  if (point == read_) return;
  read_ = std::min(point, format_.size);
  file_.seek(first_byte_ + read_ * format_.file_bytes);
}

bool CloudStream::next(CloudTable& block, std::size_t most) {
  const auto count = static_cast<std::size_t>(std::min<std::uint64_t>(most, format_.size - read_));
  if (block.fields.empty()) block = format_.layout;
  block.size = block.width = count;
  block.height = 1;
  block.rows.resize(count * block.row_bytes);
  if (count == 0) return false;
  bytes_.resize(count * format_.file_bytes);
  file_.read(bytes_.data(), bytes_.size());
  format_.convert(bytes_.data(), block);
  read_ += count;
  return true;
}

}  // namespace segorient::program
