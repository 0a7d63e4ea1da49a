// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <pcl/pcl_config.h>
#include <pcl/search/kdtree.h>
#include <segorient/common/neighborhoods.h>
#include <segorient/search/median_hash_index.h>

#include <type_traits>
#include <vector>

namespace segorient::search {

/// Exact nearest neighbours by median subdivision and hashing (paper, section 2.1): a drop-in for
/// pcl::search::KdTree in any PCL class, with an all-points search that finds every neighbourhood
/// of a cloud at once.
///
/// @code
/// auto search = pcl::make_shared<segorient::search::MedianHash<pcl::PointXYZ>>();
/// pcl::NormalEstimationOMP<pcl::PointXYZ, pcl::Normal> normals;
/// normals.setSearchMethod(search);            // instead of pcl::search::KdTree
///
/// search->setInputCloud(cloud);
/// segorient::Neighborhoods neighbors;
/// search->nearestKSearchAll(18, neighbors);   // many times faster than a loop of queries
/// @endcode
///
/// Distances are, to the last bit, those of PCL's own kd-tree; equal distances are ordered by
/// index. Where PCL asserts or crashes (no cloud, NaN query, index out of range, k <= 0), the
/// result here is empty and the count 0. Points with NaN or infinite coordinates are never found. k
/// larger than the cloud is cut to it, but nearestKSearchAll() makes room for k. With indices,
/// results are indices into the cloud, a query by index is a position in the indices, and an index
/// that is given twice is found twice.
///
/// After setEpsilon(e), distances are at most 1 + e times the true ones of the same rank, and the
/// same for the same cloud and query. Single queries make use of that only where the cloud's points
/// are not in order: where they are, as in a scan, exact queries are the faster ones.
///
/// Queries are const and may run concurrently on one object. A point representation (see
/// KdTree::setPointRepresentation) of up to three dimensions is honoured; one of more dimensions is
/// handed to PCL's kd-tree.
template <typename PointT>
class MedianHash : public pcl::search::KdTree<PointT> {
 public:
  using Base = pcl::search::KdTree<PointT>;
  using typename Base::PointCloud;
  using typename Base::PointCloudConstPtr;
  using Indices = pcl::Indices;
  using IndicesConstPtr = pcl::IndicesConstPtr;
  using Ptr = pcl::shared_ptr<MedianHash<PointT>>;
  using ConstPtr = pcl::shared_ptr<const MedianHash<PointT>>;

#if PCL_VERSION_COMPARE(>=, 1, 14, 0)
  using InputResult = bool;  ///< what setInputCloud returns: whether the cloud could be used
#else
  using InputResult = void;
#endif

  using Base::getEpsilon;
  using Base::nearestKSearch;
  using Base::radiusSearch;
  using Base::setEpsilon;

  /// \param sorted whether radius results are ascending; k nearest are in any case
  explicit MedianHash(bool sorted = true);

  /// Builds the structure on a copy of the coordinates. Settings stay as they are.
  /// \param indices points of `cloud` to use, or null for all; invalid ones are left out
  InputResult setInputCloud(const PointCloudConstPtr& cloud,
                            const IndicesConstPtr& indices = IndicesConstPtr()) override;

  /// Sets how points become vectors and rebuilds if there is a cloud.
  void setPointRepresentation(const typename Base::PointRepresentationConstPtr& representation);

  int nearestKSearch(const PointT& point, int k, Indices& k_indices,
                     std::vector<float>& k_sqr_distances) const override;
  int nearestKSearch(const PointCloud& cloud, pcl::index_t index, int k, Indices& k_indices,
                     std::vector<float>& k_sqr_distances) const override;
  int nearestKSearch(pcl::index_t index, int k, Indices& k_indices,
                     std::vector<float>& k_sqr_distances) const override;
  void nearestKSearch(const PointCloud& cloud, const Indices& indices, int k,
                      std::vector<Indices>& k_indices,
                      std::vector<std::vector<float>>& k_sqr_distances) const override;

  int radiusSearch(const PointT& point, double radius, Indices& k_indices,
                   std::vector<float>& k_sqr_distances, unsigned int max_nn = 0) const override;
  int radiusSearch(const PointCloud& cloud, pcl::index_t index, double radius, Indices& k_indices,
                   std::vector<float>& k_sqr_distances, unsigned int max_nn = 0) const override;
  int radiusSearch(pcl::index_t index, double radius, Indices& k_indices,
                   std::vector<float>& k_sqr_distances, unsigned int max_nn = 0) const override;
  void radiusSearch(const PointCloud& cloud, const Indices& indices, double radius,
                    std::vector<Indices>& k_indices,
                    std::vector<std::vector<float>>& k_sqr_distances,
                    unsigned int max_nn = 0) const override;

  /// The k nearest of every point of the input cloud (or of its indices), itself first: row i of
  /// `out` belongs to point i (or to the i-th index). Runs on getNumberOfThreads() threads.
  /// With a point representation of more than three dimensions `out` has no rows at all.
  /// \param with_distances false leaves the squared distances out, which is faster
  /// \throws std::bad_alloc if there is no memory for k entries a point; `out` is empty then
  void nearestKSearchAll(int k, Neighborhoods& out, bool with_distances = true) const;

  /// All points nearer than `radius` to every point of the input cloud (or of its indices), in rows
  /// as those of nearestKSearchAll(), ascending and exact whatever was set. Rows are empty if the
  /// radius is not above 0 or its square is 0 in float.
  /// \param max_nn keeps the closest max_nn of each row only, the point itself in any case; 0 = all
  /// \throws std::bad_alloc if there is no memory for all that is found; `out` is empty then
  void radiusSearchAll(double radius, RadiusNeighborhoods& out, unsigned int max_nn = 0,
                       bool with_distances = true) const;
  /// Not with_distances in the place of max_nn.
  template <typename Bool, typename = std::enable_if_t<std::is_same_v<Bool, bool>>>
  void radiusSearchAll(double radius, RadiusNeighborhoods& out, Bool, bool = true) const = delete;

  /// Most points in a region of the median subdivision; takes effect at the next setInputCloud().
  /// Exact results do not depend on it. Default 4096; below 8 means 8, above 32768 means 32768.
  void setRegionSize(std::size_t points) {
    options_.region_size = points;
  }
  std::size_t getRegionSize() const {
    return options_.region_size;
  }

  /// Threads for building, for the searches for all points and for batches of queries; 0 (default)
  /// = all. Results do not depend on it.
  void setNumberOfThreads(unsigned int threads = 0);
  unsigned int getNumberOfThreads() const {
    return static_cast<unsigned int>(options_.threads);
  }

  /// Bytes in use by the structure.
  std::size_t memory() const {
    return index_.memory();
  }

 private:
  /// How a point becomes three floats.
  enum class Access {
    kNone,            ///< there is no cloud
    kXYZ,             ///< its x, y, z
    kRepresentation,  ///< through the point representation
    kPcl              ///< more than three dimensions: PCL's kd-tree searches
  };

  bool build(const PointCloudConstPtr& cloud, const IndicesConstPtr& indices);
  Access chooseAccess() const;
  bool toFloats(const PointT& point, float* out) const;
  void checkSearchAll(const char* method) const;
  const PointT* inputPoint(pcl::index_t index) const;
  std::vector<float> batchQueries(const PointCloud& cloud, const Indices& indices) const;

  MedianHashIndex::Options options_;
  MedianHashIndex index_;
  Access access_ = Access::kNone;
  typename Base::PointRepresentationConstPtr representation_;  ///< the one the cloud was read with
};

}  // namespace segorient::search

#ifdef PCL_NO_PRECOMPILE
#include <segorient/search/impl/median_hash.hpp>
#endif
