// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/sensors/joint_sensors.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "common/by_size.h"
#include "orientation/sensors/flat_points.h"
#include "orientation/sensors/from_above.h"
#include "orientation/sensors/moving_sensor.h"
#include "orientation/sensors/occupancy.h"
#include "orientation/sensors/places_of_points.h"
#include "orientation/sensors/seen_within.h"
#include "orientation/sensors/several_stations.h"
#include "orientation/sensors/shadows.h"
#include "orientation/sensors/station_search.h"
#include "search/index_of.h"

namespace segorient {

using detail::DensityPatches;
using detail::FramedPoints;
using detail::toFloat;

namespace {

// What may be left of the deviation. Several stations have more to adapt: true ones in rooms and
// yards left .03 to .28, or nothing but chance; wrong ones around single bodies .33 and more.
constexpr float kSureSeveral = 0.3F;
// So many stations, where they explain enough. Who goes through a building with a scanner has more,
// which can adapt to much: in five buildings 13 true ones left .11 to .17, false ones of bodies as
// vertices by rows .22 and more.
constexpr std::size_t kSome = 10;
constexpr std::size_t kMany = 20;
constexpr float kSureMany = 0.19F;
// What a scanner has below it, it sees all of, or from 60 or 45 degrees on: sines.
constexpr std::array<float, 3> kLowest{detail::kNoLowest, -0.866F, -0.707F};
// Along a line inside the scene, with free beams: true ones left .05 to .40 in sight, others .47
// and more but for vertices by rows, which shadows tell.
constexpr float kSureTrack = 0.43F;
// A line with free beams, over what several stations leave. Two stations lie on one, which left .73
// and more of 56 scans by two; that 72 beams adapt to 1500 pieces is a twentieth. Of 97 scans by
// three and more it left 1.17 and more, of 12 by lidars that stopped a few times, taken for
// stations elsewhere, .55 to .95.
constexpr float kLessThanTwo = 0.7F;
constexpr float kLessThanMore = 1.F;
// Stations whose axis lies level, as that of scanners that tilt, are sought where densities vary by
// so many times what chance makes of them, and only inside of the scene. The same is asked of them;
// of a real one in a hall, where the densities varied by 12 times, .35 was left.
constexpr float kVariesTilted = 4.F;
constexpr float kVariesMuch = 8.F;
constexpr float kSureWhereMuch = 0.4F;

constexpr std::array<double, 3> kUp{0.0, 0.0, 1.0};  // a direction, not a threshold

// What the pieces tell of each point.
void assignPlaces(const FramedPoints& cloud, const DensityPatches& patches,
                  const detail::PieceOrigins& origins, int threads, SensorReport& report) {
  std::vector<std::array<float, 3>> places;
  for (const FoundSensor& sensor : report.sensors) places.push_back(sensor.position);
  detail::PointPlaces found = detail::placesOfPoints(cloud, patches, origins, places, threads);
  report.sensor_of = std::move(found.place);
  report.either_side = std::move(found.either_side);
  for (const std::int32_t s : report.sensor_of) {
    if (s >= 0) ++report.sensors[static_cast<std::size_t>(s)].points;
  }
  // Those with most points first.
  const BySize by_size(report.sensors.size(),
                       [&](std::size_t s) { return report.sensors[s].points; });
  by_size.sort(report.sensors);
  by_size.renumber(report.sensor_of);
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

// Whether most of them are in a body. What a sensor on its way did not see from one of its places
// it saw from others: that surfaces go on behind others says nothing.
bool areInABody(const std::vector<std::array<double, 3>>& places, const DensityPatches& patches,
                const detail::FlatPoints& flat, int threads) {
  constexpr std::size_t kLooks = 8;  // at some of them: most of so many are most of all
  const bool has_walls = patches.haveWalls();
  const std::size_t looks = std::min(kLooks, places.size());
  std::size_t like = 0;
  for (std::size_t k = 0; k < looks; ++k) {
    const detail::Shadows seen = detail::findShadows(flat, detail::toFloat(places[k]), threads);
    like += seen.hideNothing(has_walls) ? 1 : 0;
  }
  return 2 * like > looks;
}

// Nobody knows the places, but the sides.
void lookWithin(const PointView& points, detail::FlatPointsOnce& flat, const DensityPatches& all,
                const detail::Extent& extent, const detail::Occupancy& occupancy, int threads,
                SensorReport& report) {
  constexpr std::size_t kPieces = 800;  // as many as there are places, since time is their product
  const DensityPatches patches = all.thinned(kPieces);
  const detail::SeenWithin seen = detail::seenWithin(patches, occupancy, extent, threads);
  if (seen.directions.empty()) return;
  if (areInABody(seen.places, patches, flat.get(), threads)) return;
  const std::vector<std::int32_t> piece =
      search::nearestOf(patches.index(threads), points, threads);
  report.directions.assign(3 * points.size, 0.F);
  for (std::size_t i = 0; i < piece.size(); ++i) {
    if (piece[i] < 0) continue;
    std::copy_n(&seen.directions[3 * static_cast<std::size_t>(piece[i])], 3,
                &report.directions[3 * i]);
  }
  report.why = "no places explain the densities, but it was seen from within";
}

// A scanner that looks ahead stands at the rim of what it sees.
bool areInside(const std::vector<std::array<double, 3>>& positions, const detail::Extent& extent) {
  const double margin = 0.05 * extent.diagonal();
  return std::all_of(positions.begin(), positions.end(),
                     [&](const std::array<double, 3>& p) { return extent.holds(p, margin); });
}

// What is seen from far away looks much alike from the other side: that several places outside of
// the ball that holds the scene explain densities does not tell the sides.
bool areOutside(const std::vector<std::array<double, 3>>& positions, const detail::Extent& extent) {
  return std::all_of(positions.begin(), positions.end(), [&](const std::array<double, 3>& p) {
    return detail::distance(p, extent.middle()) > 0.5 * extent.diagonal();
  });
}

bool isEnough(const detail::Stations& stations, const SensorReport& report) {
  return stations.cost <= std::max(kSureSeveral * report.deviation, report.chance);
}

// The first are those of scanners that see all that is below them. Nothing but a level floor tells
// from where on others do, and no more is tried where they explain enough.
std::optional<detail::Stations> searchUprightStations(const DensityPatches& patches,
                                                      const detail::Occupancy& occupancy,
                                                      const SensorReport& report, int threads) {
  std::optional<detail::Stations> best;
  for (const float lowest : kLowest) {
    const bool enough = best && isEnough(*best, report);
    if (lowest != detail::kNoLowest && (enough || !patches.haveWalls())) break;
    const detail::Place rays{{}, kUp, detail::SamplingLaw::ANGLE_GRID, lowest};
    const std::optional<detail::Stations> found =
        detail::searchStations(patches, occupancy, rays, kSome, threads);
    // What one station does not see nobody tells of.
    const bool tells = found && (lowest == detail::kNoLowest || found->positions.size() > 1);
    if (tells && (!best || found->cost < best->cost)) best = found;
  }
  return best;
}

// A wrong line runs through what it would have seen.
std::optional<detail::Track> trackInSight(const DensityPatches& patches,
                                          const detail::Extent& extent,
                                          const detail::Occupancy& occupancy,
                                          const SensorReport& report, int threads) {
  const float most = kSureTrack * report.deviation;
  const std::optional<detail::Track> found = detail::searchTrack(patches, extent, threads);
  if (!found || found->cost > most) return std::nullopt;
  detail::Track settled = detail::settleInSight(patches, extent, occupancy, *found);
  if (settled.cost > most) return std::nullopt;
  return settled;
}

void addTrack(const FramedPoints& cloud, const DensityPatches& patches,
              const detail::Occupancy& occupancy, const detail::Track& track, int threads,
              SensorReport& report) {
  addSensors(track.places, SensorKind::MOVING, kUp, track.cost / report.deviation, report);
  assignPlaces(cloud, patches, detail::originsOf(patches, occupancy, track), threads, report);
  report.why = "places along a line explain the densities";
}

void addStations(const FramedPoints& cloud, const DensityPatches& patches,
                 const detail::Occupancy& occupancy, const detail::Stations& stations, int threads,
                 SensorReport& report) {
  const float ratio = stations.cost / report.deviation;
  addSensors(stations.positions, SensorKind::STATION, stations.rays.axis, ratio, report);
  assignPlaces(cloud, patches, detail::originsOf(patches, occupancy, stations), threads, report);
  report.why = "several places explain the densities";
}

// Few places of a sensor on its way may pass for stations, elsewhere.
bool addStationsOrTrack(const FramedPoints& cloud, const DensityPatches& patches,
                        const detail::Extent& extent, const detail::Occupancy& occupancy,
                        int threads, SensorReport& report) {
  const std::optional<detail::Stations> stations =
      searchUprightStations(patches, occupancy, report, threads);
  if (!stations || !isEnough(*stations, report)) return false;
  if (areOutside(stations->positions, extent)) return false;
  // Where chance is all that is left, nothing else has to explain it.
  if (stations->cost > report.chance) {
    const bool are_two = stations->positions.size() <= 2;
    const std::optional<detail::Track> track =
        trackInSight(patches, extent, occupancy, report, threads);
    if (track && track->cost < (are_two ? kLessThanTwo : kLessThanMore) * stations->cost) {
      addTrack(cloud, patches, occupancy, *track, threads, report);
      return true;
    }
  }
  addStations(cloud, patches, occupancy, *stations, threads, report);
  return true;
}

// Where neither few of them nor a line explain enough.
bool addManyStations(const FramedPoints& cloud, const DensityPatches& patches,
                     const detail::Extent& extent, const detail::Occupancy& occupancy, int threads,
                     SensorReport& report) {
  const detail::Place rays{{}, kUp, detail::SamplingLaw::ANGLE_GRID};
  const std::optional<detail::Stations> stations =
      detail::searchStations(patches, occupancy, rays, kMany, threads);
  if (!stations || stations->cost > kSureMany * report.deviation) return false;
  if (areOutside(stations->positions, extent)) return false;
  addStations(cloud, patches, occupancy, *stations, threads, report);
  return true;
}

// A cloud in another frame.
struct TurnedScene {
  detail::SceneFrame frame;
  std::vector<float> rows;
  DensityPatches patches;
  detail::Extent extent;
  detail::Occupancy occupancy;

  TurnedScene(const detail::SceneFrame& into, const PointView& cloud, const DensityPatches& all,
              int threads)
      : frame(into),
        rows(into.into(cloud, threads)),
        patches(into.into(all)),
        extent(detail::extentOf(patches)),
        occupancy(points(), patches, extent) {}

  PointView points() const { return {rows.data(), 3, rows.size() / 3}; }
};

// Scanners that tilt turn about a level axis.
void lookForTilted(const FramedPoints& cloud, const DensityPatches& patches,
                   const detail::Extent& extent, const detail::Occupancy& occupancy, int threads,
                   SensorReport& report) {
  if (report.deviation < kVariesTilted * report.chance) return;
  std::optional<detail::Stations> best;
  for (std::size_t a = 0; a < 2; ++a) {
    std::array<double, 3> axis{0.0, 0.0, 0.0};
    axis[a] = 1.0;
    const std::optional<detail::Stations> found = detail::searchStations(
        patches, occupancy, {{}, axis, detail::SamplingLaw::ANGLE_GRID}, kSome, threads);
    if (found && (!best || found->cost < best->cost)) best = found;
  }
  if (!best) return;
  const float ratio = best->cost / report.deviation;
  const bool much = report.deviation >= kVariesMuch * report.chance;
  if (ratio > (much ? kSureWhereMuch : kSureSeveral)) return;
  if (!areInside(best->positions, extent)) return;
  addStations(cloud, patches, occupancy, *best, threads, report);
  report.why = "several places of scanners that tilt explain the densities";
}

}  // namespace

void detail::findSeveral(PreparedCloud& cloud, const DensityPatches& patches, bool has_axes,
                         FromAbove& above, int threads, SensorReport& report) {
  const detail::Extent extent = detail::extentOf(patches);
  const detail::Occupancy occupancy(cloud.points(), patches, extent);
  const FramedPoints framed{cloud.points(), cloud.points(), cloud.index()};
  if (addStationsOrTrack(framed, patches, extent, occupancy, threads, report)) return;
  const std::optional<detail::Track> track =
      trackInSight(patches, extent, occupancy, report, threads);
  if (!track && addManyStations(framed, patches, extent, occupancy, threads, report)) return;
  if (!track) above.look(report);
  // Tilting scanners that stand in a row look somewhat like a line.
  const bool is_clear = track && track->cost <= kSureSeveral * report.deviation;
  if (has_axes && report.sensors.empty() && !is_clear) {
    lookForTilted(framed, patches, extent, occupancy, threads, report);
  }
  if (track && report.sensors.empty()) {
    addTrack(framed, patches, occupancy, *track, threads, report);
  }
  if (report.sensors.empty()) {
    lookWithin(cloud.points(), above.flat(), patches, extent, occupancy, threads, report);
  }
}

void detail::findSeveralTurned(SceneFrame frame, PreparedCloud& cloud,
                               const DensityPatches& patches, int threads, SensorReport& report) {
  std::vector<TurnedScene> scenes;
  for (std::size_t up = 0; up < 3; ++up, frame = frame.rolled()) {
    scenes.emplace_back(frame, cloud.points(), patches, threads);
  }
  const auto framed = [&cloud](const TurnedScene& scene) {
    return FramedPoints{scene.points(), cloud.points(), cloud.index()};
  };
  const auto keepBetter = [&report](const TurnedScene& scene, SensorReport found) {
    scene.frame.back(found);
    const bool is_best =
        report.sensors.empty() || found.sensors[0].cost_ratio < report.sensors[0].cost_ratio;
    if (is_best) report = std::move(found);
  };
  const SensorReport nothing = report;
  for (const TurnedScene& scene : scenes) {
    SensorReport found = nothing;
    if (addStationsOrTrack(framed(scene), scene.patches, scene.extent, scene.occupancy, threads,
                           found)) {
      keepBetter(scene, std::move(found));
    }
  }
  if (!report.sensors.empty()) return;
  // A line has more to adapt, and is looked for only where no stations are.
  for (const TurnedScene& scene : scenes) {
    const std::optional<Track> track =
        trackInSight(scene.patches, scene.extent, scene.occupancy, report, threads);
    if (!track) continue;
    SensorReport found = nothing;
    addTrack(framed(scene), scene.patches, scene.occupancy, *track, threads, found);
    keepBetter(scene, std::move(found));
  }
  if (!report.sensors.empty()) return;
  const TurnedScene& upright = scenes.front();
  FlatPointsOnce flat(upright.points(), threads);
  lookWithin(upright.points(), flat, upright.patches, upright.extent, upright.occupancy, threads,
             report);
  upright.frame.back(report);
}

}  // namespace segorient
