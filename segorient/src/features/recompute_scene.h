// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <segorient/common/export.h>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "features/recompute_normals.h"

namespace segorient::detail {

/// What both rules read: the old labels and normals.
struct RecomputationScene {
  PointView points;
  const Neighborhoods& neighborhoods;
  const std::vector<std::uint8_t>& regular;
  const std::vector<std::int32_t>& labels;
  const std::vector<float>& normals;
  int entries;  ///< most entries of a row to use, the point itself included
  int threads;

  std::size_t size() const { return points.size; }
  int count(std::size_t i) const {
    const int c = neighborhoods.count(i);
    return c < entries ? c : entries;
  }
  std::size_t neighbor(std::size_t i, int j) const {
    return static_cast<std::size_t>(neighborhoods.indices(i)[j]);
  }
  bool isRegular(std::int32_t label) const {
    return label >= 0 && static_cast<std::size_t>(label) < regular.size() &&
           regular[static_cast<std::size_t>(label)] != 0;
  }
  /// |cos| of the angle between two points' normals; NaN where one is missing.
  double cosine(std::size_t a, std::size_t b) const {
    const float* u = &normals[4 * a];
    const float* v = &normals[4 * b];
    return std::abs(static_cast<double>(u[0]) * static_cast<double>(v[0]) +
                    static_cast<double>(u[1]) * static_cast<double>(v[1]) +
                    static_cast<double>(u[2]) * static_cast<double>(v[2]));
  }

  /// Whether the neighbourhood holds points of other segments, and normals that differ.
  /// \param flat normals with a larger cosine do not
  bool meetsBorder(std::size_t i, double flat) const {
    // Nearly all points are far from any border: what each of them costs is this loop.
    const pcl::index_t* row = neighborhoods.indices(i);
    const std::int32_t* label_of = labels.data();
    const std::int32_t label = label_of[i];
    const int end = count(i);
    std::int32_t difference = 0;
    int k = 1;
    for (; k + 4 <= end && difference == 0; k += 4) {
      difference = (label_of[row[k]] ^ label) | (label_of[row[k + 1]] ^ label) |
                   (label_of[row[k + 2]] ^ label) | (label_of[row[k + 3]] ^ label);
    }
    for (; k < end && difference == 0; ++k) difference = label_of[row[k]] ^ label;
    if (difference == 0 && isRegular(label)) return false;
    bool bent = false;
    for (int j = 1; j < end && !bent; ++j) bent = !(cosine(i, neighbor(i, j)) > flat);
    return bent;
  }
};

/// What becomes of one point.
struct Recomputed {
  std::size_t point = 0;
  bool accepted = false;
  /// The point lies on an edge itself and so has no face: not accepted.
  bool on_edge = false;
  std::int32_t label = -1;
  float normal[3] = {0, 0, 0};
};

/// What the one-sided rule gives a point.
enum class OneSidedNormal : std::uint8_t {
  LIKELIEST,  ///< normal of the side that the point most likely belongs to
  /// Mean of the sides' normals, each by how likely the point belongs to it: what noise leaves open
  /// stays in between. The scene's normals must be oriented, and so are the result's. Where many
  /// points lie on the edges themselves, as vertices of a mesh do, these are told.
  EXPECTED
};

/// What shares of all points tell the one-sided rule; of a part of a cloud they would tell others.
struct KnownEdges {
  bool any = false;          ///< whether the cloud has edges at all
  bool with_points = false;  ///< and many points on them
};

/// Round after round on one cloud, whose labels and normals may change in between.
class SEGORIENT_FEATURES_EXPORT OneSidedRule {
 public:
  /// \param known of the cloud that the points are part of; none = measured in each round
  explicit OneSidedRule(const RecomputationOptions& options,
                        OneSidedNormal which = OneSidedNormal::LIKELIEST,
                        std::optional<KnownEdges> known = {});
  ~OneSidedRule();
  OneSidedRule(const OneSidedRule&) = delete;
  OneSidedRule& operator=(const OneSidedRule&) = delete;

  /// One entry for each point that was looked at. What lies where no label has changed since the
  /// last round is as it was then.
  std::vector<Recomputed> apply(const RecomputationScene& scene);

 private:
  struct Rounds;

  RecomputationOptions options_;
  OneSidedNormal which_;
  std::optional<KnownEdges> known_;
  std::unique_ptr<Rounds> rounds_;
};
std::vector<Recomputed> applyModifiedNeighborhoods(const RecomputationScene& scene,
                                                   const RecomputationOptions& options);

}  // namespace segorient::detail
