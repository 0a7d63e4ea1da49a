// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/automatic/patch_signs.h"

#include <Eigen/Core>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "common/dot.h"
#include "common/threads.h"
#include "orientation/automatic/even_cells.h"
#include "orientation/automatic/sheet_signs.h"
#include "orientation/automatic/sign_patches.h"
#include "orientation/winding/dipole_fields.h"

namespace segorient::detail {
namespace {

// In mean distances to the six nearest points: every second point or so is a cell, and a wall of
// two spacings keeps its sides apart.
constexpr float kCell = 0.8F;
constexpr float kSmooth = 1.F;  // a cell and its neighbours, so that no single dipole stands out
// Places where the winding number is asked: eight and more for each sign.
constexpr std::size_t kPlaces = 4000;
// So that smoothness and the winding number weigh alike: a patch of 80 cells has some 27 pairs of
// neighbours across each of four sides. Opposed across one side it pays for 32 cells, on the wrong
// side of its surface for 80.
constexpr double kSmoothness = 0.3;
constexpr double kTie = 1e-3;         // of a patch's share: what no place sees stays 0
constexpr int kSweeps = 200;          // at most
constexpr double kSettled = 1e-3;     // of a whole sign
constexpr int kRounds = 5;            // each leaves out what the last one left undecided
constexpr float kDecided = 0.3F;      // a third of the way from "either" to "this side"
constexpr float kPairs = 3.F;         // as in SignEnergy: pairs of neighbours in terms of a share
constexpr float kUndecided = 0.125F;  // between the right side, 0, and the wrong one
constexpr float kWorst = 0.25F;       // on the wrong side, or where the winding number says nothing
// What is left undecided is in contact, with the inside around it: w is 1 there, not 0. Times the
// share of the surface: at most .02 of bodies in contact, .06 to .13 of open sheets that were
// rolled up to bodies.
constexpr float kOutside = 0.03F;
// Bodies in contact have .01 to .045 (single patches across a joint), open sheets .06 and more.
constexpr float kGood = 0.05F;
// What cells see no plane of: bodies in contact .03 (edges), walls of half a spacing, layers and
// outliers .1 and more. There, cells mix what the signs should tell apart.
constexpr float kNoSurface = 0.1F;
constexpr float kBetter = 0.75F;  // of two equally good ones one has up to .1 less

bool isClosed(const AutoNormals& found) {
  double sum = 0.0;
  double points = 0.0;
  for (const ComponentOrientationResult& component : found.orientation.result.components) {
    const auto size = static_cast<double>(component.points);
    sum += size * static_cast<double>(std::min(1.F, component.residual));
    points += size;
  }
  return sum <= static_cast<double>(kClosedResidual) * points;
}

using Signs = Eigen::VectorXd;

struct Solution {
  Signs signs;  // -1 to 1
  float energy = 0.F;
  // Whether what is decided bounds bodies, and what is not lies between them.
  bool allowed = false;
};

class PatchEquations {
 public:
  PatchEquations(const EvenCells& cells, float radius, int threads);

  std::size_t size() const { return patches_.size(); }
  const SignPatches& patches() const { return patches_; }

  // \param start signs; all 0 for none \param layers whether bodies may overlap
  Solution solve(Signs start, int rounds, bool layers) const;
  // Mean square difference of the winding number from the middle between two whole numbers, by
  // whole signs, over what is decided; with neighbours that contradict each other.
  Solution judge(Signs signs) const;
  // The sum of all patches as they are: -1 where it has the inside out.
  double side() const;

 private:
  void findFields(float radius, int threads);
  Signs descend(Signs signs, const Eigen::VectorXf& weights, const Eigen::VectorXf& targets) const;

  const EvenCells& cells_;
  SignPatches patches_;
  std::vector<std::uint32_t> places_;  // cells
  Eigen::VectorXf areas_;              // of places, as shares of all
  Eigen::MatrixXf fields_;             // winding number of each patch (column) at each place (row)
};

PatchEquations::PatchEquations(const EvenCells& cells, float radius, int threads)
    : cells_(cells), patches_(growPatches(cells)) {
  const std::size_t stride = std::max<std::size_t>(1, cells.size() / kPlaces);
  for (std::size_t c = 0; c < cells.size(); c += stride) {
    places_.push_back(static_cast<std::uint32_t>(c));
  }
  areas_.resize(static_cast<Eigen::Index>(places_.size()));
  for (Eigen::Index k = 0; k < areas_.size(); ++k) {
    areas_[k] = cells.areas[places_[static_cast<std::size_t>(k)]];
  }
  areas_ /= areas_.sum();
  findFields(radius, threads);
}

void PatchEquations::findFields(float radius, int threads) {
  std::vector<float> at;
  for (const std::uint32_t c : places_) {
    at.insert(at.end(), &cells_.places[4 * std::size_t{c}], &cells_.places[4 * std::size_t{c}] + 4);
  }
  std::vector<float> dipoles(4 * cells_.size());
  for (std::size_t c = 0; c < cells_.size(); ++c) {
    for (std::size_t a = 0; a < 3; ++a) {
      dipoles[4 * c + a] = cells_.areas[c] * cells_.normals[4 * c + a];
    }
    dipoles[4 * c + 3] = cells_.areas[c];
  }
  const PointView places{at.data(), 4, places_.size()};
  fields_.resize(areas_.size(), static_cast<Eigen::Index>(size()));
#pragma omp parallel for num_threads(resolveThreads(threads, size(), 2.0)) schedule(dynamic)
  for (std::size_t p = 0; p < size(); ++p) {
    const std::vector<float> w =
        windingNumbers(places, {cells_.points(), dipoles, &patches_.cells[p]}, radius, 1);
    std::copy(w.begin(), w.end(), fields_.col(static_cast<Eigen::Index>(p)).data());
  }
}

double PatchEquations::side() const {
  const Eigen::VectorXf w = fields_.rowwise().sum();
  return static_cast<double>(w.dot(areas_)) < 0.0 ? -1.0 : 1.0;
}

// Each sign in turn takes its best value while the others stay: down to the one minimum, as the sum
// is convex.
Signs PatchEquations::descend(Signs signs, const Eigen::VectorXf& weights,
                              const Eigen::VectorXf& targets) const {
  const auto n = static_cast<Eigen::Index>(size());
  const Eigen::MatrixXf weighted = weights.cwiseSqrt().asDiagonal() * fields_;
  Eigen::MatrixXf squares = Eigen::MatrixXf::Zero(n, n);
  squares.selfadjointView<Eigen::Lower>().rankUpdate(weighted.transpose());
  squares.triangularView<Eigen::StrictlyUpper>() = squares.transpose();
  Eigen::MatrixXd matrix = squares.cast<double>();
  Signs wanted(n);
  for (Eigen::Index p = 0; p < n; ++p) {
    wanted[p] =
        static_cast<double>((fields_.col(p).array() * weights.array() * targets.array()).sum());
    matrix(p, p) += kTie * static_cast<double>(patches_.areas[static_cast<std::size_t>(p)]);
  }
  for (const PatchBorder& border : patches_.borders) {
    const double c = kSmoothness * static_cast<double>(border.agreement);
    matrix(border.a, border.a) += std::fabs(c);
    matrix(border.b, border.b) += std::fabs(c);
    matrix(border.a, border.b) -= c;
    matrix(border.b, border.a) -= c;
  }
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    double most = 0.0;
    for (Eigen::Index p = 0; p < n; ++p) {
      if (!(matrix(p, p) > 0.0)) continue;
      const double step = (wanted[p] - matrix.col(p).dot(signs)) / matrix(p, p);
      const double to = std::clamp(signs[p] + step, -1.0, 1.0);
      most = std::max(most, std::fabs(to - signs[p]));
      signs[p] = to;
    }
    if (most < kSettled) break;
  }
  return signs;
}

Solution PatchEquations::solve(Signs start, int rounds, bool layers) const {
  constexpr float kBack = 0.05F;  // of a patch's weight, so that it can come back
  Signs signs = std::move(start);
  const bool from_nothing = signs.isZero();
  for (int round = 0; round < rounds; ++round) {
    Eigen::VectorXf weights = areas_;
    Eigen::VectorXf targets = Eigen::VectorXf::Constant(areas_.size(), 0.5F);
    if (round > 0 || !from_nothing) {
      const Eigen::VectorXf w = fields_ * signs.cast<float>();
      for (Eigen::Index k = 0; k < w.size(); ++k) {
        const std::int32_t p = patches_.of[places_[static_cast<std::size_t>(k)]];
        if (p >= 0) {
          // Half a sign is enough to be asked.
          const auto sure = static_cast<float>(std::fabs(signs[p])) / 0.5F;
          weights[k] *= std::min(1.F, kBack + sure);
        }
        if (layers && w[k] > 1.F) targets[k] = std::floor(w[k]) + 0.5F;
      }
    }
    for (Eigen::Index k = 0; k < weights.size(); ++k) {
      if (patches_.of[places_[static_cast<std::size_t>(k)]] < 0) weights[k] = 0.F;
    }
    signs = descend(std::move(signs), weights, targets);
  }
  return judge(std::move(signs));
}

Solution PatchEquations::judge(Signs signs) const {
  Eigen::VectorXf whole(signs.size());
  for (Eigen::Index p = 0; p < signs.size(); ++p) {
    const bool decided = std::fabs(signs[p]) > static_cast<double>(kDecided);
    whole[p] = decided ? std::copysign(1.F, static_cast<float>(signs[p])) : 0.F;
  }
  Eigen::VectorXf w = fields_ * whole;
  if (w.dot(areas_) < 0.F) w = -w;
  float sum = 0.F;
  float decided = 0.F;
  float outside = 0.F;
  float asked = 0.F;
  for (Eigen::Index k = 0; k < w.size(); ++k) {
    const std::int32_t p = patches_.of[places_[static_cast<std::size_t>(k)]];
    if (p < 0) continue;
    asked += areas_[k];
    if (whole[p] == 0.F) {
      outside += areas_[k] * (0.5F - w[k]);
      continue;
    }
    const float from_whole = w[k] > 1.F ? w[k] - std::floor(w[k]) : w[k];
    sum += areas_[k] * std::min(kWorst, (from_whole - 0.5F) * (from_whole - 0.5F));
    decided += areas_[k];
  }
  std::vector<float> normals(4 * cells_.size(), 0.F);
  for (std::size_t c = 0; c < cells_.size(); ++c) {
    if (patches_.of[c] < 0) continue;
    for (std::size_t a = 0; a < 3; ++a) {
      normals[4 * c + a] = whole[patches_.of[c]] * cells_.normals[4 * c + a];
    }
  }
  Solution out;
  out.signs = std::move(signs);
  out.allowed = decided > 0.F && sum <= kGood * decided && outside <= kOutside * asked;
  out.energy = kPairs * brokenShare(cells_, normals);
  if (asked > 0.F) out.energy += (sum + kUndecided * (asked - decided)) / asked;
  return out;
}

// Of each cell, the sign of its patch. Half of an undecided patch may lie outside of the contact:
// its cells look which way the field of all decided ones falls.
std::vector<float> signsOfCells(const EvenCells& cells, const SignPatches& patches,
                                const Signs& signs, float radius, int threads) {
  std::vector<float> out(cells.size(), 0.F);
  std::vector<float> dipoles(4 * cells.size(), 0.F);
  std::vector<float> at;
  std::vector<std::uint32_t> undecided;
  for (std::size_t c = 0; c < cells.size(); ++c) {
    if (patches.of[c] >= 0) out[c] = static_cast<float>(signs[patches.of[c]]);
    const float* n = &cells.normals[4 * c];
    if (std::fabs(out[c]) > kDecided) {
      const float area = std::copysign(cells.areas[c], out[c]);
      for (std::size_t a = 0; a < 3; ++a) dipoles[4 * c + a] = area * n[a];
      dipoles[4 * c + 3] = cells.areas[c];
    } else {
      undecided.push_back(static_cast<std::uint32_t>(c));
      at.insert(at.end(), &cells.places[4 * c], &cells.places[4 * c] + 4);
    }
  }
  const std::vector<float> field = steepestDescents({at.data(), 4, undecided.size()},
                                                    {cells.points(), dipoles}, radius, threads);
  for (std::size_t k = 0; k < undecided.size(); ++k) {
    const std::size_t c = undecided[k];
    // A plane's falls by 1 / (2 radius).
    const float falls = 2.F * radius * dot(&field[4 * k], &cells.normals[4 * c]);
    if (std::isfinite(falls)) out[c] = std::clamp(out[c] + falls, -kDecided, kDecided);
  }
  return out;
}

// The sign of the nearest cell whose normal is that of the point; 0 if there is none around.
float signOf(const EvenCells& cells, const std::vector<float>& signs, const float* place,
             const float* normal, std::size_t cell) {
  constexpr float kAlike = 0.7F;  // 45 degrees
  float sign = 0.F;
  float least = std::numeric_limits<float>::max();
  for (int j = 0; j < cells.around.count(cell); ++j) {
    const auto c = static_cast<std::size_t>(cells.around.indices(cell)[j]);
    if (signs[c] == 0.F || dot(normal, &cells.normals[4 * c]) < kAlike) continue;
    float d[3];
    for (std::size_t a = 0; a < 3; ++a) d[a] = cells.places[4 * c + a] - place[a];
    if (dot(d, d) >= least) continue;
    least = dot(d, d);
    sign = signs[c];
  }
  return sign;
}

void takeSigns(const PointView& points, const EvenCells& cells, const std::vector<float>& signs,
               AutoNormals& found) {
  for (std::size_t i = 0; i < points.size; ++i) {
    float* n = &found.normals[4 * i];
    if (!std::isfinite(n[0])) continue;
    const float sign = signOf(cells, signs, points[i], n, cells.cell_of[i]);
    found.confidences[i] = std::min(found.confidences[i], std::fabs(sign));
    if (sign >= 0.F) continue;
    for (std::size_t a = 0; a < 3; ++a) n[a] = -n[a];
  }
}

// The one solution from nothing; not allowed where cells do not make a surface.
Solution solveFromNothing(const PatchEquations& equations) {
  float surface = 0.F;
  for (const float share : equations.patches().areas) surface += share;
  if (equations.size() == 0 || surface < 1.F - kNoSurface) return {};
  return equations.solve(Signs::Zero(static_cast<Eigen::Index>(equations.size())), 1, false);
}

// A coarse look at a large cloud, for a tenth of the time: open sheets bound no bodies.
bool mayBoundBodies(const PointView& points, int threads, const AutoNormals& found) {
  constexpr float kCoarse = 50000.F;  // cells
  const float size = std::sqrt(static_cast<float>(points.size) / kCoarse);
  if (size <= 2.F * kCell) return true;
  const float radius = size * found.spacing;
  const EvenCells cells = gatherCells(points, found.normals, radius, threads);
  return solveFromNothing({cells, kSmooth / kCell * radius, threads}).allowed;
}

}  // namespace

void solvePatchSigns(const PointView& points, int threads, AutoNormals& found) {
  if (isClosed(found) || !mayBoundBodies(points, threads, found)) return;
  const EvenCells cells = gatherCells(points, found.normals, kCell * found.spacing, threads);
  const float radius = kSmooth * found.spacing;
  const PatchEquations equations(cells, radius, threads);
  const Solution first = solveFromNothing(equations);
  if (!first.allowed) return;
  const Signs own = Signs::Constant(first.signs.size(), equations.side());
  Solution best;
  best.energy = kBetter * equations.judge(own).energy;
  for (const Solution& other : {first, equations.solve(first.signs, kRounds - 1, false),
                                equations.solve(own, kRounds, true)}) {
    if (other.allowed && other.energy < best.energy) best = other;
  }
  if (!best.allowed) return;
  takeSigns(points, cells, signsOfCells(cells, equations.patches(), best.signs, radius, threads),
            found);
}

}  // namespace segorient::detail
