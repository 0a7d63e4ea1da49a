// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/sensors/from_above.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <unordered_map>
#include <vector>

#include "common/in_double.h"
#include "common/median.h"
#include "orientation/sensors/height_field.h"
#include "orientation/sensors/station_search.h"
#include "search/index_of.h"

namespace segorient::detail {
namespace {

// Of all points: what is scattered in a scan of something solid are edges, and noise.
constexpr float kManyScattered = 0.1F;
// The rest are stray points below the ground, and steep ground.
constexpr float kNearlyAll = 0.9F;

// Heights of points over the ground at their places.
class HeightsOver {
 public:
  HeightsOver(const PointView& ground, float side) : side_(side) {
    std::unordered_map<std::uint64_t, std::vector<float>> columns;
    for (std::size_t i = 0; i < ground.size; ++i) {
      columns[columnOf(ground[i])].push_back(ground[i][2]);
    }
    for (const auto& [column, heights] : columns) ground_[column] = median(heights);
  }

  /// Of those that have ground below or above them.
  void add(const float* point, std::vector<float>& out) const {
    const auto found = ground_.find(columnOf(point));
    if (found != ground_.end()) out.push_back(point[2] - found->second);
  }

 private:
  std::uint64_t columnOf(const float* p) const {
    // Whatever is farther away than that is in no column with anything nearer.
    constexpr float kFarthest = 1e9F;
    const auto part = [&](float x) {
      const float column = std::clamp(std::floor(x / side_), -kFarthest, kFarthest);
      return static_cast<std::uint32_t>(static_cast<std::int32_t>(column));
    };
    return (std::uint64_t{part(p[0])} << 32U) | std::uint64_t{part(p[1])};
  }

  float side_;
  std::unordered_map<std::uint64_t, float> ground_;
};

// The ground's surface, if that is what is on surfaces, and the rest is above.
std::optional<HeightField> groundUnderWoods(const FlatPoints& flat, int threads) {
  const std::size_t n = flat.size();
  const std::size_t on_surfaces = flat.onSurfaces().size();
  const auto scattered = static_cast<float>(n - on_surfaces);
  if (on_surfaces == 0 || scattered < kManyScattered * static_cast<float>(n)) return {};
  std::vector<float> xyz;
  xyz.reserve(4 * on_surfaces);
  for (const std::size_t i : flat.onSurfaces()) {
    xyz.insert(xyz.end(), flat.view()[i], flat.view()[i] + 3);
    xyz.push_back(0.F);
  }
  const PointView ground{xyz.data(), 4, on_surfaces};
  const search::MedianHashIndex index = search::indexOf(ground, threads);
  const DensityPatches patches = densityPatches(ground, index, threads);
  const HeightField field = measureHeightField(ground, index, patches, flat.view());
  if (!field.sure()) return {};
  // As far from the ground as noise does not reach.
  const float side = kColumn * patches.spacing;
  const HeightsOver heights_over(ground, side);
  std::vector<float> heights;
  for (std::size_t i = 0; i < n; ++i) {
    if (!flat.isOnSurface(i)) heights_over.add(flat.view()[i], heights);
  }
  const auto count = [&](float sign) {
    return static_cast<float>(
        std::count_if(heights.begin(), heights.end(), [&](float h) { return sign * h > side; }));
  };
  const float above = count(1.F);
  const bool is_woods =
      above > kManyScattered * static_cast<float>(n) && above > kNearlyAll * (above + count(-1.F));
  return is_woods ? std::optional(field) : std::nullopt;
}

void setAbove(SensorEvidence evidence, const Extent& extent, const HeightField& field,
              const char* why, SensorReport& report) {
  constexpr double kFarAbove = 100.0;  // extents: rays are parallel to half a degree
  FoundSensor sensor;
  sensor.kind = SensorKind::ABOVE;
  sensor.evidence = evidence;
  std::array<double, 3> position = extent.middle();
  position[2] += kFarAbove * extent.diagonal();
  sensor.position = toFloat(position);
  sensor.axis = {0.F, 0.F, 1.F};
  sensor.cost_ratio = field.layered;
  sensor.sure = true;
  report.sensors = {sensor};
  std::fill(report.sensor_of.begin(), report.sensor_of.end(), 0);
  report.why = why;
}

}  // namespace

bool isOverGround(const SensorReport& report) {
  return report.sure() && (report.sensors[0].evidence == SensorEvidence::LAYERS ||
                           report.sensors[0].evidence == SensorEvidence::WOODS);
}

void lookOverWoods(const FlatPoints& flat, const DensityPatches& patches, int threads,
                   SensorReport& report) {
  const std::optional<HeightField> ground = groundUnderWoods(flat, threads);
  if (!ground) return;
  setAbove(SensorEvidence::WOODS, extentOf(patches), *ground,
           "one surface over the ground, with what is scattered above it", report);
}

void lookFromAbove(PreparedCloud& cloud, const DensityPatches& patches, int threads,
                   SensorReport& report) {
  const HeightField field =
      measureHeightField(cloud.points(), cloud.index(), patches, cloud.points());
  if (field.sure()) {
    setAbove(SensorEvidence::LAYERS, extentOf(patches), field,
             "one uneven surface over the ground, as it is seen from above", report);
  } else {
    lookOverWoods(FlatPoints(cloud.points(), threads), patches, threads, report);
  }
}

}  // namespace segorient::detail
