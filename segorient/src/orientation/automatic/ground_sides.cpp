// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/automatic/ground_sides.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

#include "common/box.h"

namespace segorient::detail {
namespace {

// Points that a column has on the average, were all of them in one layer: walls stand in few
// columns then.
constexpr double kPointsOfColumn = 16.0;
// Layers: as far apart as two columns are wide, which slopes of 60 degrees stay below.
constexpr float kApart = 2.F;
// Sine of 10 degrees: as far as normals err, so that walls closer to vertical face neither way.
constexpr float kSteep = 0.17F;
// Of a component: a share of the columns is known to a hundredth by then.
constexpr std::size_t kSample = 65536;
// Standard deviations of a sum of signs by chance: a few columns tell nothing.
constexpr float kByChance = 3.F;
constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

/// The columns over one component.
class Columns {
 public:
  void include(const float* p) {
    ++points_;
    box_.add(p);
  }

  /// Once all points are included: the lowest and the highest point of each column are to be found.
  void divide() {
    if (points_ == 0) return;
    const float width = box_.high[0] - box_.low[0];
    const float depth = box_.high[1] - box_.low[1];
    const double most = std::max(1.0, static_cast<double>(points_) / kPointsOfColumn);
    const float side = std::max({std::sqrt(width * depth / static_cast<float>(most)),
                                 std::max(width, depth) / static_cast<float>(most),
                                 std::numeric_limits<float>::min()});
    across_ = static_cast<std::size_t>(width / side) + 1;
    const std::size_t along = static_cast<std::size_t>(depth / side) + 1;
    side_ = side;
    lowest_.assign(across_ * along, kNone);
    highest_.assign(across_ * along, kNone);
  }

  void add(const PointView& points, std::uint32_t i) {
    const auto x = static_cast<std::size_t>((points[i][0] - box_.low[0]) / side_);
    const auto y = static_cast<std::size_t>((points[i][1] - box_.low[1]) / side_);
    std::uint32_t& lowest = lowest_[y * across_ + x];
    std::uint32_t& highest = highest_[y * across_ + x];
    if (lowest == kNone || points[i][2] < points[lowest][2]) lowest = i;
    if (highest == kNone || points[i][2] > points[highest][2]) highest = i;
  }

  /// \param act called with the lowest and the highest point of each column, unless its surface is
  /// steep; 1 or -1 as it faces up or down by the signs so far; whether the column has one layer
  template <typename Act>
  void forEachEnd(const SheetSigns& sheets, const Act& act) const {
    for (std::size_t c = 0; c < lowest_.size(); ++c) {
      if (lowest_[c] == kNone) continue;
      const bool one_layer =
          sheets.points[highest_[c]][2] - sheets.points[lowest_[c]][2] < kApart * side_;
      for (const std::uint32_t i : {lowest_[c], highest_[c]}) {
        const float up = sheets.pointSign(i) * sheets.field.normals[4 * std::size_t{i} + 2];
        if (std::fabs(up) >= kSteep) act(i, up > 0.F ? 1.F : -1.F, one_layer);
      }
    }
  }

  float facingUp(const SheetSigns& sheets) const {
    float sum = 0.F;
    float count = 0.F;
    std::array<float, 3> slope{0.F, 0.F, 0.F};  // of all, as if it faced up
    forEachEnd(sheets, [&](std::uint32_t i, float up, bool one_layer) {
      count += 1.F;
      if (one_layer) sum += up;
      const float* n = &sheets.field.normals[4 * std::size_t{i}];
      for (std::size_t a = 0; a < 3; ++a) slope[a] += n[2] < 0.F ? -n[a] : n[a];
    });
    // Land lies level as a whole, to 45 degrees.
    if (std::hypot(slope[0], slope[1]) > slope[2]) return 0.F;
    return std::fabs(sum) > kByChance * std::sqrt(count) ? sum / count : 0.F;
  }

 private:
  std::size_t points_ = 0;
  Box box_;
  float side_ = 1.F;
  std::size_t across_ = 1;
  std::vector<std::uint32_t> lowest_;
  std::vector<std::uint32_t> highest_;
};

// Over each component that is asked for, be there one or thousands, by a sample of its own: all
// points or every n-th, up to some two times `most` of them.
std::vector<Columns> columnsOver(const SheetSigns& sheets, const std::vector<bool>& asked,
                                 std::size_t most) {
  const std::vector<std::size_t> sizes = sheets.componentSizes();
  std::vector<Columns> out(asked.size());
  std::vector<std::size_t> left_out(asked.size(), 0);  // points until the next one of the sample
  std::vector<std::uint32_t> sample;
  for (std::size_t i = 0; i < sheets.points.size; ++i) {
    const std::int32_t component = sheets.componentOf(i);
    if (component < 0 || !asked[at(component)]) continue;
    std::size_t& wait = left_out[at(component)];
    if (wait > 0) {
      --wait;
      continue;
    }
    wait = std::max<std::size_t>(1, sizes[at(component)] / most) - 1;
    sample.push_back(static_cast<std::uint32_t>(i));
    out[at(component)].include(sheets.points[i]);
  }
  for (Columns& columns : out) columns.divide();
  for (const std::uint32_t i : sample) out[at(sheets.componentOf(i))].add(sheets.points, i);
  return out;
}

}  // namespace

std::vector<float> facingUp(const SheetSigns& sheets) {
  const std::size_t count = sheets.windings.size();
  if (sheets.hints.surface == SurfaceKind::CLOSED) return std::vector<float>(count, 0.F);
  std::vector<float> out;
  for (const Columns& c : columnsOver(sheets, std::vector<bool>(count, true), kSample)) {
    out.push_back(c.facingUp(sheets));
  }
  return out;
}

std::vector<Ballot> groundVotes(const SheetSigns& sheets, const std::vector<float>& up) {
  std::vector<Ballot> out(sheets.clusters.size());
  const std::vector<Columns> columns =
      columnsOver(sheets, sheets.ground, std::numeric_limits<std::size_t>::max());
  for (std::size_t c = 0; c < columns.size(); ++c) {
    const float side = up[c] < 0.F ? -1.F : 1.F;
    columns[c].forEachEnd(sheets, [&](std::uint32_t i, float facing, bool one_layer) {
      if (!one_layer) return;
      Ballot& ballot = out[at(sheets.clusters.of(at(sheets.segmentation.labels[i])))];
      ballot.balance += static_cast<double>(side * facing);
      ballot.total += 1.0;
    });
  }
  return out;
}

}  // namespace segorient::detail
