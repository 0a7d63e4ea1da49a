// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/point_view.h>
#include <segorient/search/median_hash_index.h>

namespace segorient::search {

/// The index of all of some points.
inline MedianHashIndex indexOf(const PointView& points, int threads) {
  MedianHashIndex out;
  MedianHashIndex::Options options;
  options.threads = threads;
  out.build(points, nullptr, options);
  return out;
}

}  // namespace segorient::search
