// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <pcl/PointIndices.h>
#include <pcl/pcl_base.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>
#include <pcl/search/search.h>
#include <segorient/segmentation/impl/cloud_segmentation.hpp>

#include <limits>
#include <memory>
#include <vector>

namespace segorient {

/// Cuts a cloud into faces of similar normals: region growing by alpha and beta, then three
/// clean-up passes (paper, section 2.3). Takes the place of pcl::RegionGrowing; setters with the
/// same meaning have the same names.
///
/// @code
/// segorient::NormalSegmentation<pcl::PointXYZ, pcl::Normal> segmentation;
/// segmentation.setInputCloud(cloud);
/// segmentation.setInputNormals(normals);
/// std::vector<pcl::PointIndices> faces;
/// segmentation.extract(faces);            // by descending size
/// auto colored = segmentation.getColoredCloud();
/// @endcode
///
/// Different from pcl::RegionGrowing: normals need not be oriented; a normal is compared with its
/// neighbour's (alpha) and with the mean of the segment (beta); gaps are not jumped and the sides
/// of thin walls not mixed; small segments are cleaned up; the result does not depend on the order
/// of the points. Neighbours come from an all-points search of its own; a search method is only
/// needed to have others.
///
/// Beta keeps each segment so flat that it can be seen through a plane: triangulation and
/// orientation build on that, and take getPlanarSegmentation(). A round face consists of several
/// such segments. Everything without Planar in its name, extract() and getLabels() first of all,
/// is about whole faces: segments united where their common border is smooth, unless
/// setUniteSmooth (false).
///
/// Without a cloud, or with normals of another size, extract() reports through PCL_ERROR and gives
/// no segments. Points with NaN coordinates or normals are in no segment, nor are strays farther
/// from the bulk of the points than 2^24 times its extent, where floats end.
template <typename PointT, typename NormalT>
class NormalSegmentation : public pcl::PCLBase<PointT> {
 public:
  using Base = pcl::PCLBase<PointT>;
  using typename Base::PointCloud;
  using typename Base::PointCloudConstPtr;
  using Ptr = pcl::shared_ptr<NormalSegmentation<PointT, NormalT>>;
  using ConstPtr = pcl::shared_ptr<const NormalSegmentation<PointT, NormalT>>;
  using KdTree = pcl::search::Search<PointT>;
  using KdTreePtr = typename KdTree::Ptr;
  using Normal = pcl::PointCloud<NormalT>;
  using NormalPtr = typename Normal::Ptr;
  using NormalConstPtr = typename Normal::ConstPtr;

  void setInputCloud(const PointCloudConstPtr& cloud) override;
  void setIndices(const pcl::IndicesPtr& indices) override;
  void setIndices(const pcl::IndicesConstPtr& indices) override;
  void setIndices(const pcl::PointIndicesConstPtr& indices) override;
  void setIndices(std::size_t row_start, std::size_t col_start, std::size_t nb_rows,
                  std::size_t nb_cols) override;

  /// Unit normals with curvature, one a point of the cloud; signs do not matter.
  void setInputNormals(const NormalConstPtr& normals) { set(normals_, normals); }
  NormalConstPtr getInputNormals() const { return normals_; }

  /// Search to take neighbours from; null (default) for the all-points search of
  /// search::MedianHash.
  void setSearchMethod(const KdTreePtr& search) { set(search_, search); }
  KdTreePtr getSearchMethod() const { return search_; }

  /// Ready neighbourhoods of the whole cloud (row = point), so that neighbours are found once; null
  /// (default) to search. At most setNumberOfNeighbours() of each row are used.
  void setNeighborhoods(const std::shared_ptr<const Neighborhoods>& neighborhoods);
  std::shared_ptr<const Neighborhoods> getNeighborhoods() const { return neighborhoods_; }

  /// Neighbours of a point, itself not counted; default 10. With 0 there are no segments, as in
  /// PCL.
  void setNumberOfNeighbours(unsigned int neighbors);
  unsigned int getNumberOfNeighbours() const { return neighbors_; }

  /// Alpha: largest angle between the normals of two neighbours; default 20 degrees, in radians.
  void setSmoothnessThreshold(float alpha) { set(options_.alpha, alpha); }
  float getSmoothnessThreshold() const { return options_.alpha; }

  /// Beta: largest angle between a point's normal and the segment's reference normal; default 30
  /// degrees. A right angle or more: no such limit.
  void setReferenceThreshold(float beta) { set(options_.beta, beta); }
  float getReferenceThreshold() const { return options_.beta; }

  /// Epsilon: by how much the clean-up may exceed beta; default 10 degrees.
  void setReferenceTolerance(float epsilon) { set(options_.epsilon, epsilon); }
  float getReferenceTolerance() const { return options_.epsilon; }

  /// Points of higher curvature join a segment but do not pass it on, nor are segments united
  /// across them; default: no limit.
  void setCurvatureThreshold(float curvature) { set(options_.max_curvature, curvature); }
  float getCurvatureThreshold() const { return options_.max_curvature; }

  /// Whether the curvature threshold is used; default true. Unlike in PCL, this does not switch the
  /// residual test on when it is switched off, nor the other way round.
  void setCurvatureTestFlag(bool value) { set(curvature_test_, value); }
  bool getCurvatureTestFlag() const { return curvature_test_; }

  /// Points farther than this off the tangent plane of the point that they are reached from join a
  /// segment but do not pass it on, nor are segments united there; in the cloud's unit of length,
  /// default 0.05. Not above 0 while the test is on: no segments, as in PCL.
  void setResidualThreshold(float residual) { set(residual_, residual); }
  float getResidualThreshold() const { return residual_; }

  /// Whether the residual threshold is used; default false.
  void setResidualTestFlag(bool value) { set(residual_test_, value); }
  bool getResidualTestFlag() const { return residual_test_; }

  /// True (default): a normal is compared with that of the neighbour that it is reached from,
  /// false: with that of the segment's first point; segments are then not united. Beta is looked at
  /// in any case.
  void setSmoothModeFlag(bool value) { set(options_.compare_with_seed, !value); }
  bool getSmoothModeFlag() const { return !options_.compare_with_seed; }

  /// Segments with fewer points are small: the clean-up works on them; default 20.
  void setSmallSegmentSize(std::size_t points) { set(options_.small_size, points); }
  std::size_t getSmallSegmentSize() const { return options_.small_size; }

  /// Pass 1: share of the surrounding points that a segment must hold to take a small one in;
  /// default 0.4.
  void setNeighborShare(float share) { set(options_.neighbor_share, share); }
  float getNeighborShare() const { return options_.neighbor_share; }

  /// Neighbours farther apart than this many local spacings are none; default 2.5, 0 = no limit.
  void setMaximumGap(float spacings) { set(options_.max_gap, spacings); }
  float getMaximumGap() const { return options_.max_gap; }

  /// Points farther than this many local spacings off the tangent plane are not reached; default
  /// 0.5, 0 = no limit. Raised by itself on noisy clouds, see SegmentationOptions::max_offset.
  void setMaximumOffset(float spacings) { set(options_.max_offset, spacings); }
  float getMaximumOffset() const { return options_.max_offset; }

  /// Points along sharp edges go to the segment whose flat part, continued, passes nearest; default
  /// true.
  void setSettleEdges(bool value) { set(options_.settle_edges, value); }
  bool getSettleEdges() const { return options_.settle_edges; }

  /// Clean-up pass 1: a small segment joins the neighbouring one that agrees with it best; default
  /// true. What it did: getReport().absorbed.
  void setAbsorbSmall(bool value) { set(options_.absorb_small, value); }
  bool getAbsorbSmall() const { return options_.absorb_small; }
  /// Pass 2: points of small segments join regular ones one by one; default true. What it did:
  /// getReport().extracted.
  void setExtractEdges(bool value) { set(options_.extract_edges, value); }
  bool getExtractEdges() const { return options_.extract_edges; }
  /// Pass 3: small segments that touch become connected ones; without it they stay isolated.
  /// Default true. What it did: getReport().connected.
  void setConnectSmall(bool value) { set(options_.connect_small, value); }
  bool getConnectSmall() const { return options_.connect_small; }

  /// Whether segments that only beta parted become one face again; default true. What it did:
  /// getReport().united.
  void setUniteSmooth(bool value) { set(unite_smooth_, value); }
  bool getUniteSmooth() const { return unite_smooth_; }

  /// Segments that extract() leaves out: those of fewer points (default 1) or more (default: no
  /// limit).
  void setMinClusterSize(pcl::uindex_t points) { min_size_ = points; }
  pcl::uindex_t getMinClusterSize() const { return min_size_; }
  void setMaxClusterSize(pcl::uindex_t points) { max_size_ = points; }
  pcl::uindex_t getMaxClusterSize() const { return max_size_; }

  /// 0 (default) = all cores. The result does not depend on it.
  void setNumberOfThreads(unsigned int threads = 0) {
    options_.threads = static_cast<int>(threads);
  }
  unsigned int getNumberOfThreads() const { return static_cast<unsigned int>(options_.threads); }

  /// The faces by descending size, as indices into the cloud. Segments anew each time, as PCL does:
  /// points may have changed in place.
  virtual void extract(std::vector<pcl::PointIndices>& clusters);

  /// The face that holds a point; empty if the point is in none.
  virtual void getSegmentFromPoint(pcl::index_t index, pcl::PointIndices& cluster);

  /// The cloud with a colour a face (pcl::GlasbeyLUT by label; always the same for the same faces),
  /// grey where there is none. Null before extract().
  pcl::PointCloud<pcl::PointXYZRGB>::Ptr getColoredCloud();
  pcl::PointCloud<pcl::PointXYZRGBA>::Ptr getColoredCloudRGBA();

  /// Face of each point of the cloud, -1 = none; empty before extract().
  const std::vector<std::int32_t>& getLabels() const { return result_.faces().labels; }
  /// The faces by label: kind, size, reference normal, centroid, area, rms; empty before extract().
  const std::vector<Segment>& getSegments() const { return result_.faces().segments; }
  /// The faces with their points: getLabels(), getSegments(), members and signs in one. Empty
  /// before extract().
  const Segmentation& getFaces() const { return result_.faces(); }
  /// How surely each point of the cloud is in its face: the share of its neighbours that are in the
  /// same one, 0 without a face; empty before extract().
  std::vector<float> getConfidences() const { return result_.confidences(); }
  /// The segments before they were united, with labels of their own: what SegmentTriangulation and
  /// SegmentOrientation take. Empty before extract().
  const Segmentation& getPlanarSegmentation() const { return result_.segmentation(); }
  /// What growing and each clean-up pass did.
  const SegmentationReport& getReport() const { return result_.report(); }
  /// Which segments of getPlanarSegmentation() touch, and the point pairs across each border.
  SegmentGraph getPlanarSegmentGraph() const { return result_.graph(); }

  // As version 1.0 had them.
  [[deprecated("getPlanarSegmentation")]] const Segmentation& getSegmentation() const {
    return getPlanarSegmentation();
  }
  [[deprecated("getPlanarSegmentGraph")]] SegmentGraph getSegmentGraph() const {
    return getPlanarSegmentGraph();
  }

 protected:
  using Base::deinitCompute;
  using Base::fake_indices_;
  using Base::indices_;
  using Base::initCompute;
  using Base::input_;

 private:
  bool segment();
  bool settingsAreGood() const;
  void outdated() {
    if (!done_) return;
    result_.clear();
    done_ = false;
  }
  /// Changes what segments depend on.
  template <typename T>
  void set(T& setting, const T& value) {
    setting = value;
    outdated();
  }
  CloudSegmentation::Search searchFunction();
  template <typename ColoredT>
  typename pcl::PointCloud<ColoredT>::Ptr colored() const;

  NormalConstPtr normals_;
  KdTreePtr search_;
  std::shared_ptr<const Neighborhoods> neighborhoods_;
  SegmentationOptions options_;
  unsigned int neighbors_ = 10;
  bool curvature_test_ = true;
  bool residual_test_ = false;
  float residual_ = 0.05F;
  bool unite_smooth_ = true;
  pcl::uindex_t min_size_ = 1;
  pcl::uindex_t max_size_ = std::numeric_limits<pcl::uindex_t>::max();
  CloudSegmentation result_;
  bool done_ = false;
};

}  // namespace segorient

#ifdef PCL_NO_PRECOMPILE
#include <segorient/segmentation/impl/normal_segmentation.hpp>
#endif
