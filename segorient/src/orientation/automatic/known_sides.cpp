// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <algorithm>
#include <cmath>
#include <utility>

#include "orientation/automatic/sensor_signs.h"
#include "orientation/automatic/sheet_stages.h"

namespace segorient::detail {
namespace {

// As kMostContrary of scans: of votes within sheets, against what most of their sheet says. True
// places leave .007 of them and less; on open surfaces wrong ones leave .011 and more. Times the
// density ratio, true places leave up to .0075, wrong ones for layers from .013 on.
constexpr float kMostSplit = 0.01F;

// How far one place sees smooth sheets from both sides, which no sensor does: share of the votes
// against their own segment. \param own components that do not ask it
float splitOf(const SheetSigns& sheets, const std::vector<Ballot>& ballots,
              const std::vector<bool>& own) {
  double agreed = 0.0;
  double total = 0.0;
  for (std::size_t s = 0; s < ballots.size(); ++s) {
    if (own[at(sheets.component_of[s])]) continue;
    agreed += std::fabs(ballots[s].balance);
    total += ballots[s].total;
  }
  return total > 0.0 ? 0.5F * (1.F - static_cast<float>(agreed / total)) : 0.F;
}

// What the winding number may leave of a surface that counts as closed, whatever a place says. A
// room seen from within all but closes, too; but what hides points goes on behind them, as closed
// surfaces do, and so does what is all around a doubtful place.
float residualOfClosed(const SheetSigns& sheets, bool hides) {
  const bool goes_on = hides || (sheets.sensors.doubtful && sheets.sensors.enclosed);
  return goes_on ? kOpenResidual : sheets.closedResidual();
}

// One place for all points may be wrong as a whole, inside a solid, or have seen one side of it
// only. Unless its density says that all was seen from there, what closes in itself knows better:
// it keeps its outside if that faces the place, or if the place is doubtful. A doubtful place that
// sees the rest from both sides is dropped.
void weighOnePlace(SheetSigns& sheets, const std::vector<Ballot>& ballots) {
  const bool told_closed = sheets.hints.surface == SurfaceKind::CLOSED;
  if (!sheets.sensors.one_place || !sheets.sensors.scans[0].used) return;
  if (sheets.hints.surface == SurfaceKind::OPEN) return;
  if (sheets.sensors.confirmed && !told_closed) return;
  std::vector<Ballot> by_component(sheets.windings.size());
  for (std::size_t s = 0; s < sheets.signs.size(); ++s) {
    by_component[at(sheets.component_of[s])].add(ballots[s], sheets.signs[s]);
  }
  const float residual = residualOfClosed(sheets, sheets.sensors.hides);
  std::vector<bool> own(sheets.windings.size(), false);
  std::size_t believed = 0;
  for (std::size_t c = 0; c < own.size(); ++c) {
    const bool contrary = by_component[c].share() < -kClearly;
    const bool keeps =
        told_closed || !contrary || (sheets.sensors.doubtful && !sheets.sensors.in_a_room);
    own[c] = keeps && sheets.isClosed(c, residual);
    if (!own[c] || !contrary) believed += sheets.found.result.components[c].points;
  }
  for (std::size_t i = 0; i < sheets.points.size; ++i) {
    const std::int32_t c = sheets.componentOf(i);
    if (c < 0 || !own[at(c)]) continue;
    sheets.facing[i] = 0.F;
    std::fill_n(&sheets.sensors.toward[3 * i], 3, 0.F);
  }
  KnownSensor& report = sheets.sensors.scans[0];
  report.used = 2 * believed > sheets.cloud_points;
  sheets.sensors.countSeen();
  if (!sheets.sensors.doubtful) return;
  // followHints() has left closed components alone where a doubtful place hides points or is
  // enclosed, so that it decided nothing if all are closed.
  sheets.found.place_idle = (report.hidden > kFewHidden || sheets.sensors.enclosed) &&
                            std::all_of(own.begin(), own.end(), [](bool o) { return o; });
  report.contrary = splitOf(sheets, ballots, own);
  if (sheets.sensors.allowed) return;
  // The less its density is that of a sensor there, the less may contradict it. Thinned clouds have
  // another one, but hide nothing.
  const float unlike =
      sheets.sensors.hides && std::isfinite(report.density) ? std::max(1.F, report.density) : 1.F;
  if (report.contrary * unlike <= kMostSplit) return;
  report.used = false;
  sheets.sensors.dropUnused();
  sheets.sensors.countSeen();
  sheets.facing.assign(sheets.points.size, 0.F);
}

// Where no segment's points say more than its borders could, as of pieces of one surface that tiles
// overlap on, those of all segments of the component do.
void turnWhatNoSegmentDecides(SheetSigns& sheets, const std::vector<Ballot>& ballots,
                              std::vector<bool>& decided) {
  std::vector<Ballot> all(sheets.windings.size());
  std::vector<bool> has_decided(all.size(), false);
  for (std::size_t s = 0; s < decided.size(); ++s) {
    const std::size_t c = at(sheets.component_of[s]);
    all[c].add(ballots[s], sheets.signs[s]);
    if (decided[s]) has_decided[c] = true;
  }
  for (std::size_t s = 0; s < decided.size(); ++s) {
    const std::size_t c = at(sheets.component_of[s]);
    if (has_decided[c] || !isClear(all[c].balance)) continue;
    decided[s] = true;
    if (all[c].balance < 0.F) sheets.signs[s] = static_cast<std::int8_t>(-sheets.signs[s]);
  }
}

// What stands on the ground, and whose borders to it hardly tell, faces up where it is seen from
// above.
void turnWhatStands(SheetSigns& sheets, const std::vector<Ballot>& ballots) {
  std::vector<Ballot> up(sheets.clusters.size());
  for (std::size_t s = 0; s < ballots.size(); ++s) {
    up[at(sheets.clusters.of(s))].add(ballots[s], sheets.signs[s]);
  }
  sheets.turnClusters(sheets.outvoted(up, kSureBorders));
}

}  // namespace

void followHints(SheetSigns& sheets) {
  const PointHints& hints = sheets.hints;
  if (!hints.has_viewpoint && hints.directions.empty() && hints.seeds.empty()) return;
  std::vector<HintVotes> by_cluster(sheets.clusters.size());
  for (std::size_t s = 0; s < sheets.clusters.size(); ++s) {
    by_cluster[at(sheets.clusters.of(s))].add(sheets.hint_votes[s], sheets.signs[s]);
  }
  const std::vector<std::int32_t> component_of = sheets.componentsOfClusters();
  const KnownSensors& known_sensors = sheets.sensors;
  const bool hides = known_sensors.doubtful && known_sensors.scans[0].hidden > kFewHidden;
  const float residual = residualOfClosed(sheets, hides);
  std::vector<Ballot> seen(sheets.clusters.size());
  std::vector<Ballot> known(sheets.clusters.size());
  for (std::size_t c = 0; c < sheets.clusters.size(); ++c) {
    if (component_of[c] < 0) continue;
    const HintVotes& v = by_cluster[c];
    if (v.seeds.total > 0.F || v.directions.total > 0.F) {
      known[c] = v.seeds.total > 0.F ? v.seeds : v.directions;
    } else if (!sheets.isClosed(at(component_of[c]), residual)) {
      seen[c] = v.view;
    }
  }
  sheets.turnClusters(sheets.outvoted(known, kFirmBorders));
  sheets.turnClusters(sheets.outvoted(seen, kSureBorders));
}

void followSensors(SheetSigns& sheets) {
  sheets.facing = facingOf(sheets.field, sheets.points.size, sheets.sensors);
  weighOnePlace(sheets, facingBySegment(sheets.facing, sheets.segmentation));
  const std::vector<Ballot> ballots = facingBySegment(sheets.facing, sheets.segmentation);
  const bool faces_up = sheets.hints.place.faces_up;
  if (faces_up) turnWhatStands(sheets, ballots);
  std::vector<bool> decided = turnToSensors(ballots, sheets.votes, !faces_up, sheets.signs);
  turnWhatNoSegmentDecides(sheets, ballots, decided);
  std::vector<Ballot> seen(sheets.windings.size());
  for (std::size_t s = 0; s < sheets.signs.size(); ++s) {
    if (decided[s]) seen[at(sheets.component_of[s])].add(ballots[s], sheets.signs[s]);
  }
  for (std::size_t c = 0; c < seen.size(); ++c) {
    // That a sheet's upper side is the seen one is a convention, if a good one.
    if (!(seen[c].total > 0.F) || faces_up) continue;
    sheets.found.result.components[c].by = DecidedBy::HINTS;
    sheets.found.result.components[c].confidence = std::fabs(seen[c].share());
  }
}

void believeSensors(SheetSigns& sheets) {
  if (sheets.sensors.none()) return;
  for (std::size_t i = 0; i < sheets.points.size; ++i) {
    if (!isClear(sheets.facing[i])) continue;
    sheets.found.result.point_signs[i] = sheets.facing[i] < 0.F ? std::int8_t{-1} : std::int8_t{1};
    if (!sheets.hints.place.faces_up) sheets.found.result.point_confidences[i] = 1.F;
  }
  sheets.found.sensors = std::move(sheets.sensors.scans);
  static_cast<SeenPoints&>(sheets.found) = std::move(sheets.sensors);
}

}  // namespace segorient::detail
