// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "common/compact_cloud.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>

#include "common/bulk_bounds.h"
#include "common/compiler.h"
#include "common/threads.h"

namespace segorient {
namespace {

struct Keyed {
  std::uint64_t key;
  pcl::index_t row;
};

// Spreads the low 21 bits so that two zero bits follow each.
std::uint64_t spreadBits(std::uint64_t v) {
  v &= 0x1fffff;
  v = (v | v << 32) & 0x1f00000000ffffULL;
  v = (v | v << 16) & 0x1f0000ff0000ffULL;
  v = (v | v << 8) & 0x100f00f00f00f00fULL;
  v = (v | v << 4) & 0x10c30c30c30c30c3ULL;
  return (v | v << 2) & 0x1249249249249249ULL;
}

// Least significant digit first; digits in which all keys agree are skipped.
void radixSort(std::vector<Keyed>& items) {
  constexpr int kBits = 11;
  constexpr int kDigits = 6;
  constexpr std::size_t kSize = std::size_t{1} << kBits;
  std::vector<std::array<std::size_t, kSize>> histogram(kDigits);
  for (auto& h : histogram) h.fill(0);
  for (const Keyed& item : items) {
    for (int d = 0; d < kDigits; ++d) {
      ++histogram[static_cast<std::size_t>(d)][(item.key >> (d * kBits)) & (kSize - 1)];
    }
  }
  std::vector<Keyed> other(items.size());
  for (int d = 0; d < kDigits; ++d) {
    auto& h = histogram[static_cast<std::size_t>(d)];
    const bool constant =
        std::any_of(h.begin(), h.end(), [&](std::size_t c) { return c == items.size(); });
    if (constant) continue;
    std::size_t sum = 0;
    for (auto& c : h) {
      const std::size_t count = c;
      c = sum;
      sum += count;
    }
    for (const Keyed& item : items) other[h[(item.key >> (d * kBits)) & (kSize - 1)]++] = item;
    items.swap(other);
  }
}

class Source {
 public:
  Source(const PointView& points, const std::vector<pcl::index_t>* indices)
      : points_(points), indices_(indices) {}
  std::size_t size() const { return indices_ != nullptr ? indices_->size() : points_.size; }
  // A row that is known to be in range.
  const float* known(pcl::index_t i) const {
    const auto at = static_cast<std::size_t>(i);
    return points_[indices_ != nullptr ? static_cast<std::size_t>((*indices_)[at]) : at];
  }
  // Null where the row is out of range or not finite.
  const float* at(std::size_t i) const {
    if (indices_ != nullptr) {
      const pcl::index_t row = (*indices_)[i];
      if (row < 0 || static_cast<std::size_t>(row) >= points_.size) return nullptr;
    }
    const float* p = known(static_cast<pcl::index_t>(i));
    return isFinite(p) ? p : nullptr;
  }

 private:
  const PointView& points_;
  const std::vector<pcl::index_t>* indices_;
};

bool lessXyz(const float* a, const float* b) {
  if (a[0] != b[0]) return a[0] < b[0];
  if (a[1] != b[1]) return a[1] < b[1];
  return a[2] < b[2];
}

bool equalXyz(const float* a, const float* b) {
  return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
}

std::array<double, 3> inDouble(const float* p) {
  return {static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])};
}

std::vector<Keyed> zOrder(const Source& source) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  // Strays must not make one cell of all others: what lies outside goes into the outermost cells.
  const Bounds bulk = bulkBounds(source.size(), [&](std::size_t i) -> std::array<double, 3> {
    const float* p = source.at(i);
    if (p == nullptr) return {kNone, kNone, kNone};
    return inDouble(p);
  });
  // One scale for all axes, so that cells are cubes.
  constexpr double kLastCell = (1 << 21) - 1;
  const double scale = bulk.extent() > 0.0 ? kLastCell / bulk.extent() : 0.0;
  std::vector<Keyed> items;
  items.reserve(source.size());
  for (std::size_t i = 0; i < source.size(); ++i) {
    const float* p = source.at(i);
    if (p == nullptr || bulk.isBeyondFloats(inDouble(p))) continue;
    items.push_back({0, static_cast<pcl::index_t>(i)});
    for (std::size_t a = 0; a < 3; ++a) {
      const double cell = (static_cast<double>(p[a]) - bulk.low[a]) * scale;
      items.back().key |= spreadBits(static_cast<std::uint64_t>(std::clamp(cell, 0.0, kLastCell)))
                          << a;
    }
  }
  return items;
}

// Points of one cell by coordinates, equal ones by row: a total order that the input order cannot
// change, and duplicates stand side by side.
void sortWithinCells(const Source& source, std::vector<Keyed>& items) {
  for (std::size_t i = 0; i < items.size();) {
    std::size_t j = i + 1;
    while (j < items.size() && items[j].key == items[i].key) ++j;
    if (j - i > 1) {
      std::sort(items.begin() + static_cast<std::ptrdiff_t>(i),
                items.begin() + static_cast<std::ptrdiff_t>(j),
                [&](const Keyed& a, const Keyed& b) {
                  const float* p = source.known(a.row);
                  const float* q = source.known(b.row);
                  return equalXyz(p, q) ? a.row < b.row : lessXyz(p, q);
                });
    }
    i = j;
  }
}

}  // namespace

CompactCloud compactCloud(const PointView& points, const std::vector<pcl::index_t>* indices,
                          int /*threads*/) {
  const Source source(points, indices);
  std::vector<Keyed> items = zOrder(source);
  radixSort(items);
  sortWithinCells(source, items);

  CompactCloud out;
  out.row_of.assign(source.size(), -1);
  out.source.reserve(items.size());
  out.xyz.reserve(4 * items.size());
  const float* last = nullptr;
  // The input may be in any order.
  constexpr std::size_t kAhead = 16;
  for (std::size_t i = 0; i < items.size(); ++i) {
    if (i + kAhead < items.size()) {
      const pcl::index_t next = items[i + kAhead].row;
      prefetch(source.known(next));
      prefetchToWrite(&out.row_of[static_cast<std::size_t>(next)]);
    }
    const Keyed& item = items[i];
    const float* p = source.known(item.row);
    if (last == nullptr || !equalXyz(p, last)) {
      out.source.push_back(item.row);
      out.xyz.insert(out.xyz.end(), {p[0], p[1], p[2], 0.0F});
      last = p;
    }
    out.row_of[static_cast<std::size_t>(item.row)] =
        static_cast<pcl::index_t>(out.source.size() - 1);
  }
  return out;
}

void normalizeUnit(CompactCloud& cloud) {
  double extent = 0.0;
  for (std::size_t a = 0; a < 3 && cloud.size() > 0; ++a) {
    float low = cloud.xyz[a];
    float high = cloud.xyz[a];
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      low = std::min(low, cloud.xyz[4 * i + a]);
      high = std::max(high, cloud.xyz[4 * i + a]);
    }
    extent = std::max(extent, static_cast<double>(high) - static_cast<double>(low));
  }
  if (!(extent > 0.0)) return;
  constexpr int kMost = 125;  // its inverse has to be a float as well
  const int exponent = std::clamp(std::ilogb(extent), -kMost, kMost);
  const float inverse = std::ldexp(1.F, -exponent);
  for (float& v : cloud.xyz) v *= inverse;
  cloud.unit *= std::ldexp(1.F, exponent);
}

}  // namespace segorient
