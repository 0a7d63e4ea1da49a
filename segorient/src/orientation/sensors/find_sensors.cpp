// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <segorient/common/threads.h>
#include <segorient/orientation/sensors.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "orientation/sensors/height_field.h"
#include "orientation/sensors/image_rays.h"
#include "orientation/sensors/moving_sensor.h"
#include "orientation/sensors/occupancy.h"
#include "orientation/sensors/sensor_search.h"
#include "orientation/sensors/several_stations.h"
#include "orientation/sensors/station_search.h"

namespace segorient {

using detail::DensityPatches;
using detail::FittedPlace;
using detail::SamplingLaw;

namespace {

// Deviations of log density that are hardly more than chance have nothing to explain.
constexpr float kMoreThanChance = 1.3F;
// What a law may leave of the constant's deviation. One place that is looked at because it was
// suggested: true ones left .04 to .57, wrong ones .81 and more. The best of all places: true ones
// .04 to .31, solids and sheets .99 and more, several stations around an object from .42 on.
constexpr float kSureSuggested = 0.6F;
constexpr float kSureFound = 0.33F;
// Several stations have more to adapt: true ones in rooms and yards left .03 to .28, wrong ones
// around single bodies .34 and more. Their density varies far beyond chance, too: by 3 times and
// more, that of merged range scans and of uneven samplings by 2.1 times at most.
constexpr float kSureSeveral = 0.3F;
// Along a line inside the scene, with free beams: true ones left .05 to .31, others .53 and more;
// outside the scene .35 came about, but no vehicle goes there.
constexpr float kSureTrack = 0.4F;
constexpr float kFarBeyondChance = 2.5F;
// A suggestion is kept unless a place beside it explains this much more.
constexpr float kMuchBetter = 0.6F;
// From farther away, in diagonals, distances hardly differ, and a law is one of incidence alone.
constexpr double kFarthest = 10.0;

std::array<float, 3> toFloat(const std::array<double, 3>& v) {
  return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
}

FoundSensor describe(const FittedPlace& fitted, float constant, bool suggested) {
  FoundSensor out;
  out.kind = fitted.place.law == SamplingLaw::PINHOLE ? SensorKind::CAMERA : SensorKind::STATION;
  out.position = toFloat(fitted.place.position);
  if (fitted.place.law != SamplingLaw::SOLID_ANGLE) out.axis = toFloat(fitted.place.axis);
  out.suggested = suggested;
  out.cost_ratio = fitted.cost / constant;
  out.sure = out.cost_ratio <= (suggested ? kSureSuggested : kSureFound);
  return out;
}

// For each point the place that left most of the density of the nearest piece.
void assignPlaces(PreparedCloud& cloud, const DensityPatches& patches,
                  const std::vector<std::int32_t>& place_of_piece, int threads,
                  SensorReport& report) {
  std::vector<float> centers;
  for (std::size_t i = 0; i < patches.size(); ++i) {
    centers.insert(centers.end(), {patches.x[i], patches.y[i], patches.z[i]});
  }
  search::MedianHashIndex index;
  search::MedianHashIndex::Options options;
  options.threads = threads;
  index.build({centers.data(), 3, patches.size()}, nullptr, options);
  const int team = resolveThreads(threads);
#pragma omp parallel for schedule(static) num_threads(team)
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    pcl::index_t nearest = 0;
    float distance = 0.F;
    if (index.nearestK(cloud.points()[i], 1, &nearest, &distance) < 1) continue;
    report.sensor_of[i] = place_of_piece[static_cast<std::size_t>(nearest)];
  }
  for (const std::int32_t s : report.sensor_of) {
    if (s >= 0) ++report.sensors[static_cast<std::size_t>(s)].points;
  }
  // Those with most points first.
  std::vector<std::size_t> order(report.sensors.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return report.sensors[a].points > report.sensors[b].points;
  });
  std::vector<FoundSensor> sorted;
  std::vector<std::int32_t> rank(order.size());
  for (std::size_t r = 0; r < order.size(); ++r) {
    sorted.push_back(report.sensors[order[r]]);
    rank[order[r]] = static_cast<std::int32_t>(r);
  }
  report.sensors = std::move(sorted);
  for (std::int32_t& s : report.sensor_of) {
    if (s >= 0) s = rank[static_cast<std::size_t>(s)];
  }
}

void addSensors(const std::vector<std::array<double, 3>>& positions, SensorKind kind,
                const std::array<double, 3>& axis, float ratio, SensorReport& report) {
  for (const std::array<double, 3>& position : positions) {
    FoundSensor sensor;
    sensor.kind = kind;
    sensor.position = toFloat(position);
    sensor.axis = toFloat(axis);
    sensor.cost_ratio = ratio;
    sensor.sure = true;
    report.sensors.push_back(sensor);
  }
}

void lookFromAbove(PreparedCloud& cloud, const DensityPatches& patches,
                   const detail::Extent& extent, SensorReport& report) {
  const detail::HeightField field = detail::measureHeightField(cloud, patches);
  if (!field.sure()) return;
  constexpr double kFarAbove = 100.0;  // extents: rays are parallel to half a degree
  FoundSensor sensor;
  sensor.kind = SensorKind::ABOVE;
  sensor.evidence = SensorEvidence::LAYERS;
  std::array<double, 3> position{};
  for (std::size_t a = 0; a < 3; ++a) position[a] = 0.5 * (extent.low[a] + extent.high[a]);
  position[2] += kFarAbove * extent.diagonal();
  sensor.position = toFloat(position);
  sensor.axis = {0.F, 0.F, 1.F};
  sensor.cost_ratio = field.layered;
  sensor.sure = true;
  sensor.points = cloud.size();
  report.sensors.push_back(sensor);
  report.sensor_of.assign(cloud.size(), 0);
  report.why = "one uneven surface over the ground, as it is seen from above";
}

// What several places explain together is put into the report, if they do.
void findSeveral(PreparedCloud& cloud, const DensityPatches& patches, int threads,
                 SensorReport& report) {
  constexpr std::array<double, 3> kUp{0.0, 0.0, 1.0};
  const detail::Extent extent = detail::extentOf(patches);
  const detail::Occupancy occupancy(cloud.points(), patches, extent);
  const detail::Stations stations = detail::searchStations(patches, occupancy, kUp, threads);
  const float ratio = stations.cost / report.deviation;
  if (!stations.positions.empty() && ratio <= kSureSeveral) {
    addSensors(stations.positions, SensorKind::STATION, kUp, ratio, report);
    assignPlaces(cloud, patches, detail::stationOf(patches, occupancy, stations), threads, report);
    report.why = "several places explain the densities";
    return;
  }
  const detail::Track track = detail::searchTrack(patches, extent, threads);
  const float left = track.cost / report.deviation;
  if (!track.inside || left > kSureTrack) {
    lookFromAbove(cloud, patches, extent, report);
    return;
  }
  addSensors(track.places, SensorKind::MOVING, kUp, left, report);
  assignPlaces(cloud, patches, detail::placeOf(patches, occupancy, track), threads, report);
  report.why = "places along a line explain the densities";
}

bool isNear(const std::array<double, 3>& position, const detail::Extent& extent) {
  const double reach = kFarthest * extent.diagonal();
  for (std::size_t a = 0; a < 3; ++a) {
    if (!(position[a] > extent.low[a] - reach && position[a] < extent.high[a] + reach))
      return false;
  }
  return true;
}

// The suggestion that fits best, if one does.
std::optional<FittedPlace> trySuggestions(const DensityPatches& patches, float constant,
                                          const SensorOptions& options) {
  const detail::Extent extent = detail::extentOf(patches);
  std::optional<FittedPlace> best;
  for (const std::array<float, 3>& s : options.suggestions) {
    const std::array<double, 3> position{static_cast<double>(s[0]), static_cast<double>(s[1]),
                                         static_cast<double>(s[2])};
    if (!isNear(position, extent)) continue;
    const FittedPlace fitted = detail::fitAt(patches, position);
    if (fitted.cost > kSureSuggested * constant) continue;
    if (!best || fitted.cost < best->cost) best = fitted;
  }
  return best;
}

FoundSensor findStation(const DensityPatches& patches, float constant,
                        const SensorOptions& options) {
  const std::optional<FittedPlace> suggested = trySuggestions(patches, constant, options);
  if (suggested) {
    constexpr double kStep = 0.02;
    constexpr int kEvaluations = 200;
    FittedPlace beside = *suggested;
    beside.cost = detail::refinePlace(patches, kStep * detail::extentOf(patches).diagonal(), true,
                                      kEvaluations, beside.place);
    if (beside.cost > kMuchBetter * suggested->cost) return describe(*suggested, constant, true);
  }
  if (!options.search) return {};
  const std::optional<FittedPlace> found =
      detail::searchStation(patches, constant, options.threads);
  return found ? describe(*found, constant, false) : FoundSensor{};
}

}  // namespace

const char* sensorKindName(SensorKind kind) {
  switch (kind) {
    case SensorKind::CAMERA:
      return "camera";
    case SensorKind::MOVING:
      return "moving";
    case SensorKind::ABOVE:
      return "above";
    case SensorKind::STATION:
      break;
  }
  return "station";
}

const char* sensorEvidenceName(SensorEvidence evidence) {
  switch (evidence) {
    case SensorEvidence::LAYERS:
      return "layers";
    case SensorEvidence::IMAGE:
      return "image";
    case SensorEvidence::DENSITY:
      break;
  }
  return "density";
}

bool SensorReport::sure() const {
  return std::any_of(sensors.begin(), sensors.end(), [](const FoundSensor& s) { return s.sure; });
}

namespace {

// By densities; in the unit of the cloud, sensor_of by its points.
SensorReport searchSensors(PreparedCloud& cloud, const SensorOptions& options) {
  SensorReport out;
  out.sensor_of.assign(cloud.size(), -1);
  const DensityPatches patches =
      detail::densityPatches(cloud.points(), cloud.index(), options.threads);
  if (patches.size() == 0) {
    out.why = "too few flat neighbourhoods to measure densities by";
    return out;
  }
  std::vector<float> densities = patches.log_density;
  out.deviation = detail::deviation(densities);
  out.chance = detail::chanceDeviation(patches.k);
  if (out.deviation < kMoreThanChance * out.chance) {
    out.why = "the density is even";
    return out;
  }
  FoundSensor sensor = findStation(patches, out.deviation, options);
  if (!sensor.sure) {
    out.why = "no places explain the densities";
    if (options.search && out.deviation >= kFarBeyondChance * out.chance) {
      findSeveral(cloud, patches, options.threads, out);
    }
    return out;
  }
  sensor.points = cloud.size();
  out.sensor_of.assign(cloud.size(), 0);
  out.why = sensor.suggested ? "the suggested place explains the densities"
                             : "one place explains the densities";
  out.sensors.push_back(sensor);
  return out;
}

}  // namespace

SensorReport detail::sensorsOf(const PointView& points, PreparedCloud& cloud,
                               const SensorOptions& options) {
  SensorReport out;
  std::optional<FoundSensor> camera;
  if (options.image_width > 0) camera = cameraOfImage(points, options.image_width);
  if (camera) {
    out.sensors.push_back(*camera);
    out.sensor_of.assign(cloud.size(), 0);
    out.why = "the rays of the image meet in one place";
  } else {
    SensorOptions scaled = options;
    for (std::array<float, 3>& s : scaled.suggestions) {
      for (float& v : s) v /= cloud.unit();
    }
    out = searchSensors(cloud, scaled);
    for (FoundSensor& s : out.sensors) {
      for (float& v : s.position) v *= cloud.unit();
    }
  }
  out.sensor_of = cloud.scatter(out.sensor_of, 1, std::int32_t{-1});
  for (FoundSensor& s : out.sensors) s.points = 0;
  for (const std::int32_t s : out.sensor_of) {
    if (s >= 0) ++out.sensors[static_cast<std::size_t>(s)].points;
  }
  return out;
}

SensorReport findSensors(const PointView& points, const SensorOptions& options) {
  PreparedCloud cloud(points, nullptr, options.threads);
  return detail::sensorsOf(points, cloud, options);
}

}  // namespace segorient
