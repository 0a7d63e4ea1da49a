// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/sensors/found_sensor.h"

#include <algorithm>

namespace segorient::detail {

void setOnly(const FoundSensor& sensor, const char* why, SensorReport& out) {
  out.sensors = {sensor};
  std::fill(out.sensor_of.begin(), out.sensor_of.end(), 0);
  out.why = why;
}

bool isOverGround(const SensorReport& report) {
  return report.sure() && (report.sensors[0].evidence == SensorEvidence::LAYERS ||
                           report.sensors[0].evidence == SensorEvidence::WOODS);
}

}  // namespace segorient::detail
