// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/point_view.h>

#include <vector>

#include "render/rasterizer.h"

namespace segorient::program {

/// Unit normals of a table or of an array; NaN where there is none.
class NormalSource {
 public:
  /// \param normals 4 floats a point, or null: those of the table
  NormalSource(const CloudTable& table, const float* normals)
      : columns_(table.normals()),
        table_(table),
        normals_(normals),
        any_(normals != nullptr || table.hasNormals()) {}
  bool any() const { return any_; }
  std::array<float, 3> at(std::size_t row) const;

 private:
  std::array<const Field*, 3> columns_;
  const CloudTable& table_;
  const float* normals_;
  bool any_;
};

/// A splat for each point with finite coordinates, without colours, in an order of their own.
/// \param rows of the splats in `all`
std::vector<Splat> makeSplats(const PointView& all, const NormalSource& normals, int threads,
                              std::vector<std::uint32_t>& rows);

}  // namespace segorient::program
