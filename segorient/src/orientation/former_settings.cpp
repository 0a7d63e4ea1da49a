// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <segorient/common/export.h>

#include "orientation/pipeline_stages.h"

SEGORIENT_DEPRECATED_BEGIN
namespace segorient {

PipelineOptions::PipelineOptions() = default;
PipelineOptions::PipelineOptions(const PipelineOptions& other) = default;
PipelineOptions::PipelineOptions(PipelineOptions&& other) noexcept = default;
PipelineOptions& PipelineOptions::operator=(const PipelineOptions& other) = default;
PipelineOptions& PipelineOptions::operator=(PipelineOptions&& other) noexcept = default;
PipelineOptions::~PipelineOptions() = default;

}  // namespace segorient

namespace segorient::detail {
namespace {

template <typename T>
void take(const std::optional<T>& former, T& now) {
  if (former) now = *former;
}

}  // namespace

PipelineOptions withFormerSettings(const PipelineOptions& options) {
  PipelineOptions out = options;
  AutomaticOptions& now = out.orientation.automatic;
  take(options.sheet_normals.split_walls, now.split_walls);
  take(options.sheet_normals.dominant_plane, now.dominant_plane);
  take(options.sheets.alpha, now.alpha);
  take(options.sheets.beta, now.beta);
  take(options.sheets.epsilon, now.epsilon);
  take(options.sheets.require_support, now.require_support);
  take(options.sheets.clean_up, now.clean_up);
  take(options.automatic.contract_certain, now.contract_certain);
  take(options.automatic.wind_components, now.wind_components);
  take(options.automatic.turn_loose_parts, now.turn_loose_parts);
  take(options.denoise, now.denoise);
  take(options.filter_rounds, now.filter_rounds);
  take(options.filter_wedges, now.filter_wedges);
  take(options.winding_normals, now.winding_normals);
  return out;
}
}  // namespace segorient::detail
SEGORIENT_DEPRECATED_END
