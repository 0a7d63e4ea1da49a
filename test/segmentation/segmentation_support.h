// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/neighborhoods.h>
#include <segorient/search/median_hash_index.h>

#include <vector>

#include "features/local_normals.h"
#include "labelled_solids.h"
#include "segmentation/region_growing.h"

namespace segorient::test {

inline PointView viewOf(const std::vector<float>& rows) {
  return {rows.data(), 4, rows.size() / 4};
}

/// Rows of normal and curvature.
inline NormalView normalsOf(const std::vector<float>& rows) {
  return {rows.data(), 4, rows.size() / 4};
}

inline Neighborhoods neighborsOf(const LabelledCloud& cloud, int k) {
  search::MedianHashIndex index;
  index.build(viewOf(cloud.xyz), nullptr, {});
  Neighborhoods table;
  index.nearestKAll(k + 1, table);
  return table;
}

inline std::vector<float> planeNormals(const LabelledCloud& cloud, const Neighborhoods& table,
                                       int k) {
  std::vector<float> normals(cloud.xyz.size());
  LocalNormalOptions options;
  options.k = k;
  estimateNormals(viewOf(cloud.xyz), table, options, normals.data());
  return normals;
}

/// A cloud with everything that segmentation takes.
struct Prepared {
  explicit Prepared(LabelledCloud c, int k = 12)
      : cloud(std::move(c)), table(neighborsOf(cloud, k)), normals(planeNormals(cloud, table, k)) {}

  Segmentation segment(const SegmentationOptions& options = {},
                       SegmentationReport* report = nullptr) const {
    return segmentByNormals(viewOf(cloud.xyz), normalsOf(normals), table, options, report);
  }

  LabelledCloud cloud;
  Neighborhoods table;
  std::vector<float> normals;
};

}  // namespace segorient::test
