// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <pcl/point_types.h>
#include <pcl/impl/instantiate.hpp>
#include <segorient/surface/impl/segment_triangulation.hpp>

PCL_INSTANTIATE(SegmentTriangulation, (pcl::PointNormal)(pcl::PointXYZRGBNormal)(
                                          pcl::PointXYZINormal)(pcl::PointXYZLNormal))
