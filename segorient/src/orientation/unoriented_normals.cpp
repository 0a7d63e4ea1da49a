// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "unoriented_normals.h"

#include <segorient/features/automatic_normals.h>
#include <segorient/features/local_normals.h>

namespace segorient::detail {

std::string findUnorientedNormals(const PointView& points, const search::MedianHashIndex& index,
                                  const Neighborhoods& neighborhoods,
                                  const PipelineOptions& options, std::vector<float>& normals) {
  normals.resize(4 * points.size);
  if (options.normals.estimator == NormalEstimator::Automatic) {
    const AutomaticNormalReport report =
        options.k > 0
            ? estimateNormalsAutomatically(points, neighborhoods, options.threads, normals.data())
            : estimateNormalsAutomatically(points, index, neighborhoods, options.threads,
                                           normals.data());
    return report.text();
  }
  LocalNormalOptions settings = options.normals;
  settings.k = 0;
  settings.threads = options.threads;
  estimateNormals(points, neighborhoods, settings, normals.data());
  return "as asked for";
}

}  // namespace segorient::detail
