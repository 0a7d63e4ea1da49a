// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
//
// Other searches, as their users would call them, each with a loop over all queries.
#pragma once

#include <pcl/search/search.h>

#include <cstdint>
#include <flann/flann.hpp>
#include <vector>

#include "benchmark_clouds.h"
#include "search_race.h"
#ifdef SEGORIENT_HAVE_NANOFLANN
#include <nanoflann.hpp>
#endif

namespace segorient::benchmark {

/// Queries one by one through PCL's interface.
inline void nearestLoop(const pcl::search::Search<pcl::PointXYZ>& tree, const Cloud& queries, int k,
                        unsigned int threads) {
  inParts(queries.size(), threads, [&](std::size_t begin, std::size_t end) {
    pcl::Indices indices;
    std::vector<float> distances;
    for (std::size_t i = begin; i < end; ++i) {
      tree.nearestKSearch(queries[i], k, indices, distances);
    }
  });
}

inline void radiusLoop(const pcl::search::Search<pcl::PointXYZ>& tree, const Cloud& queries,
                       double radius, unsigned int threads) {
  inParts(queries.size(), threads, [&](std::size_t begin, std::size_t end) {
    pcl::Indices indices;
    std::vector<float> distances;
    for (std::size_t i = begin; i < end; ++i) {
      tree.radiusSearch(queries[i], radius, indices, distances);
    }
  });
}

/// FLANN's kd-tree for three dimensions without PCL around it, all queries in one call.
class Flann {
 public:
  explicit Flann(const Cloud& cloud)
      : points_(coordinates(cloud)), tree_(matrix(points_), flann::KDTreeSingleIndexParams(15)) {
    tree_.buildIndex();
  }
  void nearest(const Cloud& queries, int k, unsigned int threads) const {
    std::vector<float> from = coordinates(queries);
    const auto columns = static_cast<std::size_t>(k);
    std::vector<int> indices(queries.size() * columns);
    std::vector<float> distances(queries.size() * columns);
    inParts(queries.size(), threads, [&](std::size_t begin, std::size_t end) {
      flann::Matrix<int> found(&indices[begin * columns], end - begin, columns);
      flann::Matrix<float> squared(&distances[begin * columns], end - begin, columns);
      tree_.knnSearch(flann::Matrix<float>(&from[3 * begin], end - begin, 3), found, squared,
                      columns, flann::SearchParams(flann::FLANN_CHECKS_UNLIMITED));
    });
  }

 private:
  static std::vector<float> coordinates(const Cloud& cloud) {
    std::vector<float> out;
    for (const auto& p : cloud) out.insert(out.end(), p.data, p.data + 3);
    return out;
  }
  static flann::Matrix<float> matrix(std::vector<float>& values) {
    return {values.data(), values.size() / 3, 3};
  }
  std::vector<float> points_;
  flann::KDTreeSingleIndex<flann::L2_Simple<float>> tree_;
};

#ifdef SEGORIENT_HAVE_NANOFLANN
/// nanoflann on a PCL cloud, in place.
class Nanoflann {
 public:
  explicit Nanoflann(const Cloud& cloud) : adaptor_{cloud}, tree_(3, adaptor_, {15}) {
    tree_.buildIndex();
  }
  void nearest(const Cloud& queries, int k, unsigned int threads) const {
    inParts(queries.size(), threads, [&](std::size_t begin, std::size_t end) {
      std::vector<std::uint32_t> indices(static_cast<std::size_t>(k));
      std::vector<float> distances(indices.size());
      for (std::size_t i = begin; i < end; ++i) {
        tree_.knnSearch(queries[i].data, indices.size(), indices.data(), distances.data());
      }
    });
  }
  void within(const Cloud& queries, double radius, unsigned int threads) const {
    const auto squared = static_cast<float>(radius * radius);
    inParts(queries.size(), threads, [&](std::size_t begin, std::size_t end) {
      std::vector<std::pair<std::uint32_t, float>> found;
      for (std::size_t i = begin; i < end; ++i) {
        tree_.radiusSearch(queries[i].data, squared, found, nanoflann::SearchParams());
      }
    });
  }

 private:
  struct Adaptor {
    const Cloud& cloud;
    std::size_t kdtree_get_point_count() const { return cloud.size(); }
    float kdtree_get_pt(std::size_t i, std::size_t axis) const { return cloud[i].data[axis]; }
    template <class Box>
    bool kdtree_get_bbox(Box& /*box*/) const {
      return false;
    }
  };
  using Tree =
      nanoflann::KDTreeSingleIndexAdaptor<nanoflann::L2_Simple_Adaptor<float, Adaptor>, Adaptor, 3>;
  Adaptor adaptor_;
  Tree tree_;
};
#endif

}  // namespace segorient::benchmark
