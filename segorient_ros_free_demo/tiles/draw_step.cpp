// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "io/cloud_writer.h"
#include "support/colors.h"
#include "tiles/steps.h"
#include "tiles/tie_file.h"
#include "tiles/tile_points.h"
#include "tiles/tile_records.h"

namespace segorient::program {
namespace {

using Place = std::array<double, 3>;

constexpr std::uint32_t kHaloColor = 0xc8c8c8;
constexpr std::uint32_t kBorderColor = 0x202020;  // of edges between pieces of one tile
constexpr std::uint32_t kTieColor = 0xd02020;     // of edges between pieces of two tiles
// Shares of the cloud's extent.
constexpr double kApart = 0.35;   // tiles are moved away from the middle by so much of their place
constexpr double kAbove = 0.025;  // the graph lies so far above the surface
constexpr double kStep = 0.002;   // of the points of a line
// Pieces with fewer of a tile's points are left out: some points along edges, mostly.
constexpr double kLeastShare = 0.02;

Place between(const Place& a, const Place& b, double t) {
  Place out{};
  for (std::size_t i = 0; i < 3; ++i) out[i] = a[i] + t * (b[i] - a[i]);
  return out;
}

double distance(const Place& a, const Place& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

class Drawing {
 public:
  Drawing(const Plan& plan, const std::string& folder) : plan_(plan), folder_(folder) {
    for (const char* name : {"x", "y", "z"}) table_.addField(name, 'F', 4);
    table_.addField("rgb", 'F', 4);
  }

  CloudTable draw() {
    measure();
    for (std::uint32_t t = 0; t < plan_.tiles(); ++t) drawPoints(t);
    for (std::uint32_t t = 0; t < plan_.tiles(); ++t) findNodes(t);
    for (std::uint32_t t = 0; t < plan_.tiles(); ++t) drawBorders(t);
    drawTies();
    table_.size = table_.width = rgb_.size();
    table_.rows.resize(table_.size * table_.row_bytes);
    const auto to = table_.xyz();
    const Field& color = *table_.find("rgb");
    for (std::size_t i = 0; i < table_.size; ++i) {
      for (std::size_t a = 0; a < 3; ++a) table_.setReal(*to[a], i, places_[i][a]);
      std::memcpy(table_.at(color, i), &rgb_[i], sizeof(rgb_[i]));
    }
    return std::move(table_);
  }

 private:
  void put(const Place& place, std::uint32_t color) {
    places_.push_back(place);
    rgb_.push_back(color);
  }
  void line(const Place& from, const Place& to, std::uint32_t color) {
    const double steps = std::ceil(distance(from, to) / (kStep * extent_));
    for (double s = 0.0; s <= steps; ++s) put(between(from, to, s / std::max(1.0, steps)), color);
  }
  Place of(std::uint32_t tile, const float* xyz) const {
    Place out{};
    for (std::size_t a = 0; a < 3; ++a) {
      out[a] = plan_.tile_origins[tile][a] + static_cast<double>(xyz[a]) + moved_[tile][a];
    }
    return out;
  }
  void measure();
  void drawPoints(std::uint32_t tile);
  void findNodes(std::uint32_t tile);
  void drawBorders(std::uint32_t tile);
  void drawTies();
  void edge(std::uint32_t tile_a, std::int32_t a, std::uint32_t tile_b, std::int32_t b,
            std::uint32_t color) {
    const auto from = nodes_.find({tile_a, a});
    const auto to = nodes_.find({tile_b, b});
    if (from != nodes_.end() && to != nodes_.end()) line(from->second, to->second, color);
  }

  const Plan& plan_;
  const std::string& folder_;
  double extent_ = 1.0;
  std::vector<Place> moved_;                                       // by tile
  std::map<std::pair<std::uint32_t, std::int32_t>, Place> nodes_;  // by tile and piece
  std::vector<Place> places_;
  std::vector<std::uint32_t> rgb_;
  CloudTable table_;
};

void Drawing::measure() {
  std::vector<Place> middles(plan_.tiles());
  Place middle{0, 0, 0};
  for (std::uint32_t t = 0; t < plan_.tiles(); ++t) {
    const TilePoints points = readTilePoints(plan_, folder_, t);
    double count = 0.0;
    for (std::size_t i = 0; i < points.roles.size(); ++i) {
      if (!isOwn(points.roles[i])) continue;
      ++count;
      for (std::size_t a = 0; a < 3; ++a)
        middles[t][a] += static_cast<double>(points.xyz[3 * i + a]);
    }
    for (std::size_t a = 0; a < 3; ++a) {
      middles[t][a] = middles[t][a] / std::max(1.0, count) + plan_.tile_origins[t][a];
      middle[a] += middles[t][a] / static_cast<double>(plan_.tiles());
    }
  }
  extent_ = 0.0;
  for (const Place& m : middles) {
    extent_ = std::max(extent_, 3.0 * distance(m, middle));
    Place moved{};
    for (std::size_t a = 0; a < 3; ++a) moved[a] = kApart * (m[a] - middle[a]);
    moved_.push_back(moved);
  }
  if (!(extent_ > 0.0)) extent_ = 1.0;
}

void Drawing::drawPoints(std::uint32_t tile) {
  const TilePoints points = readTilePoints(plan_, folder_, tile);
  for (std::size_t i = 0; i < points.roles.size(); ++i) {
    put(of(tile, &points.xyz[3 * i]), isOwn(points.roles[i]) ? segmentColor(tile) : kHaloColor);
  }
}

// The middle of each piece, above the surface on the side that join found.
void Drawing::findNodes(std::uint32_t tile) {
  const PatchFile patches = loadPatches(tilePath(folder_, tile, "patches"), plan_.run, tile);
  const SignsFile signs = loadSigns(tilePath(folder_, tile, "signs"), plan_.run, tile);
  struct Sum {
    double points = 0.0;
    Place place{0, 0, 0};
    Place normal{0, 0, 0};
  };
  std::map<std::int32_t, Sum> sums;
  double all = 0.0;
  for (const TilePatch& p : patches.patches) {
    Sum& sum = sums[p.piece];
    const double sign = signs.signs.pieces.at(static_cast<std::size_t>(p.piece));
    all += p.points;
    sum.points += p.points;
    for (std::size_t a = 0; a < 3; ++a) {
      sum.place[a] += p.points * static_cast<double>(p.position[a]);
      sum.normal[a] += sign * p.points * static_cast<double>(p.normal[a]);
    }
  }
  for (const auto& [piece, sum] : sums) {
    if (sum.points < kLeastShare * all) continue;
    const double length = std::max(1e-30, distance(sum.normal, {0, 0, 0}));
    Place node{};
    for (std::size_t a = 0; a < 3; ++a) {
      node[a] = plan_.tile_origins[tile][a] + moved_[tile][a] + sum.place[a] / sum.points +
                kAbove * extent_ * sum.normal[a] / length;
    }
    nodes_[{tile, piece}] = node;
  }
}

void Drawing::drawBorders(std::uint32_t tile) {
  const ShareFile share = loadShare(tilePath(folder_, tile, "share"), plan_.run, tile);
  for (const TileVote& v : share.votes) edge(tile, v.a, tile, v.b, kBorderColor);
}

void Drawing::drawTies() {
  std::set<std::array<std::int64_t, 4>> drawn;
  for (std::uint32_t a = 0; a < plan_.tiles(); ++a) {
    const TieReader of_a(tilePath(folder_, a, "ties"), plan_.run, a);
    for (const TieSlice& slice : of_a.slices()) {
      if (slice.other <= a || slice.other >= plan_.tiles()) continue;
      const TieReader of_b(tilePath(folder_, slice.other, "ties"), plan_.run, slice.other);
      const std::vector<TileTie> in_a = of_a.about(slice.other, slice.owner);
      const std::vector<TileTie> in_b = of_b.about(a, slice.owner);
      for (std::size_t i = 0; i < std::min(in_a.size(), in_b.size()); ++i) {
        if (!drawn.insert({a, in_a[i].piece, slice.other, in_b[i].piece}).second) continue;
        edge(a, in_a[i].piece, slice.other, in_b[i].piece, kTieColor);
      }
    }
  }
}

}  // namespace

void drawStep(const Plan& plan, const std::string& folder, const std::string& out) {
  const CloudTable table = Drawing(plan, folder).draw();
  OutputFile file(out);
  OutputCloud cloud(table);
  cloud.addRest(table);
  writeCloud(cloud, file);
  file.commit();
}

}  // namespace segorient::program
