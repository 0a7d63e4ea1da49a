// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/sensors/scene_frame.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

#include "common/dot.h"
#include "common/parallel_for.h"
#include "orientation/sensors/station_search.h"

namespace segorient::detail {
namespace {

using Axis = std::array<float, 3>;

// Cosine of 8 degrees: as far as normals err on scans, and sine.
constexpr float kAlong = 0.99F;
constexpr float kAcross = 0.14F;
// Cosine of 3 degrees: the laws hardly tell that from upright.
constexpr float kUpright = 0.9986F;
// Of directions at random one in a hundred is that near to a line.
constexpr float kMost = 0.1F;
constexpr float kSecond = 0.03F;
// Of the extent: floors and grounds are that flat.
constexpr float kFlat = 0.02F;
// A share of so many pieces is known to a fiftieth; and as many lines are tried.
constexpr std::size_t kPieces = 600;

Axis normalOf(const DensityPatches& patches, std::size_t i) {
  return {patches.nx[i], patches.ny[i], patches.nz[i]};
}

bool normalize(Axis& v) {
  const float length = std::sqrt(dot(v.data(), v.data()));
  if (!(length > 0.F)) return false;
  for (float& x : v) x /= length;
  return true;
}

Axis centerOf(const DensityPatches& patches, std::size_t i) {
  return {patches.x[i], patches.y[i], patches.z[i]};
}

// Pieces that face along the normal of one of them and lie in its plane.
std::size_t countInPlane(const DensityPatches& patches, std::size_t of, float thickness) {
  const Axis line = normalOf(patches, of);
  const Axis center = centerOf(patches, of);
  const float height = dot(center.data(), line.data());
  std::size_t count = 0;
  for (std::size_t i = 0; i < patches.size(); ++i) {
    if (!(std::fabs(dot(normalOf(patches, i).data(), line.data())) > kAlong)) continue;
    const Axis other = centerOf(patches, i);
    if (std::fabs(dot(other.data(), line.data()) - height) <= thickness) ++count;
  }
  return count;
}

Axis meanAlong(const DensityPatches& patches, const Axis& line) {
  Axis sum{0.F, 0.F, 0.F};
  for (std::size_t i = 0; i < patches.size(); ++i) {
    const Axis n = normalOf(patches, i);
    const float along = dot(n.data(), line.data());
    if (!(std::fabs(along) > kAlong)) continue;
    for (std::size_t a = 0; a < 3; ++a) sum[a] += along < 0.F ? -n[a] : n[a];
  }
  return normalize(sum) ? sum : line;
}

// The line that the largest plane faces, if that is large enough: facades on either side of a
// street are several, its ground is one. \param across only lines at right angles to this one, if
// there is one
std::optional<Axis> lineOfMost(const DensityPatches& patches, const Axis* across, float thickness,
                               float least) {
  constexpr int kRounds = 3;  // of a mean shift
  Axis best{};
  std::size_t most = 0;
  for (std::size_t i = 0; i < patches.size(); ++i) {
    const Axis line = normalOf(patches, i);
    if (across != nullptr && std::fabs(dot(line.data(), across->data())) > kAcross) continue;
    const std::size_t count = countInPlane(patches, i, thickness);
    if (count <= most) continue;
    most = count;
    best = line;
  }
  if (most == 0 || static_cast<float>(most) < least * static_cast<float>(patches.size())) {
    return std::nullopt;
  }
  for (int round = 0; round < kRounds; ++round) best = meanAlong(patches, best);
  return best;
}

Axis cross(const Axis& a, const Axis& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

// Any line across z, where nothing tells one: the coordinate axis farthest from it.
Axis axisAcross(const Axis& z) {
  Axis out{0.F, 0.F, 0.F};
  std::size_t least = 0;
  for (std::size_t a = 1; a < 3; ++a) {
    if (std::fabs(z[a]) < std::fabs(z[least])) least = a;
  }
  out[least] = 1.F;
  return out;
}

}  // namespace

SceneFrame::SceneFrame(const DensityPatches& patches) {
  const DensityPatches some = patches.thinned(kPieces);
  const float thickness = kFlat * static_cast<float>(extentOf(some).diagonal());
  std::optional<Axis> z = lineOfMost(some, nullptr, thickness, kMost);
  if (!z) return;
  // Of a cloud that leans, up stays up.
  const auto largest = std::max_element(
      z->begin(), z->end(), [](float a, float b) { return std::fabs(a) < std::fabs(b); });
  if (*largest < 0.F) {
    for (float& v : *z) v = -v;
  }
  const std::optional<Axis> second = lineOfMost(some, &*z, thickness, kSecond);
  Axis x = second.value_or(axisAcross(*z));
  const float along = dot(x.data(), z->data());
  for (std::size_t a = 0; a < 3; ++a) x[a] -= along * (*z)[a];
  if (!normalize(x)) return;
  const std::array<Axis, 3> axes{x, cross(*z, x), *z};
  const auto isUp = [](const Axis& axis) { return std::fabs(axis[2]) > kUpright; };
  if (isUp(*z) || (second && (isUp(axes[0]) || isUp(axes[1])))) return;
  axes_ = axes;
  is_own_ = false;
}

Axis SceneFrame::into(const Axis& v) const {
  if (is_own_) return v;
  return {dot(axes_[0].data(), v.data()), dot(axes_[1].data(), v.data()),
          dot(axes_[2].data(), v.data())};
}

Axis SceneFrame::back(const Axis& v) const {
  if (is_own_) return v;
  Axis out{0.F, 0.F, 0.F};
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t a = 0; a < 3; ++a) out[a] += v[k] * axes_[k][a];
  }
  return out;
}

DensityPatches SceneFrame::into(DensityPatches patches) const {
  for (std::size_t i = 0; i < patches.size() && !is_own_; ++i) {
    const Axis center = into(centerOf(patches, i));
    const Axis normal = into(normalOf(patches, i));
    patches.x[i] = center[0];
    patches.y[i] = center[1];
    patches.z[i] = center[2];
    patches.nx[i] = normal[0];
    patches.ny[i] = normal[1];
    patches.nz[i] = normal[2];
  }
  return patches;
}

std::vector<float> SceneFrame::into(const PointView& points, int threads) const {
  std::vector<float> out(3 * points.size);
  parallelFor(points.size, threads, 5.0, [&](std::size_t i) {
    const Axis p = into(Axis{points[i][0], points[i][1], points[i][2]});
    std::copy(p.begin(), p.end(), &out[3 * i]);
  });
  return out;
}

void SceneFrame::back(FoundSensor& sensor) const {
  sensor.position = back(sensor.position);
  sensor.axis = back(sensor.axis);
}

void SceneFrame::back(SensorReport& report) const {
  for (FoundSensor& s : report.sensors) back(s);
  for (std::size_t i = 0; i + 3 <= report.directions.size(); i += 3) {
    float* d = &report.directions[i];
    const Axis turned = back(Axis{d[0], d[1], d[2]});
    std::copy(turned.begin(), turned.end(), d);
  }
}

SceneFrame SceneFrame::rolled() const {
  SceneFrame out = *this;
  std::rotate(out.axes_.begin(), out.axes_.begin() + 1, out.axes_.end());
  return out;
}

}  // namespace segorient::detail
