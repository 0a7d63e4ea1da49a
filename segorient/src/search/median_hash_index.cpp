// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors

#include <algorithm>
#include <memory>
#include <utility>

#include "common/median.h"
#include "common/parallel_for.h"
#include "search/index_impl.h"

namespace segorient::search {

namespace {

// Squared distances from some points of the input to the next ones, unordered.
std::vector<float> stepsOf(const BuildPoint* points, std::size_t count) {
  constexpr std::size_t kSteps = 255;
  std::vector<float> steps;
  for (std::size_t i = 0; count > 1 && i < kSteps; ++i) {
    const std::size_t at = i * (count - 1) / kSteps;
    float sum = 0.0F;
    for (int a = 0; a < 3; ++a) {
      const float d = points[at + 1].xyz[a] - points[at].xyz[a];
      sum += d * d;
    }
    steps.push_back(sum);
  }
  return steps;
}

constexpr double kQueryTime = 400.0;  // ns, see resolveThreads()

// Most points are hardly farther from the one before than from their 16th neighbour.
bool areInOrder(const std::vector<float>& steps, const Layout& layout) {
  if (steps.empty() || layout.regions.empty()) return false;
  std::vector<float> spacing;
  for (const Region& region : layout.regions) spacing.push_back(region.spacing16);
  return median(steps) < 4.0F * median(std::move(spacing));
}

}  // namespace

MedianHashIndex::MedianHashIndex() : impl_(std::make_unique<Impl>()) {}
MedianHashIndex::~MedianHashIndex() = default;
MedianHashIndex::MedianHashIndex(MedianHashIndex&&) noexcept = default;
MedianHashIndex& MedianHashIndex::operator=(MedianHashIndex&&) noexcept = default;

void MedianHashIndex::build(const PointView& points, const std::vector<pcl::index_t>* indices,
                            const Options& options) {
  static std::atomic<std::uint64_t> built{0};
  impl_ = std::make_unique<Impl>();
  Impl& self = *impl_;
  self.options = options;
  self.rows = indices != nullptr ? indices->size() : points.size;
  self.number = ++built;
  if (std::max(points.size, self.rows) > kMostPoints) {
    self.rows = 0;
    return;
  }
  const std::unique_ptr<BuildPoint[]> finite(new BuildPoint[self.rows]);
  std::size_t count = 0;
  for (std::size_t i = 0; i < self.rows; ++i) {
    const auto at = indices != nullptr ? static_cast<std::size_t>((*indices)[i]) : i;
    if (at >= points.size || !isFinite(points[at])) continue;
    const float* p = points[at];
    finite[count++] = {{p[0], p[1], p[2]}, static_cast<std::uint32_t>(i)};
  }
  const std::size_t region_size =
      std::min(std::max<std::size_t>(options.region_size, 8), kMostRegionSize);
  constexpr double kBuildTime = 30.0;  // ns a point
  const std::vector<float> steps = stepsOf(finite.get(), count);
  self.layout = buildLayout(finite.get(), count, region_size, indices,
                            resolveThreads(options.threads, count, kBuildTime));
  self.in_order = areInOrder(steps, self.layout);
}

std::size_t MedianHashIndex::size() const {
  return impl_->layout.size();
}

std::size_t MedianHashIndex::memory() const {
  return sizeof(Impl) + impl_->layout.memory() + impl_->ids_memory + impl_->boxesMemory();
}

const char* MedianHashIndex::instructionSet() const {
  return impl_->kernels->name;
}

float MedianHashIndex::epsilon() const {
  return impl_->options.epsilon;
}

void MedianHashIndex::setNumberOfThreads(int threads) {
  impl_->options.threads = threads;
}

int MedianHashIndex::nearestK(const float* query, int k, pcl::index_t* indices,
                              float* sqr_distances, float epsilon) const {
  if (k <= 0 || size() == 0 || !isFinite(query)) return 0;
  const std::size_t wanted = std::min(static_cast<std::size_t>(k), size());
  impl_->search(query, wanted, epsilon, indices, sqr_distances);
  return static_cast<int>(wanted);
}

int MedianHashIndex::radius(const float* query, double radius, std::vector<pcl::index_t>& indices,
                            std::vector<float>& sqr_distances, unsigned int max_nn,
                            bool sorted) const {
  indices.clear();
  sqr_distances.clear();
  if (!(radius > 0.0) || size() == 0 || !isFinite(query)) return 0;
  return impl_->searchRadius(query, radius, indices, sqr_distances, max_nn, sorted);
}

void MedianHashIndex::nearestKBatch(const PointView& queries, int k,
                                    std::vector<std::vector<pcl::index_t>>& indices,
                                    std::vector<std::vector<float>>& sqr_distances,
                                    float epsilon) const {
  const std::size_t wanted = std::min(static_cast<std::size_t>(std::max(k, 0)), size());
  indices.resize(queries.size);
  sqr_distances.resize(queries.size);
  parallelFor(queries.size, impl_->options.threads, kQueryTime, [&](std::size_t i) {
    const float* query = queries[i];
    const std::size_t found = isFinite(query) ? wanted : 0;
    indices[i].resize(found);
    sqr_distances[i].resize(found);
    nearestK(query, static_cast<int>(found), indices[i].data(), sqr_distances[i].data(), epsilon);
  });
}

void MedianHashIndex::radiusBatch(const PointView& queries, double radius,
                                  std::vector<std::vector<pcl::index_t>>& indices,
                                  std::vector<std::vector<float>>& sqr_distances,
                                  unsigned int max_nn, bool sorted) const {
  indices.resize(queries.size);
  sqr_distances.resize(queries.size);
  parallelFor(queries.size, impl_->options.threads, kQueryTime, [&](std::size_t i) {
    this->radius(queries[i], radius, indices[i], sqr_distances[i], max_nn, sorted);
  });
}

}  // namespace segorient::search
