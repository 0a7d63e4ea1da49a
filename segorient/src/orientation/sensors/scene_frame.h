// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/point_view.h>
#include <segorient/orientation/sensors.h>

#include <array>
#include <vector>

#include "orientation/sensors/density_patches.h"

namespace segorient::detail {

/// The directions that most of a scene faces, floors and walls at right angles, as coordinate axes:
/// z is across the largest plane. Scanners stand upright on a floor, whatever coordinates the cloud
/// is in, and the laws and paths of sensors are tried about the coordinate axes.
class SceneFrame {
 public:
  SceneFrame() = default;  ///< the cloud's own axes
  /// The cloud's own axes also where its z is such a direction, or there are none.
  explicit SceneFrame(const DensityPatches& patches);

  bool isOwn() const { return is_own_; }  ///< nothing is turned
  /// From the cloud's coordinates into those of the frame, and back; the origin stays.
  std::array<float, 3> into(const std::array<float, 3>& v) const;
  std::array<float, 3> back(const std::array<float, 3>& v) const;
  DensityPatches into(DensityPatches patches) const;
  /// 3 floats a point.
  std::vector<float> into(const PointView& points, int threads) const;
  void back(FoundSensor& sensor) const;
  void back(SensorReport& report) const;  ///< its sensors and directions

  /// The next of the three directions as z.
  SceneFrame rolled() const;

 private:
  bool is_own_ = true;
  std::array<std::array<float, 3>, 3> axes_{{{1.F, 0.F, 0.F}, {0.F, 1.F, 0.F}, {0.F, 0.F, 1.F}}};
};

}  // namespace segorient::detail
