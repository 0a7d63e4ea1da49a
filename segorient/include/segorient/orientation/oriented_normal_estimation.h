// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <pcl/features/normal_3d.h>
#include <segorient/orientation/pipeline.h>

#include <array>
#include <cstdint>
#include <vector>

namespace segorient {

/// Consistently oriented normals, outward where there is an outside: neighbours, normals, segments
/// and their orientation in one class. Takes the place of pcl::NormalEstimation with its viewpoint.
///
/// @code
/// segorient::OrientedNormalEstimation<pcl::PointXYZ, pcl::Normal> estimation;
/// estimation.setInputCloud(cloud);
/// estimation.compute(*normals);                  // nothing else needs to be set
/// const auto& labels = estimation.getLabels();   // the segment of each point
/// @endcode
///
/// Neighbours come from an all-points search of its own; a search method is not used. The whole
/// cloud is oriented even where indices are set: they choose what is returned. With a search
/// surface, the input points are oriented as points of that surface.
///
/// The viewpoint (setViewPoint(), or the cloud's sensor origin where that is not 0) is evidence for
/// AUTO; what closes in itself keeps its outside against it, unless the cloud shows that it was
/// seen from there. See OrientationHints. Points that have fields vp_x, vp_y and vp_z say
/// themselves where they were seen from. An organized cloud is taken for the range image that it
/// is.
///
/// A point without a normal (NaN coordinates, a stray farther away than 2^24 times the extent of
/// the others, or fewer than three distinct points around) gets NaN, and is_dense is cleared. No
/// cloud, an empty one, a negative k or radius, or both: PCL_ERROR and an empty output. Settings
/// that the method does not look at, see settingsWithoutEffect(), are named by a PCL_WARN. What
/// setProgress()'s function throws leaves compute(); the object can be used again.
template <typename PointInT, typename PointOutT>
class OrientedNormalEstimation : public pcl::NormalEstimation<PointInT, PointOutT> {
 public:
  using Base = pcl::NormalEstimation<PointInT, PointOutT>;
  using Ptr = pcl::shared_ptr<OrientedNormalEstimation<PointInT, PointOutT>>;
  using ConstPtr = pcl::shared_ptr<const OrientedNormalEstimation<PointInT, PointOutT>>;
  using PointCloudOut = typename Base::PointCloudOut;
  using PointCloudConstPtr = typename Base::PointCloudConstPtr;
  using Method = OrientationMethod;

  /// \param threads as setNumberOfThreads()
  explicit OrientedNormalEstimation(unsigned int threads = 0) {
    feature_name_ = "OrientedNormalEstimation";
    setNumberOfThreads(threads);
  }

  using Base::setInputCloud;
  void setInputCloud(const PointCloudConstPtr& cloud) override;

  // setKSearch() counts the point itself, as in PCL; 0 (default) = 33 for AUTO, for the others 13,
  // 19 or 31 by the cloud's noise. setRadiusSearch() in its place: as many neighbours for all
  // points as half of the points have within that radius, see medianNeighborsWithin().

  /// How segments are oriented; default AUTO, the best known.
  void setMethod(Method method) { options_.orientation.method = method; }
  Method getMethod() const { return options_.orientation.method; }

  /// How normals are estimated; default AUTO: estimator and neighbours from the cloud itself,
  /// as getReport().normals_chosen tells. AUTO has its own way and does not look at this.
  void setNormalEstimator(NormalEstimator estimator) { options_.normals.estimator = estimator; }
  NormalEstimator getNormalEstimator() const { return options_.normals.estimator; }

  /// Alpha: largest angle between the normals of neighbours in a segment, radians; default 20
  /// degrees, but AUTO takes 15 on clean data for the segments that it orients by.
  void setSmoothnessThreshold(float alpha) {
    options_.segmentation.alpha = options_.orientation.automatic.alpha = alpha;
  }
  float getSmoothnessThreshold() const { return options_.segmentation.alpha; }

  /// Beta: largest angle between a normal and its segment's reference normal, radians; default 30
  /// degrees.
  void setReferenceThreshold(float beta) {
    options_.segmentation.beta = options_.orientation.automatic.beta = beta;
  }
  float getReferenceThreshold() const { return options_.segmentation.beta; }

  /// Gamma: angles between segments up to this decide, radians; default 35 degrees. AUTO does not
  /// look at this.
  void setGamma(float gamma) { options_.orientation.gamma = gamma; }
  float getGamma() const { return options_.orientation.gamma; }

  /// Epsilon: by how much the clean-up of segments may exceed beta, radians; default 10 degrees.
  void setReferenceTolerance(float epsilon) {
    options_.segmentation.epsilon = options_.orientation.automatic.epsilon = epsilon;
  }
  float getReferenceTolerance() const { return options_.segmentation.epsilon; }

  // As version 1.0 had them.
  [[deprecated("setSmoothnessThreshold")]] void setAlpha(float alpha) {
    setSmoothnessThreshold(alpha);
  }
  [[deprecated("getSmoothnessThreshold")]] float getAlpha() const {
    return getSmoothnessThreshold();
  }
  [[deprecated("setReferenceThreshold")]] void setBeta(float beta) { setReferenceThreshold(beta); }
  [[deprecated("getReferenceThreshold")]] float getBeta() const { return getReferenceThreshold(); }
  [[deprecated("setReferenceTolerance")]] void setEpsilon(float epsilon) {
    setReferenceTolerance(epsilon);
  }
  [[deprecated("getReferenceTolerance")]] float getEpsilon() const {
    return getReferenceTolerance();
  }

  /// Whether the surface is closed or open; default UNKNOWN: told from the cloud.
  void setSurfaceKind(SurfaceKind kind) { surface_kind_ = kind; }
  SurfaceKind getSurfaceKind() const { return surface_kind_; }

  /// The sensor is so far away that all of its rays are parallel: the direction towards it, of any
  /// length; setUp() for aircraft. 0 0 0 (default) = there is no such sensor. Points that have
  /// vp_x, vp_y and vp_z keep theirs.
  void setViewDirection(float x, float y, float z) {
    direction_ = {x, y, z};
    has_direction_ = x != 0.F || y != 0.F || z != 0.F;
  }
  /// The sensor is far above, +z.
  void setUp() { setViewDirection(0.F, 0.F, 1.F); }
  const std::array<float, 3>& getViewDirection() const { return direction_; }

  /// Which scan each point is of (of the search surface, if one is set), see OrientationHints.
  void setScans(const std::vector<std::int32_t>& scans) { scans_ = scans; }
  const std::vector<std::int32_t>& getScans() const { return scans_; }

  /// Whether the signs of normals that the input points have say something; default false.
  void setKeepOrientation(bool value) { keep_orientation_ = value; }
  bool getKeepOrientation() const { return keep_orientation_; }

  /// Points whose normals are known; null (default) = none.
  void setSeeds(const pcl::PointCloud<pcl::PointNormal>::ConstPtr& seeds) { seeds_ = seeds; }
  pcl::PointCloud<pcl::PointNormal>::ConstPtr getSeeds() const { return seeds_; }

  /// All settings of all stages, the number of threads with them; a k of this class takes
  /// precedence, and hints of the settings over those of this class.
  void setOptions(const PipelineOptions& options) { options_ = options; }
  const PipelineOptions& getOptions() const { return options_; }

  /// 0 (default) = all cores. The result does not depend on it.
  void setNumberOfThreads(unsigned int threads = 0) {
    options_.threads = static_cast<int>(threads);
  }
  unsigned int getNumberOfThreads() const { return static_cast<unsigned int>(options_.threads); }

  /// Called with each stage's name and the fraction of the work that is done.
  void setProgress(const PipelineProgress& progress) { progress_ = progress; }
  const PipelineProgress& getProgress() const { return progress_; }

  // Of the last compute(), empty before; entry i belongs to output i.

  /// Segment of each point, -1 where there is no normal.
  const std::vector<std::int32_t>& getLabels() const { return result_.segmentation.labels; }
  /// Confidence of each point's orientation, 0 to 1.
  const std::vector<float>& getConfidences() const { return result_.confidences; }
  /// The segments, with their members among the output's points.
  const Segmentation& getSegmentation() const { return result_.segmentation; }
  /// How each segment was oriented, by label.
  const std::vector<SegmentOrientationResult>& getSegments() const { return result_.segments; }
  /// Connected component of each point, into the report's components.
  const std::vector<std::int32_t>& getComponents() const { return result_.components; }
  /// What was done: points, segments, times, components. Of the whole cloud.
  const PipelineReport& getReport() const { return result_.report; }

 protected:
  using Base::fake_surface_;
  using Base::feature_name_;
  using Base::getClassName;
  using Base::indices_;
  using Base::input_;
  using Base::k_;
  using Base::search_radius_;
  using Base::surface_;
  using Base::use_sensor_origin_;
  using Base::vpx_;
  using Base::vpy_;
  using Base::vpz_;

  bool initCompute() override;
  void computeFeature(PointCloudOut& output) override;

 private:
  void estimate(PointCloudOut& output);
  void warnOfUnused(PipelineOptions options) const;
  void write(PointCloudOut& output) const;
  OrientationHints gatherHints(const pcl::PointCloud<PointInT>& cloud) const;

  PipelineOptions options_;
  PipelineProgress progress_;
  SurfaceKind surface_kind_ = SurfaceKind::UNKNOWN;
  bool keep_orientation_ = false;
  bool has_direction_ = false;
  std::array<float, 3> direction_{0.F, 0.F, 0.F};
  std::vector<std::int32_t> scans_;
  pcl::PointCloud<pcl::PointNormal>::ConstPtr seeds_;
  OrientedCloud result_;

 public:
  PCL_MAKE_ALIGNED_OPERATOR_NEW
};

}  // namespace segorient

#ifdef PCL_NO_PRECOMPILE
#include <segorient/orientation/impl/oriented_normal_estimation.hpp>
#endif
