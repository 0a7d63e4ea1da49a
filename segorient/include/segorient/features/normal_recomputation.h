// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <pcl/pcl_base.h>
#include <pcl/point_cloud.h>
#include <segorient/common/neighborhoods.h>
#include <segorient/features/normal_options.h>

#include <cstdint>
#include <vector>

namespace segorient {

/// Sharpens the normals near edges with the help of a segmentation (paper, section 2.3.1); see
/// RecomputationRule for the two rules.
///
/// @code
/// segorient::NormalRecomputation<pcl::PointXYZ, pcl::Normal> recomputation;
/// recomputation.setInputCloud(cloud);
/// recomputation.setInputNormals(normals);
/// recomputation.setLabels(labels, regular);  // of NormalSegmentation::getPlanarSegmentation()
/// recomputation.compute(*sharper);
/// @endcode
///
/// Neighbours come from a ready table or an all-points search of its own. Points without a label or
/// a normal, and those with NaN coordinates, keep their normal as it is. Without a cloud, or with
/// normals, labels or a table of another size: PCL_ERROR and an empty output.
template <typename PointT, typename NormalT>
class NormalRecomputation : public pcl::PCLBase<PointT> {
 public:
  using Ptr = pcl::shared_ptr<NormalRecomputation<PointT, NormalT>>;
  using ConstPtr = pcl::shared_ptr<const NormalRecomputation<PointT, NormalT>>;
  using Normals = pcl::PointCloud<NormalT>;
  using NormalsConstPtr = typename Normals::ConstPtr;
  using NeighborhoodsConstPtr = pcl::shared_ptr<const Neighborhoods>;

  NormalRecomputation() { setKSearch(21); }

  /// One normal a point of the input cloud, in any orientation.
  void setInputNormals(const NormalsConstPtr& normals) { normals_ = normals; }
  NormalsConstPtr getInputNormals() const { return normals_; }

  /// \param labels one a point of the input cloud, -1 for none
  /// \param regular one a label: 1 for the regular segments
  void setLabels(const std::vector<std::int32_t>& labels,
                 const std::vector<std::uint8_t>& regular) {
    labels_ = moved_labels_ = labels;
    regular_ = regular;
  }
  /// As set, and after compute() as moved; the next compute() starts from those that were set.
  const std::vector<std::int32_t>& getLabels() const { return moved_labels_; }
  const std::vector<std::uint8_t>& getRegular() const { return regular_; }

  /// Uses this table, one row a point of the input cloud, instead of searching. Null: search.
  void setNeighborhoods(const NeighborhoodsConstPtr& neighborhoods) {
    neighborhoods_ = neighborhoods;
  }
  NeighborhoodsConstPtr getNeighborhoods() const { return neighborhoods_; }

  /// Default ONE_SIDED.
  void setRule(RecomputationRule rule) { options_.rule = rule; }
  RecomputationRule getRule() const { return options_.rule; }

  /// How often the rule is applied; each round starts from the labels and normals of the last one.
  /// Default 2: a third changes next to nothing. 0 or less: normals stay as they are.
  void setNumberOfRounds(int rounds) { rounds_ = rounds; }
  int getNumberOfRounds() const { return rounds_; }

  /// Neighbours of each point and the point itself, as in PCL; default 21. (Version 1.0 did not
  /// count the point here.) 1 or less: one neighbour, or all that a ready table has.
  void setKSearch(int k) {
    k_ = k;
    options_.k = k > 1 ? k - 1 : 0;
  }
  int getKSearch() const { return k_; }

  /// \param angle see RecomputationOptions::edge_angle, radians; default 20 degrees
  void setEdgeAngle(float angle) { options_.edge_angle = angle; }
  float getEdgeAngle() const { return options_.edge_angle; }

  /// \param delta see RecomputationOptions::delta, radians; default 30 degrees
  void setDelta(float delta) { options_.delta = delta; }
  float getDelta() const { return options_.delta; }

  /// \param between see RecomputationOptions::delta_between_references; default false
  void setDeltaBetweenReferences(bool between) { options_.delta_between_references = between; }
  bool getDeltaBetweenReferences() const { return options_.delta_between_references; }

  /// \param estimator for modified neighbourhoods; default PLANE, which AUTO is as well
  void setEstimator(NormalEstimator estimator) { options_.estimator = estimator; }
  NormalEstimator getEstimator() const { return options_.estimator; }

  /// \param threads 0 (default) = all cores. The result does not depend on it
  void setNumberOfThreads(unsigned int threads = 0) {
    options_.threads = static_cast<int>(threads);
  }
  unsigned int getNumberOfThreads() const { return static_cast<unsigned int>(options_.threads); }

  /// \param output the input normals, one an index, those near edges replaced, with the points'
  ///        coordinates where the type has some; may be the cloud of the input normals
  void compute(Normals& output);

  /// What the last compute() did, in all rounds together.
  const RecomputationReport& getReport() const { return report_; }

 private:
  bool checkInput() const;
  void recompute(Normals& output);

  using pcl::PCLBase<PointT>::indices_;
  using pcl::PCLBase<PointT>::input_;

  NormalsConstPtr normals_;
  std::vector<std::int32_t> labels_;  ///< as set
  std::vector<std::int32_t> moved_labels_;
  std::vector<std::uint8_t> regular_;
  NeighborhoodsConstPtr neighborhoods_;
  RecomputationOptions options_;
  int k_ = 0;
  int rounds_ = 2;
  RecomputationReport report_;
};

}  // namespace segorient

#ifdef PCL_NO_PRECOMPILE
#include <segorient/features/impl/normal_recomputation.hpp>
#endif
