// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "tiles/chunk_order.h"

namespace segorient::program {
namespace {

// Of a packet, but at the end of a tile: its head is a twentieth of it.
constexpr std::size_t kPacketPoints = 256;

}  // namespace

ChunkOrder::ChunkOrder(const TileTree& tree) : tile_of_cell_(tree.nodes().size(), 0) {
  for (const TileTree::Box& cell : tree.cells()) tile_of_cell_[cell.node] = cell.tile;
}

void ChunkOrder::forEachPacket(const std::vector<StoredPoint>& points,
                               const std::function<void(ChunkPacket&)>& visit) const {
  // Where each cell's points begin among all, by cell and then as they came.
  std::vector<std::size_t> begin(tile_of_cell_.size() + 1, 0);
  for (const StoredPoint& p : points) ++begin[p.cell + 1];
  for (std::size_t c = 1; c < begin.size(); ++c) begin[c] += begin[c - 1];
  std::vector<std::uint32_t> order(points.size());
  {
    std::vector<std::size_t> at(begin.begin(), begin.end() - 1);
    for (std::size_t i = 0; i < points.size(); ++i) {
      order[at[points[i].cell]++] = static_cast<std::uint32_t>(i);
    }
  }
  ChunkPacket packet;
  for (std::size_t c = 0; c + 1 < begin.size(); ++c) {
    if (begin[c] == begin[c + 1]) continue;
    if (packet.points.empty()) {
      packet.tile = tile_of_cell_[c];
      packet.first_cell = static_cast<std::uint32_t>(c);
    }
    packet.last_cell = static_cast<std::uint32_t>(c);
    for (std::size_t i = begin[c]; i < begin[c + 1]; ++i) {
      packet.points.push_back(points[order[i]]);
      packet.order.add(packet.points.back().place);
    }
    std::size_t next = c + 1;
    while (next + 1 < begin.size() && begin[next] == begin[next + 1]) ++next;
    const bool more = next + 1 < begin.size() && tile_of_cell_[next] == packet.tile;
    if (more && packet.points.size() < kPacketPoints) continue;
    visit(packet);
    packet.points.clear();
    packet.order.clear();
  }
}

}  // namespace segorient::program
