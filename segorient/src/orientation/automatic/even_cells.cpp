// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/automatic/even_cells.h"

#include <segorient/search/median_hash_index.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "common/box.h"
#include "common/dot.h"
#include "features/sheet_fit.h"
#include "orientation/automatic/blue_noise.h"
#include "search/index_of.h"

namespace segorient::detail {
namespace {

constexpr int kAround = 9;  // the cell itself and eight neighbours
// Area per square of the mean distance to the six nearest of a blue-noise subset (measured; .866 of
// a hexagonal grid).
constexpr float kAreaPerSquare = 0.92F;

using Row = std::vector<std::uint32_t>::iterator;

// Halves at the median of the longest side, and so on: what is in any half, quarter ... of the
// order lies in a box of its own.
void halve(const PointView& places, Row first, Row last) {
  if (last - first < 2) return;
  Box box;
  for (Row r = first; r != last; ++r) box.add(places[*r]);
  const std::size_t axis = box.longestAxis();
  const Row middle = first + (last - first) / 2;
  std::nth_element(first, middle, last, [&](std::uint32_t a, std::uint32_t b) {
    const float in_a = places[a][axis];
    const float in_b = places[b][axis];
    return in_a != in_b ? in_a < in_b : a < b;
  });
  halve(places, first, middle);
  halve(places, middle, last);
}

// Numbers cells anew, so that near ones are side by side.
void sortCells(EvenCells& cells) {
  std::vector<std::uint32_t> order(cells.size());
  std::iota(order.begin(), order.end(), 0U);
  halve(cells.points(), order.begin(), order.end());
  std::vector<std::uint32_t> place(order.size());
  std::vector<float> places(cells.places.size(), 0.F);
  for (std::size_t c = 0; c < order.size(); ++c) {
    place[order[c]] = static_cast<std::uint32_t>(c);
    std::copy_n(&cells.places[std::size_t{4} * order[c]], 3, &places[4 * c]);
  }
  cells.places = std::move(places);
  for (std::uint32_t& c : cells.cell_of) c = place[c];
}

}  // namespace

float cellArea(const PointView& cells, const Neighborhoods& around, std::size_t cell) {
  const float h = meanDistance(cells, around, cell, kFirstRing);
  return kAreaPerSquare * h * h;
}

EvenCells gatherCells(const PointView& points, const std::vector<float>& normals, float radius,
                      int threads) {
  EvenCells out;
  BlueNoise cells = thinOut(points, radius, threads);
  const std::size_t n = cells.kept.size();
  if (n == 0) return out;
  out.places = meanPlaces(points, cells);
  out.cell_of = std::move(cells.cell_of);
  sortCells(out);
  out.normals.assign(4 * n, 0.F);
  for (std::size_t i = 0; i < points.size; ++i) {
    if (!isFinite(&normals[4 * i])) continue;
    float* sum = &out.normals[std::size_t{4} * out.cell_of[i]];
    for (std::size_t a = 0; a < 3; ++a) sum[a] += normals[4 * i + a];
  }
  for (std::size_t c = 0; c < n; ++c) {
    float* m = &out.normals[4 * c];
    const float length = std::sqrt(dot(m, m));
    for (std::size_t a = 0; a < 3; ++a) m[a] = length > 0.F ? m[a] / length : 0.F;
  }
  search::indexOf(out.points(), threads).nearestKAll(kAround, out.around, false);
  for (std::size_t c = 0; c < n; ++c) out.areas.push_back(cellArea(out.points(), out.around, c));
  return out;
}

namespace {

std::vector<std::uint32_t> nearestBy(const search::MedianHashIndex& index, const PointView& points,
                                     int threads) {
  std::vector<std::uint32_t> out;
  for (const std::int32_t cell : search::nearestOf(index, points, threads)) {
    out.push_back(static_cast<std::uint32_t>(std::max(cell, 0)));
  }
  return out;
}

}  // namespace

std::vector<std::uint32_t> nearestCells(const PointView& points, const PointView& cells,
                                        int threads) {
  return nearestBy(search::indexOf(cells, threads), points, threads);
}

void assignCells(const PointView& points, int threads, EvenCells& cells) {
  const search::MedianHashIndex index = search::indexOf(cells.points(), threads);
  index.nearestKAll(kAround, cells.around, false);
  cells.cell_of = nearestBy(index, points, threads);
}

}  // namespace segorient::detail
