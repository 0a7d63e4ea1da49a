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
#include "common/parts.h"

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

using Items = FastVector<Keyed>;

constexpr double kItemTime = 20.0;  // nanoseconds, of each pass

constexpr int kDigitBits = 11;
constexpr std::size_t kDigits = 6;
constexpr std::size_t kValues = std::size_t{1} << kDigitBits;
using Histogram = std::array<std::uint32_t, kValues>;

std::size_t digitOf(const Keyed& item, std::size_t digit) {
  return (item.key >> (digit * kDigitBits)) & (kValues - 1);
}

bool isConstant(const Items& items, const Parts& parts, std::size_t digit,
                const std::vector<Histogram>& histograms) {
  const std::size_t value = digitOf(items.front(), digit);
  std::size_t count = 0;
  for (std::size_t part = 0; part < parts.count(); ++part) count += histograms[part][value];
  return count == items.size();
}

// Least significant digit first; digits in which all keys agree are skipped. Each part of the items
// has places of its own for each value of a digit.
void radixSort(Items& items, int threads) {
  if (items.empty()) return;
  const Parts parts(items.size(), threads, kItemTime);
  std::vector<Histogram> histograms(parts.count());
  Items other(items.size());
  for (std::size_t digit = 0; digit < kDigits; ++digit) {
    parts.forEach([&](std::size_t part) {
      Histogram& h = histograms[part];
      h.fill(0);
      for (std::size_t i = parts.begin(part); i < parts.end(part); ++i) {
        ++h[digitOf(items[i], digit)];
      }
    });
    if (isConstant(items, parts, digit, histograms)) continue;
    std::uint32_t sum = 0;
    for (std::size_t value = 0; value < kValues; ++value) {
      for (Histogram& h : histograms) {
        const std::uint32_t count = h[value];
        h[value] = sum;
        sum += count;
      }
    }
    parts.forEach([&](std::size_t part) {
      Histogram& h = histograms[part];
      for (std::size_t i = parts.begin(part); i < parts.end(part); ++i) {
        other[h[digitOf(items[i], digit)]++] = items[i];
      }
    });
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

/// The cell of each point along a curve through a fine grid.
class ZOrder {
 public:
  ZOrder(const Source& source, int threads, const Bounds* frame)
      : source_(source), bulk_(frame != nullptr ? *frame : boundsOf(source, threads)) {
    const double extent = bulk_.extent();
    if (extent > 0.0) scale_ = kLastCell / extent;
  }

  Items items(int threads) const {
    const Parts parts(source_.size(), threads, kItemTime);
    Items items(source_.size());
    std::vector<std::size_t> ends(parts.count());
    parts.forEach([&](std::size_t part) {
      std::size_t at = parts.begin(part);
      for (std::size_t i = at; i < parts.end(part); ++i) {
        const float* p = source_.at(i);
        if (p == nullptr || bulk_.isBeyondFloats(inDouble(p))) continue;
        items[at++] = {keyOf(p), static_cast<pcl::index_t>(i)};
      }
      ends[part] = at;
    });
    // Together again where points were left out.
    auto end = items.begin();
    for (std::size_t part = 0; part < parts.count(); ++part) {
      const auto first = items.begin() + static_cast<std::ptrdiff_t>(parts.begin(part));
      const auto last = items.begin() + static_cast<std::ptrdiff_t>(ends[part]);
      end = first == end ? last : std::move(first, last, end);
    }
    items.erase(end, items.end());
    return items;
  }

 private:
  static constexpr double kLastCell = (1 << 21) - 1;

  // Strays must not make one cell of all others: what lies outside goes into the outermost cells.
  static Bounds boundsOf(const Source& source, int threads) {
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    return bulkBounds(
        source.size(),
        [&](std::size_t i) -> std::array<double, 3> {
          const float* p = source.at(i);
          if (p == nullptr) return {kNone, kNone, kNone};
          return inDouble(p);
        },
        threads);
  }

  std::uint64_t keyOf(const float* p) const {
    std::uint64_t key = 0;
    for (std::size_t a = 0; a < 3; ++a) {
      const double cell = (static_cast<double>(p[a]) - bulk_.low[a]) * scale_;
      key |= spreadBits(static_cast<std::uint64_t>(std::clamp(cell, 0.0, kLastCell))) << a;
    }
    return key;
  }

  const Source& source_;
  Bounds bulk_;
  double scale_ = 0.0;  ///< one for all axes, so that cells are cubes
};

// Points of one cell by coordinates, equal ones by row: a total order that the input order cannot
// change, and duplicates stand side by side.
void sortWithinCells(const Source& source, Items& items) {
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

// Whether an item is the first one of its place.
bool isFirst(const Source& source, const Items& items, std::size_t i) {
  return i == 0 || !equalXyz(source.known(items[i].row), source.known(items[i - 1].row));
}

}  // namespace

CompactCloud compactCloud(const PointView& points, const std::vector<pcl::index_t>* indices,
                          int threads, const Bounds* frame) {
  const Source source(points, indices);
  Items items = ZOrder(source, threads, frame).items(threads);
  radixSort(items, threads);
  sortWithinCells(source, items);

  const Parts parts(items.size(), threads, kItemTime);
  // The input may be in any order.
  constexpr std::size_t kAhead = 16;
  std::vector<std::size_t> first_of(parts.count() + 1, 0);
  parts.forEach([&](std::size_t part) {
    std::size_t distinct = 0;
    for (std::size_t i = parts.begin(part); i < parts.end(part); ++i) {
      if (i + kAhead < items.size()) prefetch(source.known(items[i + kAhead].row));
      if (isFirst(source, items, i)) ++distinct;
    }
    first_of[part + 1] = distinct;
  });
  std::partial_sum(first_of.begin(), first_of.end(), first_of.begin());

  CompactCloud out;
  out.row_of.assign(source.size(), -1);
  out.source.resize(first_of.back());
  out.xyz.resize(4 * first_of.back());
  parts.forEach([&](std::size_t part) {
    std::size_t next = first_of[part];
    for (std::size_t i = parts.begin(part); i < parts.end(part); ++i) {
      if (i + kAhead < items.size()) {
        const pcl::index_t row = items[i + kAhead].row;
        prefetch(source.known(row));
        prefetchToWrite(&out.row_of[static_cast<std::size_t>(row)]);
      }
      const pcl::index_t row = items[i].row;
      if (isFirst(source, items, i)) {
        out.source[next] = row;
        std::copy_n(source.known(row), 3, &out.xyz[4 * next]);
        out.xyz[4 * next + 3] = 0.F;
        ++next;
      }
      out.row_of[static_cast<std::size_t>(row)] = static_cast<pcl::index_t>(next - 1);
    }
  });
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
