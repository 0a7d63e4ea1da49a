// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "orientation/automatic/component_links.h"
#include "orientation/automatic/ground_sides.h"
#include "orientation/automatic/loose_parts.h"
#include "orientation/automatic/sheet_stages.h"
#include "orientation/automatic/suggested_view.h"

namespace segorient::detail {
namespace {

// The hint that decides a component, if any: three votes of four at least.
const Ballot* decisive(const HintVotes& hints, bool open) {
  constexpr float kMost = 0.5F;  // .75 for less .25 against
  for (const Ballot* ballot : {&hints.seeds, &hints.directions}) {
    if (ballot->total > 0.F && std::fabs(ballot->share()) >= kMost) return ballot;
  }
  return open && hints.view.balance != 0.F ? &hints.view : nullptr;
}

// \return whether a part was turned over
bool turnLooseParts(SheetSigns& sheets, const std::vector<std::int32_t>& part_of,
                    const std::vector<bool>& looked_at, const TurnRule& rule) {
  const LooseParts loose = findLooseParts(sheets.segmentation, sheets.votes, sheets.signs,
                                          sheets.component_of, part_of, looked_at);
  if (loose.none()) return false;
  FastVector<float> dipoles = sheets.dipoles();
  for (std::size_t i = 0; i < sheets.points.size; ++i) {
    const std::int32_t c = sheets.componentOf(i);
    const auto sign = static_cast<float>(c < 0 ? 1 : sheets.windings[at(c)].sign);
    for (std::size_t a = 0; a < 3; ++a) dipoles[4 * i + a] *= sign;
  }
  const std::vector<std::int8_t> turn =
      turnParts(sheets.points, dipoles.data(), sheets.field.spacing, sheets.ofPoints(loose.of),
                loose.count, loose.components, rule, sheets.threads);
  for (std::size_t s = 0; s < sheets.signs.size(); ++s) {
    sheets.signs[s] = static_cast<std::int8_t>(sheets.signs[s] * turn[at(loose.of[s])]);
  }
  return std::find(turn.begin(), turn.end(), std::int8_t{-1}) != turn.end();
}

// Clusters first. Where the winding number is that of a clean closed surface nearly everywhere, it
// is to be trusted with single segments, too; noise would mislead it. Of clusters that had to be
// turned, the sum fell by .42 and more, of others in noise and thin walls by .24 at most; where
// less is gained, the part's own points have to tell, see TurnRule.
void turnLooseParts(SheetSigns& sheets) {
  std::vector<std::int32_t> part_of = sheets.clusters.of();
  const std::vector<bool> all(sheets.windings.size(), true);
  if (turnLooseParts(sheets, part_of, all, {})) sheets.windComponents();
  std::vector<bool> clean(sheets.windings.size());
  for (std::size_t c = 0; c < clean.size(); ++c) {
    clean[c] = sheets.windings[c].residual <= kClosedResidual;
  }
  std::iota(part_of.begin(), part_of.end(), 0);
  if (turnLooseParts(sheets, part_of, clean, {0.1, kClosedResidual})) sheets.windComponents();
}

// Ground, or what is seen from above: a third of the columns more have one layer that faces up than
// have one that faces down.
constexpr float kLies = 1.F / 3.F;

// By convention ground up, else +z, then +y, then +x.
std::vector<std::int8_t> conventions(const SheetSigns& sheets, const std::vector<float>& up) {
  const std::size_t count = sheets.windings.size();
  std::vector<std::array<double, 3>> sum(count, {0.0, 0.0, 0.0});
  std::vector<double> points(count, 0.0);
  for (std::size_t i = 0; i < sheets.points.size; ++i) {
    if (sheets.componentOf(i) < 0) continue;
    const std::size_t c = at(sheets.componentOf(i));
    const auto sign = static_cast<double>(sheets.pointSign(i));
    for (std::size_t a = 0; a < 3; ++a) {
      sum[c][a] += sign * static_cast<double>(sheets.field.normals[4 * i + a]);
    }
    points[c] += 1.0;
  }
  std::vector<std::int8_t> out(count, 1);
  for (std::size_t c = 0; c < count; ++c) {
    if (sheets.ground[c]) {
      out[c] = up[c] < 0.F ? -1 : 1;
      continue;
    }
    const double least = 1e-6 * points[c];
    double direction = sum[c][2];
    if (std::fabs(direction) <= least) direction = sum[c][1];
    if (std::fabs(direction) <= least) direction = sum[c][0];
    if (direction < 0.0) out[c] = -1;
  }
  return out;
}

// Of open ground the winding number tells bulge from hollow, not outside from inside. Where all
// else closes the surface already, what a part adds has to be more than what closed clouds lack.
bool isUnknown(const SheetSigns& sheets, std::size_t component) {
  const ComponentWinding& winding = sheets.windings[component];
  return sheets.ground[component] || winding.evidence < kNoEvidence ||
         (sheets.looksClosed(component, kOpenResidual) && winding.gain <= kClosedResidual);
}

std::int8_t signWithoutHints(const SheetSigns& sheets, std::size_t component,
                             std::int8_t convention) {
  return isUnknown(sheets, component) ? convention : sheets.windings[component].sign;
}

// What decides the side of a component: the winding number, or what is known beforehand, or else
// convention.
ComponentOrientationResult sideOf(const SheetSigns& sheets, std::size_t component,
                                  std::int8_t convention, const HintVotes& hints) {
  const ComponentWinding& winding = sheets.windings[component];
  ComponentOrientationResult out = sheets.found.result.components[component];
  const bool unknown = isUnknown(sheets, component);
  out.sign = signWithoutHints(sheets, component, convention);
  out.by = unknown ? DecidedBy::NOTHING : DecidedBy::GLOBAL;
  out.evidence = winding.evidence;
  out.confidence = unknown ? 0.F : winding.evidence;
  if (sheets.options.wind_components) out.residual = winding.residual;
  const bool open = unknown || !sheets.isClosed(component, kOpenResidual);
  if (const Ballot* hint = decisive(hints, open)) {
    out.sign = hint->balance < 0.F ? std::int8_t{-1} : std::int8_t{1};
    out.by = DecidedBy::HINTS;
    out.confidence = std::fabs(hint->share());
  }
  return out;
}

}  // namespace

void turnComponentsOut(SheetSigns& sheets) {
  if (sheets.options.wind_components) {
    sheets.windComponents();
    if (sheets.options.turn_loose_parts) turnLooseParts(sheets);
  }
  const std::vector<float> up = facingUp(sheets);
  for (std::size_t c = 0; c < up.size(); ++c) {
    // Of a part of a closed surface all else closes it.
    sheets.ground[c] = std::fabs(up[c]) > kLies && !sheets.looksClosed(c, sheets.closedResidual());
  }
  if (std::find(sheets.ground.begin(), sheets.ground.end(), true) != sheets.ground.end()) {
    // One layer over a plane is on one side of it throughout.
    sheets.turnClusters(sheets.outvoted(groundVotes(sheets, up), kSureBorders));
  }
  const std::vector<std::int8_t> conventional = conventions(sheets, up);
  std::vector<HintVotes> hinted(sheets.windings.size());
  for (std::size_t s = 0; s < sheets.signs.size(); ++s) {
    hinted[at(sheets.component_of[s])].add(sheets.hint_votes[s], sheets.signs[s]);
  }
  std::vector<ComponentOrientationResult>& components = sheets.found.result.components;
  sheets.found.ground.assign(sheets.ground.begin(), sheets.ground.end());
  sheets.found.inside_out.assign(components.size(), 0);
  for (std::size_t c = 0; c < components.size(); ++c) {
    components[c] = sideOf(sheets, c, conventional[c], hinted[c]);
  }
  const std::vector<bool> facing = faceSuggestedPlace(sheets, components);
  std::vector<ComponentOrientationResult> without = components;
  bool differ = false;
  for (std::size_t c = 0; c < components.size(); ++c) {
    without[c].sign = signWithoutHints(sheets, c, conventional[c]);
    differ = differ || without[c].sign != components[c].sign;
  }
  if (sheets.sensors.none()) {
    followNearest(sheets, facing, components);
    if (differ) followNearest(sheets, facing, without);
  }
  for (std::size_t c = 0; differ && c < components.size(); ++c) {
    sheets.found.inside_out[c] = components[c].sign != without[c].sign ? 1 : 0;
  }
  for (std::size_t s = 0; s < sheets.signs.size(); ++s) {
    const std::int8_t turn = components[at(sheets.component_of[s])].sign;
    sheets.signs[s] = static_cast<std::int8_t>(sheets.signs[s] * turn);
  }
}

}  // namespace segorient::detail
