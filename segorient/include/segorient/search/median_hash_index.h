// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <pcl/types.h>
#include <segorient/common/export.h>
#include <segorient/common/neighborhoods.h>
#include <segorient/common/point_view.h>

#include <functional>
#include <memory>
#include <type_traits>
#include <vector>

namespace segorient::search {

/// The search structure behind MedianHash, on plain arrays: regions by median subdivision, in each
/// a hash of the points into cells (paper, section 2.1). Exact unless epsilon is set.
///
/// Distances are those of a plain float evaluation of dx*dx + dy*dy + dz*dz in that order, without
/// fused operations; ties are settled by index. Queries are const and may run concurrently.
/// A query with a NaN or infinite coordinate finds nothing.
class SEGORIENT_SEARCH_EXPORT MedianHashIndex {
 public:
  struct Options {
    std::size_t region_size = 4096;  ///< most points in a region
    int threads = 0;                 ///< 0 = all cores
    /// Distances are at most (1 + epsilon) times the true ones; 0 = exact. Single queries make no
    /// use of it where the points are in order, as in a scan: exact queries are faster there.
    float epsilon = 0.0F;
  };

  MedianHashIndex();
  ~MedianHashIndex();
  /// What was moved from may be built again, assigned to or destroyed, no more.
  MedianHashIndex(MedianHashIndex&&) noexcept;
  MedianHashIndex& operator=(MedianHashIndex&&) noexcept;
  MedianHashIndex(const MedianHashIndex&) = delete;
  MedianHashIndex& operator=(const MedianHashIndex&) = delete;

  /// Points, and indices, that there may be: 32 bits number up to four cells for each, whatever
  /// pcl::index_t is.
  static constexpr std::size_t kMostPoints = 1'000'000'000;

  /// Copies the points; those with NaN or infinite coordinates are left out. More than kMostPoints
  /// are not taken: the index is empty then.
  /// \param indices rows of `points` to use, or null for all; repeated ones are found repeatedly,
  ///        out of range ones are left out
  void build(const PointView& points, const std::vector<pcl::index_t>* indices,
             const Options& options);

  std::size_t size() const;    ///< points that can be found
  std::size_t memory() const;  ///< bytes in use

  /// The instruction set in use: the best that this machine has, unless the environment variable
  /// SEGORIENT_SIMD named another one (scalar, sse2, avx2, avx512) at build(). Exact results do not
  /// depend on it.
  const char* instructionSet() const;

  /// The k nearest, ascending. Room for min(k, size()) entries each is the caller's.
  /// \return how many were found: min(k, size()), 0 for k <= 0
  int nearestK(const float* query, int k, pcl::index_t* indices, float* sqr_distances) const {
    return nearestK(query, k, indices, sqr_distances, epsilon());
  }
  /// \param epsilon instead of the one of build()
  int nearestK(const float* query, int k, pcl::index_t* indices, float* sqr_distances,
               float epsilon) const;

  /// All points nearer than `radius` (strictly, as FLANN).
  /// \param max_nn keeps the closest max_nn only; 0 = all
  /// \param sorted ascending order; otherwise any
  int radius(const float* query, double radius, std::vector<pcl::index_t>& indices,
             std::vector<float>& sqr_distances, unsigned int max_nn, bool sorted) const;

  /// nearestK() for many queries, on several threads; results are resized, empty where a query is
  /// not finite.
  void nearestKBatch(const PointView& queries, int k,
                     std::vector<std::vector<pcl::index_t>>& indices,
                     std::vector<std::vector<float>>& sqr_distances, float epsilon) const;

  /// radius() for many queries, on several threads.
  void radiusBatch(const PointView& queries, double radius,
                   std::vector<std::vector<pcl::index_t>>& indices,
                   std::vector<std::vector<float>>& sqr_distances, unsigned int max_nn,
                   bool sorted) const;

  /// The k nearest of every row that build() was given: row i of `out` belongs to row i (or to the
  /// i-th index) and begins with that point itself. Rows of points left out are empty.
  /// \throws std::bad_alloc if there is no memory for rows * k entries; `out` is empty then
  void nearestKAll(int k, Neighborhoods& out, bool with_distances = true) const {
    nearestKAll(k, out, with_distances, epsilon());
  }
  /// \param epsilon instead of the one of build()
  void nearestKAll(int k, Neighborhoods& out, bool with_distances, float epsilon) const;

  /// Called for each region of the index, from several threads at once. Both are valid during the
  /// call only. `rows` are near each other; they are rows that build() was given (or numbers of
  /// indices, as in nearestKAll()). Row i of `table` has the min(k, size()) nearest of rows[i].
  using RegionTaker =
      std::function<void(const std::vector<pcl::index_t>& rows, const Neighborhoods& table)>;

  /// What nearestKAll() finds with epsilon 0, region by region, for whoever does not need the table
  /// of all rows at once: it takes region_size * k * sizeof(pcl::index_t) bytes a thread. Rows of
  /// points left out are not visited.
  /// \throws what `take` does, std::bad_alloc if there is no memory; other regions may not have
  /// been
  ///         visited then
  void nearestKByRegion(int k, const RegionTaker& take) const;

  /// All points nearer than `radius` to every row that build() was given, as nearestKAll(): each
  /// row ascending, the point itself first, exact for any epsilon. Rows are empty if the radius is
  /// not above 0 or its square is 0 in float.
  /// \param max_nn keeps the closest max_nn of a row only, the point itself in any case; 0 = all
  /// \throws std::bad_alloc if there is no memory for all that is found; `out` is empty then
  void radiusAll(double radius, RadiusNeighborhoods& out, unsigned int max_nn = 0,
                 bool with_distances = true) const;
  /// Not with_distances in the place of max_nn.
  template <typename Bool, typename = std::enable_if_t<std::is_same_v<Bool, bool>>>
  void radiusAll(double radius, RadiusNeighborhoods& out, Bool, bool = true) const = delete;

  float epsilon() const;                 ///< as given to build()
  void setNumberOfThreads(int threads);  ///< 0 = all cores; results do not depend on it

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace segorient::search
