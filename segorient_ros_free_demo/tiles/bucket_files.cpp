// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "tiles/bucket_files.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>

#include "io/errors.h"
#include "tiles/tile_file.h"

namespace segorient::program {

BucketFiles::BucketFiles(std::string folder, std::uint64_t run, std::size_t tiles,
                         std::size_t memory)
    : folder_(std::move(folder)),
      most_waiting_(std::clamp<std::size_t>(memory / std::max<std::size_t>(1, tiles), 4096,
                                            std::size_t{1} << 20)),
      buckets_(tiles) {
  for (std::size_t t = 0; t < tiles; ++t) {
    std::remove(aside(t).c_str());
    const TileFileHeader header =
        makeHeader(TileFileKind::POINTS, run, static_cast<std::uint32_t>(t));
    append(t, &header, sizeof(header));
    buckets_[t].waiting.reserve(most_waiting_ + 64);
  }
}

BucketFiles::~BucketFiles() {
  for (std::size_t t = 0; t < buckets_.size() && !committed_; ++t) std::remove(aside(t).c_str());
}

std::string BucketFiles::aside(std::size_t tile) const {
  return tilePath(folder_, tile, "points.part");
}

void BucketFiles::append(std::size_t tile, const void* data, std::size_t bytes) const {
  std::FILE* file = std::fopen(aside(tile).c_str(), "ab");
  const bool written = file != nullptr && std::fwrite(data, 1, bytes, file) == bytes;
  int error = errno;
  if (file != nullptr && std::fclose(file) != 0 && written) {
    throw FileError(aside(tile), std::string("cannot be written: ") + std::strerror(errno));
  }
  if (!written) {
    throw FileError(aside(tile), std::string("cannot be written: ") + std::strerror(error));
  }
}

void BucketFiles::flush(std::size_t tile) {
  Bucket& bucket = buckets_[tile];
  if (bucket.waiting.empty()) return;
  bucket.checksum.add(bucket.waiting.data(), bucket.waiting.size());
  append(tile, bucket.waiting.data(), bucket.waiting.size());
  bucket.waiting.clear();
}

void BucketFiles::add(std::size_t tile, const PointRecord& record, const float* viewpoint) {
  std::vector<std::uint8_t>& waiting = buckets_[tile].waiting;
  const auto put = [&](const void* data, std::size_t bytes) {
    const auto* from = static_cast<const std::uint8_t*>(data);
    waiting.insert(waiting.end(), from, from + bytes);
  };
  put(&record, sizeof(record));
  if (viewpoint != nullptr) put(viewpoint, 3 * sizeof(float));
  if (waiting.size() >= most_waiting_) flush(tile);
}

void BucketFiles::commit() {
  for (std::size_t t = 0; t < buckets_.size(); ++t) {
    flush(t);
    const TileFileEnd end{buckets_[t].checksum.length(), buckets_[t].checksum.value()};
    append(t, &end, sizeof(end));
  }
  for (std::size_t t = 0; t < buckets_.size(); ++t) {
    const std::string place = tilePath(folder_, t, "points");
    if (std::rename(aside(t).c_str(), place.c_str()) != 0) {
      throw FileError(place, std::string("cannot be written: ") + std::strerror(errno));
    }
  }
  committed_ = true;
}

}  // namespace segorient::program
