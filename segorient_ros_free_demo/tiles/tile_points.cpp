// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "tiles/tile_points.h"

#include <algorithm>
#include <limits>
#include <map>
#include <utility>

#include "tiles/point_files.h"

namespace segorient::program {
namespace {

class Reader {
 public:
  Reader(const Plan& plan, const std::string& folder, std::uint32_t tile)
      : plan_(plan), folder_(folder), tile_(tile) {
    findCells();
  }

  TilePoints read() {
    for (std::uint32_t t = 0; t < plan_.tiles(); ++t) {
      if (t == tile_ || has_wanted_[t] != 0) readFile(t);
    }
    listShared();
    return std::move(out_);
  }

 private:
  void findCells();
  void readFile(std::uint32_t owner);
  void addPoint(const StoredPoint& p, std::uint32_t owner);
  void push(const StoredPoint& p, TileRole role, double whole);
  void listShared();

  const Plan& plan_;
  const std::string& folder_;
  std::uint32_t tile_;
  // By node of the tree: of this tile's cells, whether others are near; of others', whether this
  // tile is.
  std::vector<std::uint8_t> is_near_;
  std::vector<std::uint8_t> has_wanted_;  // by tile
  // By the other tile and the owner.
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<std::uint32_t>> shared_;
  TilePoints out_;
};

void Reader::findCells() {
  const std::vector<TileTree::Box> tiles = plan_.tree.tileBoxes();
  is_near_.assign(plan_.tree.nodes().size(), 0);
  has_wanted_.assign(tiles.size(), 0);
  for (const TileTree::Box& cell : plan_.tree.cells()) {
    const double reach = plan_.tree.nodes()[cell.node].reach;
    if (cell.tile != tile_) {
      if (!cell.isWithin(tiles[tile_], reach)) continue;
      is_near_[cell.node] = 1;
      has_wanted_[cell.tile] = 1;
    } else if (std::any_of(tiles.begin(), tiles.end(), [&](const TileTree::Box& t) {
                 return t.tile != tile_ && cell.isWithin(t, reach);
               })) {
      is_near_[cell.node] = 1;
    }
  }
}

void Reader::readFile(std::uint32_t owner) {
  PartsReader file(tilePath(folder_, owner, "points"), TileFileKind::POINTS, plan_.run, owner);
  std::vector<StoredPoint> points;
  const std::vector<PointPacket> packets = file.list<PointPacket>();
  if (owner == tile_) out_.starts = file.list<OutputStart>();
  FilePart part{sizeof(TileFileHeader), 0, 0};
  for (const PointPacket& packet : packets) {
    part.offset += part.bytes;
    part.bytes = packet.bytes;
    part.checksum = packet.checksum;
    if (packet.last_cell < packet.first_cell || packet.last_cell >= is_near_.size()) file.fail();
    const auto first = is_near_.begin() + packet.first_cell;
    const auto last = is_near_.begin() + packet.last_cell + 1;
    if (owner != tile_ && std::find(first, last, 1) == last) continue;
    points.clear();
    if (!unpackPoints(file.part(part), packet.count, {plan_.has_viewpoints, plan_.hasNormals()},
                      points)) {
      file.fail();
    }
    for (const StoredPoint& p : points) addPoint(p, owner);
  }
}

void Reader::addPoint(const StoredPoint& p, std::uint32_t owner) {
  const std::uint32_t cell = plan_.tree.cellOf(p.place);
  const double reach = plan_.tree.nodes()[cell].reach;
  const auto place = static_cast<std::uint32_t>(out_.roles.size());
  if (owner == tile_) {
    bool shared = false;
    if (is_near_[cell] != 0) {
      plan_.tree.forEachWithin(p.place, reach, [&](std::uint32_t t, double) {
        if (t == tile_) return;
        shared = true;
        shared_[{t, tile_}].push_back(place);
      });
    }
    push(p, shared ? TileRole::SHARED : TileRole::OWN, reach);
    return;
  }
  double distance = -1.0;
  plan_.tree.forEachWithin(p.place, reach, [&](std::uint32_t t, double d) {
    if (t == tile_) distance = d;
  });
  if (distance < 0.0) return;
  shared_[{owner, owner}].push_back(place);
  push(p, TileRole::HALO,
       distance > 0.0 ? plan_.tree.wholeRadius(p.place, reach, distance) : reach);
}

void Reader::push(const StoredPoint& p, TileRole role, double whole) {
  const std::array<double, 3>& origin = plan_.tile_origins[tile_];
  for (std::size_t a = 0; a < 3; ++a) {
    out_.xyz.push_back(static_cast<float>(p.place[a] - origin[a]));
  }
  out_.roles.push_back(role);
  out_.whole.push_back(static_cast<float>(whole));
  if (plan_.has_viewpoints) {
    out_.viewpoints.insert(out_.viewpoints.end(), p.seen_from.begin(), p.seen_from.end());
  }
  if (plan_.hasNormals()) {
    out_.normals.insert(out_.normals.end(), p.normal.begin(), p.normal.end());
  }
}

void Reader::listShared() {
  for (auto& [between, points] : shared_) {
    out_.shared.push_back({between.first, between.second, std::move(points)});
  }
}

}  // namespace

TilePoints readTilePoints(const Plan& plan, const std::string& folder, std::uint32_t tile) {
  return Reader(plan, folder, tile).read();
}

}  // namespace segorient::program
