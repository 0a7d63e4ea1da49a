// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/sensors/point_hints.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/box.h"
#include "common/in_double.h"
#include "common/unit_vector.h"
#include "orientation/sensors/sensor_hints.h"
#include "search/index_of.h"

namespace segorient {
namespace {

using Vector = std::array<float, 3>;

// In the cloud's unit, where its extent is about 1: the square is still a number.
constexpr double kFar = 1e15;
// So far that all points see it in one direction, by .006 degrees, and still tell by distance who
// is before whom.
constexpr double kSeenAlongOneDirection = 1e4;

// In the unit of a PreparedCloud; what is farther than floats can square is brought nearer.
Vector scaled(const Vector& v, float unit) {
  double largest = 0.0;
  for (const float c : v) {
    largest = std::max(largest, std::fabs(static_cast<double>(c)) / static_cast<double>(unit));
  }
  const double factor = (largest > kFar ? kFar / largest : 1.0) / static_cast<double>(unit);
  Vector out{};
  for (std::size_t a = 0; a < 3; ++a)
    out[a] = static_cast<float>(factor * static_cast<double>(v[a]));
  return out;
}

void add(const Vector& v, float* out) {
  for (std::size_t a = 0; a < 3; ++a) out[a] += v[a];
}

std::size_t rowsOf(const std::vector<float>& values) {
  return values.size() / 3;
}

void addDirections(const OrientationHints& hints, const PreparedCloud& cloud,
                   std::vector<float>& directions) {
  if (hints.normals.empty()) return;
  directions.assign(3 * cloud.size(), 0.F);
  for (std::size_t row = 0; row < std::min(cloud.rows(), rowsOf(hints.normals)); ++row) {
    if (cloud.pointOf(row) < 0) continue;
    Vector unit_vector{};
    if (unitVector(inDouble(&hints.normals[3 * row]), unit_vector.data())) {
      add(unit_vector, &directions[3 * static_cast<std::size_t>(cloud.pointOf(row))]);
    }
  }
}

// What was seen along one direction was seen from so far away that no point tells the difference.
bool farPlace(const OrientationHints& hints, Vector& out) {
  if (!hints.has_direction || !unitVector(inDouble(hints.direction.data()), out.data()))
    return false;
  for (float& v : out) v *= static_cast<float>(kSeenAlongOneDirection);
  return true;
}

// Of rows that repeat a point, the place that comes first in order, whatever the order of the rows.
void addSensors(const OrientationHints& hints, const PreparedCloud& cloud,
                std::vector<float>& sensors, std::vector<std::int32_t>& scans) {
  Vector far{};
  const bool has_far = farPlace(hints, far);
  if (hints.viewpoints.empty() && !has_far) return;
  sensors.assign(3 * cloud.size(), std::numeric_limits<float>::quiet_NaN());
  if (!hints.scans.empty()) scans.assign(cloud.size(), -1);
  for (std::size_t row = 0; row < cloud.rows(); ++row) {
    if (cloud.pointOf(row) < 0) continue;
    Vector place = far;
    bool known = has_far;
    if (row < rowsOf(hints.viewpoints)) {
      const float* given = &hints.viewpoints[3 * row];
      const Vector own = scaled({given[0], given[1], given[2]}, cloud.unit());
      if (detail::saysPlace(own.data(),
                            cloud.points()[static_cast<std::size_t>(cloud.pointOf(row))])) {
        place = own;
        known = true;
      }
    }
    if (!known) continue;
    const auto point = static_cast<std::size_t>(cloud.pointOf(row));
    float* out = &sensors[3 * point];
    const std::int32_t scan = row < hints.scans.size() ? std::max(-1, hints.scans[row]) : -1;
    const bool same = std::equal(place.begin(), place.end(), out);
    if (same && !scans.empty()) scans[point] = std::min(scans[point], scan);
    if (same || (isFinite(out) &&
                 !std::lexicographical_compare(place.begin(), place.end(), out, out + 3))) {
      continue;
    }
    std::copy(place.begin(), place.end(), out);
    if (!scans.empty()) scans[point] = scan;
  }
  const auto known = [](float v) { return std::isfinite(v); };
  if (std::none_of(sensors.begin(), sensors.end(), known)) {
    sensors.clear();
    scans.clear();
  }
}

// A seed that is farther from the cloud than that is wide is in other coordinates.
void addSeeds(const OrientationHints& hints, PreparedCloud& cloud,
              std::vector<PointHints::Seed>& seeds) {
  if (hints.seeds.empty() || cloud.size() == 0) return;
  Box box;
  for (std::size_t i = 0; i < cloud.size(); ++i) box.add(cloud.points()[i]);
  for (const OrientationHints::Seed& given : hints.seeds) {
    PointHints::Seed seed;
    const Vector position = scaled(given.position, cloud.unit());
    if (!unitVector(inDouble(given.normal.data()), seed.normal.data()) ||
        !isFinite(position.data()) || !box.contains(position.data(), box.diagonal()))
      continue;
    const search::Nearest nearest(cloud.index(), position.data());
    if (nearest.point < 0) continue;
    seed.point = static_cast<std::size_t>(nearest.point);
    seeds.push_back(seed);
  }
}

}  // namespace

PointHints resolveHints(const OrientationHints& hints, PreparedCloud& cloud) {
  PointHints out;
  out.surface = hints.surface;
  out.viewpoint = scaled(hints.viewpoint, cloud.unit());
  out.has_viewpoint = hints.has_viewpoint && isFinite(out.viewpoint.data());
  if (!hints.suggested.empty()) out.suggested = scaled(hints.suggested.front(), cloud.unit());
  addDirections(hints, cloud, out.directions);
  addSensors(hints, cloud, out.sensors, out.scans);
  addSeeds(hints, cloud, out.seeds);
  return out;
}

}  // namespace segorient
