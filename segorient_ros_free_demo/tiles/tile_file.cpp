// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "tiles/tile_file.h"

#include <cstring>

namespace segorient::program {
namespace {

constexpr std::array<char, 8> kMagic{'s', 'e', 'g', 't', 'i', 'l', 'e', '2'};

}  // namespace

TileFileHeader makeHeader(TileFileKind kind, std::uint64_t run, std::uint32_t tile) {
  TileFileHeader header;
  header.magic = kMagic;
  std::strncpy(header.version.data(), SEGORIENT_VERSION, header.version.size() - 1);
  header.kind = kind;
  header.tile = tile;
  header.run = run;
  return header;
}

TileFileHeader requireHeader(InputFile& file, TileFileKind kind, std::uint64_t run,
                             std::uint32_t tile) {
  TileFileHeader header;
  if (file.remaining() < sizeof(header)) file.fail(kDamaged);
  file.read(&header, sizeof(header));
  const TileFileHeader wanted = makeHeader(kind, run, tile);
  if (header.magic != wanted.magic) file.fail("is no file of a work folder");
  if (header.version != wanted.version) {
    file.fail("was written by segorient " +
              std::string(header.version.data(), strnlen(header.version.data(), 24)) +
              ", and this is " SEGORIENT_VERSION);
  }
  if (header.kind != kind || header.tile != tile) file.fail(kDamaged);
  if (run != 0 && header.run != run) {
    file.fail("belongs to other inputs or options: remove the work folder");
  }
  return header;
}

TileFileWriter::TileFileWriter(const std::string& path, TileFileKind kind, std::uint64_t run,
                               std::uint32_t tile)
    : file_(path) {
  const TileFileHeader header = makeHeader(kind, run, tile);
  file_.write(&header, sizeof(header));
}

void TileFileWriter::commit() {
  const TileFileEnd end{checksum_.length(), checksum_.value()};
  file_.write(&end, sizeof(end));
  file_.commit();
}

TileFileReader::TileFileReader(const std::string& path, TileFileKind kind, std::uint64_t run,
                               std::uint32_t tile)
    : file_(path), header_(requireHeader(file_, kind, run, tile)) {
  if (file_.remaining() < sizeof(TileFileEnd)) fail();
}

std::uint64_t TileFileReader::remaining() const {
  return file_.remaining() < sizeof(TileFileEnd) ? 0 : file_.remaining() - sizeof(TileFileEnd);
}

void TileFileReader::bytes(void* to, std::size_t size) {
  if (size > remaining()) fail();
  file_.read(to, size);
  checksum_.add(to, size);
}

void TileFileReader::end() {
  TileFileEnd stored;
  if (file_.remaining() != sizeof(stored)) fail();
  file_.read(&stored, sizeof(stored));
  if (stored.length != checksum_.length() || stored.checksum != checksum_.value()) fail();
}

void TileFileReader::fail() const {
  file_.fail(kDamaged);
}

}  // namespace segorient::program
