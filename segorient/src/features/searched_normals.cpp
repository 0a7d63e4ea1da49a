// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <segorient/features/impl/searched_normals.hpp>

#include <algorithm>
#include <iterator>
#include <limits>

#include "common/parallel_for.h"
#include "common/refers_to.h"
#include "features/local_fit_job.h"
#include "search/prepared_cloud.h"

namespace segorient {
namespace {

constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

bool isRow(pcl::index_t index, std::size_t size) {
  return index >= 0 && static_cast<std::size_t>(index) < size;
}

void setUndefined(float* normal, LocalCurvature* curvature) {
  std::fill_n(normal, 4, kNaN);
  if (curvature) *curvature = {{kNaN, kNaN, kNaN}, kNaN, kNaN};
}

/// The neighbours of some queries as one table, filled row by row.
class TableBuilder {
 public:
  void clear() {
    flat_.clear();
    counts_.clear();
    queries_.clear();
  }
  // Neighbours that a search found elsewhere than among `points` are left out.
  void add(const float* query, const pcl::index_t* neighbors, std::size_t count,
           std::size_t points) {
    const std::size_t before = flat_.size();
    std::copy_if(neighbors, neighbors + count, std::back_inserter(flat_),
                 [&](pcl::index_t i) { return isRow(i, points); });
    counts_.push_back(flat_.size() - before);
    queries_.insert(queries_.end(), {query[0], query[1], query[2], 0.0F});
  }
  PointView queries() const { return {queries_.data(), 4, counts_.size()}; }
  const Neighborhoods& table() {
    const std::size_t most =
        counts_.empty() ? 0 : *std::max_element(counts_.begin(), counts_.end());
    table_.reset(counts_.size(), static_cast<int>(most), false);
    const pcl::index_t* from = flat_.data();
    for (std::size_t i = 0; i < counts_.size(); ++i) {
      std::copy_n(from, counts_[i], table_.mutableIndices(i));
      table_.setCount(i, static_cast<int>(counts_[i]));
      from += counts_[i];
    }
    return table_;
  }

 private:
  std::vector<pcl::index_t> flat_;
  std::vector<std::size_t> counts_;
  std::vector<float> queries_;
  Neighborhoods table_;
};

/// Curvatures are over lengths.
void restoreUnit(float unit, std::size_t count, LocalCurvature* curvatures) {
  for (std::size_t i = 0; curvatures != nullptr && i < count; ++i) {
    curvatures[i].pc1 /= unit;
    curvatures[i].pc2 /= unit;
  }
}

/// All normals from the neighbours among the points of a cloud themselves.
/// \param k the point itself counted
void estimateAll(PreparedCloud& cloud, int k, const pcl::Indices& indices,
                 const LocalNormalOptions& options, float* normals, LocalCurvature* curvatures) {
  cloud.findNeighbors(k - 1, false);
  std::vector<float> of_points(4 * cloud.size());
  std::vector<LocalCurvature> point_curvatures(curvatures ? cloud.size() : 0);
  estimateNormals(cloud.points(), cloud.points(), cloud.neighborhoods(), options, of_points.data(),
                  curvatures ? point_curvatures.data() : nullptr);
  for (std::size_t i = 0; i < indices.size(); ++i) {
    const pcl::index_t point =
        isRow(indices[i], cloud.rows()) ? cloud.pointOf(static_cast<std::size_t>(indices[i])) : -1;
    if (point < 0) {
      setUndefined(normals + 4 * i, curvatures ? curvatures + i : nullptr);
      continue;
    }
    std::copy_n(&of_points[4 * static_cast<std::size_t>(point)], 4, normals + 4 * i);
    if (curvatures) curvatures[i] = point_curvatures[static_cast<std::size_t>(point)];
  }
  restoreUnit(cloud.unit(), indices.size(), curvatures);
}

/// Rows in the unit of a cloud.
std::vector<float> inUnitOf(const PreparedCloud& cloud, const PointView& points) {
  std::vector<float> out(4 * points.size, 0.F);
  for (std::size_t i = 0; i < points.size; ++i) {
    for (std::size_t a = 0; a < 3; ++a) out[4 * i + a] = points[i][a] / cloud.unit();
  }
  return out;
}

}  // namespace

void searchAndEstimateNormals(const PointView& input, const pcl::Indices& indices,
                              const PointView* surface, const NeighborhoodSize& size,
                              const LocalNormalOptions& options, float* normals,
                              LocalCurvature* curvatures) {
  PreparedCloud cloud(surface ? *surface : input, nullptr, options.threads);
  const int k =
      static_cast<int>(std::min(static_cast<std::size_t>(std::max(size.k, 0)), cloud.size()));

  // Searching for all points at once costs a fraction of as many single queries.
  if (!surface && k > 0 && indices.size() > input.size / 4) {
    estimateAll(cloud, k, indices, options, normals, curvatures);
    return;
  }
  const search::MedianHashIndex& index = cloud.index();
  const double radius = size.radius / static_cast<double>(cloud.unit());
  const std::vector<float> queries = inUnitOf(cloud, input);
  const PointView query_view{queries.data(), 4, input.size};
  const NeighborSearch search = [&](pcl::index_t i, pcl::Indices& found, std::vector<float>& sqr) {
    const auto row = static_cast<std::size_t>(i);
    if (!surface && cloud.pointOf(row) < 0) return 0;
    const float* query = query_view[row];
    if (size.k <= 0) return index.radius(query, radius, found, sqr, 0, true);
    found.resize(static_cast<std::size_t>(k));
    sqr.resize(static_cast<std::size_t>(k));
    return index.nearestK(query, k, found.data(), sqr.data());
  };
  searchAndEstimateNormals(query_view, indices, cloud.points(), search, options, normals,
                           curvatures);
  restoreUnit(cloud.unit(), indices.size(), curvatures);
}

void searchAndEstimateNormals(const PointView& input, const pcl::Indices& indices,
                              const PointView& surface, const NeighborSearch& search,
                              const LocalNormalOptions& options, float* normals,
                              LocalCurvature* curvatures) {
  const detail::FourFloats xyz(surface);
  const PointView points{xyz.data(), 4, surface.size};
  LocalNormalOptions block_options = options;
  block_options.threads = 1;
  constexpr std::size_t kBlock = 256;
  const std::size_t blocks = (indices.size() + kBlock - 1) / kBlock;
  struct Space {
    TableBuilder builder;
    pcl::Indices found;
    std::vector<float> sqr_distances;
  };
  parallelFor(
      blocks, options.threads, timeOfEach(blocks, indices.size(), 1000.0), [] { return Space(); },
      [&](std::size_t b, Space& space) {
        const std::size_t begin = b * kBlock;
        const std::size_t end = std::min(indices.size(), begin + kBlock);
        space.builder.clear();
        for (std::size_t i = begin; i < end; ++i) {
          const float undefined[3] = {kNaN, kNaN, kNaN};
          const bool usable = isRow(indices[i], input.size) &&
                              isFinite(input[static_cast<std::size_t>(indices[i])]);
          const int count = usable ? search(indices[i], space.found, space.sqr_distances) : 0;
          space.builder.add(
              usable ? input[static_cast<std::size_t>(indices[i])] : undefined, space.found.data(),
              std::min(static_cast<std::size_t>(std::max(count, 0)), space.found.size()),
              points.size);
        }
        estimateNormals(space.builder.queries(), points, space.builder.table(), block_options,
                        normals + 4 * begin, curvatures ? curvatures + begin : nullptr);
      });
}

bool estimateNormalsFromTable(const PointView& input, const pcl::Indices& indices,
                              const PointView& surface, const Neighborhoods& neighborhoods,
                              const LocalNormalOptions& options, float* normals,
                              LocalCurvature* curvatures) {
  const std::size_t rows = neighborhoods.size();
  if (rows != indices.size() && rows != input.size) return false;
  if (!refersTo(neighborhoods, surface.size)) return false;
  const bool by_index = rows != input.size;
  const detail::FourFloats xyz(surface);
  const PointView points{xyz.data(), 4, surface.size};
  bool identity = indices.size() == input.size;
  for (std::size_t i = 0; identity && i < indices.size(); ++i) {
    identity = static_cast<std::size_t>(indices[i]) == i;
  }
  if (identity) {
    estimateNormals(input, points, neighborhoods, options, normals, curvatures);
    return true;
  }
  TableBuilder builder;
  for (std::size_t i = 0; i < indices.size(); ++i) {
    const float undefined[3] = {kNaN, kNaN, kNaN};
    const bool usable = isRow(indices[i], input.size);
    const std::size_t row = by_index ? i : static_cast<std::size_t>(indices[i]);
    if (usable) {
      builder.add(input[static_cast<std::size_t>(indices[i])], neighborhoods.indices(row),
                  static_cast<std::size_t>(neighborhoods.count(row)), points.size);
    } else {
      builder.add(undefined, nullptr, 0, points.size);
    }
  }
  estimateNormals(builder.queries(), points, builder.table(), options, normals, curvatures);
  return true;
}

}  // namespace segorient
