// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <segorient/orientation/first_stages.h>

#include <limits>
#include <utility>

#include "orientation/stage_clock.h"
#include "orientation/surface_stages.h"
#include "segmentation/segmentation_rows.h"

namespace segorient {

struct FirstStages::Impl {
  Impl(const PipelineOptions& all, PipelineProgress progress)
      : options(all), clock(std::move(progress)) {}

  const PipelineOptions& options;
  detail::StageClock clock;
  detail::SurfaceStages stages;
};

FirstStages::FirstStages(const PointView& points, const PipelineOptions& options,
                         PipelineProgress progress)
    : impl_(std::make_unique<Impl>(options, std::move(progress))) {
  impl_->clock.begin("search", 0.0);
  impl_->stages.cloud = PreparedCloud(points, nullptr, options.threads);
  impl_->stages.findNeighbors(options.k > 0 ? options.k : kDefaultNeighbors);
  impl_->clock.end();
}

FirstStages::~FirstStages() = default;

void FirstStages::findNormals() {
  impl_->clock.begin("normals", 0.4);
  impl_->stages.findNormals(impl_->options);
  impl_->clock.end();
  impl_->stages.recomputeNormals(impl_->options, impl_->clock);
  impl_->clock.end();
}

void FirstStages::findSegments() {
  if (impl_->stages.normals.empty()) findNormals();
  impl_->clock.begin("segmentation", 0.8);
  SegmentationOptions options{impl_->options.segmentation};
  options.threads = impl_->options.threads;
  impl_->stages.findSegments(options);
  impl_->clock.end();
}

std::vector<float> FirstStages::normals() const {
  return impl_->stages.cloud.scatter(impl_->stages.normals, 4,
                                     std::numeric_limits<float>::quiet_NaN());
}

Segmentation FirstStages::segmentation() const {
  return segmentation::scatter(impl_->stages.cloud, impl_->stages.segmentation);
}

const std::vector<StageTime>& FirstStages::times() const {
  return impl_->clock.times();
}

int FirstStages::k() const {
  return impl_->stages.k;
}

const std::string& FirstStages::normalsChosen() const {
  return impl_->stages.normals_chosen;
}

std::size_t FirstStages::nonFinite() const {
  return impl_->stages.cloud.withoutPoint();
}

std::size_t FirstStages::duplicates() const {
  return impl_->stages.cloud.duplicates();
}

}  // namespace segorient
