// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "tiles/chunk_order.h"

#include "common/prefetch.h"

namespace segorient::program {
namespace {

// Of a packet, but at the end of a tile: its head is a twentieth of it.
constexpr std::size_t kPacketPoints = 256;

}  // namespace

ChunkOrder::ChunkOrder(const TileTree& tree) : tile_of_cell_(tree.nodes().size(), 0) {
  for (const TileTree::Box& cell : tree.cells()) tile_of_cell_[cell.node] = cell.tile;
}

void ChunkOrder::cut(const std::vector<StoredPoint>& points) {
  // Where each cell's points begin among all, by cell and then as they came.
  std::vector<std::size_t> begin(tile_of_cell_.size() + 1, 0);
  for (const StoredPoint& p : points) {
    if (p.cell != kNoCell) ++begin[p.cell + 1];
  }
  for (std::size_t c = 1; c < begin.size(); ++c) begin[c] += begin[c - 1];
  order_.resize(begin.back());
  std::vector<std::size_t> at(begin.begin(), begin.end() - 1);
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i].cell != kNoCell) order_[at[points[i].cell]++] = static_cast<std::uint32_t>(i);
  }
  packets_.clear();
  bool open = false;
  for (std::size_t c = 0; c + 1 < begin.size(); ++c) {
    if (begin[c] == begin[c + 1]) continue;
    const auto cell = static_cast<std::uint32_t>(c);
    if (!open) packets_.push_back({begin[c], 0, tile_of_cell_[c], cell, 0});
    PacketRange& range = packets_.back();
    range.end = begin[c + 1];
    range.last_cell = cell;
    std::size_t next = c + 1;
    while (next + 1 < begin.size() && begin[next] == begin[next + 1]) ++next;
    const bool more = next + 1 < begin.size() && tile_of_cell_[next] == tile_of_cell_[c];
    open = more && range.size() < kPacketPoints;
  }
}

void ChunkOrder::addPlaces(const std::vector<StoredPoint>& points, const PacketRange& range,
                           PlaceOrder& order) const {
  constexpr std::size_t kAhead = 16;
  for (std::size_t i = range.begin; i < range.end; ++i) {
    if (i + kAhead < order_.size()) prefetch(&points[order_[i + kAhead]]);
    order.add(points[order_[i]].place);
  }
}

}  // namespace segorient::program
