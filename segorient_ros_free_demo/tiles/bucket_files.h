// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "tiles/checksum.h"
#include "tiles/plan.h"

namespace segorient::program {

/// The point files of all tiles, written at once: any number of them, none of which stays open.
class BucketFiles {
 public:
  /// \param memory for all that waits to be written
  BucketFiles(std::string folder, std::uint64_t run, std::size_t tiles, std::size_t memory);
  ~BucketFiles();  ///< removes what was not committed
  BucketFiles(const BucketFiles&) = delete;
  BucketFiles& operator=(const BucketFiles&) = delete;

  void add(std::size_t tile, const PointRecord& record, const float* viewpoint);
  void commit();

 private:
  struct Bucket {
    std::vector<std::uint8_t> waiting;
    Checksum checksum;
  };
  std::string aside(std::size_t tile) const;
  void flush(std::size_t tile);
  void append(std::size_t tile, const void* data, std::size_t bytes) const;

  std::string folder_;
  std::size_t most_waiting_;
  std::vector<Bucket> buckets_;
  bool committed_ = false;
};

}  // namespace segorient::program
