// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <segorient/common/threads.h>
#include <segorient/search/median_hash_index.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

namespace segorient::search {
namespace {

constexpr std::size_t kLeafSize = 32;

struct Node {
  std::array<float, 3> lo, hi;
  std::uint32_t begin, end;
  std::uint32_t left, right;  // 0 = leaf
};

// Every rounding is monotone, so this is never above the rounded distance to a point of the box.
float boxDistance(const Node& node, const float* q) {
  float sum = 0.0F;
  for (std::size_t a = 0; a < 3; ++a) {
    const float d = std::max(std::max(node.lo[a] - q[a], q[a] - node.hi[a]), 0.0F);
    sum += d * d;
  }
  return sum;
}

struct Found {
  float distance;
  pcl::index_t index;
  bool operator<(const Found& o) const {
    return distance < o.distance || (distance == o.distance && index < o.index);
  }
};

}  // namespace

struct MedianHashIndex::Impl {
  Options options;
  std::size_t rows = 0;
  std::vector<float> xyz;           // 3 a point, in tree order
  std::vector<std::uint32_t> row;   // row given to build()
  std::vector<pcl::index_t> index;  // index reported
  std::vector<Node> nodes;

  std::uint32_t makeNode(std::vector<std::uint32_t>& order, const std::vector<float>& raw,
                         std::uint32_t begin, std::uint32_t end) {
    Node node{};
    node.begin = begin;
    node.end = end;
    for (std::size_t a = 0; a < 3; ++a) {
      node.lo[a] = std::numeric_limits<float>::infinity();
      node.hi[a] = -std::numeric_limits<float>::infinity();
      for (std::uint32_t i = begin; i < end; ++i) {
        node.lo[a] = std::min(node.lo[a], raw[3 * order[i] + a]);
        node.hi[a] = std::max(node.hi[a], raw[3 * order[i] + a]);
      }
    }
    const auto id = static_cast<std::uint32_t>(nodes.size());
    nodes.push_back(node);
    if (end - begin <= kLeafSize) return id;
    std::size_t axis = 0;
    for (std::size_t a = 1; a < 3; ++a) {
      if (node.hi[a] - node.lo[a] > node.hi[axis] - node.lo[axis]) axis = a;
    }
    const std::uint32_t mid = begin + (end - begin) / 2;
    std::nth_element(
        order.begin() + begin, order.begin() + mid, order.begin() + end,
        [&](std::uint32_t i, std::uint32_t j) { return raw[3 * i + axis] < raw[3 * j + axis]; });
    const std::uint32_t left = makeNode(order, raw, begin, mid);
    const std::uint32_t right = makeNode(order, raw, mid, end);
    nodes[id].left = left;
    nodes[id].right = right;
    return id;
  }

  // `best` is a max-heap of at most k.
  void searchK(std::uint32_t id, const float* q, std::size_t k, pcl::index_t self,
               std::vector<Found>& best) const {
    const Node& node = nodes[id];
    if (node.left == 0) {
      for (std::uint32_t i = node.begin; i < node.end; ++i) offer(i, q, k, self, best);
      return;
    }
    std::uint32_t first = node.left;
    std::uint32_t second = node.right;
    float near = boxDistance(nodes[first], q);
    float far = boxDistance(nodes[second], q);
    if (far < near) {
      std::swap(first, second);
      std::swap(near, far);
    }
    if (best.size() < k || near <= best.front().distance) searchK(first, q, k, self, best);
    if (best.size() < k || far <= best.front().distance) searchK(second, q, k, self, best);
  }

  void offer(std::uint32_t i, const float* q, std::size_t k, pcl::index_t self,
             std::vector<Found>& best) const {
    const float dx = q[0] - xyz[3 * i];
    const float dy = q[1] - xyz[3 * i + 1];
    const float dz = q[2] - xyz[3 * i + 2];
    // The point itself goes before its duplicates.
    const Found found{dx * dx + dy * dy + dz * dz, index[i] == self ? -1 : index[i]};
    if (best.size() == k) {
      if (!(found < best.front())) return;
      std::pop_heap(best.begin(), best.end());
      best.pop_back();
    }
    best.push_back(found);
    std::push_heap(best.begin(), best.end());
  }

  void searchRadius(std::uint32_t id, const float* q, float limit, std::vector<Found>& out) const {
    const Node& node = nodes[id];
    if (!(boxDistance(node, q) < limit)) return;
    if (node.left != 0) {
      searchRadius(node.left, q, limit, out);
      searchRadius(node.right, q, limit, out);
      return;
    }
    for (std::uint32_t i = node.begin; i < node.end; ++i) {
      const float dx = q[0] - xyz[3 * i];
      const float dy = q[1] - xyz[3 * i + 1];
      const float dz = q[2] - xyz[3 * i + 2];
      const float d = dx * dx + dy * dy + dz * dz;
      if (d < limit) out.push_back({d, index[i]});
    }
  }
};

MedianHashIndex::MedianHashIndex() : impl_(std::make_unique<Impl>()) {}
MedianHashIndex::~MedianHashIndex() = default;
MedianHashIndex::MedianHashIndex(MedianHashIndex&&) noexcept = default;
MedianHashIndex& MedianHashIndex::operator=(MedianHashIndex&&) noexcept = default;

void MedianHashIndex::build(const PointView& points, const std::vector<pcl::index_t>* indices,
                            const Options& options) {
  impl_ = std::make_unique<Impl>();
  Impl& self = *impl_;
  self.options = options;
  self.rows = indices != nullptr ? indices->size() : points.size;
  std::vector<float> raw;
  std::vector<std::uint32_t> row;
  for (std::size_t i = 0; i < self.rows; ++i) {
    const auto at = indices != nullptr ? static_cast<std::size_t>((*indices)[i]) : i;
    if (at >= points.size || !isFinite(points[at])) continue;
    raw.insert(raw.end(), points[at], points[at] + 3);
    row.push_back(static_cast<std::uint32_t>(i));
  }
  std::vector<std::uint32_t> order(row.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<std::uint32_t>(i);
  if (order.empty()) return;
  self.makeNode(order, raw, 0, static_cast<std::uint32_t>(order.size()));
  for (const std::uint32_t i : order) {
    self.xyz.insert(self.xyz.end(), raw.begin() + 3 * i, raw.begin() + 3 * i + 3);
    self.row.push_back(row[i]);
    self.index.push_back(indices != nullptr ? (*indices)[row[i]]
                                            : static_cast<pcl::index_t>(row[i]));
  }
}

float MedianHashIndex::epsilon() const {
  return impl_->options.epsilon;
}

void MedianHashIndex::setNumberOfThreads(int threads) {
  impl_->options.threads = threads;
}

std::size_t MedianHashIndex::size() const {
  return impl_->row.size();
}

std::size_t MedianHashIndex::memory() const {
  return impl_->xyz.capacity() * sizeof(float) + impl_->row.capacity() * sizeof(std::uint32_t) +
         impl_->index.capacity() * sizeof(pcl::index_t) + impl_->nodes.capacity() * sizeof(Node);
}

int MedianHashIndex::nearestK(const float* query, int k, pcl::index_t* indices,
                              float* sqr_distances, float /*epsilon*/) const {
  if (k <= 0 || size() == 0 || !isFinite(query)) return 0;
  const std::size_t wanted = std::min(static_cast<std::size_t>(k), size());
  std::vector<Found> best;
  best.reserve(wanted);
  impl_->searchK(0, query, wanted, -1, best);
  std::sort_heap(best.begin(), best.end());
  for (std::size_t i = 0; i < best.size(); ++i) {
    indices[i] = best[i].index;
    sqr_distances[i] = best[i].distance;
  }
  return static_cast<int>(best.size());
}

int MedianHashIndex::radius(const float* query, double radius, std::vector<pcl::index_t>& indices,
                            std::vector<float>& sqr_distances, unsigned int max_nn,
                            bool sorted) const {
  indices.clear();
  sqr_distances.clear();
  if (!(radius > 0.0) || size() == 0 || !isFinite(query)) return 0;
  std::vector<Found> found;
  impl_->searchRadius(0, query, static_cast<float>(radius * radius), found);
  if (sorted || (max_nn > 0 && found.size() > max_nn)) std::sort(found.begin(), found.end());
  if (max_nn > 0 && found.size() > max_nn) found.resize(max_nn);
  for (const Found& f : found) {
    indices.push_back(f.index);
    sqr_distances.push_back(f.distance);
  }
  return static_cast<int>(found.size());
}

void MedianHashIndex::nearestKAll(int k, Neighborhoods& out, bool with_distances,
                                  float /*epsilon*/) const {
  const Impl& self = *impl_;
  const std::size_t wanted = std::min(static_cast<std::size_t>(std::max(k, 0)), size());
  out.reset(self.rows, k, with_distances);
  if (wanted == 0) return;
  const auto n = static_cast<std::int64_t>(size());
#pragma omp parallel num_threads(resolveThreads(self.options.threads))
  {
    std::vector<Found> best;
    best.reserve(wanted);
#pragma omp for schedule(dynamic, 1024)
    for (std::int64_t i = 0; i < n; ++i) {
      const auto at = static_cast<std::size_t>(i);
      best.clear();
      self.searchK(0, &self.xyz[3 * at], wanted, self.index[at], best);
      std::sort_heap(best.begin(), best.end());
      pcl::index_t* row = out.mutableIndices(self.row[at]);
      float* distances = out.mutableSqrDistances(self.row[at]);
      for (std::size_t j = 0; j < best.size(); ++j) {
        row[j] = best[j].index < 0 ? self.index[at] : best[j].index;
        if (distances != nullptr) distances[j] = best[j].distance;
      }
      out.setCount(self.row[at], static_cast<int>(best.size()));
    }
  }
}

}  // namespace segorient::search
