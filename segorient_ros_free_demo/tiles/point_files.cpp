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

// Of a packet, but at the end of what is written at once: its head is a tenth of it.
constexpr std::size_t kPacketPoints = 256;
constexpr std::uint64_t kMostTilePoints = 0xffffffffU;  // as numbers of 32 bits tell them apart

}  // namespace

PointFiles::PointFiles(std::string folder, std::uint64_t run, std::size_t tiles,
                       const PointFields& fields, std::size_t memory)
    : folder_(std::move(folder)),
      fields_(fields),
      most_waiting_(std::max<std::size_t>(
          kPacketPoints, memory / std::max<std::size_t>(1, tiles) / sizeof(StoredPoint))),
      files_(tiles) {
  for (std::size_t t = 0; t < tiles; ++t) {
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

// By cell, and within packets by number.
void PointFiles::flush(std::size_t tile) {
  File& file = files_[tile];
  std::vector<StoredPoint>& waiting = file.waiting;
  std::stable_sort(waiting.begin(), waiting.end(),
                   [](const StoredPoint& p, const StoredPoint& q) { return p.cell < q.cell; });
  bytes_.clear();
  for (std::size_t first = 0; first < waiting.size();) {
    std::size_t last = std::min(first + kPacketPoints, waiting.size());
    while (last < waiting.size() && waiting[last].cell == waiting[last - 1].cell) ++last;
    PointPacket packet;
    packet.first_cell = waiting[first].cell;
    packet.last_cell = waiting[last - 1].cell;
    packet.count = static_cast<std::uint32_t>(last - first);
    std::sort(waiting.begin() + static_cast<std::ptrdiff_t>(first),
              waiting.begin() + static_cast<std::ptrdiff_t>(last),
              [](const StoredPoint& p, const StoredPoint& q) { return p.number < q.number; });
    packPoints(&waiting[first], last - first, fields_, packet_);
    packet.bytes = static_cast<std::uint32_t>(packet_.size());
    packet.checksum = checksumOf(packet_.data(), packet_.size());
    file.packets.push_back(packet);
    bytes_.insert(bytes_.end(), packet_.begin(), packet_.end());
    first = last;
  }
  waiting.clear();
  append(tile, bytes_.data(), bytes_.size());
}

void PointFiles::add(std::size_t tile, std::uint32_t output, StoredPoint& point) {
  File& file = files_[tile];
  if (file.points >= kMostTilePoints) {
    throw FileError(aside(tile), "has more than four billion points in one place");
  }
  if (file.starts.empty() || file.starts.back().output != output) {
    file.starts.push_back({file.points, output, 0});
  }
  point.number = static_cast<std::uint32_t>(file.points++);
  std::vector<StoredPoint>& waiting = file.waiting;
  if (waiting.empty()) waiting.reserve(most_waiting_);
  waiting.push_back(point);
  if (waiting.size() >= most_waiting_) flush(tile);
}

void PointFiles::commit() {
  for (std::size_t t = 0; t < files_.size(); ++t) {
    if (!files_[t].waiting.empty()) flush(t);
    std::vector<StoredPoint>().swap(files_[t].waiting);
    ListWriter lists;
    lists.list(files_[t].packets);
    lists.list(files_[t].starts);
    const std::vector<std::uint8_t>& bytes = lists.bytes();
    const PartsEnd end{files_[t].offset, checksumOf(bytes.data(), bytes.size())};
    append(t, bytes.data(), bytes.size());
    append(t, &end, sizeof(end));
  }
  for (std::size_t t = 0; t < files_.size(); ++t) {
    const std::string place = tilePath(folder_, t, "points");
    if (std::rename(aside(t).c_str(), place.c_str()) != 0) {
      throw FileError(place, std::string("cannot be written: ") + std::strerror(errno));
    }
  }
  committed_ = true;
}

}  // namespace segorient::program
