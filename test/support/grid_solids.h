// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <cmath>
#include <cstddef>

#include "labelled_solids.h"

namespace segorient::test {

/// Points of a regular grid on a box, those on its edges and corners included once, as CAD exports
/// and voxel tools write them. A point of an edge belongs to two faces; it is given the first one.
/// \param steps along x, y and z
/// \param angle that the box is turned by about a slanted axis, so that no axis is special
inline LabelledCloud gridBox(int steps_x, int steps_y, int steps_z, double angle = 0) {
  LabelledCloud cloud;
  cloud.name = "grid box";
  cloud.spacing = 1.0 / steps_x;
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(angle, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  const int steps[3] = {steps_x, steps_y, steps_z};
  for (int c = 0; c < 3; ++c) {
    cloud.area += 2.0 * steps[c] * steps[(c + 1) % 3] * cloud.spacing * cloud.spacing;
  }
  for (int x = 0; x <= steps_x; ++x) {
    for (int y = 0; y <= steps_y; ++y) {
      for (int z = 0; z <= steps_z; ++z) {
        const int at[3] = {x, y, z};
        int face = -1;
        for (int c = 0; c < 3 && face < 0; ++c) {
          if (at[c] == 0) face = 2 * c;
          if (at[c] == steps[c]) face = 2 * c + 1;
        }
        if (face < 0) continue;
        Eigen::Vector3d normal = Eigen::Vector3d::Zero();
        normal[face / 2] = face % 2 == 0 ? -1 : 1;
        normal = turn * normal;
        const Eigen::Vector3d p = turn * (cloud.spacing * Eigen::Vector3d(x, y, z));
        for (int c = 0; c < 3; ++c) cloud.xyz.push_back(static_cast<float>(p[c]));
        for (int c = 0; c < 3; ++c) cloud.normals.push_back(static_cast<float>(normal[c]));
        cloud.xyz.push_back(0);
        cloud.normals.push_back(0);
        cloud.face.push_back(face);
      }
    }
  }
  return cloud;
}

}  // namespace segorient::test
