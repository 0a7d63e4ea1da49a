// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
//
// Normals by CGAL, where it is installed.
#pragma once

#include <segorient/common/point_view.h>

#include <cstddef>
#include <vector>

#ifdef SEGORIENT_HAVE_CGAL
#define CGAL_EIGEN3_ENABLED 1
#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/jet_estimate_normals.h>
#include <CGAL/property_map.h>

#include <tuple>
#endif

namespace segorient::benchmark {

/// jet_estimate_normals (quadratic) of k neighbours, 4 floats a point; empty without CGAL.
inline std::vector<float> cgalJetNormals([[maybe_unused]] const PointView& points,
                                         [[maybe_unused]] unsigned k) {
  std::vector<float> normals;
#ifdef SEGORIENT_HAVE_CGAL
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  using Item = std::tuple<Kernel::Point_3, Kernel::Vector_3>;
  std::vector<Item> items;
  for (std::size_t i = 0; i < points.size; ++i) {
    const float* p = points[i];
    items.emplace_back(Kernel::Point_3(static_cast<double>(p[0]), static_cast<double>(p[1]),
                                       static_cast<double>(p[2])),
                       Kernel::Vector_3(0, 0, 0));
  }
  const auto settings = CGAL::parameters::point_map(CGAL::Nth_of_tuple_property_map<0, Item>())
                            .normal_map(CGAL::Nth_of_tuple_property_map<1, Item>());
  CGAL::jet_estimate_normals<CGAL::Sequential_tag>(items, k, settings);
  for (const Item& item : items) {
    const Kernel::Vector_3& n = std::get<1>(item);
    for (int a = 0; a < 3; ++a) normals.push_back(static_cast<float>(n[a]));
    normals.push_back(0.F);
  }
#endif
  return normals;
}

}  // namespace segorient::benchmark
