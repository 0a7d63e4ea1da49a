// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "support/sensor_report.h"

#include <cstdio>

namespace segorient::program {

std::string describeSensor(const FoundSensor& sensor, const std::array<double, 3>& origin) {
  char text[200];
  std::snprintf(
      text, sizeof(text), "%s at (%.4g, %.4g, %.4g)%s for %zu points: %.0f %% of the %s, %s",
      toString(sensor.kind), origin[0] + static_cast<double>(sensor.position[0]),
      origin[1] + static_cast<double>(sensor.position[1]),
      origin[2] + static_cast<double>(sensor.position[2]),
      sensor.suggested ? ", as suggested," : "", sensor.points,
      100.0 * static_cast<double>(sensor.cost_ratio),
      sensor.evidence == SensorEvidence::SHADOWS ? "steps of depth go on behind" : "deviation left",
      sensor.sure ? "sure" : "not sure");
  return text;
}

void printNotFollowed(const std::vector<KnownSensor>& sensors, const std::array<double, 3>& origin,
                      int column) {
  for (const KnownSensor& s : sensors) {
    if (s.used) continue;
    const std::string scan = s.scan < 0 ? "" : " of scan " + std::to_string(s.scan);
    std::printf("%-*sthe sensor%s at (%g, %g, %g): its %zu points contradict it\n", column,
                "not followed", scan.c_str(), origin[0] + static_cast<double>(s.position[0]),
                origin[1] + static_cast<double>(s.position[1]),
                origin[2] + static_cast<double>(s.position[2]), s.points);
  }
}

void printSeedsLeftOut(std::size_t seeds, int column) {
  if (seeds == 0) return;
  std::printf("%-*s%zu seeds: farther from the cloud than it is wide, or without a normal\n",
              column, "not followed", seeds);
}

}  // namespace segorient::program
