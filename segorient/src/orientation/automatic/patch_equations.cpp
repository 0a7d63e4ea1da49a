// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/automatic/patch_equations.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/every_nth.h"
#include "common/parallel_for.h"
#include "orientation/winding/dipole_fields.h"

namespace segorient::detail {
namespace {

// Places where the winding number is asked: eight and more for each sign.
constexpr std::size_t kPlaces = 4000;
// More are many small parts, of which four places each tell no sign, and memory and time go by the
// square. Patches of full size are 500; of 126 clouds the most were 526.
constexpr std::size_t kMostPatches = kPlaces / 4;
// So that smoothness and the winding number weigh alike: a patch of 80 cells has some 27 pairs of
// neighbours across each of four sides. Opposed across one side it pays for 32 cells, on the wrong
// side of its surface for 80.
constexpr double kSmoothness = 0.3;
constexpr double kTie = 1e-3;         // of a patch's share: what no place sees stays 0
constexpr int kSweeps = 200;          // at most
constexpr double kSettled = 1e-3;     // of a whole sign
constexpr float kPairs = 3.F;         // as in SignEnergy: pairs of neighbours in terms of a share
constexpr float kUndecided = 0.125F;  // between the right side, 0, and the wrong one
constexpr float kWorst = 0.25F;       // on the wrong side, or where the winding number says nothing
// What is left undecided is in contact, with the inside around it: w is 1 there, not 0. Times the
// share of the surface: at most .02 of bodies in contact, .06 to .13 of open sheets that were
// rolled up to bodies.
constexpr float kOutside = 0.03F;
// The square of .2: w is off by a fifth on the average. Joints of bodies in contact and their edges
// make .09 to .19, rolled sheets that a false wall closes .21 and more.
constexpr float kGood = 0.04F;

}  // namespace

PatchEquations::PatchEquations(const EvenCells& cells, float radius, int threads)
    : cells_(cells), patches_(growPatches(cells)) {
  if (patches_.size() > kMostPatches) {
    patches_ = {};
    return;
  }
  for (const std::size_t c : EveryNth(cells.size(), kPlaces)) {
    places_.push_back(static_cast<std::uint32_t>(c));
    patch_at_.push_back(patches_.of[c]);
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
  const std::vector<float> dipoles = dipolesOf(cells_.normals, cells_.areas);
  const PointView places{at.data(), 4, places_.size()};
  fields_.resize(areas_.size(), static_cast<Eigen::Index>(size()));
  parallelFor(size(), threads, 1e5, [&](std::size_t p) {
    const std::vector<float> w =
        windingNumbers(places, {cells_.points(), dipoles, &patches_.cells[p]}, radius, 1);
    std::copy(w.begin(), w.end(), fields_.col(static_cast<Eigen::Index>(p)).data());
  });
}

// Each sign in turn takes its best value while the others stay: down to the one minimum, as the sum
// is convex.
Signs PatchEquations::descend(Signs signs, const Eigen::VectorXf& weights) const {
  const auto n = static_cast<Eigen::Index>(size());
  const Eigen::MatrixXf weighted = weights.cwiseSqrt().asDiagonal() * fields_;
  Eigen::MatrixXf squares = Eigen::MatrixXf::Zero(n, n);
  squares.selfadjointView<Eigen::Lower>().rankUpdate(weighted.transpose());
  squares.triangularView<Eigen::StrictlyUpper>() = squares.transpose();
  Eigen::MatrixXd matrix = squares.cast<double>();
  Signs wanted(n);
  for (Eigen::Index p = 0; p < n; ++p) {
    wanted[p] = 0.5 * static_cast<double>(fields_.col(p).dot(weights));
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

PatchSolution PatchEquations::solve(Signs start, int rounds) const {
  constexpr float kBack = 0.05F;  // of a patch's weight, so that it can come back
  Signs signs = std::move(start);
  const bool from_nothing = signs.isZero();
  for (int round = 0; round < rounds; ++round) {
    Eigen::VectorXf weights = areas_;
    for (Eigen::Index k = 0; k < weights.size(); ++k) {
      const std::int32_t p = patch_at_[static_cast<std::size_t>(k)];
      if (p < 0) {
        weights[k] = 0.F;
      } else if (round > 0 || !from_nothing) {
        // Half a sign is enough to be asked.
        weights[k] *= std::min(1.F, kBack + 2.F * static_cast<float>(std::fabs(signs[p])));
      }
    }
    signs = descend(std::move(signs), weights);
  }
  return judge(std::move(signs));
}

PatchSolution PatchEquations::judge(Signs signs) const {
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
    const std::int32_t p = patch_at_[static_cast<std::size_t>(k)];
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
  PatchSolution out;
  out.signs = std::move(signs);
  out.allowed = decided > 0.F && sum <= kGood * decided && outside <= kOutside * asked;
  out.energy = kPairs * brokenShare(cells_, normals);
  if (asked > 0.F) out.energy += (sum + kUndecided * (asked - decided)) / asked;
  return out;
}

}  // namespace segorient::detail
