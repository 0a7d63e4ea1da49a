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

  void segment(double fraction, Segmentation* faces) {
    clock.begin("segmentation", fraction);
    SegmentationOptions settings = options.segmentation;
    settings.threads = options.threads;
    stages.findSegments(settings, faces);
    clock.end();
  }

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
  for (int round = 0; round < impl_->options.recomputations; ++round) {
    impl_->segment(0.5, nullptr);
    impl_->clock.begin("recomputation", 0.65);
    impl_->stages.recomputeNormals(impl_->options);
    impl_->clock.end();
  }
}

void FirstStages::findSegments(bool split) {
  Segmentation faces;
  impl_->segment(0.8, split ? nullptr : &faces);
  if (!split) impl_->stages.segmentation = std::move(faces);
}

std::vector<float> FirstStages::normals() const {
  return impl_->stages.cloud.scatter(impl_->stages.normals, 4,
                                     std::numeric_limits<float>::quiet_NaN());
}

std::vector<float> FirstStages::normalsBySegment() const {
  std::vector<float> out = normals();
  const PreparedCloud& cloud = impl_->stages.cloud;
  const std::vector<std::int8_t>& signs = impl_->stages.segmentation.signs;
  for (std::size_t row = 0; row < cloud.rows(); ++row) {
    const pcl::index_t i = cloud.pointOf(row);
    if (i < 0 || signs[static_cast<std::size_t>(i)] >= 0) continue;
    for (std::size_t a = 0; a < 3; ++a) out[4 * row + a] *= -1.F;
  }
  return out;
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
