// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/automatic/orient_sheets.h"

#include <utility>

#include "orientation/automatic/sheet_signs.h"
#include "orientation/automatic/sheet_stages.h"

namespace segorient {

AutoOrientation orientSheets(const PointView& points, const Neighborhoods& neighborhoods,
                             const SheetField& field, const Segmentation& segmentation,
                             std::vector<BorderVote> votes, std::size_t count,
                             const AutomaticOptions& options, const PointHints& hints,
                             int threads) {
  detail::SheetSigns sheets(points, neighborhoods, field, segmentation, std::move(votes), count,
                            options, hints, threads);
  detail::turnComponentsOut(sheets);
  detail::followHints(sheets);
  if (!sheets.sensors.none()) detail::followSensors(sheets);
  detail::judge(sheets);
  detail::believeSensors(sheets);
  return std::move(sheets.found);
}

}  // namespace segorient
