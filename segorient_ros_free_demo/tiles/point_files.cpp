// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "tiles/point_files.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>

#include "common/parts.h"
#include "io/errors.h"
#include "tiles/plan.h"

namespace segorient::program {
namespace {

constexpr std::uint64_t kMostTilePoints = 0xffffffffU;  // as rows of 32 bits tell them apart
constexpr std::size_t kAtOnce = 1024;                   // packets that are made ready at once

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

StoredPoint* PointFiles::add(std::size_t count) {
  chunk_.resize(chunk_.size() + count);
  return chunk_.data() + (chunk_.size() - count);
}

void PointFiles::endChunk(std::uint32_t output) {
  order_.cut(chunk_);
  const std::vector<PacketRange>& packets = order_.packets();
  std::vector<Packed> batch(std::min(kAtOnce, packets.size()));
  std::vector<std::uint8_t> bytes;  // of one tile
  std::uint32_t tile = 0;
  for (std::size_t first = 0; first < packets.size(); first += batch.size()) {
    const std::size_t count = std::min(batch.size(), packets.size() - first);
    const Parts parts(count, threads_, kPacketTime);
    parts.forEach([&](std::size_t part) {
      for (std::size_t i = parts.begin(part); i < parts.end(part); ++i) {
        pack(packets[first + i], batch[i]);
      }
    });
    for (std::size_t i = 0; i < count; ++i) {
      const PacketRange& range = packets[first + i];
      if (range.tile != tile && !bytes.empty()) {
        append(tile, bytes.data(), bytes.size());
        bytes.clear();
      }
      tile = range.tile;
      list(range, batch[i], output);
      bytes.insert(bytes.end(), batch[i].bytes.begin(), batch[i].bytes.end());
    }
  }
  if (!bytes.empty()) append(tile, bytes.data(), bytes.size());
  chunk_.clear();
}

void PointFiles::pack(const PacketRange& range, Packed& out) const {
  PlaceOrder order;
  order_.addPlaces(chunk_, range, order);
  std::vector<StoredPoint> points;
  for (std::size_t i = 0; i < range.size() && (fields_.viewpoints || fields_.normals); ++i) {
    points.push_back(chunk_[order_.pointOf(range, i)]);
  }
  packPoints(points.data(), order, fields_, out.bytes);
  out.checksum = checksumOf(out.bytes.data(), out.bytes.size());
}

// Notes a packet in the list of its tile's file.
void PointFiles::list(const PacketRange& range, const Packed& points, std::uint32_t output) {
  File& file = files_[range.tile];
  if (file.starts.empty() || file.starts.back().output != output) {
    file.starts.push_back({file.points, output, 0});
  }
  PointPacket packet;
  packet.first_cell = range.first_cell;
  packet.last_cell = range.last_cell;
  packet.count = static_cast<std::uint32_t>(range.size());
  packet.bytes = static_cast<std::uint32_t>(points.bytes.size());
  packet.checksum = points.checksum;
  file.packets.push_back(packet);
  file.points += packet.count;
  if (file.points > kMostTilePoints) {
    throw FileError(aside(range.tile), "has more than four billion points in one place");
  }
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
