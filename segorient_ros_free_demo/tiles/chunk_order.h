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

/// What the work on one packet takes, in nanoseconds: see Parts.
constexpr double kPacketTime = 30000.0;

/// Which points of a chunk one packet has: those of some cells that follow one another.
struct PacketRange {
  std::size_t begin = 0;  ///< among the points by cell
  std::size_t end = 0;
  std::uint32_t tile = 0;
  std::uint32_t first_cell = 0;
  std::uint32_t last_cell = 0;
  std::size_t size() const { return end - begin; }
};

/// A chunk is as many rows of the inputs as memory has room for. Plan gives its points to the tiles
/// in an order that takes few bytes, by cells and within these by place, and write finds that order
/// again: so no file has to say which row is whose.
class ChunkOrder {
 public:
  explicit ChunkOrder(const TileTree& tree);

  /// Cuts a chunk into packets. \param points all of one output; those of no cell are left out
  void cut(const std::vector<StoredPoint>& points);
  /// Of the chunk that was cut, ascending by tile.
  const std::vector<PacketRange>& packets() const { return packets_; }
  /// Adds the places of one of them to an order, by any number of threads.
  /// \param points those that were cut
  void addPlaces(const std::vector<StoredPoint>& points, const PacketRange& range,
                 PlaceOrder& order) const;
  /// Which point of the chunk is the i-th of a packet, as their places were added.
  std::size_t pointOf(const PacketRange& range, std::size_t i) const {
    return order_[range.begin + i];
  }

 private:
  std::vector<std::uint32_t> tile_of_cell_;
  std::vector<std::uint32_t> order_;  // the points of the chunk by cell
  std::vector<PacketRange> packets_;
};

}  // namespace segorient::program
