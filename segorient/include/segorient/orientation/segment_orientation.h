// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <pcl/pcl_base.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>
#include <pcl/search/search.h>
#include <segorient/common/neighborhoods.h>
#include <segorient/orientation/impl/oriented_segmentation.hpp>

#include <limits>
#include <memory>
#include <vector>

namespace segorient {

/// Consistent orientation of a cloud's normals by its segments: the paper's methods one by one, its
/// combination, and the default (paper, section 3).
///
/// @code
/// segorient::SegmentOrientation<pcl::PointXYZ, pcl::Normal> orientation;
/// orientation.setInputCloud(cloud);
/// orientation.setInputNormals(normals);  // of any estimator; signs do not matter
/// orientation.setMethod(segorient::OrientationMethod::COMBINED);
/// orientation.compute(*oriented);
/// @endcode
///
/// setOptions (paperOptions (method)) sets the paper's rules to the letter; the defaults are ours.
/// Settings that the method does not look at, see settingsWithoutEffect(), are named by a PCL_WARN.
///
/// Segments are those of setSegmentation(), such as NormalSegmentation finds them, or made anew.
/// AUTO orients normals of its own, by segments that keep the sides of thin walls apart, as
/// OrientedNormalEstimation does, and brings their signs over to these: the given segments do not
/// change them. It does not look for sensors, as that class does; where known, they decide.
///
/// Every point that has a normal is oriented. NaN stays NaN, and a point that is nowhere, with NaN
/// coordinates or farther from the bulk of the points than 2^24 times its extent, gets NaN whatever
/// normal it had; is_dense is cleared then. With indices, output i belongs to
/// index i; the whole cloud is oriented all the same. No cloud, normals of another size, segments
/// of another cloud, neighbourhoods of another one or a negative k: PCL_ERROR and an empty output.
template <typename PointT, typename NormalT>
class SegmentOrientation : public pcl::PCLBase<PointT> {
 public:
  using Base = pcl::PCLBase<PointT>;
  using Ptr = pcl::shared_ptr<SegmentOrientation<PointT, NormalT>>;
  using ConstPtr = pcl::shared_ptr<const SegmentOrientation<PointT, NormalT>>;
  using PointCloudN = pcl::PointCloud<NormalT>;
  using PointCloudNConstPtr = typename PointCloudN::ConstPtr;
  using SearcherPtr = typename pcl::search::Search<PointT>::Ptr;
  using SegmentationConstPtr = std::shared_ptr<const Segmentation>;
  using NeighborhoodsConstPtr = std::shared_ptr<const Neighborhoods>;
  using Method = OrientationMethod;

  static constexpr Method AUTO = Method::AUTO;
  static constexpr Method PROPAGATION = Method::PROPAGATION;
  static constexpr Method BOUNDARY = Method::BOUNDARY;
  static constexpr Method COMBINED = Method::COMBINED;
  static constexpr Method EXTREMAL = Method::EXTREMAL;
  static constexpr Method HOPPE = Method::HOPPE;

  /// One normal a point of the input cloud.
  void setInputNormals(const PointCloudNConstPtr& normals) { normals_ = normals; }
  PointCloudNConstPtr getInputNormals() const { return normals_; }

  /// Segments of the whole input cloud; null (default) to make them from the normals.
  void setSegmentation(const SegmentationConstPtr& segmentation) { segmentation_ = segmentation; }
  SegmentationConstPtr getSegmentation() const { return segmentation_; }

  /// How the segments made anew are made: of at most 10 neighbours.
  void setSegmentationOptions(const SegmentationSettings& options) {
    segmentation_options_ = options;
  }
  const SegmentationSettings& getSegmentationOptions() const { return segmentation_options_; }

  /// What finds neighbours; null (default) = our own all-points search, which is faster. It is put
  /// on the whole input cloud.
  void setSearchMethod(const SearcherPtr& search) { search_ = search; }
  SearcherPtr getSearchMethod() const { return search_; }

  /// Ready neighbourhoods of the whole input cloud (row = point), so that neighbours are found
  /// once; null (default) to search. They go before a search method; setKSearch() then says how
  /// many entries of each row to use (0 = all).
  void setNeighborhoods(const NeighborhoodsConstPtr& neighborhoods) {
    neighborhoods_ = neighborhoods;
  }
  NeighborhoodsConstPtr getNeighborhoods() const { return neighborhoods_; }

  /// Neighbours of a point and the point itself, as in PCL; 0 (default) = 33 for AUTO and 13 for
  /// the others, or all that a ready table has. More than 129, or than that has, are not used.
  void setKSearch(int k) { k_ = k; }
  int getKSearch() const { return k_; }

  /// All settings at once, such as paperOptions(). Hints among them take the place of what this
  /// class's own setters and the points say.
  void setOptions(const OrientationSettings& options) {
    static_cast<OrientationSettings&>(options_) = options;
  }
  const OrientationSettings& getOptions() const { return options_; }

  /// Default AUTO.
  void setMethod(Method method) { options_.method = method; }
  Method getMethod() const { return options_.method; }

  /// Angles between segments up to this, and from pi minus this on, decide; radians, default 35
  /// degrees.
  void setGamma(float gamma) { options_.gamma = gamma; }
  float getGamma() const { return options_.gamma; }

  /// Which angle stands for two segments: between reference normals (the paper's) or across the
  /// border (default).
  void setSegmentAngle(SegmentAngle angle) { options_.angle = angle; }
  SegmentAngle getSegmentAngle() const { return options_.angle; }

  /// How boundaries are told: from neighbours (default) or from triangulations (the paper's).
  void setBoundaryTest(BoundaryTest test) { options_.boundary = test; }
  BoundaryTest getBoundaryTest() const { return options_.boundary; }

  /// How segments are triangulated for BoundaryTest::TRIANGULATED.
  void setTriangulationOptions(const TriangulationSettings& options) {
    options_.triangulation = options;
  }
  const TriangulationSettings& getTriangulationOptions() const { return options_.triangulation; }

  /// Beyond the paper: segments that are not one-sided are dissolved, and angle and boundary of a
  /// border must not contradict each other, see OrientationOptions; default true.
  void setCheckBorders(bool value) { options_.check_borders = value; }
  bool getCheckBorders() const { return options_.check_borders; }

  /// Majority of a boundary's votes that decides, 0 to 1; default 0.5 (three to one).
  void setMinMargin(float margin) { options_.min_margin = margin; }
  float getMinMargin() const { return options_.min_margin; }

  /// m: most points in a box when extremal points are looked for; default 120.
  void setMaxBoxPoints(std::size_t points) { options_.max_box_points = points; }
  std::size_t getMaxBoxPoints() const { return options_.max_box_points; }

  /// Whether connected components are turned outward; default true.
  void setTurnOutward(bool value) { options_.turn_outward = value; }
  bool getTurnOutward() const { return options_.turn_outward; }

  // What is known beforehand: evidence for AUTO, not truth; see OrientationHints. Points that have
  // fields vp_x, vp_y and vp_z say themselves where they were seen from.

  /// Where the cloud was seen from; what closes in itself keeps its outside against it, unless the
  /// cloud shows that it was seen from there.
  void setViewPoint(float x, float y, float z) {
    hints_.has_viewpoint = true;
    hints_.viewpoint = {x, y, z};
  }
  /// NaN if none was set.
  void getViewPoint(float& x, float& y, float& z) const {
    constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
    x = hints_.has_viewpoint ? hints_.viewpoint[0] : kNone;
    y = hints_.has_viewpoint ? hints_.viewpoint[1] : kNone;
    z = hints_.has_viewpoint ? hints_.viewpoint[2] : kNone;
  }

  /// Whether the surface is closed or open; default UNKNOWN: told from the cloud.
  void setSurfaceKind(SurfaceKind kind) { hints_.surface = kind; }
  SurfaceKind getSurfaceKind() const { return hints_.surface; }

  /// Whether the signs of the input normals say something; default false.
  void setKeepOrientation(bool value) { keep_orientation_ = value; }
  bool getKeepOrientation() const { return keep_orientation_; }

  /// Points whose normals are known; null (default) = none.
  void setSeeds(const pcl::PointCloud<pcl::PointNormal>::ConstPtr& seeds) { seeds_ = seeds; }
  pcl::PointCloud<pcl::PointNormal>::ConstPtr getSeeds() const { return seeds_; }

  /// 0 (default) = all cores. The result does not depend on it.
  void setNumberOfThreads(unsigned int threads = 0) {
    options_.threads = static_cast<int>(threads);
  }
  unsigned int getNumberOfThreads() const { return static_cast<unsigned int>(options_.threads); }

  /// \param output the input normals, oriented, with the points' coordinates where the type has
  ///        some; may be the cloud of the input normals
  void compute(PointCloudN& output);

  // Of the last compute(), empty before; by point of the input cloud.

  /// Signs, deciding methods and confidences of segments, components and points.
  const OrientationResult& getResult() const { return result_.orientation; }
  /// The segments in use: labels, members, reference normals and signs as they were oriented, so
  /// that triangulations made from them have their fronts outward.
  const Segmentation& getUsedSegmentation() const { return result_.segmentation; }
  /// Segment of each point, -1 = none.
  const std::vector<std::int32_t>& getLabels() const { return result_.segmentation.labels; }

 protected:
  using Base::deinitCompute;
  using Base::indices_;
  using Base::initCompute;
  using Base::input_;

 private:
  bool orient();
  PointSearch searchFunction();
  int otherNeighbors() const;

  PointCloudNConstPtr normals_;
  SearcherPtr search_;
  NeighborhoodsConstPtr neighborhoods_;
  SegmentationConstPtr segmentation_;
  SegmentationSettings segmentation_options_;
  OrientationOptions options_;
  OrientationHints hints_;  // without what the clouds say
  pcl::PointCloud<pcl::PointNormal>::ConstPtr seeds_;
  bool keep_orientation_ = false;
  int k_ = 0;
  OrientedSegmentation result_;

 public:
  PCL_MAKE_ALIGNED_OPERATOR_NEW
};

}  // namespace segorient

#ifdef PCL_NO_PRECOMPILE
#include <segorient/orientation/impl/segment_orientation.hpp>
#endif
