// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/automatic/sheet_signs.h"

#include <algorithm>
#include <utility>

#include "common/by_size.h"
#include "common/parallel_for.h"
#include "orientation/automatic/loose_parts.h"

namespace segorient::detail {

SheetSigns::SheetSigns(const PointView& all, const Neighborhoods& neighborhoods,
                       const SheetField& sheet_field, const Segmentation& segments,
                       std::vector<BorderVote> border_votes, std::size_t count,
                       const AutomaticOptions& settings, const PointHints& known, int most_threads)
    : points(all),
      cloud_points(count),
      field(sheet_field),
      segmentation(segments),
      options(settings),
      hints(known),
      threads(most_threads),
      hint_votes(hintVotes(all, sheet_field, segments, known)),
      sensors(findKnownSensors(all, neighborhoods, sheet_field.spacing, known, most_threads)),
      votes(std::move(border_votes)),
      clusters(segments, votes, settings.contract_certain, count) {
  numberComponents();
}

void SheetSigns::numberComponents() {
  const std::size_t n = clusters.size();
  std::vector<std::uint32_t> size(n, 0);
  std::vector<bool> is_root(n, false);
  signs.resize(n);
  for (std::size_t s = 0; s < n; ++s) {
    const std::size_t root = at(clusters.root(clusters.of(s)));
    is_root[root] = true;
    size[root] += segmentation.segments[s].size;
    signs[s] = clusters.sign(s);
  }
  // Segments without points are components of their own, too.
  std::vector<std::int32_t> roots;
  for (std::size_t s = 0; s < n; ++s) {
    if (is_root[s]) roots.push_back(static_cast<std::int32_t>(s));
  }
  const BySize by_size(roots.size(), [&](std::size_t c) { return size[at(roots[c])]; });
  by_size.sort(roots);
  std::vector<std::int32_t> number(n, -1);
  for (const std::int32_t root : roots) {
    number[at(root)] = static_cast<std::int32_t>(found.result.components.size());
    found.result.components.emplace_back().points = size[at(root)];
  }
  for (std::size_t s = 0; s < n; ++s) {
    component_of.push_back(number[at(clusters.root(clusters.of(s)))]);
  }
  windings.assign(roots.size(), ComponentWinding{});
  ground.assign(roots.size(), false);
}

std::vector<std::size_t> SheetSigns::componentSizes() const {
  std::vector<std::size_t> out(windings.size(), 0);
  for (std::size_t i = 0; i < points.size; ++i) {
    if (componentOf(i) >= 0) ++out[at(componentOf(i))];
  }
  return out;
}

std::vector<std::int32_t> SheetSigns::componentsOfClusters() const {
  std::vector<std::int32_t> out(clusters.size(), -1);
  for (std::size_t s = 0; s < out.size(); ++s) out[at(clusters.of(s))] = component_of[s];
  return out;
}

FastVector<float> SheetSigns::dipoles() const {
  FastVector<float> out(4 * points.size);
  // The mean distance to the 6 nearest of points of density 1/a is 0.977 sqrt(a). Noise of r
  // spacings takes two points sqrt(2) r apart across the surface, which adds about 2 r^2 to the
  // square.
  const float r = field.residual;
  const float per_square = 1.047F / (1.F + 2.F * r * r);
  parallelFor(points.size, threads, 10.0, [&](std::size_t i) {
    float* dipole = &out[4 * i];
    const float sign = pointSign(i);
    if (sign == 0.F) {
      std::fill_n(dipole, 4, 0.F);
      return;
    }
    const float h = field.spacing[i];
    const float area = per_square * h * h;
    for (std::size_t a = 0; a < 3; ++a) dipole[a] = sign * area * field.normals[4 * i + a];
    dipole[3] = area;
  });
  return out;
}

std::vector<std::int32_t> SheetSigns::ofPoints(const std::vector<std::int32_t>& of_segments) const {
  std::vector<std::int32_t> out(points.size, -1);
  for (std::size_t i = 0; i < points.size; ++i) {
    if (segmentation.labels[i] >= 0) out[i] = of_segments[at(segmentation.labels[i])];
  }
  return out;
}

void SheetSigns::windComponents() {
  windings = solveComponents(points, dipoles().data(), field.spacing, ofPoints(component_of),
                             windings.size(), threads);
}

bool SheetSigns::isClosed(std::size_t component, float residual) const {
  if (hints.surface != SurfaceKind::UNKNOWN) return hints.surface == SurfaceKind::CLOSED;
  return !ground[component] && windings[component].residual <= residual;
}

float SheetSigns::closedResidual() const {
  return std::min(kOpenResidual, kClosedResidual + kResidualOfNoise * field.residual);
}

std::vector<bool> SheetSigns::outvoted(const std::vector<Ballot>& ballots,
                                       float sure_borders) const {
  const std::vector<float> agreement = agreementOf(clusters.of(), votes, signs, 0.F);
  std::vector<bool> out(clusters.size());
  for (std::size_t c = 0; c < out.size(); ++c) {
    out[c] = agreement[c] <= sure_borders && ballots[c].share() < -kClearly;
  }
  return out;
}

void SheetSigns::turnClusters(const std::vector<bool>& chosen) {
  for (std::size_t s = 0; s < signs.size(); ++s) {
    if (chosen[at(clusters.of(s))]) signs[s] = static_cast<std::int8_t>(-signs[s]);
  }
}

}  // namespace segorient::detail
