// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "render/cloud_page.h"

#include <cmath>

#include "render/palette.h"
#include "render/splats.h"
#include "support/colors.h"

namespace segorient::program {
namespace {

PageSegment pageSegment(const SegmentFact& fact) {
  PageSegment out;
  out.confidence = fact.confidence;
  out.text = fact.kind;
  if (!fact.oriented_by.empty()) out.text += ", oriented by " + fact.oriented_by;
  if (!fact.component_by.empty()) out.text += ", its whole part by " + fact.component_by;
  if (fact.hard) out.text += ", hard";
  return out;
}

void addLabels(const CloudTable& table, PageCloud& cloud) {
  const Field* field = table.find("label");
  if (field == nullptr) return;
  cloud.labels.resize(table.size);
  for (std::size_t i = 0; i < table.size; ++i) cloud.labels[i] = labelOf(table, field, i);
}

void addColors(const CloudTable& table, PageCloud& cloud) {
  const Field* field = table.find("rgb");
  if (field == nullptr) return;
  bool own = cloud.labels.empty();
  cloud.colors.resize(table.size);
  for (std::size_t i = 0; i < table.size; ++i) {
    cloud.colors[i] = packedColor(table, *field, i);
    own = own || cloud.colors[i] != segmentColor(cloud.labels[i]);
  }
  if (!own) cloud.colors.clear();
}

}  // namespace

PageCloud pageCloud(const CloudTable& table, const LocalPoints& points, const Facts& facts,
                    const std::string& title) {
  PageCloud cloud;
  cloud.title = title;
  cloud.points = points.view();
  cloud.origin = points.origin();
  if (table.hasNormals()) {
    const NormalSource normals(table, nullptr);
    const PointSensors sensors(table, facts);
    cloud.normals.reserve(3 * table.size);
    for (std::size_t i = 0; i < table.size; ++i) {
      const auto n = normals.at(i);
      cloud.normals.insert(cloud.normals.end(), n.begin(), n.end());
      if (sensors.any()) cloud.sides.push_back(sensors.side(i, n, Side::Open));
    }
  }
  addLabels(table, cloud);
  addColors(table, cloud);
  if (const Field* field = scanField(table)) {
    cloud.scans.resize(table.size);
    for (std::size_t i = 0; i < table.size; ++i) cloud.scans[i] = labelOf(table, field, i);
  }
  if (const Field* field = table.find("confidence")) {
    cloud.confidences.resize(table.size);
    for (std::size_t i = 0; i < table.size; ++i) {
      cloud.confidences[i] = static_cast<float>(table.value(*field, i));
    }
  }
  for (const SegmentFact& fact : facts.segments) cloud.segments.push_back(pageSegment(fact));
  cloud.sensors = facts.sensors;
  cloud.contradictions = facts.contradictions;
  return cloud;
}

}  // namespace segorient::program
