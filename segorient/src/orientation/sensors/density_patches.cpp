// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/sensors/density_patches.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>

#include "common/directions.h"
#include "common/every_nth.h"
#include "common/median.h"
#include "common/parallel_for.h"
#include "features/symmetric_eigen.h"
#include "search/index_of.h"

namespace segorient::detail {
namespace {

// A few parameters are fitted; medians of so many are sure to two per cent.
constexpr std::size_t kSample = 3000;
// Neighbourhoods to try: the density of k points has an error of 1 / root k, noise and quantised
// depth ask for more of them, detail for fewer.
constexpr std::array<int, 3> kScales{24, 48, 96};
constexpr float kMostlyFlat = 0.62F;   // so many are flat: no need for more neighbours
constexpr float kNotMuchLess = 0.75F;  // of the flat ones: the more neighbours, the surer
// Fits of five parameters to fewer independent densities than this may come about by chance.
constexpr std::size_t kIndependent = 60;
constexpr std::size_t kLeastFlat = 150;

struct Piece {
  std::array<float, 3> center{};
  std::array<float, 3> normal{};
  float log_density = 0.F;
  bool flat = false;
};

Piece pieceOf(const PointView& points, const float* origin, const pcl::index_t* rows, int count) {
  double sum[3] = {0.0, 0.0, 0.0};
  SymmetricMatrix3 m{0.0, 0.0, 0.0, 0.0, 0.0, 0.0};
  for (int j = 0; j < count; ++j) {
    const float* q = points[static_cast<std::size_t>(rows[j])];
    const double d[3] = {static_cast<double>(q[0]) - static_cast<double>(origin[0]),
                         static_cast<double>(q[1]) - static_cast<double>(origin[1]),
                         static_cast<double>(q[2]) - static_cast<double>(origin[2])};
    for (int a = 0; a < 3; ++a) sum[a] += d[a];
    m.add(d);
  }
  const double n = count;
  const double c[3] = {sum[0] / n, sum[1] / n, sum[2] / n};
  const SymmetricEigen3 eigen =
      symmetricEigen({m.xx / n - c[0] * c[0], m.xy / n - c[0] * c[1], m.xz / n - c[0] * c[2],
                      m.yy / n - c[1] * c[1], m.yz / n - c[1] * c[2], m.zz / n - c[2] * c[2]});
  Piece out;
  out.flat = isPieceOfSurface(eigen.values[0], eigen.values[1], eigen.values[2]);
  if (!out.flat) return out;
  for (std::size_t a = 0; a < 3; ++a) {
    out.center[a] = static_cast<float>(static_cast<double>(origin[a]) + c[a]);
    out.normal[a] = static_cast<float>(eigen.vectors[0][a]);
  }
  // An evenly filled disc of area A has variances A / (4 pi).
  out.log_density =
      static_cast<float>(std::log(n / (4.0 * kPi * std::sqrt(eigen.values[1] * eigen.values[2]))));
  return out;
}

struct Sample {
  std::vector<std::size_t> rows;
  std::vector<pcl::index_t> neighbors;  // kMost a row
  std::vector<float> sixth;             // distance to the sixth neighbour
};

// ns a point, see resolveThreads().
constexpr double kPatchTime = 3000.0;

// Only as many neighbours as the scale needs: on a cloud of even density the first one will do.
Sample takeSample(const PointView& points, const search::MedianHashIndex& index, int count,
                  int threads) {
  Sample out;
  for (const std::size_t i : EveryNth(points.size, kSample)) out.rows.push_back(i);
  const auto width = static_cast<std::size_t>(count);
  out.neighbors.resize(out.rows.size() * width);
  out.sixth.resize(out.rows.size());
  parallelFor(
      out.rows.size(), threads, kPatchTime, [&] { return std::vector<float>(width); },
      [&](std::size_t i, std::vector<float>& squared) {
        index.nearestK(points[out.rows[i]], count, &out.neighbors[i * width], squared.data());
        out.sixth[i] = std::sqrt(squared[6]);
      });
  return out;
}

DensityPatches atScale(const PointView& points, const search::MedianHashIndex& index, int k,
                       int threads) {
  const int count = k + 1;
  Sample sample = takeSample(points, index, count, threads);
  std::vector<Piece> pieces(sample.rows.size());
  parallelFor(pieces.size(), threads, kPatchTime, [&](std::size_t i) {
    pieces[i] = pieceOf(points, points[sample.rows[i]],
                        &sample.neighbors[i * static_cast<std::size_t>(count)], count);
  });
  DensityPatches out;
  out.k = k;
  for (const Piece& piece : pieces) {
    if (!piece.flat || !std::isfinite(piece.log_density)) continue;
    out.add(piece.center.data(), piece.normal.data(), piece.log_density);
  }
  out.setSparsity();
  out.flat = static_cast<float>(out.size()) / static_cast<float>(pieces.size());
  const auto place =
      sample.sixth.begin() + static_cast<std::ptrdiff_t>(sample.sixth.size() * 85 / 100);
  std::nth_element(sample.sixth.begin(), place, sample.sixth.end());
  out.reach = *place;
  out.spacing = median(sample.sixth);
  return out;
}

}  // namespace

void DensityPatches::add(const float* center, const float* normal, float density) {
  x.push_back(center[0]);
  y.push_back(center[1]);
  z.push_back(center[2]);
  nx.push_back(normal[0]);
  ny.push_back(normal[1]);
  nz.push_back(normal[2]);
  log_density.push_back(density);
}

std::vector<float> DensityPatches::heightsOver(const std::array<double, 3>& place) const {
  const auto px = static_cast<float>(place[0]);
  const auto py = static_cast<float>(place[1]);
  const auto pz = static_cast<float>(place[2]);
  const float* const at[3] = {x.data(), y.data(), z.data()};
  const float* const normal[3] = {nx.data(), ny.data(), nz.data()};
  std::vector<float> out(size());
  float* const height = out.data();
  for (std::size_t i = 0, n = out.size(); i < n; ++i) {
    height[i] = (px - at[0][i]) * normal[0][i] + (py - at[1][i]) * normal[1][i] +
                (pz - at[2][i]) * normal[2][i];
  }
  return out;
}

std::array<double, 3> DensityPatches::imageOf(const std::array<double, 3>& place) const {
  std::array<double, 3> image = place;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < size(); ++i) {
    const double away[3] = {place[0] - static_cast<double>(x[i]),
                            place[1] - static_cast<double>(y[i]),
                            place[2] - static_cast<double>(z[i])};
    const double square = away[0] * away[0] + away[1] * away[1] + away[2] * away[2];
    if (square >= least) continue;
    least = square;
    const double normal[3] = {static_cast<double>(nx[i]), static_cast<double>(ny[i]),
                              static_cast<double>(nz[i])};
    const double height = away[0] * normal[0] + away[1] * normal[1] + away[2] * normal[2];
    for (std::size_t a = 0; a < 3; ++a) image[a] = place[a] - 2.0 * height * normal[a];
  }
  return image;
}

bool DensityPatches::haveWalls() const {
  constexpr std::size_t kSome = 400;  // of the pieces, against all of them
  constexpr float kParallel = 0.98F;  // cosine: 11 degrees, of which a cylinder's strip is a 16th
  constexpr float kInPlane = 3.F;     // spacings: noise, and what a plane is tilted by
  constexpr double kWall = 0.1;       // of the pieces: a room has six, and furniture
  constexpr float kAcross = 0.5F;     // cosine: 60 degrees and more
  const EveryNth some(size(), kSome);
  std::vector<std::size_t> walls;  // pieces in them
  for (const std::size_t i : some) {
    std::size_t with = 0;
    for (std::size_t j = 0; j < size(); ++j) {
      const float cosine = nx[i] * nx[j] + ny[i] * ny[j] + nz[i] * nz[j];
      const float height = nx[i] * (x[j] - x[i]) + ny[i] * (y[j] - y[i]) + nz[i] * (z[j] - z[i]);
      const bool in_plane = std::fabs(cosine) > kParallel && std::fabs(height) < kInPlane * spacing;
      with += in_plane ? 1 : 0;
    }
    if (static_cast<double>(with) > kWall * static_cast<double>(size())) walls.push_back(i);
  }
  const auto isAcross = [&](std::size_t i) {
    const std::size_t first = walls.front();
    const float cosine = nx[i] * nx[first] + ny[i] * ny[first] + nz[i] * nz[first];
    return std::fabs(cosine) < kAcross;
  };
  return 2 * walls.size() > some.size() && std::any_of(walls.begin(), walls.end(), isAcross);
}

search::MedianHashIndex DensityPatches::index(int threads) const {
  std::vector<float> centers;
  for (std::size_t i = 0; i < size(); ++i) centers.insert(centers.end(), {x[i], y[i], z[i]});
  return search::indexOf({centers.data(), 3, size()}, threads);
}

void DensityPatches::setSparsity() {
  const float middle = median(log_density);
  sparsity.resize(log_density.size());
  for (std::size_t i = 0; i < sparsity.size(); ++i) sparsity[i] = std::exp(middle - log_density[i]);
}

DensityPatches DensityPatches::thinned(std::size_t count) const {
  DensityPatches out;
  out.k = k;
  out.tell_laws = tell_laws;
  out.spacing = spacing;
  out.reach = reach;
  for (const std::size_t i : EveryNth(size(), std::max<std::size_t>(1, count))) {
    const float center[3] = {x[i], y[i], z[i]};
    const float normal[3] = {nx[i], ny[i], nz[i]};
    out.add(center, normal, log_density[i]);
    out.sparsity.push_back(sparsity[i]);
  }
  return out;
}

DensityPatches densityPatches(const PointView& points, const search::MedianHashIndex& index,
                              int threads) {
  std::vector<DensityPatches> scales;
  DensityPatches few;
  for (const int k : kScales) {
    if (points.size < static_cast<std::size_t>(k) * kIndependent) break;
    DensityPatches found = atScale(points, index, k, threads);
    const float independent = found.flat * static_cast<float>(points.size) / static_cast<float>(k);
    found.tell_laws = independent >= static_cast<float>(kIndependent) && found.size() >= kLeastFlat;
    if (found.tell_laws && found.flat >= kMostlyFlat) return found;
    if (found.tell_laws) {
      scales.push_back(std::move(found));
    } else if (k == kScales[0]) {
      few = std::move(found);
    }
  }
  float most = 0.F;
  for (const DensityPatches& s : scales) most = std::max(most, s.flat);
  for (std::size_t s = scales.size(); s-- > 0;) {
    if (scales[s].flat >= kNotMuchLess * most) return std::move(scales[s]);
  }
  return few;
}

float chanceDeviation(int k) {
  // The mean of |x| of a normal distribution is .8 of its deviation.
  return 0.8F / std::sqrt(static_cast<float>(k + 1));
}

std::pair<float, float> rangeWithout(std::size_t cut, std::vector<float> values) {
  const auto low = values.begin() + static_cast<std::ptrdiff_t>(cut);
  std::nth_element(values.begin(), low, values.end());
  const auto high = values.end() - static_cast<std::ptrdiff_t>(cut) - 1;
  const float least = *low;
  std::nth_element(values.begin(), high, values.end());
  return {least, *high};
}

Box boxWithout(std::size_t part, const PointView& points, std::size_t sample) {
  Box box;
  for (std::size_t a = 0; a < 3; ++a) {
    std::vector<float> values;
    for (const std::size_t i : EveryNth(points.size, sample)) values.push_back(points[i][a]);
    const std::size_t cut = values.size() / part;
    std::tie(box.low[a], box.high[a]) = rangeWithout(cut, std::move(values));
  }
  return box;
}

float deviation(const std::vector<float>& values) {
  if (values.empty()) return 0.F;
  const float middle = median(values);
  const float* const value = values.data();
  double sum = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    sum += static_cast<double>(std::min(std::fabs(value[i] - middle), kDeviationCut));
  }
  return static_cast<float>(sum / static_cast<double>(values.size()));
}

}  // namespace segorient::detail
