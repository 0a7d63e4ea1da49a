// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "tiles/plan_sensors.h"

#include <algorithm>
#include <limits>
#include <memory>
#include <utility>

#include "orientation/sensors/known_sensors.h"
#include "orientation/sensors/place_choice.h"
#include "orientation/sensors/room_shadows.h"
#include "search/prepared_cloud.h"
#include "tiles/plan_probe.h"

namespace segorient::program {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

}  // namespace

PlanSensors::PlanSensors(const Plan& plan, const PointSample& sample, const PlacesSaid& said,
                         std::size_t image_width, int threads) {
  const std::optional<TileTree::Place> of_points = said.one();
  const bool columns = plan.has_viewpoints && !said.none();
  // Each point knows its own, or what is known is not a place.
  completes_given_ = columns && said.partly() && !plan.has_viewpoint;
  if ((columns && !of_points && !completes_given_) || !plan.trajectory.empty()) return;
  if (plan.keep_orientation || !plan.find_sensors || plan.closed) return;
  takeSample(plan, sample);
  const std::size_t size = points_.size() / 3;
  OrientationHints given = hintsOf(plan, plan.origin);
  if (plan.up) {
    if (heeds(given, threads)) return;
    given.has_direction = false;
    refuses_up_ = true;
  }
  if (columns && !completes_given_) {
    const std::array<float, 3> place = near(*of_points, plan.origin);
    for (std::size_t i = 0; i < size; ++i) {
      given.viewpoints.insert(given.viewpoints.end(), place.begin(), place.end());
    }
  }
  given.suggested = {near({0.0, 0.0, 0.0}, plan.origin)};
  if (by_row_ && image_width > 0) given.grids = {{0, image_width, size / image_width}};
  choose(given, threads);
  // Whoever names a side of a sheet means it; and a thinner cloud hides the sides of a plate.
  place_.faces_up = place_.faces_up && by_row_ && plan.seeds.empty();
  if (by_row_ || (sure_ == 0 && !place_.seen_within)) return;
  search::MedianHashIndex::Options search_options;
  search_options.threads = threads;
  index_.build({points_.data(), 3, size}, nullptr, search_options);
}

void PlanSensors::takeSample(const Plan& plan, const PointSample& sample) {
  by_row_ = plan.rows <= kSamplePoints;
  const std::size_t size = by_row_ ? static_cast<std::size_t>(plan.rows) : sample.places().size();
  points_.assign(3 * size, kNaN);
  for (std::size_t i = 0; i < sample.places().size(); ++i) {
    const std::size_t to = by_row_ ? static_cast<std::size_t>(sample.rows()[i]) : i;
    const std::array<float, 3> p = near(sample.places()[i], plan.origin);
    std::copy(p.begin(), p.end(), points_.begin() + static_cast<std::ptrdiff_t>(3 * to));
  }
}

// An even part of the sample.
std::vector<std::size_t> PlanSensors::somePoints() const {
  constexpr std::size_t kMost = 100000;
  const std::size_t size = points_.size() / 3;
  const std::size_t one_of = (size + kMost - 1) / kMost;
  std::vector<std::size_t> out;
  for (std::size_t i = 0; i < size; ++i) {
    if (PointSample::scatter(i) % one_of == 0) out.push_back(i);
  }
  return out;
}

// A part of the sample, oriented: enough to see how segments fit together, as they are few.
PipelineReport PlanSensors::orientSome(const OrientationHints& given, int threads) const {
  std::vector<float> part;
  for (const std::size_t i : somePoints()) {
    part.insert(part.end(), &points_[3 * i], &points_[3 * i] + 3);
  }
  PipelineOptions options;
  options.threads = threads;
  options.orientation.hints = std::make_shared<OrientationHints>(given);
  options.orientation.automatic.find_sensors = false;
  return orientCloud({part.data(), 3, part.size() / 3}, nullptr, options).report;
}

// Whether the surface does.
bool PlanSensors::heeds(const OrientationHints& given, int threads) const {
  const std::vector<KnownSensor> known = orientSome(given, threads).known_sensors;
  return known.empty() || known.front().used;
}

// Whether those that were found together see sheets from both sides, where what may have been seen
// from either side counts, too: tiles are not told that.
bool PlanSensors::seeBothSides(int threads) const {
  std::vector<float> part;
  OrientationHints hints;
  for (const std::size_t i : somePoints()) {
    part.insert(part.end(), &points_[3 * i], &points_[3 * i] + 3);
    const std::array<float, 3> sensor = placeOf(i);
    hints.viewpoints.insert(hints.viewpoints.end(), sensor.begin(), sensor.end());
  }
  PreparedCloud cloud({part.data(), 3, part.size() / 3}, nullptr, threads);
  PointHints known = resolveHints(hints, cloud);
  known.place.along_way = place_.along_way;
  return detail::seeBothSides(cloud, known, threads);
}

void PlanSensors::choose(const OrientationHints& given, int threads) {
  const PointView points{points_.data(), 3, points_.size() / 3};
  PreparedCloud cloud(points, nullptr, threads);
  detail::PlaceChoice choice = detail::choosePlaces(points, given, true, cloud, threads);
  if (!completes_given_) {
    place_ = choice.place;
    follows_given_ = !choice.hints;
    if (choice.hints) directions_ = std::move(choice.hints->normals);
    if (choice.if_no_room && detail::boundBodies(orientSome({}, threads).components)) {
      directions_.clear();
      place_ = *choice.if_no_room;
    }
  }
  report_ = std::move(choice.sensors);
  if (!report_.sure()) return;
  if (report_.sensors.size() > 1 && seeBothSides(threads)) {
    for (FoundSensor& s : report_.sensors) s.sure = false;
    place_ = {};
    return;
  }
  sure_ = static_cast<std::size_t>(std::count_if(report_.sensors.begin(), report_.sensors.end(),
                                                 [](const FoundSensor& s) { return s.sure; }));
}

// A point of the sample, or the nearest one.
std::size_t PlanSensors::sampleOf(std::uint64_t row, const std::array<float, 3>& place) const {
  if (by_row_) return static_cast<std::size_t>(row);
  pcl::index_t point = 0;
  float distance = 0.F;
  const bool any = index_.nearestK(place.data(), 1, &point, &distance) > 0;
  return any ? static_cast<std::size_t>(point) : 0;
}

std::array<float, 3> PlanSensors::directionOf(std::uint64_t row,
                                              const std::array<float, 3>& place) const {
  std::array<float, 3> out{};
  std::copy_n(&directions_[3 * sampleOf(row, place)], 3, out.begin());
  return out;
}

std::array<float, 3> PlanSensors::placeOf(std::size_t point) const {
  const std::int32_t sensor = report_.sensor_of[point];
  if (sensor < 0 || !report_.sensors[static_cast<std::size_t>(sensor)].sure) {
    return {kNaN, kNaN, kNaN};
  }
  return report_.sensors[static_cast<std::size_t>(sensor)].position;
}

std::array<float, 3> PlanSensors::of(std::uint64_t row, const std::array<float, 3>& place) const {
  const std::size_t point = sampleOf(row, place);
  const bool either_side = !report_.either_side.empty() && report_.either_side[point] != 0;
  return either_side ? std::array<float, 3>{kNaN, kNaN, kNaN} : placeOf(point);
}

}  // namespace segorient::program
