// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <pcl/PolygonMesh.h>
#include <pcl/Vertices.h>
#include <pcl/surface/reconstruction.h>
#include <segorient/segmentation/segmentation.h>
#include <segorient/surface/segment_mesh.h>

#include <vector>

namespace segorient {

/// Triangulates the segments of a cloud, each seen along its reference normal (paper,
/// section 3.2.1). Takes the place of pcl::GreedyProjectionTriangulation where gaps along sharp
/// edges do not matter: the segments' meshes do not meet.
///
/// @code
/// segorient::SegmentTriangulation<pcl::PointNormal> triangulation;
/// triangulation.setInputCloud(cloud_with_normals);
/// triangulation.setSegmentation(segmentation.getPlanarSegmentation());  // else its own
/// pcl::PolygonMesh mesh;
/// triangulation.reconstruct(mesh);
/// @endcode
///
/// Faces are counter-clockwise as seen from where their segment's reference normal points to.
/// Without a cloud, or with a segmentation of another one, it reports through PCL_ERROR and gives
/// no polygons.
template <typename PointNT>
class SegmentTriangulation : public pcl::MeshConstruction<PointNT> {
 public:
  using Base = pcl::MeshConstruction<PointNT>;
  using Ptr = pcl::shared_ptr<SegmentTriangulation<PointNT>>;
  using ConstPtr = pcl::shared_ptr<const SegmentTriangulation<PointNT>>;

  SegmentTriangulation() { this->check_tree_ = false; }

  /// Segments of the input cloud; an empty one (default): the cloud is segmented by its normals,
  /// with NormalSegmentation's defaults.
  void setSegmentation(const Segmentation& segmentation) { segmentation_ = segmentation; }
  const Segmentation& getSegmentation() const { return segmentation_; }

  /// See TriangulationOptions: share of the fullest bin that counts as a maximum; default 0.1.
  void setKappa1(float kappa1) { options_.kappa1 = kappa1; }
  float getKappa1() const { return options_.kappa1; }

  /// Share of the critical length that edges of boundary triangles may have; default 0.7.
  void setKappa2(float kappa2) { options_.kappa2 = kappa2; }
  float getKappa2() const { return options_.kappa2; }

  /// Critical length over the right end of the last maximum; default 2, the paper's rule is 1.
  void setCriticalFactor(float factor) { options_.critical_factor = factor; }
  float getCriticalFactor() const { return options_.critical_factor; }

  /// Bins of the histogram; default 0: as wide as a quarter of the median edge.
  void setNumberOfBins(int bins) { options_.bins = bins; }
  int getNumberOfBins() const { return options_.bins; }

  /// Whether pockets and holes no larger than random sampling leaves are filled; default true, the
  /// paper's rule is false.
  void setFillGaps(bool fill) { options_.fill_gaps = fill; }
  bool getFillGaps() const { return options_.fill_gaps; }

  /// Whether connected and isolated segments are triangulated, too; default false.
  void setAllSegments(bool all) { all_ = all; }
  bool getAllSegments() const { return all_; }

  /// 0 (default) = all cores. The result does not depend on it.
  void setNumberOfThreads(unsigned int threads = 0) {
    options_.threads = static_cast<int>(threads);
  }
  unsigned int getNumberOfThreads() const { return static_cast<unsigned int>(options_.threads); }

  /// All segments as one mesh over the whole input cloud.
  void reconstruct(pcl::PolygonMesh& output) override;
  void reconstruct(std::vector<pcl::Vertices>& polygons) override;

  /// By segment, after reconstruct(): triangles, boundary loops, duplicates.
  const std::vector<SegmentMesh>& getMeshes() const { return meshes_; }

  /// One segment of the last reconstruct() as a mesh of its own points only, which are those of the
  /// cloud that was triangulated.
  /// \return false if there is no such segment or it has no triangles; the mesh is empty then
  bool getSegmentMesh(std::size_t segment, pcl::PolygonMesh& output) const;

 protected:
  using Base::fake_indices_;
  using Base::indices_;
  using Base::input_;

  void performReconstruction(pcl::PolygonMesh& output) override;
  void performReconstruction(std::vector<pcl::Vertices>& polygons) override;

 private:
  bool usable(const char* what) const;

  Segmentation segmentation_;
  TriangulationOptions options_;
  bool all_ = false;
  std::vector<SegmentMesh> meshes_;
  typename pcl::PointCloud<PointNT>::ConstPtr triangulated_;  ///< that meshes_ are of
};

}  // namespace segorient

#ifdef PCL_NO_PRECOMPILE
#include <segorient/surface/impl/segment_triangulation.hpp>
#endif
