// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "render/page/surroundings.h"

#include <segorient/search/median_hash_index.h>

#include <cmath>

#include "common/threads.h"
#include "render/page/disc_radii.h"
#include "render/page/vectors.h"

namespace segorient::program {
namespace {

constexpr int kAround = 16;         // neighbours, as in pictures
constexpr float kCutSlack = 0.05F;  // of the radius; closes the gap along the edge

// The nearest edges that reach into a disc, towards different sides.
std::array<DiscEnd, Surroundings::kEnds> endsOf(std::size_t i, const PointView& points,
                                                const std::vector<float>& normals,
                                                const Neighborhoods& neighborhoods, float radius) {
  std::array<DiscEnd, Surroundings::kEnds> ends{};
  std::size_t found = 0;
  const Vec own = vectorAt(&normals[3 * i]);
  for (int j = 1; j < neighborhoods.count(i) && found < ends.size(); ++j) {
    const auto other = static_cast<std::size_t>(neighborhoods.indices(i)[j]);
    Vec n = vectorAt(&normals[3 * other]);
    if (!(std::abs(dot(own, n)) < kSameSheet)) continue;
    const float* p = points[i];
    const float* q = points[other];
    float distance = dot(n, {q[0] - p[0], q[1] - p[1], q[2] - p[2]});
    // The disc's own side, whatever the signs of normals are.
    if (distance < 0.F) {
      for (float& v : n) v = -v;
      distance = -distance;
    }
    distance = distance / radius + kCutSlack;
    if (!(distance < 1.F) || (found > 0 && dot(ends[0].direction, n) > kSameSheet)) continue;
    ends[found++] = {n, distance};
  }
  return ends;
}

}  // namespace

Surroundings::Surroundings(const PageCloud& cloud, const std::vector<std::uint32_t>& rows,
                           int threads) {
  std::vector<float> shown;
  std::vector<float> normals;
  shown.reserve(3 * rows.size());
  for (const std::uint32_t row : rows) {
    shown.insert(shown.end(), cloud.points[row], cloud.points[row] + 3);
    if (cloud.normals.empty()) continue;
    const float* n = &cloud.normals[3 * std::size_t{row}];
    const float length = std::hypot(n[0], n[1], n[2]);
    for (int a = 0; a < 3; ++a) normals.push_back(n[a] / length);
  }
  PointView view;
  view.data = shown.data();
  view.stride = 3;
  view.size = rows.size();
  search::MedianHashIndex index;
  search::MedianHashIndex::Options options;
  options.threads = threads;
  index.build(view, nullptr, options);
  Neighborhoods neighborhoods;
  index.nearestKAll(kAround + 1, neighborhoods);
  float middle = 0.F;
  const std::vector<float> radii = discRadii(neighborhoods, middle, threads);
  radius = static_cast<double>(middle);
  for (const float r : radii) sizes.push_back(middle > 0.F ? r / middle : 1.F);
  if (normals.empty()) return;
  ends.resize(rows.size());
  const auto count = static_cast<std::ptrdiff_t>(rows.size());
#pragma omp parallel for schedule(static, 4096) num_threads(resolveThreads(threads))
  for (std::ptrdiff_t k = 0; k < count; ++k) {
    const auto i = static_cast<std::size_t>(k);
    ends[i] = endsOf(i, view, normals, neighborhoods, radii[i]);
  }
  sides = findSides(view, normals, neighborhoods, radii, middle, threads);
  for (std::size_t i = 0; i < sides.size() && !cloud.sides.empty(); ++i) {
    const Side told = cloud.sides[rows[i]];
    if (told != Side::Open) sides[i] = told;
  }
}

}  // namespace segorient::program
