// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/neighborhoods.h>
#include <segorient/search/median_hash_index.h>
#include <segorient/segmentation/segmentation.h>

#include <array>
#include <cmath>
#include <vector>

#include "orientation/paper/combination.h"
#include "orientation/paper/extremal_points.h"
#include "orientation/paper/segment_links.h"
#include "orientation/paper/segment_relations.h"
#include "oriented_shapes.h"
#include "segmentation/segment_graph.h"

namespace segorient::test {

/// A cloud whose segments are its faces, with true normals of scrambled signs; face f is turned
/// over where turned[f] is true. So the right answer of every method is known: exactly these.
struct FaceSegments {
  LabelledCloud cloud;
  std::vector<float> normals;
  Neighborhoods neighborhoods;
  Segmentation segmentation;
  SegmentGraph links;

  FaceSegments(LabelledCloud faces, const std::vector<bool>& turned, int k = 12)
      : cloud(std::move(faces)), normals(scrambledNormals(cloud, 7)) {
    search::MedianHashIndex index;
    index.build(points(), nullptr, {});
    index.nearestKAll(k + 1, neighborhoods);
    segmentation.segments.resize(turned.size());
    segmentation.labels.assign(cloud.face.begin(), cloud.face.end());
    segmentation.signs.resize(cloud.size());
    for (std::size_t s = 0; s < turned.size(); ++s) {
      Segment& segment = segmentation.segments[s];
      segment.first = static_cast<std::uint32_t>(segmentation.members.size());
      std::array<float, 3> sum{};
      for (std::size_t i = 0; i < cloud.size(); ++i) {
        if (cloud.face[i] != static_cast<int>(s)) continue;
        segmentation.members.push_back(static_cast<pcl::index_t>(i));
        const bool same = dot3(&normals[4 * i], &cloud.normals[4 * i]) > 0;
        segmentation.signs[i] = same != turned[s] ? std::int8_t{1} : std::int8_t{-1};
        for (std::size_t a = 0; a < 3; ++a) {
          sum[a] += static_cast<float>(segmentation.signs[i]) * normals[4 * i + a];
        }
      }
      segment.size = static_cast<std::uint32_t>(segmentation.members.size()) - segment.first;
      const float length = std::sqrt(dot3(sum.data(), sum.data()));
      for (std::size_t a = 0; a < 3; ++a) segment.reference_normal[a] = sum[a] / length;
    }
    links = linkRegularSegments(segmentation, buildSegmentGraph(segmentation, neighborhoods),
                                neighborhoods);
  }

  PointView points() const { return pointsOf(cloud); }
  NormalView normalView() const { return {normals.data(), 4, cloud.size()}; }
};

/// Whether the segments' signs undo exactly what was turned, up to one sign for all.
inline bool undoes(const std::vector<SegmentOrientationResult>& results,
                   const std::vector<bool>& turned, bool up_to_sign) {
  bool as_is = true;
  bool reversed = true;
  for (std::size_t s = 0; s < turned.size(); ++s) {
    const int wanted = turned[s] ? -1 : 1;
    as_is = as_is && results[s].sign == wanted;
    reversed = reversed && results[s].sign == -wanted;
  }
  return as_is || (up_to_sign && reversed);
}

}  // namespace segorient::test
