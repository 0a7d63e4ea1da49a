// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "features/recompute_scene.h"

namespace segorient::detail {

/// What the one-sided rule knows of a point while votes are counted.
enum class LookState : std::uint8_t { UNTOUCHED, EXAMINED, MIDDLE, SHARP };

/// A patch and the points that it serves: a range of the points looked at.
struct Patch {
  std::size_t middle = 0;
  std::size_t begin = 0;
  std::size_t end = 0;
};

/// The points to look at, patch by patch, and some patches spread evenly over the cloud.
struct Looks {
  std::vector<std::size_t> points;
  std::vector<Patch> patches;
  std::vector<std::size_t> sample;
};

/// The points at borders, on patches that are laid greedily: each point becomes the middle of one
/// that has none among its nearest. By coordinates, so that nothing depends on their order.
/// \param[in,out] state of all points, UNTOUCHED before
Looks layPatches(const RecomputationScene& scene, std::vector<LookState>& state);

}  // namespace segorient::detail
