// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/paper/outward_components.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "common/at.h"
#include "common/box.h"
#include "common/by_size.h"
#include "common/directions.h"
#include "orientation/winding/winding_number.h"

namespace segorient {
namespace {

using Rows = std::vector<pcl::index_t>;

std::vector<Rows> rowsByComponent(const OrientationResult& result) {
  std::vector<Rows> rows(result.components.size());
  for (std::size_t i = 0; i < result.point_components.size(); ++i) {
    const std::int32_t component = result.point_components[i];
    if (component >= 0) rows[at(component)].push_back(static_cast<pcl::index_t>(i));
  }
  return rows;
}

Box boxAround(const PointView& points, const Rows& rows) {
  Box box;
  for (const pcl::index_t row : rows) box.add(points[static_cast<std::size_t>(row)]);
  return box;
}

// At most `count` of the rows, evenly spread over them (and so over space, as rows are in Z-order).
Rows sample(const Rows& rows, std::size_t count) {
  if (rows.size() <= count) return rows;
  Rows out(count);
  for (std::size_t i = 0; i < count; ++i) out[i] = rows[i * rows.size() / count];
  return out;
}

// Turns a component by the votes of its extremal points.
void turnOutward(const std::vector<ExtremalPoint>& extremal, float gamma,
                 const std::vector<std::int8_t>& signs, ComponentOrientationResult& component) {
  float balance = 0.F;
  float total = 0.F;
  for (const ExtremalPoint& found : extremal) {
    if (!(found.angle < gamma)) continue;
    const int sign = found.sign * signs[static_cast<std::size_t>(found.point)];
    balance += static_cast<float>(sign) * std::cos(found.angle);
    total += std::cos(found.angle);
  }
  component.evidence = total > 0.F ? balance / total : 0.F;
  component.votes = total;
  component.confidence = std::abs(component.evidence);
  component.by = total > 0.F ? DecidedBy::EXTREMAL : DecidedBy::NOTHING;
  component.sign = balance < 0.F ? std::int8_t{-1} : std::int8_t{1};
}

// What an oriented point stands for, as a dipole: its neighbours' disc, shared among them.
void setDipole(const PointView& points, const PointView& normals,
               const Neighborhoods& neighborhoods, std::size_t row, float weight, float* dipole) {
  const int count = neighborhoods.count(row);
  float squared = 0.F;
  if (count >= 2) {
    const float* p = points[row];
    const float* q = points[static_cast<std::size_t>(neighborhoods.indices(row)[count - 1])];
    for (std::size_t a = 0; a < 3; ++a) squared += (q[a] - p[a]) * (q[a] - p[a]);
  }
  dipole[3] =
      std::abs(weight) * static_cast<float>(kPi) * squared / (static_cast<float>(count) - 0.5F);
  const float signed_area = weight < 0.F ? -dipole[3] : dipole[3];
  for (std::size_t a = 0; a < 3; ++a) dipole[a] = signed_area * normals[row][a];
}

// Whether larger components enclose others is asked for the largest ones only: for crumbs it
// neither matters nor can be told.
constexpr std::size_t kMostNested = 64;
constexpr std::size_t kProbes = 24;  // points of the inner component
// points of the outer one: 1 / 64 of the radius apart on a sphere
constexpr std::size_t kSources = 4096;

// Components by how many others' boxes contain theirs: outer ones first.
std::vector<std::size_t> outerFirst(const std::vector<Box>& boxes) {
  std::vector<std::ptrdiff_t> depth;
  depth.reserve(boxes.size());
  for (const Box& own : boxes) {
    depth.push_back(std::count_if(boxes.begin(), boxes.end(),
                                  [&](const Box& other) { return other.encloses(own); }));
  }
  return BySize(boxes.size(), [&](std::size_t b) { return -depth[b]; }).order();
}

// How often a turned component winds around the points of another: 1 in a closed body, 0 outside,
// -1 in a hollow one's cavity by its own wall.
class Enclosure {
 public:
  Enclosure(const PointView& points, const PointView& normals, const Neighborhoods& neighborhoods,
            const OrientationResult& result)
      : points_(points), normals_(normals), neighborhoods_(neighborhoods), result_(result) {}

  float around(const Rows& probes, const Rows& outer, int outer_sign) const {
    const Rows chosen = sample(outer, kSources);
    const float share = static_cast<float>(outer.size()) / static_cast<float>(chosen.size()) *
                        static_cast<float>(outer_sign);
    std::vector<float> places;
    std::vector<float> dipoles(4 * chosen.size());
    for (std::size_t i = 0; i < chosen.size(); ++i) {
      const auto row = static_cast<std::size_t>(chosen[i]);
      places.insert(places.end(), points_[row], points_[row] + 3);
      setDipole(points_, normals_, neighborhoods_, row,
                share * static_cast<float>(result_.point_signs[row]), &dipoles[4 * i]);
    }
    const PointView sources{places.data(), 3, chosen.size()};
    WindingNumber field;
    field.build(sources, dipoles.data(), {});
    float sum = 0.F;
    // The probes are points of another component, and none of these.
    for (const pcl::index_t probe : probes) {
      sum += field.evaluate(points_[static_cast<std::size_t>(probe)], 0.F);
    }
    return sum / static_cast<float>(probes.size());
  }

 private:
  const PointView& points_;
  const PointView& normals_;
  const Neighborhoods& neighborhoods_;
  const OrientationResult& result_;
};

void turnCavities(const PointView& points, const Enclosure& enclosure,
                  const std::vector<Rows>& rows,
                  std::vector<ComponentOrientationResult>& components) {
  const std::size_t count = std::min(kMostNested, components.size());
  std::vector<Box> boxes;
  for (std::size_t c = 0; c < count; ++c) boxes.push_back(boxAround(points, rows[c]));
  const std::vector<std::size_t> order = outerFirst(boxes);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t inner = order[i];
    const Rows probes = sample(rows[inner], kProbes);
    float filled = 0.F;
    bool enclosed = false;
    for (std::size_t j = 0; j < i; ++j) {
      const std::size_t outer = order[j];
      if (!boxes[outer].encloses(boxes[inner])) continue;
      enclosed = true;
      filled += enclosure.around(probes, rows[outer], components[outer].sign);
    }
    if (!enclosed) continue;
    ComponentOrientationResult& component = components[inner];
    if (filled > 0.5F) component.sign = static_cast<std::int8_t>(-component.sign);
    const float doubt = std::min(1.F, 2.F * std::abs(filled - (filled > 0.5F ? 1.F : 0.F)));
    component.by = DecidedBy::ENCLOSURE;
    component.confidence *= 1.F - doubt;
  }
}

}  // namespace

void sortComponents(OrientationResult& result) {
  std::vector<ComponentOrientationResult>& components = result.components;
  for (ComponentOrientationResult& component : components) component.points = 0;
  for (const std::int32_t c : result.point_components) {
    if (c >= 0) ++components[at(c)].points;
  }
  const BySize by_size(components.size(), [&](std::size_t c) { return components[c].points; });
  by_size.sort(components);
  by_size.renumber(result.point_components);
  for (SegmentOrientationResult& segment : result.segments) {
    segment.component = by_size(segment.component);
  }
}

void orientComponents(const PointView& points, const PointView& normals,
                      const Neighborhoods& neighborhoods, const OrientationOptions& options,
                      OrientationResult& result, const std::vector<ExtremalPoint>& of_all) {
  sortComponents(result);
  const std::vector<Rows> rows = rowsByComponent(result);
  const bool known = rows.size() == 1 && !of_all.empty();
  for (std::size_t c = 0; c < rows.size(); ++c) {
    turnOutward(known ? of_all
                      : findExtremalPoints(points, normals, rows[c], options.max_box_points,
                                           options.threads),
                options.gamma, result.point_signs, result.components[c]);
  }
  turnCavities(points, Enclosure(points, normals, neighborhoods, result), rows, result.components);

  for (std::size_t i = 0; i < result.point_signs.size(); ++i) {
    const std::int32_t c = result.point_components[i];
    if (c < 0) continue;
    result.point_signs[i] =
        static_cast<std::int8_t>(result.point_signs[i] * result.components[at(c)].sign);
  }
  for (SegmentOrientationResult& segment : result.segments) {
    if (segment.component < 0) continue;
    const std::int8_t sign = result.components[at(segment.component)].sign;
    segment.sign = static_cast<std::int8_t>(segment.sign * sign);
    segment.extremal_agreement *= sign;
  }
}

}  // namespace segorient
