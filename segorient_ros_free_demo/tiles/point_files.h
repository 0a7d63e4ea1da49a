// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "tiles/chunk_order.h"
#include "tiles/tile_parts.h"
#include "tiles/tile_records.h"

namespace segorient::program {

/// Points of some cells of the tree that follow one another.
struct PointPacket {
  std::uint64_t checksum = 0;
  std::uint32_t bytes = 0;  ///< behind those of the packet before
  std::uint32_t first_cell = 0;
  std::uint32_t last_cell = 0;
  std::uint32_t count = 0;
};

/// The point files of all tiles, written at once: any number of them, none of which stays open.
/// Each holds the tile's own points, as packets of a few cells, so that others find what they need
/// of it for their halos.
class PointFiles {
 public:
  PointFiles(std::string folder, std::uint64_t run, const TileTree& tree, const PointFields& fields,
             int threads);
  ~PointFiles();  ///< removes what was not committed
  PointFiles(const PointFiles&) = delete;
  PointFiles& operator=(const PointFiles&) = delete;

  /// Adds points to the chunk. \return the first of them, to be told until the next call
  StoredPoint* add(std::size_t count);
  /// After the last point of a chunk. \param output that its points will be part of; those of one
  /// come one after the other
  void endChunk(std::uint32_t output);
  /// \return how many points each tile has
  std::vector<std::uint64_t> commit();

 private:
  struct Packed {
    std::vector<std::uint8_t> bytes;
    std::uint64_t checksum = 0;
  };
  struct File {
    std::vector<PointPacket> packets;
    std::vector<OutputStart> starts;
    std::uint64_t points = 0;
    std::uint64_t offset = 0;
  };
  std::string aside(std::size_t tile) const;
  void pack(const PacketRange& range, Packed& out) const;
  void list(const PacketRange& range, const Packed& points, std::uint32_t output);
  void append(std::size_t tile, const void* data, std::size_t bytes);

  std::string folder_;
  PointFields fields_;
  int threads_;
  ChunkOrder order_;
  std::vector<StoredPoint> chunk_;
  std::vector<File> files_;
  bool committed_ = false;
};

}  // namespace segorient::program
