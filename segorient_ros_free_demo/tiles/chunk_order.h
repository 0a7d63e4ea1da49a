// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "tiles/place_order.h"
#include "tiles/point_packets.h"
#include "tiles/tile_tree.h"

namespace segorient::program {

/// Points of one packet of a chunk.
struct ChunkPacket {
  std::uint32_t tile = 0;
  std::uint32_t first_cell = 0;
  std::uint32_t last_cell = 0;
  std::vector<StoredPoint> points;   ///< in the order of the chunk
  PlaceOrder order;                  ///< of their places, which were added to it
  std::vector<std::uint8_t> packed;  ///< for who makes files of them
};

/// A chunk is as many rows of the inputs as memory has room for. Plan gives its points to the tiles
/// in an order that takes few bytes, by cells and within these by place, and write finds that order
/// again: so no file has to say which row is whose.
class ChunkOrder {
 public:
  explicit ChunkOrder(const TileTree& tree);

  /// Cuts a chunk into packets, ascending by tile, each of some cells that follow one another.
  /// \param points all of one output \param prepare called for several packets at once, which it
  /// may change \param visit called for one after the other
  void forEachPacket(const std::vector<StoredPoint>& points, int threads,
                     const std::function<void(ChunkPacket&)>& prepare,
                     const std::function<void(ChunkPacket&)>& visit) const;

 private:
  // Of the points by cell.
  struct Range {
    std::size_t begin = 0;
    std::size_t end = 0;
    std::uint32_t first_cell = 0;
    std::uint32_t last_cell = 0;
  };
  std::vector<Range> cut(const std::vector<std::size_t>& begin) const;

  std::vector<std::uint32_t> tile_of_cell_;
};

}  // namespace segorient::program
