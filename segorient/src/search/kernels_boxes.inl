// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
//
// The search through boxes in boxes, for queries away from the points.

inline std::uint32_t bitsOf(float v) {
  std::uint32_t bits = 0;
  copyBytes(&bits, &v, sizeof(bits));
  return bits;
}
inline float floatOf(std::uint32_t bits) {
  float v = 0.0F;
  copyBytes(&v, &bits, sizeof(v));
  return v;
}

// Frees all places for points nearer than a limit.
inline void reset(NearestKeys& best, float limit) {
  for (std::size_t i = 0; i < best.k; ++i) best.keys[i] = std::uint64_t{bitsOf(limit)} << 32U;
  best.limit = limit;
}

// A point as far as the last one may still replace it by a smaller id, so that the limit is the
// next larger float.
inline void insert(NearestKeys& best, float distance, std::uint32_t id) {
  const std::uint64_t key = std::uint64_t{bitsOf(distance)} << 32U | id;
  std::size_t at = best.k - 1;
  if (key >= best.keys[at]) return;
  for (; at > 0 && key < best.keys[at - 1]; --at) best.keys[at] = best.keys[at - 1];
  best.keys[at] = key;
}
inline void tighten(NearestKeys& best) {
  const auto last = static_cast<std::uint32_t>(best.keys[best.k - 1] >> 32U);
  const float next = floatOf(last + 1);
  best.limit = next < best.limit ? next : best.limit;
}

// Squared distances to all points of a leaf or boxes of a node. \return the lanes below a limit
inline unsigned int distancesTo(const PointLeaf& leaf, const float* q, float limit, float* out) {
  unsigned int near = 0;
  for (std::size_t i = 0; i < kBoxFanOut; i += kWidth) {
    const Vector d = squaredNorm(broadcast(q[0]) - load(leaf.xyz[0] + i),
                                 broadcast(q[1]) - load(leaf.xyz[1] + i),
                                 broadcast(q[2]) - load(leaf.xyz[2] + i));
    store(d, out + i);
    near |= lessMask(d, broadcast(limit)) << i;
  }
  return near;
}
inline unsigned int distancesTo(const BoxNode& node, const float* q, float limit, float* out) {
  unsigned int near = 0;
  for (std::size_t i = 0; i < kBoxFanOut; i += kWidth) {
    Vector gaps[3];
    for (int a = 0; a < 3; ++a) {
      const Vector at = broadcast(q[a]);
      gaps[a] = largestOf(largestOf(load(node.lo[a] + i) - at, at - load(node.hi[a] + i)),
                          broadcast(0.0F));
    }
    const Vector d = squaredNorm(gaps[0], gaps[1], gaps[2]);
    store(d, out + i);
    near |= lessMask(d, broadcast(limit)) << i;
  }
  return near;
}

inline void scanLeaf(const PointLeaf& leaf, BoxSearch& search) {
  float distance[kBoxFanOut];
  unsigned int near = distancesTo(leaf, search.query, search.best.limit, distance);
  if (near == 0) return;
  for (; near != 0; near &= near - 1) {
    const auto lane = std::size_t{lowestBit(near)};
    insert(search.best, distance[lane], leaf.id[lane]);
  }
  tighten(search.best);
}

inline std::size_t nearestLane(const float* distance, unsigned int lanes) {
  auto nearest = std::size_t{lowestBit(lanes)};
  for (lanes &= lanes - 1; lanes != 0; lanes &= lanes - 1) {
    const auto lane = std::size_t{lowestBit(lanes)};
    if (distance[lane] < distance[nearest]) nearest = lane;
  }
  return nearest;
}

// Always down into the nearest box: how far the k nearest are at most.
inline void firstLimit(BoxSearch& search, const BoxNode* node) {
  float distance[kBoxFanOut];
  while (node->leaves == nullptr) {
    const unsigned int lanes = distancesTo(*node, search.query, kLargest, distance);
    if (lanes == 0) return;
    const std::size_t lane = nearestLane(distance, lanes);
    node = node->nodes != nullptr ? node->nodes + lane
                                  : search.region(*search.tree, node->first_region + lane);
  }
  unsigned int lanes = distancesTo(*node, search.query, kLargest, distance);
  while (lanes != 0) {
    const std::size_t lane = nearestLane(distance, lanes);
    if (!(distance[lane] < search.best.limit)) break;
    lanes &= ~(1U << lane);
    scanLeaf(node->leaves[lane], search);
  }
  reset(search.best, search.best.limit);
}

// What is still to be looked at.
struct BoxEntry {
  float distance;
  std::uint32_t region;  // where there is no node
  const BoxNode* node;
};

// Puts the lanes onto the stack, the nearest last.
inline std::size_t pushNear(const BoxNode& node, const float* distance, unsigned int lanes,
                            BoxEntry* stack, std::size_t depth) {
  const std::size_t bottom = depth;
  for (; lanes != 0; lanes &= lanes - 1) {
    const auto lane = std::uint32_t{lowestBit(lanes)};
    std::size_t at = depth++;
    for (; at > bottom && stack[at - 1].distance < distance[lane]; --at) stack[at] = stack[at - 1];
    stack[at] = {distance[lane], node.first_region + lane,
                 node.nodes != nullptr ? node.nodes + lane : nullptr};
  }
  return depth;
}

void nearestInBoxes(BoxSearch& search, const BoxNode* root) {
  reset(search.best, floatOf(0x7f800000U));
  // Where results are approximate, what led to the limit would not be found again.
  if (search.prune == 1.0F) firstLimit(search, root);
  // Fifteen more at each level; there are up to seven above the regions and four in one.
  BoxEntry stack[192];
  std::size_t depth = 0;
  stack[depth++] = {0.0F, 0, root};
  while (depth > 0) {
    const BoxEntry entry = stack[--depth];
    const float bound = search.best.limit * search.prune;
    if (!(entry.distance < bound)) continue;
    const BoxNode* const node =
        entry.node != nullptr ? entry.node : search.region(*search.tree, entry.region);
    float distance[kBoxFanOut];
    unsigned int lanes = distancesTo(*node, search.query, bound, distance);
    if (node->leaves == nullptr) {
      depth = pushNear(*node, distance, lanes, stack, depth);
      continue;
    }
    while (lanes != 0) {
      const std::size_t lane = nearestLane(distance, lanes);
      if (!(distance[lane] < search.best.limit * search.prune)) break;
      lanes &= ~(1U << lane);
      scanLeaf(node->leaves[lane], search);
    }
  }
}
