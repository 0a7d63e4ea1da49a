// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/sensors/camera_views.h"

#include <algorithm>

#include "orientation/sensors/view_pyramid.h"

namespace segorient::detail {

const std::vector<RevealedPlace>& CameraViews::cameras() {
  if (cameras_) return *cameras_;
  cameras_.emplace();
  for (const Apex& apex : findApexes(flat(), threads_)) {
    const Shadows shadows = findShadows(flat(), apex.place, threads_, !apex.whole);
    if (apex.whole ? shadows.allow() || shadows.excuse() : shadows.reveal()) {
      cameras_->push_back({apex.place, shadows, apex.whole});
    }
  }
  std::stable_sort(cameras_->begin(), cameras_->end(),
                   [](const RevealedPlace& a, const RevealedPlace& b) {
                     if (a.whole_image != b.whole_image) return a.whole_image;
                     return a.shadows.coveredOfSteps() < b.shadows.coveredOfSteps();
                   });
  return *cameras_;
}

}  // namespace segorient::detail
