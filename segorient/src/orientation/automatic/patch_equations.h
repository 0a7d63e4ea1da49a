// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <vector>

#include "orientation/automatic/even_cells.h"
#include "orientation/automatic/sign_patches.h"

namespace segorient::detail {

/// One for each patch.
using Signs = Eigen::VectorXd;

/// Signs of patches below this are undecided: a third of the way from "either" to "this side".
constexpr float kDecided = 0.3F;

struct PatchSolution {
  Signs signs;           ///< -1 to 1
  float energy = 0.F;    ///< by whole signs, see PatchEquations::judge()
  bool allowed = false;  ///< what is decided bounds bodies, and what is not lies between them
};

/// The sum that signs of patches minimise, see findCellSigns().
class PatchEquations {
 public:
  /// \param cells must outlive this \param radius of the smoothing
  PatchEquations(const EvenCells& cells, float radius, int threads);

  std::size_t size() const { return patches_.size(); }
  const SignPatches& patches() const { return patches_; }

  /// \param start signs; all 0 for none
  PatchSolution solve(Signs start, int rounds) const;
  /// By whole signs: mean square difference of the winding number from the middle between two whole
  /// numbers, over what is decided, with neighbours that contradict each other.
  PatchSolution judge(Signs signs) const;

 private:
  void findFields(float radius, int threads);
  Signs descend(Signs signs, const Eigen::VectorXf& weights) const;

  const EvenCells& cells_;
  SignPatches patches_;
  std::vector<std::uint32_t> places_;   // cells
  std::vector<std::int32_t> patch_at_;  // patch of each place, -1 where there is none
  Eigen::VectorXf areas_;               // of places, as shares of all
  Eigen::MatrixXf fields_;              // winding number of each patch (column) at each place (row)
};

}  // namespace segorient::detail
