// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/automatic/contrary_patches.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <utility>

#include "common/dot.h"
#include "common/parallel_for.h"

namespace segorient::detail {
namespace {

// 8 degrees: less than the faces of a narrow wedge differ by, more than curvature turns a normal by
// over a spacing.
constexpr float kSameFace = 0.99F;
// In spacings: less than the walls that can be told apart are thick.
constexpr float kOffset = 0.3F;
// First ring, and a little more.
constexpr int kReach = 8;
// Points of a patch that is looked at as a whole: wedges mix their sides over a few spacings only.
constexpr std::size_t kMostPoints = 200;
// Patches are turned that are smaller than this share of what they meet.
constexpr double kShare = 0.25;
// Confidence that one neighbour of the other sign among some tens would spoil.
constexpr float kUnanimous = 0.99F;
// In spacings, as above: noise of a tenth leaves normals and offsets well within these limits.
constexpr float kMostResidual = 0.1F;

enum class Agreement { UNKNOWN, SAME, CONTRARY };

/// Patches are found as they are asked for. A large one is never searched to its end.
class Patches {
 public:
  Patches(const PointView& points, const Neighborhoods& neighborhoods,
          const std::vector<float>& spacing, std::vector<float>& normals)
      : points_(points),
        neighborhoods_(neighborhoods),
        spacing_(spacing),
        normals_(normals),
        patch_(points.size, kNone) {}

  bool meetsContrary(std::size_t p) const {
    const pcl::index_t* row = neighborhoods_.indices(p);
    return std::any_of(row + 1, row + rowSize(p), [&](pcl::index_t q) {
      return agreement(p, static_cast<std::size_t>(q)) == Agreement::CONTRARY;
    });
  }

  void settle(std::size_t p) {
    forNeighbors(p, [&](std::size_t q) {
      if (agreement(p, q) == Agreement::CONTRARY) settle(patchOf(p), patchOf(q));
    });
  }

 private:
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

  struct Patch {
    std::vector<std::uint32_t> points;
    bool large = false;  ///< more points than are listed
  };

  int rowSize(std::size_t p) const { return std::min(neighborhoods_.count(p), kReach + 1); }
  template <typename Visit>
  void forNeighbors(std::size_t p, Visit&& visit) const {
    const pcl::index_t* row = neighborhoods_.indices(p);
    for (int j = 1; j < rowSize(p); ++j) visit(static_cast<std::size_t>(row[j]));
  }

  Agreement agreement(std::size_t p, std::size_t q) const {
    const float* n = normals_.data() + 4 * p;
    const float* m = normals_.data() + 4 * q;
    const float cosine = dot(n, m);
    if (!(std::fabs(cosine) > kSameFace)) return Agreement::UNKNOWN;
    float along_n = 0.F;
    float along_m = 0.F;
    for (std::size_t a = 0; a < 3; ++a) {
      const float d = points_[q][a] - points_[p][a];
      along_n += d * n[a];
      along_m += d * m[a];
    }
    const float offset = std::max(std::fabs(along_n), std::fabs(along_m));
    if (!(offset <= kOffset * std::min(spacing_[p], spacing_[q]))) return Agreement::UNKNOWN;
    return cosine > 0.F ? Agreement::SAME : Agreement::CONTRARY;
  }

  std::uint32_t patchOf(std::size_t p) {
    if (patch_[p] != kNone) return patch_[p];
    const auto id = static_cast<std::uint32_t>(patches_.size());
    Patch found;
    std::uint32_t known = kNone;
    const auto add = [&](std::size_t q) {
      patch_[q] = id;
      found.points.push_back(static_cast<std::uint32_t>(q));
    };
    add(p);
    for (std::size_t head = 0; head < found.points.size() && known == kNone; ++head) {
      const std::size_t i = found.points[head];
      forNeighbors(i, [&](std::size_t q) {
        if (patch_[q] == id || agreement(i, q) != Agreement::SAME) return;
        if (patch_[q] != kNone) {
          known = patch_[q];
        } else {
          add(q);
        }
      });
      found.large = found.points.size() > kMostPoints;
      if (found.large) break;
    }
    if (known != kNone) {
      join(found, known);
      return known;
    }
    patches_.push_back(std::move(found));
    return id;
  }

  void join(const Patch& patch, std::uint32_t into) {
    Patch& target = patches_[into];
    for (const std::uint32_t i : patch.points) patch_[i] = into;
    if (!target.large) {
      target.points.insert(target.points.end(), patch.points.begin(), patch.points.end());
    }
    target.large = target.large || patch.large || target.points.size() > kMostPoints;
  }

  void settle(std::uint32_t a, std::uint32_t b) {
    if (a == b) return;
    const auto size = [&](std::uint32_t i) {
      return patches_[i].large ? std::numeric_limits<double>::infinity()
                               : static_cast<double>(patches_[i].points.size());
    };
    if (size(a) > size(b)) std::swap(a, b);
    if (patches_[a].large || size(a) > kShare * size(b)) return;
    const Patch turned = std::exchange(patches_[a], {});
    for (const std::size_t i : turned.points) {
      for (std::size_t c = 0; c < 3; ++c) normals_[4 * i + c] = -normals_[4 * i + c];
    }
    join(turned, b);
  }

  const PointView& points_;
  const Neighborhoods& neighborhoods_;
  const std::vector<float>& spacing_;
  std::vector<float>& normals_;
  std::vector<std::uint32_t> patch_;  ///< by point
  std::vector<Patch> patches_;
};

}  // namespace

void turnContraryPatches(const PointView& points, const Neighborhoods& neighborhoods,
                         const std::vector<float>& spacing, float residual, int threads,
                         FilteredNormals& filtered) {
  if (!(residual < kMostResidual)) return;
  Patches patches(points, neighborhoods, spacing, filtered.normals);
  std::vector<std::uint8_t> contrary(points.size);
  parallelFor(points.size, threads, 100.0, [&](std::size_t p) {
    const bool agreed = filtered.confidences[p] > kUnanimous;
    contrary[p] = !agreed && patches.meetsContrary(p) ? 1 : 0;
  });
  for (std::size_t p = 0; p < points.size; ++p) {
    if (contrary[p] != 0) patches.settle(p);
  }
}

}  // namespace segorient::detail
