// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <cstdint>
#include <vector>

#include "render/projection.h"

namespace segorient::program {

/// What a picture shows of a splat.
enum class Seen : std::uint8_t {
  Front,
  Back,   ///< seen from behind
  Hidden  ///< seen from behind, and behind surface that faces the viewer: not drawn
};

/// Which side of each splat is seen; its front is the true side as far as that is known.
///
/// Of a closed surface that is never the back: what faces away is hidden by what does not, whatever
/// sticks out between points. Elsewhere the back may be seen:
///
/// A disc is larger than what it stands for, so that surfaces look closed; at outlines and edges it
/// sticks out from behind the surface that hides its point. So each point is judged, not each
/// pixel: a point that faces away is drawn only if no surface that faces the viewer lies before the
/// point itself. Where the surface turns as far within the disc as its normal faces away, the
/// viewer may see either side, and it counts as the front.
///
/// \param sides of each splat as firstLook() judges it
void judgeSides(const std::vector<Splat>& splats, const std::vector<FlatSplat>& flat,
                const View& view, float scale, std::vector<Seen>& sides);

/// What its own normal tells. A surface that bends away from the viewer within a disc is still
/// seen.
inline Seen firstLook(const Splat& splat, const FlatSplat& flat) {
  if (flat.normal[2] >= 0.F) return Seen::Front;
  if (!isClosed(splat.side)) return Seen::Back;
  return -flat.normal[2] >= splat.turn ? Seen::Hidden : Seen::Front;
}

}  // namespace segorient::program
