// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "tiles/point_files.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>

#include "io/errors.h"
#include "tiles/plan.h"

namespace segorient::program {
namespace {

constexpr std::uint64_t kMostTilePoints = 0xffffffffU;  // as rows of 32 bits tell them apart

}  // namespace

PointFiles::PointFiles(std::string folder, std::uint64_t run, const TileTree& tree,
                       const PointFields& fields, int threads)
    : folder_(std::move(folder)),
      fields_(fields),
      threads_(threads),
      order_(tree),
      files_(tree.tiles()) {
  for (std::size_t t = 0; t < files_.size(); ++t) {
    std::remove(aside(t).c_str());
    const TileFileHeader header =
        makeHeader(TileFileKind::POINTS, run, static_cast<std::uint32_t>(t));
    append(t, &header, sizeof(header));
  }
}

PointFiles::~PointFiles() {
  for (std::size_t t = 0; t < files_.size() && !committed_; ++t) std::remove(aside(t).c_str());
}

std::string PointFiles::aside(std::size_t tile) const {
  return tilePath(folder_, tile, "points.part");
}

void PointFiles::append(std::size_t tile, const void* data, std::size_t bytes) {
  std::FILE* file = std::fopen(aside(tile).c_str(), "ab");
  const bool written = file != nullptr && std::fwrite(data, 1, bytes, file) == bytes;
  const int error = errno;
  if (file != nullptr && std::fclose(file) != 0 && written) {
    throw FileError(aside(tile), std::string("cannot be written: ") + std::strerror(errno));
  }
  if (!written) {
    throw FileError(aside(tile), std::string("cannot be written: ") + std::strerror(error));
  }
  files_[tile].offset += bytes;
}

void PointFiles::endChunk(std::uint32_t output) {
  std::vector<std::uint8_t> bytes;  // of one tile
  std::uint32_t tile = 0;
  const auto pack = [&](ChunkPacket& points) {
    packPoints(points.points.data(), points.order, fields_, points.packed);
  };
  order_.forEachPacket(chunk_, threads_, pack, [&](ChunkPacket& points) {
    if (points.tile != tile && !bytes.empty()) {
      append(tile, bytes.data(), bytes.size());
      bytes.clear();
    }
    tile = points.tile;
    File& file = files_[tile];
    if (file.starts.empty() || file.starts.back().output != output) {
      file.starts.push_back({file.points, output, 0});
    }
    const std::vector<std::uint8_t>& packed = points.packed;
    PointPacket packet;
    packet.first_cell = points.first_cell;
    packet.last_cell = points.last_cell;
    packet.count = static_cast<std::uint32_t>(points.points.size());
    packet.bytes = static_cast<std::uint32_t>(packed.size());
    packet.checksum = checksumOf(packed.data(), packed.size());
    file.packets.push_back(packet);
    file.points += packet.count;
    if (file.points > kMostTilePoints) {
      throw FileError(aside(tile), "has more than four billion points in one place");
    }
    bytes.insert(bytes.end(), packed.begin(), packed.end());
  });
  if (!bytes.empty()) append(tile, bytes.data(), bytes.size());
  chunk_.clear();
}

std::vector<std::uint64_t> PointFiles::commit() {
  std::vector<std::uint64_t> points;
  for (std::size_t t = 0; t < files_.size(); ++t) {
    ListWriter lists;
    lists.list(files_[t].packets);
    lists.list(files_[t].starts);
    const std::vector<std::uint8_t>& bytes = lists.bytes();
    const PartsEnd end{files_[t].offset, checksumOf(bytes.data(), bytes.size())};
    append(t, bytes.data(), bytes.size());
    append(t, &end, sizeof(end));
    points.push_back(files_[t].points);
  }
  for (std::size_t t = 0; t < files_.size(); ++t) {
    const std::string place = tilePath(folder_, t, "points");
    if (std::rename(aside(t).c_str(), place.c_str()) != 0) {
      throw FileError(place, std::string("cannot be written: ") + std::strerror(errno));
    }
  }
  committed_ = true;
  return points;
}

}  // namespace segorient::program
