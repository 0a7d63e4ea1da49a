// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
//
// The estimators for one instruction set; see lanes.inl.

#include "lanes.inl"
#include "plane_lanes.inl"

inline void storeNormals(const LocalFitJob& job, const Batch& batch, std::size_t used,
                         const Lanes3& normal, Lanes curvature) {
  for (std::size_t l = 0; l < used; ++l) {
    storeQuad(job.normals + 4 * batch.rows[l],
              Quad{normal.x[l], normal.y[l], normal.z[l], curvature[l]});
  }
}

/// Rows [begin, end) of the job.
void estimateRows(const LocalFitJob& job, std::size_t begin, std::size_t end) {
  Batch batch(static_cast<std::size_t>(job.entries));
  for (std::size_t i = begin; i < end; i += kWidth) {
    loadBatch(job, i, end, batch);
    const std::size_t used = end - i < kWidth ? end - i : kWidth;
    const Plane plane = fitPlanes(job, batch);
    storeNormals(job, batch, used, plane.normal, plane.curvature);
  }
}
