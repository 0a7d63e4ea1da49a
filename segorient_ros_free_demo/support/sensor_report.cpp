// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "support/sensor_report.h"

#include <cstdio>

namespace segorient::program {

std::string describeSensor(const FoundSensor& sensor, const std::array<double, 3>& origin) {
  char text[200];
  std::snprintf(text, sizeof(text),
                "%s at (%.4g, %.4g, %.4g)%s for %zu points: %.0f %% of the deviation left, %s",
                toString(sensor.kind), origin[0] + static_cast<double>(sensor.position[0]),
                origin[1] + static_cast<double>(sensor.position[1]),
                origin[2] + static_cast<double>(sensor.position[2]),
                sensor.suggested ? ", as suggested," : "", sensor.points,
                100.0 * static_cast<double>(sensor.cost_ratio), sensor.sure ? "sure" : "not sure");
  return text;
}

void addTo(JsonWriter& json, const SensorReport& report, const std::array<double, 3>& origin) {
  json.beginArray("sensors");
  for (const FoundSensor& s : report.sensors) {
    json.beginItem();
    json.field("kind", toString(s.kind));
    json.field("evidence", toString(s.evidence));
    json.field("x", origin[0] + static_cast<double>(s.position[0]));
    json.field("y", origin[1] + static_cast<double>(s.position[1]));
    json.field("z", origin[2] + static_cast<double>(s.position[2]));
    json.field("axis_x", s.axis[0]);
    json.field("axis_y", s.axis[1]);
    json.field("axis_z", s.axis[2]);
    json.field("points", s.points);
    json.field("cost_ratio", s.cost_ratio);
    json.field("suggested", s.suggested);
    json.field("sure", s.sure);
    json.endObject();
  }
  json.endArray();
}

}  // namespace segorient::program
