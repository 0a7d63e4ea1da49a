// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/automatic/torn_sheets.h"

#include <segorient/common/point_view.h>

#include <algorithm>
#include <cstddef>

#include "common/at.h"
#include "common/disjoint_sets.h"
#include "common/dot.h"

namespace segorient::detail {
namespace {

constexpr int kAround = 8;  // a ring of neighbours

// What turning a patch does to the pairs of a point in it and a neighbour.
struct Patch {
  std::size_t points = 0;
  std::size_t at_tear = 0;  // points in a pair that is torn
  std::size_t torn = 0;     // pairs that agree before, and not afterwards
  std::size_t mended = 0;   // the other way round
};

std::int32_t as(std::size_t i) {
  return static_cast<std::int32_t>(i);
}

// Calls act(i, q) for all pairs of a turned point and a neighbour of it.
template <typename Act>
void forEachPair(const Neighborhoods& neighborhoods, const std::vector<float>& normals,
                 const std::vector<std::uint8_t>& turned, const Act& act) {
  for (std::size_t i = 0; i < turned.size(); ++i) {
    if (turned[i] == 0) continue;
    const int count = std::min(neighborhoods.count(i), kAround + 1);
    for (int j = 1; j < count; ++j) {
      const auto q = static_cast<std::size_t>(neighborhoods.indices(i)[j]);
      if (isFinite(&normals[4 * q])) act(i, q);
    }
  }
}

}  // namespace

void keepSheetsWhole(const Neighborhoods& neighborhoods, const std::vector<float>& normals,
                     std::vector<std::uint8_t>& turned) {
  if (std::find(turned.begin(), turned.end(), std::uint8_t{1}) == turned.end()) return;
  const auto agree = [&](std::size_t i, std::size_t q) {
    return dot(&normals[4 * i], &normals[4 * q]) > 0.F;
  };
  DisjointSets patches(turned.size());
  forEachPair(neighborhoods, normals, turned, [&](std::size_t i, std::size_t q) {
    if (turned[q] != 0 && agree(i, q)) patches.join(as(i), as(q));
  });
  std::vector<Patch> of(turned.size());
  std::vector<std::uint8_t> at_tear(turned.size(), 0);
  forEachPair(neighborhoods, normals, turned, [&](std::size_t i, std::size_t q) {
    if (turned[q] != 0) return;
    Patch& patch = of[at(patches.find(as(i)))];
    ++(agree(i, q) ? patch.torn : patch.mended);
    if (agree(i, q)) at_tear[i] = 1;
  });
  for (std::size_t i = 0; i < turned.size(); ++i) {
    if (turned[i] == 0) continue;
    Patch& patch = of[at(patches.find(as(i)))];
    ++patch.points;
    patch.at_tear += at_tear[i];
  }
  for (std::size_t i = 0; i < turned.size(); ++i) {
    if (turned[i] == 0) continue;
    const Patch& patch = of[at(patches.find(as(i)))];
    if (patch.torn > patch.mended && 2 * patch.at_tear < patch.points) turned[i] = 0;
  }
}

}  // namespace segorient::detail
