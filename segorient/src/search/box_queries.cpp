// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <cstring>
#include <memory>

#include "search/index_impl.h"

namespace segorient::search {

MedianHashIndex::Impl::~Impl() {
  delete boxes.load();
}

// Two threads may make it at the same time; the first to be done is kept.
BoxTree& MedianHashIndex::Impl::boxTree() const {
  BoxTree* made = boxes.load(std::memory_order_acquire);
  if (made != nullptr) return *made;
  auto fresh = std::make_unique<BoxTree>(layout);
  if (boxes.compare_exchange_strong(made, fresh.get(), std::memory_order_acq_rel)) {
    made = fresh.release();
  }
  return *made;
}

std::size_t MedianHashIndex::Impl::boxesMemory() const {
  const BoxTree* made = boxes.load(std::memory_order_acquire);
  return made != nullptr ? made->memory() : 0;
}

bool MedianHashIndex::Impl::searchBoxes(const float* q, std::size_t k, float prune,
                                        std::vector<std::uint64_t>& keys, pcl::index_t* indices,
                                        float* distances) const {
  if (!boxesServe(k)) return false;
  // What is approximate must not depend on which regions were made before.
  const bool may_lack = k > kMostInOnePlace;
  if (may_lack && prune != 1.0F) return false;
  BoxTree& tree = boxTree();
  if (may_lack && tree.isThinned()) return false;
  keys.resize(k);
  BoxSearch search{{q[0], q[1], q[2]},
                   prune,
                   {keys.data(), k, 0.0F},
                   [](BoxTree& of, std::size_t region) { return of.region(region); },
                   &tree};
  kernels->nearestInBoxes(search, tree.root());
  if (may_lack && tree.isThinned()) return false;
  for (std::size_t i = 0; i < k; ++i) {
    const auto bits = static_cast<std::uint32_t>(keys[i] >> 32U);
    std::memcpy(distances + i, &bits, sizeof(bits));
    indices[i] = static_cast<pcl::index_t>(static_cast<std::uint32_t>(keys[i]));
  }
  // Places that were not taken: distances overflow.
  return distances[k - 1] < std::numeric_limits<float>::infinity();
}

}  // namespace segorient::search
