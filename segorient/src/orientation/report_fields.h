// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/orientation/check_normals.h>
#include <segorient/orientation/orientation_result.h>
#include <segorient/orientation/pipeline.h>
#include <segorient/orientation/sensors.h>
#include <segorient/segmentation/segmentation.h>

#include <array>
#include <cstddef>
#include <vector>

namespace segorient::detail {

// The fields of what reports list, once for all that write them (segorient/doc/report.md). Each
// function calls `field(name, value)` in the report's order; values are numbers, bools and texts.
// `origin` is added to places.

using Origin = std::array<double, 3>;

template <typename Field>
void placeFields(const std::array<float, 3>& place, const Origin& origin, Field&& field) {
  field("x", origin[0] + static_cast<double>(place[0]));
  field("y", origin[1] + static_cast<double>(place[1]));
  field("z", origin[2] + static_cast<double>(place[2]));
}

inline const char* nameOf(SegmentKind kind) {
  static constexpr std::array<const char*, 3> kNames{"regular", "connected", "isolated"};
  return kNames[static_cast<std::size_t>(kind)];
}

/// A segment beside what became of it.
struct ReportedSegment {
  std::size_t label;
  const Segment& segment;
  const SegmentOrientationResult& result;
};

template <typename Field>
void fieldsOf(const ReportedSegment& s, const Origin&, Field&& field) {
  field("label", s.label);
  field("kind", nameOf(s.segment.kind));
  field("points", s.segment.size);
  field("component", s.result.component);
  field("sign", static_cast<int>(s.result.sign));
  field("oriented_by", toString(s.result.by));
  field("confidence", s.result.confidence);
  field("extremal_agreement", s.result.extremal_agreement);
  field("hard", s.result.hard);
}

template <typename Field>
void fieldsOf(const ComponentOrientationResult& c, const Origin&, Field&& field) {
  field("points", c.points);
  field("oriented_by", toString(c.by));
  field("sign", static_cast<int>(c.sign));
  field("evidence", c.evidence);
  field("votes", c.votes);
  field("confidence", c.confidence);
  field("contradiction", c.contradiction);
  field("winding", c.residual);
  field("against_known", c.against_known);
}

template <typename Field>
void fieldsOf(const ClusterOrientationResult& c, const Origin&, Field&& field) {
  field("points", c.points);
  field("component", c.component);
  field("confidence", c.confidence);
}

template <typename Field>
void fieldsOf(const ScaleEnergy& s, const Origin&, Field&& field) {
  field("radius_in_spacings", s.radius);
  field("outside", s.outside);
  field("facing", s.facing);
  field("backs", s.backs);
  field("energy", s.total);
  field("taken", s.taken);
}

/// A component of a scale's solution.
struct ReportedScaleComponent {
  const ScaleEnergy& scale;
  std::size_t number;
  const ComponentEnergy& energy;
};

inline std::vector<ReportedScaleComponent> componentsOf(const std::vector<ScaleEnergy>& scales) {
  std::vector<ReportedScaleComponent> out;
  for (const ScaleEnergy& scale : scales) {
    for (std::size_t c = 0; c < scale.components.size(); ++c) {
      out.push_back({scale, c, scale.components[c]});
    }
  }
  return out;
}

template <typename Field>
void fieldsOf(const ReportedScaleComponent& c, const Origin&, Field&& field) {
  field("radius_in_spacings", c.scale.radius);
  field("component", c.number);
  field("points", c.energy.points);
  field("borders", c.energy.borders);
  field("winding", c.energy.winding);
  field("known", c.energy.known);
  field("taken", c.scale.taken);
}

template <typename Field>
void fieldsOf(const Contradiction& c, const Origin& origin, Field&& field) {
  placeFields(c.where, origin, field);
  field("weight", c.weight);
}

template <typename Field>
void fieldsOf(const KnownSensor& s, const Origin& origin, Field&& field) {
  placeFields(s.position, origin, field);
  field("points", s.points);
  field("seen", s.seen);
  field("used", s.used);
  field("moving", s.moving);
  field("scan", s.scan);
  field("confirmed", s.confirmed);
  field("hidden", s.hidden);
  field("contrary", s.contrary);
  field("density", s.density);
}

template <typename Field>
void fieldsOf(const FoundSensor& s, const Origin& origin, Field&& field) {
  field("kind", toString(s.kind));
  field("evidence", toString(s.evidence));
  placeFields(s.position, origin, field);
  field("axis_x", s.axis[0]);
  field("axis_y", s.axis[1]);
  field("axis_z", s.axis[2]);
  field("points", s.points);
  field("cost_ratio", s.cost_ratio);
  field("suggested", s.suggested);
  field("sure", s.sure);
}

template <typename Field>
void fieldsOf(const FaultyPlace& p, const Origin& origin, Field&& field) {
  field("contradicts", toString(p.fault));
  field("points", p.points);
  placeFields(p.center, origin, field);
  field("size", p.size);
  field("confidence", p.confidence);
  field("scan", p.scan);
}

template <typename Field>
void fieldsOf(const ScanCheck& s, const Origin&, Field&& field) {
  field("scan", s.scan);
  field("judged", s.judged);
  field("against_sensor", s.against_sensor);
}

}  // namespace segorient::detail
