// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "features/local_normals.h"
#include "features/point_set.h"
#include "features/recompute_scene.h"
#include "features/symmetric_eigen.h"

namespace segorient::detail {
namespace {

using Border = std::pair<std::int32_t, std::int32_t>;

Border borderOf(std::int32_t a, std::int32_t b) {
  return {std::min(a, b), std::max(a, b)};
}

/// Reference normals without signs: of the unit vectors the one that is nearest to all normals of
/// the segment in the sense of squared cosines.
std::vector<SymmetricEigen3> referenceNormals(const RecomputationScene& scene) {
  std::vector<SymmetricMatrix3> sums(scene.regular.size(), SymmetricMatrix3{});
  for (std::size_t i = 0; i < scene.size(); ++i) {
    const std::int32_t label = scene.labels[i];
    const float* f = &scene.normals[4 * i];
    if (label < 0 || static_cast<std::size_t>(label) >= sums.size() || !isFinite(f)) continue;
    const double n[3] = {f[0], f[1], f[2]};
    sums[static_cast<std::size_t>(label)].add(n);
  }
  std::vector<SymmetricEigen3> result;
  result.reserve(sums.size());
  for (const SymmetricMatrix3& m : sums) result.push_back(symmetricEigen(m));
  return result;
}

/// For each two touching segments the cosine of the angle between them: of their reference normals,
/// or the mean over the pairs of neighbours across the border.
std::map<Border, double> borderCosines(const RecomputationScene& scene, bool between_references) {
  struct Mean {
    double sum = 0;
    double count = 0;
  };
  std::map<Border, Mean> means;
  for (std::size_t i = 0; i < scene.size(); ++i) {
    if (!scene.isRegular(scene.labels[i])) continue;
    for (int j = 1; j < scene.count(i); ++j) {
      const std::size_t q = scene.neighbor(i, j);
      if (scene.labels[q] == scene.labels[i] || !scene.isRegular(scene.labels[q])) continue;
      const double c = scene.cosine(i, q);
      if (std::isnan(c)) continue;
      Mean& mean = means[borderOf(scene.labels[i], scene.labels[q])];
      mean.sum += c;
      mean.count += 1;
    }
  }
  std::vector<SymmetricEigen3> references;
  if (between_references) references = referenceNormals(scene);
  std::map<Border, double> cosines;
  for (const auto& [border, mean] : means) {
    double c = mean.sum / mean.count;
    if (between_references) {
      const double* a = references[static_cast<std::size_t>(border.first)].vectors[2];
      const double* b = references[static_cast<std::size_t>(border.second)].vectors[2];
      c = std::abs(a[0] * b[0] + a[1] * b[1] + a[2] * b[2]);
    }
    cosines[border] = c;
  }
  return cosines;
}

/// Modified neighbourhoods, one point after the other.
class Modifier {
 public:
  Modifier(const RecomputationScene& scene, const std::map<Border, double>& cosines, double delta)
      : scene_(scene), cosines_(cosines), sharp_(std::cos(delta)) {}

  /// \param out at most `entries` points, the point itself first
  /// \return whether the neighbourhood had to be modified
  bool modify(std::size_t i, std::vector<pcl::index_t>& out) {
    const std::int32_t label = scene_.labels[i];
    out.clear();
    if (!scene_.isRegular(label)) return false;
    seen_.clear();
    for (int j = 0; j < scene_.count(i); ++j) {
      const std::size_t q = scene_.neighbor(i, j);
      if (!marked(label, q)) continue;
      out.push_back(static_cast<pcl::index_t>(q));
      seen_.insert(q);
    }
    const auto full = static_cast<std::size_t>(scene_.count(i));
    if (out.size() == full) return false;
    refill(i, full, out);
    return out.size() > 5;
  }

 private:
  /// Whether the point is in this segment or in one beyond a smooth border.
  bool marked(std::int32_t label, std::size_t q) const {
    if (scene_.labels[q] == label) return true;
    const auto border = cosines_.find(borderOf(label, scene_.labels[q]));
    return border != cosines_.end() && border->second > sharp_;
  }

  /// Adds marked neighbours of those that are in, nearest first, ring by ring.
  void refill(std::size_t i, std::size_t full, std::vector<pcl::index_t>& out) {
    const std::int32_t label = scene_.labels[i];
    const float* p = scene_.points[i];
    std::size_t begin = 0;
    while (out.size() < full && begin < out.size()) {
      const std::size_t end = out.size();
      ring_.clear();
      for (std::size_t m = begin; m < end; ++m) {
        const auto from = static_cast<std::size_t>(out[m]);
        for (int j = 0; j < scene_.count(from); ++j) {
          const std::size_t q = scene_.neighbor(from, j);
          if (!marked(label, q) || !seen_.insert(q)) continue;
          double d = 0;
          for (int a = 0; a < 3; ++a) {
            const double o = static_cast<double>(scene_.points[q][a]) - static_cast<double>(p[a]);
            d += o * o;
          }
          ring_.emplace_back(d, static_cast<pcl::index_t>(q));
        }
      }
      std::sort(ring_.begin(), ring_.end());
      for (const auto& [distance, q] : ring_) {
        if (out.size() == full) break;
        out.push_back(q);
      }
      begin = end;
    }
  }

  const RecomputationScene& scene_;
  const std::map<Border, double>& cosines_;
  double sharp_;
  PointSet seen_;
  std::vector<std::pair<double, pcl::index_t>> ring_;
};

}  // namespace

std::vector<Recomputed> applyModifiedNeighborhoods(const RecomputationScene& scene,
                                                   const RecomputationOptions& options) {
  const std::map<Border, double> cosines = borderCosines(scene, options.delta_between_references);
  Modifier modifier(scene, cosines, static_cast<double>(options.delta));
  std::vector<Recomputed> results;
  std::vector<std::vector<pcl::index_t>> rows;
  std::vector<float> queries;
  std::vector<pcl::index_t> row;
  for (std::size_t i = 0; i < scene.size(); ++i) {
    if (!scene.meetsBorder(i, 1.0)) continue;
    Recomputed result;
    result.point = i;
    result.label = scene.labels[i];
    result.accepted = modifier.modify(i, row);
    if (result.accepted) {
      rows.push_back(row);
      queries.insert(queries.end(),
                     {scene.points[i][0], scene.points[i][1], scene.points[i][2], 0.F});
    }
    results.push_back(result);
  }

  Neighborhoods table;
  table.reset(rows.size(), scene.entries, false);
  for (std::size_t r = 0; r < rows.size(); ++r) {
    std::copy(rows[r].begin(), rows[r].end(), table.mutableIndices(r));
    table.setCount(r, static_cast<int>(rows[r].size()));
  }
  LocalNormalOptions local;
  local.estimator = options.estimator;
  local.threads = scene.threads;
  std::vector<float> normals(4 * rows.size());
  estimateNormals({queries.data(), 4, rows.size()}, scene.points, table, local, normals.data());
  std::size_t next = 0;
  for (Recomputed& result : results) {
    if (!result.accepted) continue;
    const float* n = &normals[4 * next++];
    result.accepted = isFinite(n);
    if (result.accepted) std::copy_n(n, 3, result.normal);
  }
  return results;
}

}  // namespace segorient::detail
