// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "tiles/tile_parts.h"

#include <utility>

namespace segorient::program {
namespace {

// Parts are read as a whole, and nothing between them.
constexpr std::size_t kSmallBuffer = 256;

}  // namespace

std::uint64_t checksumOf(const void* data, std::size_t bytes) {
  Checksum sum;
  sum.add(data, bytes);
  return sum.value();
}

PartsWriter::PartsWriter(const std::string& path, TileFileKind kind, std::uint64_t run,
                         std::uint32_t tile)
    : file_(path), offset_(sizeof(TileFileHeader)) {
  const TileFileHeader header = makeHeader(kind, run, tile);
  file_.write(&header, sizeof(header));
}

FilePart PartsWriter::add(const std::vector<std::uint8_t>& bytes) {
  file_.write(bytes.data(), bytes.size());
  const FilePart part{offset_, bytes.size(), checksumOf(bytes.data(), bytes.size())};
  offset_ += bytes.size();
  return part;
}

void PartsWriter::commit(const ListWriter& lists) {
  const std::vector<std::uint8_t>& bytes = lists.bytes();
  const PartsEnd end{offset_, checksumOf(bytes.data(), bytes.size())};
  file_.write(bytes.data(), bytes.size());
  file_.write(&end, sizeof(end));
  file_.commit();
}

PartsReader::PartsReader(std::string path, TileFileKind kind, std::uint64_t run, std::uint32_t tile)
    : path_(std::move(path)) {
  InputFile file(path_, kSmallBuffer);
  const std::uint64_t size = file.remaining();
  requireHeader(file, kind, run, tile);
  PartsEnd end;
  if (file.remaining() < sizeof(end)) fail();
  file.seek(size - sizeof(end));
  file.read(&end, sizeof(end));
  if (end.offset < sizeof(TileFileHeader) || end.offset > size - sizeof(end)) fail();
  lists_.resize(static_cast<std::size_t>(size - sizeof(end) - end.offset));
  file.seek(end.offset);
  file.read(lists_.data(), lists_.size());
  if (checksumOf(lists_.data(), lists_.size()) != end.checksum) fail();
}

std::vector<std::uint8_t> PartsReader::part(const FilePart& part) const {
  InputFile file(path_, kSmallBuffer);
  const std::uint64_t size = file.remaining();
  if (part.offset > size || part.bytes > size - part.offset) fail();
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(part.bytes));
  file.seek(part.offset);
  file.read(bytes.data(), bytes.size());
  if (checksumOf(bytes.data(), bytes.size()) != part.checksum) fail();
  return bytes;
}

void PartsReader::fail() const {
  throw FileError(path_, kDamaged);
}

}  // namespace segorient::program
