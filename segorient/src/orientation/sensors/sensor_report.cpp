// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <segorient/orientation/sensors.h>

#include <algorithm>

namespace segorient {

const char* toString(SensorKind kind) {
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

const char* toString(SensorEvidence evidence) {
  switch (evidence) {
    case SensorEvidence::LAYERS:
      return "layers";
    case SensorEvidence::IMAGE:
      return "image";
    case SensorEvidence::SHADOWS:
      return "shadows";
    case SensorEvidence::DENSITY:
      break;
  }
  return "density";
}

bool SensorReport::sure() const {
  return std::any_of(sensors.begin(), sensors.end(), [](const FoundSensor& s) { return s.sure; });
}

}  // namespace segorient
