// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <pcl/point_types.h>
#include <pcl/impl/instantiate.hpp>

/// The usual types of points; others are instantiated where they are used, with PCL_NO_PRECOMPILE.
#define SEGORIENT_INPUT_TYPES                                                             \
  (pcl::PointXYZ)(pcl::PointXYZI)(pcl::PointXYZL)(pcl::PointXYZRGB)(pcl::PointXYZRGBA)(   \
      pcl::PointXYZRGBL)(pcl::PointNormal)(pcl::PointXYZRGBNormal)(pcl::PointXYZINormal)( \
      pcl::PointXYZLNormal)
