// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
//
// The estimators for one instruction set; see lanes.inl.

#include "common/lanes.inl"

#include "features/plane_lanes.inl"

#include "features/surface_lanes.inl"

#include "features/cubic_lanes.inl"

#include "features/triangulation_lanes.inl"

inline void storeNormals(const LocalFitJob& job, const std::size_t* rows, std::size_t used,
                         const Lanes3& normal, Lanes curvature) {
  float* places[kWidth];
  float unused[4];
  for (std::size_t l = 0; l < kWidth; ++l) {
    places[l] = l < used ? job.normals + 4 * rows[l] : unused;
  }
  storePoints(places, normal, curvature);
}

/// Puts cubic surfaces in the place of the quadratic ones where neighbours determine them.
inline void takeCubics(const Cubics& cubics, const Batch& batch, std::size_t half, Quadratic& q,
                       double (&c)[6][kWidth]) {
  for (std::size_t l = 0; l < kWidth; ++l) {
    if (!q.valid[l] || !cubics.valid[l]) continue;
    for (std::size_t i = 0; i < 6; ++i) {
      c[i][l] = cubics.c[i][l];
      q.c[i][l] = static_cast<float>(c[i][l]);
    }
    const int freedom = std::max(1, batch.counts[half * kWidth + l] - 10);
    q.residual[l] = static_cast<float>(std::sqrt(std::max(0.0, cubics.squares[l]) / freedom));
  }
}

/// Normals from the surfaces, and what depends on single points.
SEGORIENT_APART Lanes3 surfaceNormals(const LocalFitJob& job, const Batch& batch, std::size_t half,
                                      std::size_t used, const Plane& plane, const Lanes3& guess) {
  const std::size_t* rows = batch.rows + half * kWidth;
  const double* units = batch.unit + half * kWidth;
  const Frame<Lanes> frame = frameOf(guess);
  Quadratic q = fitQuadratics(batch, half, plane, frame);
  double c[6][kWidth];
  for (std::size_t l = 0; job.curvatures && l < kWidth; ++l) {
    for (std::size_t i = 0; i < 6; ++i) c[i][l] = static_cast<double>(q.c[i][l]);
  }
  if (job.estimator == NormalEstimator::AWAS_CUBIC) {
    Cubics cubics;
    fitCubics(batch, half, plane, frame, cubics);
    takeCubics(cubics, batch, half, q, c);
  }
  const Lanes3 fitted = unit(Lanes3{frame.n.x - q.c[1] * frame.u.x - q.c[2] * frame.v.x,
                                    frame.n.y - q.c[1] * frame.u.y - q.c[2] * frame.v.y,
                                    frame.n.z - q.c[1] * frame.u.z - q.c[2] * frame.v.z});
  for (std::size_t l = 0; job.residuals && l < used; ++l) {
    const float length = plane.size[l] * static_cast<float>(units[l]);
    job.residuals[rows[l]] =
        q.valid[l] ? q.residual[l] * length : std::numeric_limits<float>::infinity();
  }
  for (std::size_t l = 0; job.curvatures && l < used; ++l) {
    SurfaceFit fit;
    fit.valid = q.valid[l] != 0;
    fit.size = static_cast<double>(plane.size[l]) * units[l];
    for (std::size_t i = 0; i < 6; ++i) fit.c[i] = c[i][l];
    const Lanes3* axes[3] = {&frame.u, &frame.v, &frame.n};
    for (std::size_t a = 0; a < 3; ++a) {
      fit.axes[a][0] = static_cast<double>(axes[a]->x[l]);
      fit.axes[a][1] = static_cast<double>(axes[a]->y[l]);
      fit.axes[a][2] = static_cast<double>(axes[a]->z[l]);
    }
    job.curvatures[rows[l]] = fit.curvature();
  }
  return select(q.valid, fitted, guess);
}

/// Rows [begin, end) of the job.
void estimateRows(const LocalFitJob& job, std::size_t begin, std::size_t end) {
  const bool surface = job.estimator == NormalEstimator::AWAS_QUADRATIC ||
                       job.estimator == NormalEstimator::AWAS_CUBIC;
  const NormalEstimator first = surface ? job.first_guess : job.estimator;
  const auto entries = static_cast<std::size_t>(job.entries);
  Batch batch(entries);
  SortingNetwork network;
  std::vector<float> scratch(first == NormalEstimator::PLANE ? 0 : 3 * entries * kBatchRows);
  for (std::size_t i = begin; i < end; i += kBatchRows) {
    loadBatch(job, i, end, batch);
    Plane planes[2];
    fitPlanes(job, batch, planes);
    Lanes3 normals[2] = {planes[0].normal, planes[1].normal};
    if (first == NormalEstimator::LCT) {
      fanNormals(job, batch, planes, network, scratch.data(), normals);
    }
    if (first == NormalEstimator::LDT) starNormals(batch, planes, scratch.data(), normals);
    for (std::size_t half = 0; half < 2 && i + half * kWidth < end; ++half) {
      const std::size_t left = end - i - half * kWidth;
      const std::size_t used = left < kWidth ? left : kWidth;
      const Plane& plane = planes[half];
      Lanes3& normal = normals[half];
      if (surface) normal = surfaceNormals(job, batch, half, used, plane, normal);
      storeNormals(job, batch.rows + half * kWidth, used, normal, plane.curvature);
      if (job.curvatures && !surface) {
        for (std::size_t l = 0; l < used; ++l) {
          job.curvatures[batch.rows[half * kWidth + l]] = SurfaceFit().curvature();
        }
      }
    }
  }
}
