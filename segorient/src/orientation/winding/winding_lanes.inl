// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
//
// Winding numbers of kPlaces places side by side, times 4 pi, for one instruction set; see
// lanes.inl. Each lane adds what WindingNumber::evaluate() adds for its place, in the same order.

#include "common/lanes.inl"

using Doubles = SEGORIENT_VECTOR(double, SEGORIENT_LANES);

/// Adds a dipole's part, where `counts` says so.
/// \param d from the place to the dipole \param s its square
inline void addTerm(const float* dipole, const Lanes3& d, Lanes s, Mask counts, Doubles& sum) {
  const Lanes term = (dipole[0] * d.x + dipole[1] * d.y + dipole[2] * d.z) / (s * squareRoot(s));
  sum += SEGORIENT_CONVERTED(select(counts, term, Lanes{}), Doubles);
}

inline void evaluateLanes(const WindingTree& tree, const PlaceBlock& at, std::size_t first,
                          float* out) {
  const Lanes3 x{load(&at.x[first]), load(&at.y[first]), load(&at.z[first])};
  const Lanes radius = load(&at.radius[first]);
  const Lanes r2 = radius * radius;
  Doubles sum{};
  Mask resume{};  // the node from which on a lane walks on
  for (std::uint32_t i = 0; i < tree.count;) {
    const WindingNode& node = tree.nodes[i];
    const Lanes3 d{node.center[0] - x.x, node.center[1] - x.y, node.center[2] - x.z};
    const Lanes s = dot(d, d);
    const float reach = kFar * kFar * node.radius * node.radius;
    const Mask walks = resume <= static_cast<std::int32_t>(i);
    const Mask far = walks & (s > reach) & (s > 4.F * r2);
    if (any(far)) {
      addTerm(node.dipole, d, s, far, sum);
      resume = SEGORIENT_CHOSEN(far, Mask{} + static_cast<std::int32_t>(node.skip), resume);
    }
    const Mask near = walks & ~far;
    if (!any(near)) {
      i = node.skip;
      continue;
    }
    for (std::uint32_t j = node.first; j < node.first + node.size; ++j) {
      const std::size_t row = tree.rows != nullptr ? tree.rows[j] : j;
      const float* q = tree.points[row];
      const Lanes3 e{q[0] - x.x, q[1] - x.y, q[2] - x.z};
      addTerm(tree.dipoles + 4 * row, e, larger(dot(e, e), r2), near, sum);
    }
    ++i;
  }
  for (std::size_t l = 0; l < kWidth; ++l) out[first + l] = static_cast<float>(sum[l]);
}

inline void evaluateBlock(const WindingTree& tree, const PlaceBlock& at, float* out) {
  for (std::size_t first = 0; first < kPlaces; first += kWidth) {
    evaluateLanes(tree, at, first, out);
  }
}
