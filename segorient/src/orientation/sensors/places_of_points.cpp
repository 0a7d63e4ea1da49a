// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/sensors/places_of_points.h"

#include <cstddef>
#include <limits>

#include "common/at.h"
#include "common/parallel_for.h"
#include "orientation/sensors/scan_checks.h"
#include "search/index_of.h"

namespace segorient::detail {
namespace {

// Of a point, that may be of its own surface.
constexpr int kPieces = 16;
// Of a point, whose plane has both sides of a wall in it, or its own.
constexpr int kNeighbors = 16;
// What rises by less over a piece's plane is of its surface: of the distance, 9 degrees.
constexpr float kRise = 0.15F;
// ns a point, see resolveThreads().
constexpr double kPointTime = 2000.0;

// The pieces near one point, nearest first.
struct NearPieces {
  std::array<pcl::index_t, kPieces> piece;
  std::array<float, kPieces> square;
  int count = 0;

  std::size_t operator[](int j) const { return at(piece[static_cast<std::size_t>(j)]); }
  float squareOf(int j) const { return square[static_cast<std::size_t>(j)]; }
};

class PlaceFinder {
 public:
  PlaceFinder(const FramedPoints& cloud, const DensityPatches& patches, const PieceOrigins& origins,
              const std::vector<std::array<float, 3>>& places)
      : cloud_(cloud), patches_(patches), origins_(origins), places_(places) {}

  // -1 = none tells.
  std::int32_t pieceFor(std::size_t i, const NearPieces& near) const {
    if (near.count == 0) return -1;
    const int best = bestOf(i, near);
    if (isInPlane(i, near, best)) return static_cast<std::int32_t>(near[best]);
    return areOnOneSide(i, near) ? static_cast<std::int32_t>(near[0]) : -1;
  }

 private:
  float squaredHeight(std::size_t i, const NearPieces& near, int j) const {
    const float height = patches_.heightOf(cloud_.points[i], near[j]);
    return height * height;
  }

  // What lies off its plane counts as so much farther away.
  int bestOf(std::size_t i, const NearPieces& near) const {
    int best = 0;
    float least = std::numeric_limits<float>::infinity();
    for (int j = 0; j < near.count; ++j) {
      const float cost = near.squareOf(j) + squaredHeight(i, near, j) / (kRise * kRise);
      if (cost >= least) continue;
      least = cost;
      best = j;
    }
    return best;
  }

  // Whether the piece goes on there.
  bool isInPlane(std::size_t i, const NearPieces& near, int j) const {
    return squaredHeight(i, near, j) < kRise * kRise * near.squareOf(j);
  }

  // Whether all places that the pieces tell of are on one side of the point's own plane.
  bool areOnOneSide(std::size_t i, const NearPieces& near) const {
    const std::int32_t first = origins_.place[near[0]];
    int others = 0;
    for (int j = 1; j < near.count; ++j) others += origins_.place[near[j]] != first ? 1 : 0;
    if (others == 0) return true;
    std::array<pcl::index_t, kNeighbors + 1> rows;
    std::array<float, kNeighbors + 1> squares;
    const int found =
        cloud_.index.nearestK(cloud_.own[i], kNeighbors + 1, rows.data(), squares.data());
    const Plane plane = planeOf(cloud_.points, i, rows.data(), found);
    if (!plane.valid) return true;
    const auto heightOf = [&](std::int32_t place) {
      float height = 0.F;
      for (std::size_t a = 0; a < 3; ++a) {
        height += (places_[at(place)][a] - cloud_.points[i][a]) *
                  plane.normal[static_cast<Eigen::Index>(a)];
      }
      return height;
    };
    const bool above = heightOf(first) > 0.F;
    for (int j = 1; j < near.count; ++j) {
      if ((heightOf(origins_.place[near[j]]) > 0.F) != above) return false;
    }
    return true;
  }

  const FramedPoints& cloud_;
  const DensityPatches& patches_;
  const PieceOrigins& origins_;
  const std::vector<std::array<float, 3>>& places_;
};

}  // namespace

PointPlaces placesOfPoints(const FramedPoints& cloud, const DensityPatches& patches,
                           const PieceOrigins& origins,
                           const std::vector<std::array<float, 3>>& places, int threads) {
  const search::MedianHashIndex pieces = patches.index(threads);
  const PlaceFinder finder(cloud, patches, origins, places);
  PointPlaces out;
  out.place.assign(cloud.points.size, -1);
  out.either_side.assign(cloud.points.size, 0);
  parallelFor(cloud.points.size, threads, kPointTime, [&](std::size_t i) {
    NearPieces near;
    near.count = pieces.nearestK(cloud.points[i], kPieces, near.piece.data(), near.square.data());
    const std::int32_t piece = finder.pieceFor(i, near);
    if (piece < 0) return;
    out.place[i] = origins.place[at(piece)];
    out.either_side[i] = origins.either_side[at(piece)];
  });
  return out;
}

}  // namespace segorient::detail
