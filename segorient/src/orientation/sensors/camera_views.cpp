// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/sensors/camera_views.h"

#include <algorithm>

#include "orientation/sensors/view_pyramid.h"

namespace segorient::detail {
namespace {


}  // namespace

const FlatPoints& CameraViews::flat() {
  if (!flat_) flat_.emplace(cloud_.points(), threads_);
  return *flat_;
}

const std::vector<RevealedPlace>& CameraViews::cameras() {
  if (cameras_) return *cameras_;
  cameras_.emplace();
  for (const std::array<float, 3>& apex : findApexes(flat(), threads_)) {
    const Shadows shadows = findShadows(flat(), apex, threads_, true);
    if (shadows.reveal()) {
      cameras_->push_back({apex, shadows});
    }
  }
  std::stable_sort(cameras_->begin(), cameras_->end(),
                   [](const RevealedPlace& a, const RevealedPlace& b) {
                     return a.shadows.coveredOfSteps() < b.shadows.coveredOfSteps();
                   });
  return *cameras_;
}

}  // namespace segorient::detail
