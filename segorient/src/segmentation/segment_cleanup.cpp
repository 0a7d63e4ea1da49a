// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "common/parallel_for.h"
#include "segmentation/clean_up.h"

namespace segorient::segmentation {

CleanUp::CleanUp(const SegmentationOptions& options, GrowthState& state)
    : options_(options),
      state_(state),
      small_size_(static_cast<std::uint32_t>(std::min(options.small_size, state.nodes.size() + 1))),
      adjacency_(state, small_size_, options.threads),
      cos_join_(cosineOf(options.beta + options.epsilon)),
      cos_alpha_(cosineOf(options.alpha)) {}

void CleanUp::add(std::int32_t label, std::uint32_t points, std::vector<Count>& counts) {
  const auto it =
      std::find_if(counts.begin(), counts.end(), [&](const Count& c) { return c.label == label; });
  if (it == counts.end()) {
    counts.push_back({label, points});
  } else {
    it->points += points;
  }
}

void CleanUp::listHosts(std::int32_t label, Room& room, Hosts& hosts) const {
  hosts.counts.clear();
  hosts.total = 0;
  room.seen.clear();
  room.admitted.clear();
  adjacency_.forEachAround(label, [&](std::size_t p, std::size_t q) {
    if (room.seen.insert(q)) ++hosts.total;
    if (!state_.joins(q, p) || !room.admitted.insert(q)) return;
    add(state_.labels[q], 1, hosts.counts);
  });
}

// Pass 1, one segment: the neighbouring segment of the smallest angle among those that hold enough
// of the points around, or -1.
// \param hosts as listed at any time since other segments joined this one
std::int32_t CleanUp::bestHost(std::int32_t label, const Hosts& hosts) {
  counts_.clear();
  for (const Count& c : hosts.counts) add(joined_to_.find(c.label), c.points, counts_);
  const NormalSum& own = state_.clusters[static_cast<std::size_t>(label)].normal;
  std::int32_t best = -1;
  double best_cosine = cos_join_;
  for (const Count& c : counts_) {
    if (static_cast<float>(c.points) <= options_.neighbor_share * static_cast<float>(hosts.total))
      continue;
    const NormalSum& other = state_.clusters[static_cast<std::size_t>(c.label)].normal;
    const double cosine =
        std::abs(own.dot(other)) / std::sqrt(own.squaredNorm() * other.squaredNorm());
    if (cosine > best_cosine || (cosine == best_cosine && best >= 0 && c.label < best)) {
      best_cosine = cosine;
      best = c.label;
    }
  }
  return best;
}

void CleanUp::join(std::int32_t from, std::int32_t into) {
  Cluster& source = state_.clusters[static_cast<std::size_t>(from)];
  Cluster& target = state_.clusters[static_cast<std::size_t>(into)];
  const double sign = target.normal.dot(source.normal) < 0.0 ? -1.0 : 1.0;
  adjacency_.forEachPoint(from, [&](std::size_t p) {
    state_.labels[p] = into;
    if (sign < 0.0) state_.turn(p);
  });
  target.normal.add(source.normal, sign);
  target.size += source.size;
  source = Cluster{};
  joined_to_.hang(from, into);
  adjacency_.append(from, into);
}

// Ascending size; a small segment that has taken in another one has its turn again at its new size.
// What is around the others is listed beforehand, on all threads, for so many at once.
std::size_t CleanUp::absorbSmall() {
  constexpr std::size_t kListed = 1U << 16U;
  constexpr double kPointTime = 1000.0;  // ns, see resolveThreads()
  std::size_t absorbed = 0;
  std::vector<std::vector<std::int32_t>> by_size(small_size_);
  joined_to_ = detail::DisjointSets(state_.clusters.size());
  for (std::size_t s = 0; s < state_.clusters.size(); ++s) {
    const std::uint32_t size = state_.clusters[s].size;
    if (size < small_size_) by_size[size].push_back(static_cast<std::int32_t>(s));
  }
  std::vector<std::int32_t> order;
  std::vector<std::size_t> first_turns(small_size_, 0);
  for (std::uint32_t size = 1; size < small_size_; ++size) {
    order.insert(order.end(), by_size[size].begin(), by_size[size].end());
    first_turns[size] = by_size[size].size();
  }
  std::vector<Hosts> listed(std::min(kListed, order.size()));
  Room room;
  Hosts own;
  std::size_t turn = 0;
  for (std::uint32_t size = 1; size < small_size_; ++size) {
    for (std::size_t i = 0; i < by_size[size].size(); ++i) {
      if (i < first_turns[size] && turn % kListed == 0) {
        const std::size_t count = std::min(kListed, order.size() - turn);
        parallelFor(
            count, options_.threads, timeOfEach(order.size(), adjacency_.size(), kPointTime),
            [] { return Room(); },
            [&](std::size_t h, Room& of_thread) {
              listHosts(order[turn + h], of_thread, listed[h]);
            });
      }
      const std::size_t at = i < first_turns[size] ? turn++ % kListed : kListed;
      const std::int32_t label = by_size[size][i];
      if (state_.clusters[static_cast<std::size_t>(label)].size != size) continue;
      if (at == kListed) listHosts(label, room, own);
      const std::int32_t host = bestHost(label, at == kListed ? own : listed[at]);
      if (host < 0) continue;
      join(label, host);
      ++absorbed;
      const std::uint32_t new_size = state_.clusters[static_cast<std::size_t>(host)].size;
      if (new_size < small_size_) by_size[new_size].push_back(host);
    }
  }
  return absorbed;
}

// Pass 2, one point: into the regular segment whose reference normal is nearest to its own.
bool CleanUp::tryExtract(std::uint32_t slot) {
  const std::size_t p = adjacency_.point(slot);
  const std::int32_t own = state_.labels[p];
  std::int32_t best = -1;
  double best_cosine = cos_join_;
  std::int32_t last = own;  // neighbours next to each other mostly have one label
  const auto consider = [&](std::size_t q) {
    const std::int32_t label = state_.labels[q];
    if (label == last || label == own) return;
    last = label;
    if (!isFace(label) || !state_.supports(p, label)) return;
    const NormalSum& reference = state_.clusters[static_cast<std::size_t>(label)].normal;
    const double cosine =
        std::abs(reference.dot(state_.nodes[p]) / std::sqrt(reference.squaredNorm()));
    if (cosine > best_cosine || (cosine == best_cosine && best >= 0 && label < best)) {
      best_cosine = cosine;
      best = label;
    }
  };
  if (state_.support > 0) {
    adjacency_.forEachMarkedInRow(slot, consider);
  } else {
    adjacency_.forEachMarked(slot, consider);
  }
  if (best < 0) return false;
  state_.move(p, best);
  return true;
}

// A point is tried again whenever a neighbour of it has moved, until nothing moves.
std::size_t CleanUp::extractEdges() {
  constexpr std::size_t kAhead = 8;  // the memory is asked for their rows
  std::size_t extracted = 0;
  adjacency_.mark(options_.threads, [this](std::size_t p, std::size_t q) {
    return std::abs(dotNormals(state_.nodes[p], state_.nodes[q])) > cos_alpha_ &&
           state_.joins(q, p);
  });
  std::vector<std::uint32_t> queue;
  std::vector<std::uint8_t> queued(adjacency_.size(), 0);
  for (std::uint32_t slot = 0; slot < adjacency_.size(); ++slot) {
    if (isFace(state_.labels[adjacency_.point(slot)])) continue;
    queue.push_back(slot);
    queued[slot] = 1;
  }
  for (std::size_t head = 0; head < queue.size(); ++head) {
    if (head + kAhead < queue.size()) state_.fetchRow(adjacency_.point(queue[head + kAhead]));
    const std::uint32_t slot = queue[head];
    queued[slot] = 0;
    if (isFace(state_.labels[adjacency_.point(slot)]) || !tryExtract(slot)) continue;
    ++extracted;
    adjacency_.forEachNeighbor(slot, [&](std::size_t q) {
      const std::uint32_t other = adjacency_.slot(q);
      if (other == SmallAdjacency::kNone || queued[other] != 0 || isFace(state_.labels[q])) return;
      queue.push_back(other);
      queued[other] = 1;
    });
  }
  return extracted;
}

// Pass 3: union-find over the small segments that touch.
void CleanUp::connectSmall() {
  detail::DisjointSets sets(state_.clusters.size());
  for (std::uint32_t slot = 0; slot < adjacency_.size(); ++slot) {
    const std::int32_t own = state_.labels[adjacency_.point(slot)];
    if (!isSmall(own)) continue;
    adjacency_.forEachNeighbor(slot, [&](std::size_t q) {
      const std::int32_t other = state_.labels[q];
      if (other == own || !isSmall(other)) return;
      if (PairLimits::facing(state_.nodes[adjacency_.point(slot)], state_.nodes[q])) return;
      sets.join(own, other);
    });
  }
  std::vector<std::int8_t> sign(state_.clusters.size(), 1);
  for (std::size_t s = 0; s < state_.clusters.size(); ++s) {
    Cluster& cluster = state_.clusters[s];
    const auto root = static_cast<std::size_t>(sets.find(static_cast<std::int32_t>(s)));
    if (root == s || cluster.size == 0) continue;
    Cluster& target = state_.clusters[root];
    if (target.normal.dot(cluster.normal) < 0.0) sign[s] = -1;
    target.normal.add(cluster.normal, sign[s]);
    target.size += cluster.size;
    state_.kinds[root] = SegmentKind::CONNECTED;
    cluster = Cluster{};
  }
  for (std::uint32_t slot = 0; slot < adjacency_.size(); ++slot) {
    const std::size_t p = adjacency_.point(slot);
    const std::int32_t own = state_.labels[p];
    if (sign[static_cast<std::size_t>(own)] < 0) state_.turn(p);
    state_.labels[p] = sets.find(own);
  }
}

void findStrips(const SegmentationOptions& options, GrowthState& state) {
  // The inside of a band of w spacings is about 1 - 2 / w of it.
  constexpr std::uint32_t kPointsPerInner = 4;
  std::vector<std::uint32_t> inner;
  inner.reserve(state.clusters.size());
  for (const Cluster& cluster : state.clusters) inner.push_back(cluster.size);
  for (const pcl::index_t index : state.border) {
    const auto p = static_cast<std::size_t>(index);
    const std::int32_t label = state.labels[p];
    const pcl::index_t* row = state.neighborhoods->indices(p);
    const int count = std::min(state.neighborhoods->count(p), kRing + 1);
    bool inside = true;
    for (int j = 1; j < count && inside; ++j) {
      const auto q = static_cast<std::size_t>(row[j]);
      inside = state.labels[q] == label || !state.limits.near(state.nodes[p], state.nodes[q]);
    }
    inner[static_cast<std::size_t>(label)] -= inside ? 0U : 1U;
  }
  for (std::size_t s = 0; s < inner.size(); ++s) {
    const std::uint32_t size = state.clusters[s].size;
    state.strips[s] = size >= options.small_size && kPointsPerInner * inner[s] < size ? 1 : 0;
  }
}

void setKinds(const SegmentationOptions& options, GrowthState& state) {
  state.kinds.assign(state.clusters.size(), SegmentKind::REGULAR);
  for (std::size_t s = 0; s < state.clusters.size(); ++s) {
    if (state.clusters[s].size < options.small_size) state.kinds[s] = SegmentKind::ISOLATED;
  }
}

void cleanUp(const SegmentationOptions& options, GrowthState& state, SegmentationReport* report) {
  if (options.settle_edges) findStrips(options, state);
  CleanUp passes(options, state);
  const std::size_t absorbed = options.absorb_small ? passes.absorbSmall() : 0;
  const std::size_t extracted = options.extract_edges ? passes.extractEdges() : 0;
  const std::size_t settled = options.settle_edges ? settleEdges(options, state) : 0;
  setKinds(options, state);
  if (options.connect_small) passes.connectSmall();
  if (report == nullptr) return;
  report->absorbed = absorbed;
  report->extracted = extracted;
  report->settled = settled;
}

}  // namespace segorient::segmentation
