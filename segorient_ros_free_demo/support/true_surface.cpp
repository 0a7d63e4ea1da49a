// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "support/true_surface.h"

#include <algorithm>
#include <cmath>

namespace segorient::program {
namespace {

// Grid points on a mesh are this part of its extent apart: finer than any surface that is compared,
// and a few million points at most.
constexpr double kGridStep = 1.0 / 500.0;

using Vector = std::array<double, 3>;

Vector minus(const Vector& a, const Vector& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}

double length(const Vector& v) {
  return std::hypot(v[0], v[1], v[2]);
}

Vector cross(const Vector& a, const Vector& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

}  // namespace

TrueSurface::TrueSurface(const CloudTable& table, const std::array<double, 3>& origin,
                         int threads) {
  if (!table.triangles.empty()) {
    addTriangles(table, origin);
  } else if (table.hasNormals()) {
    addPoints(table, origin);
  }
  search::MedianHashIndex::Options options;
  options.threads = threads;
  index_.build({positions_.data(), 3, positions_.size() / 3}, nullptr, options);
}

void TrueSurface::add(const Vector& position, const Vector& normal) {
  const double norm = length(normal);
  if (!(norm > 0.0) || !std::isfinite(norm)) return;
  for (std::size_t a = 0; a < 3; ++a) {
    positions_.push_back(static_cast<float>(position[a]));
    normals_.push_back(static_cast<float>(normal[a] / norm));
  }
}

void TrueSurface::addPoints(const CloudTable& table, const Vector& origin) {
  for (std::size_t i = 0; i < table.size; ++i) {
    add(minus(table.position(i), origin), table.triple(table.normals(), i));
  }
}

void TrueSurface::addTriangles(const CloudTable& table, const Vector& origin) {
  const double step = kGridStep * LocalPoints(table).extent();
  for (const Triangle& t : table.triangles) {
    const Vector a = minus(table.position(t[0]), origin);
    const Vector u = minus(minus(table.position(t[1]), origin), a);
    const Vector v = minus(minus(table.position(t[2]), origin), a);
    const Vector normal = cross(u, v);
    const double longest = std::max({length(u), length(v), length(minus(u, v))});
    const int rows = step > 0.0 ? static_cast<int>(std::min(1000.0, std::ceil(longest / step))) : 1;
    for (int i = 0; i <= rows; ++i) {
      for (int j = 0; i + j <= rows; ++j) {
        Vector p = a;
        for (std::size_t c = 0; c < 3; ++c) p[c] += (i * u[c] + j * v[c]) / rows;
        add(p, normal);
      }
    }
  }
}

double TrueSurface::distance(const float* point) const {
  pcl::index_t nearest = 0;
  float squared = 0.F;
  if (index_.nearestK(point, 1, &nearest, &squared) != 1) return NAN;
  const auto row = 3 * static_cast<std::size_t>(nearest);
  double along = 0.0;
  for (std::size_t a = 0; a < 3; ++a) {
    along += static_cast<double>(normals_[row + a]) *
             (static_cast<double>(point[a]) - static_cast<double>(positions_[row + a]));
  }
  return std::abs(along);
}

}  // namespace segorient::program
