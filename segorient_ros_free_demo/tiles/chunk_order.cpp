// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "tiles/chunk_order.h"

#include <algorithm>

#include "common/parts.h"

namespace segorient::program {
namespace {

// Of a packet, but at the end of a tile: its head is a twentieth of it.
constexpr std::size_t kPacketPoints = 256;
// Packets that are made ready at once, and what one takes, in nanoseconds.
constexpr std::size_t kAtOnce = 1024;
constexpr double kPacketTime = 30000.0;

}  // namespace

ChunkOrder::ChunkOrder(const TileTree& tree) : tile_of_cell_(tree.nodes().size(), 0) {
  for (const TileTree::Box& cell : tree.cells()) tile_of_cell_[cell.node] = cell.tile;
}

// \param begin of each cell among the points by cell, and behind the last one
std::vector<ChunkOrder::Range> ChunkOrder::cut(const std::vector<std::size_t>& begin) const {
  std::vector<Range> out;
  bool open = false;
  for (std::size_t c = 0; c + 1 < begin.size(); ++c) {
    if (begin[c] == begin[c + 1]) continue;
    if (!open) out.push_back({begin[c], 0, static_cast<std::uint32_t>(c), 0});
    Range& range = out.back();
    range.end = begin[c + 1];
    range.last_cell = static_cast<std::uint32_t>(c);
    std::size_t next = c + 1;
    while (next + 1 < begin.size() && begin[next] == begin[next + 1]) ++next;
    const bool more = next + 1 < begin.size() && tile_of_cell_[next] == tile_of_cell_[c];
    open = more && range.end - range.begin < kPacketPoints;
  }
  return out;
}

void ChunkOrder::forEachPacket(const std::vector<StoredPoint>& points, int threads,
                               const std::function<void(ChunkPacket&)>& prepare,
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
  const std::vector<Range> ranges = cut(begin);
  std::vector<ChunkPacket> batch(std::min(kAtOnce, ranges.size()));
  const auto fill = [&](const Range& range, ChunkPacket& packet) {
    packet.points.clear();
    packet.order.clear();
    packet.tile = tile_of_cell_[range.first_cell];
    packet.first_cell = range.first_cell;
    packet.last_cell = range.last_cell;
    for (std::size_t i = range.begin; i < range.end; ++i) {
      packet.points.push_back(points[order[i]]);
      packet.order.add(packet.points.back().place);
    }
    prepare(packet);
  };
  for (std::size_t first = 0; first < ranges.size(); first += batch.size()) {
    const std::size_t count = std::min(batch.size(), ranges.size() - first);
    const Parts parts(count, threads, kPacketTime);
    parts.forEach([&](std::size_t part) {
      for (std::size_t i = parts.begin(part); i < parts.end(part); ++i) {
        fill(ranges[first + i], batch[i]);
      }
    });
    for (std::size_t i = 0; i < count; ++i) visit(batch[i]);
  }
}

}  // namespace segorient::program
