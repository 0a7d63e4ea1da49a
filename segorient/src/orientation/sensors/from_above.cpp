// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/sensors/from_above.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include "common/in_double.h"
#include "orientation/sensors/found_sensor.h"
#include "orientation/sensors/station_search.h"
#include "search/index_of.h"

namespace segorient::detail {
namespace {

// Of all points: what is scattered in a scan of something solid are edges, and noise.
constexpr float kManyScattered = 0.1F;
// The rest are stray points below the ground, and steep ground.
constexpr float kNearlyAll = 0.9F;

// The ground's surface, if that is what is on surfaces, and the rest is above.
std::optional<HeightField> groundUnderWoods(const FlatPoints& flat, int threads) {
  const std::size_t n = flat.size();
  const std::size_t on_surfaces = flat.onSurfaces().size();
  const auto scattered = static_cast<float>(n - on_surfaces);
  if (on_surfaces == 0 || scattered < kManyScattered * static_cast<float>(n)) return {};
  std::vector<float> on;
  std::vector<float> off;
  for (std::size_t i = 0; i < n; ++i) {
    std::vector<float>& rows = flat.isOnSurface(i) ? on : off;
    rows.insert(rows.end(), flat.view()[i], flat.view()[i] + 3);
  }
  const PointView ground{on.data(), 3, on_surfaces};
  const search::MedianHashIndex index = search::indexOf(ground, threads);
  const DensityPatches patches = densityPatches(ground, index, threads);
  const HeightField field = measureHeightField(ground, index, patches, flat.view());
  if (!field.sure()) return {};
  // As far from the ground as noise does not reach.
  const float side = kColumn * patches.spacing;
  const std::vector<float> heights = heightsOver(ground, {off.data(), 3, n - on_surfaces}, side);
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
  setOnly(sensor, why, report);
}

}  // namespace

const HeightField& FromAbove::field() {
  if (!field_) {
    field_ = measureHeightField(cloud_.points(), cloud_.index(), patches_, cloud_.points());
  }
  return *field_;
}

void FromAbove::lookOverWoods(SensorReport& report) {
  if (!asked_for_woods_) under_woods_ = groundUnderWoods(flat_.get(), threads_);
  asked_for_woods_ = true;
  if (!under_woods_) return;
  setAbove(SensorEvidence::WOODS, extentOf(patches_), *under_woods_,
           "one surface over the ground, with what is scattered above it", report);
}

void FromAbove::look(SensorReport& report) {
  if (field().sure()) {
    setAbove(SensorEvidence::LAYERS, extentOf(patches_), field(),
             "one uneven surface over the ground, as it is seen from above", report);
  } else {
    lookOverWoods(report);
  }
}

}  // namespace segorient::detail
