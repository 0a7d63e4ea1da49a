// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "render/visibility.h"

#include <algorithm>
#include <cmath>

#include "common/threads.h"
#include "render/page/vectors.h"

namespace segorient::program {
namespace {

// Discs of twice the radius have 32 points in them instead of 8: beside a straight edge, where half
// of a disc is missing, that leaves one place in ten million uncovered.
constexpr float kReach = 2.F;
constexpr float kLeastReach = 1.5F;  // pixels: a point hides those in the pixels around
// Sine of 6 degrees: what lies less high above the plane of a point may be of its own surface. Half
// the slope of the plane where that is less: a surface that turns away from the viewer at its
// outline lies before what is behind the outline at no larger angle.
constexpr float kLift = 0.1F;
constexpr float kNoise = 6.F;         // standard deviations
constexpr float kTouch = 0.1F;        // of a radius: so far before a surface, a point is on it
constexpr float kLeastSlope = 0.05F;  // a disc seen from its edge still ends somewhere
constexpr float kFarBehind = 4.F;     // reaches
constexpr std::uint32_t kNone = 0xffffffffU;
constexpr int kTile = 8;  // pixels

float reachOf(const FlatSplat& s) {
  return std::max(kLeastReach, kReach * s.radius);
}

// The splats that face the viewer, by tiles of the picture.
class Tiles {
 public:
  // Only those tiles are filled in which one of `asked` lies, and with the nearest of each pixel: a
  // dense cloud in a small picture would take for ever.
  Tiles(const std::vector<FlatSplat>& flat, const std::vector<std::uint32_t>& nearest,
        const std::vector<std::uint32_t>& asked, const View& view)
      : columns_(static_cast<int>(view.width) / kTile + 1),
        rows_(static_cast<int>(view.height) / kTile + 1),
        first_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_) + 1, 0) {
    std::vector<char> wanted(first_.size(), 0);
    for (const std::uint32_t i : asked) wanted[tileOf(flat[i].center)] = 1;
    const auto each = [&](const auto& visit) {
      for (const std::uint32_t i : nearest) {
        if (i == kNone) continue;
        const FlatSplat& s = flat[i];
        const float reach = reachOf(s);
        const int left = tile(s.center[0] - reach, columns_);
        const int right = tile(s.center[0] + reach, columns_);
        const int bottom = tile(s.center[1] + reach, rows_);
        for (int y = tile(s.center[1] - reach, rows_); y <= bottom; ++y) {
          for (int x = left; x <= right; ++x) {
            if (wanted[at(x, y)] != 0) visit(at(x, y), i);
          }
        }
      }
    };
    each([&](std::size_t t, std::size_t) { ++first_[t + 1]; });
    for (std::size_t t = 1; t < first_.size(); ++t) first_[t] += first_[t - 1];
    splats_.resize(first_.back());
    std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
    each([&](std::size_t t, std::size_t i) { splats_[next[t]++] = static_cast<std::uint32_t>(i); });
  }

  // Whether any splat of the tile where p is satisfies the test.
  template <typename Test>
  bool any(const Vec& p, const Test& test) const {
    const std::size_t t = tileOf(p);
    return std::any_of(splats_.begin() + static_cast<std::ptrdiff_t>(first_[t]),
                       splats_.begin() + static_cast<std::ptrdiff_t>(first_[t + 1]), test);
  }

 private:
  std::size_t tileOf(const Vec& p) const { return at(tile(p[0], columns_), tile(p[1], rows_)); }
  std::size_t at(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>(x);
  }
  static int tile(float pixel, int count) {
    return static_cast<int>(std::clamp(pixel / kTile, 0.F, static_cast<float>(count - 1)));
  }

  int columns_;
  int rows_;
  std::vector<std::size_t> first_;
  std::vector<std::uint32_t> splats_;
};

// Whether q, which faces the viewer, lies before p, which does not.
bool hides(const FlatSplat& q, const FlatSplat& p, float noise) {
  const float dx = p.center[0] - q.center[0];
  const float dy = p.center[1] - q.center[1];
  const float reach = reachOf(q);
  if (dx * dx + dy * dy > reach * reach) return false;
  const float slope = std::max(q.normal[2], kLeastSlope);
  const float dz = -(q.normal[0] * dx + q.normal[1] * dy) / slope;
  if (dx * dx + dy * dy + dz * dz > reach * reach) return false;
  if (q.center[2] + dz <= p.center[2] - noise) return false;
  // A surface that goes on beyond an edge lies before p as well, but without points there: those
  // that it has are on the other side of p's plane than the viewer.
  const Vec to{-dx, -dy, q.center[2] - p.center[2] + noise};
  const float cosine = -dot(p.normal, q.normal);
  float lift = -dot(p.normal, to);
  float least = std::min(kLift, -0.5F * p.normal[2]);
  if (cosine > kSameSheet) {
    // Two sides of a wall, or one surface on which one of the two points the wrong way. There, the
    // planes of both lie as far off the other point, in opposite directions, however it bends.
    lift = 0.5F * (lift + dot(q.normal, to));
    least = kLift;
  }
  return lift > least * std::sqrt(dot(to, to));
}

float tolerance(const Splat& splat, const FlatSplat& flat, float scale) {
  return kNoise * splat.noise * scale + kTouch * flat.radius;
}

// Most points of a dense cloud are hidden by one that lies in the same pixel and so far before them
// that nothing else need be asked; these leave `backs`.
// Returns the nearest that faces the viewer in each pixel, or kNone.
std::vector<std::uint32_t> hideFarBehind(const std::vector<Splat>& splats,
                                         const std::vector<FlatSplat>& flat, const View& view,
                                         float scale, std::vector<Seen>& sides,
                                         std::vector<std::uint32_t>& backs) {
  std::vector<std::uint32_t> nearest(view.width * view.height, kNone);
  const auto pixelOf = [&](const Vec& c) {
    const auto x = std::clamp(c[0], 0.F, static_cast<float>(view.width - 1));
    const auto y = std::clamp(c[1], 0.F, static_cast<float>(view.height - 1));
    return static_cast<std::size_t>(y) * view.width + static_cast<std::size_t>(x);
  };
  for (std::size_t i = 0; i < flat.size(); ++i) {
    if (sides[i] != Seen::Front) continue;
    std::uint32_t& first = nearest[pixelOf(flat[i].center)];
    if (first == kNone || flat[i].center[2] > flat[first].center[2]) {
      first = static_cast<std::uint32_t>(i);
    }
  }
  const auto isHidden = [&](std::uint32_t i) {
    const std::uint32_t q = nearest[pixelOf(flat[i].center)];
    if (q == kNone) return false;
    const float before = flat[q].center[2] - flat[i].center[2];
    if (!(before > kFarBehind * std::max(reachOf(flat[q]), tolerance(splats[i], flat[i], scale)))) {
      return false;
    }
    sides[i] = Seen::Hidden;
    return true;
  };
  backs.erase(std::remove_if(backs.begin(), backs.end(), isHidden), backs.end());
  return nearest;
}

}  // namespace

void judgeSides(const std::vector<Splat>& splats, const std::vector<FlatSplat>& flat,
                const View& view, float scale, std::vector<Seen>& sides) {
  std::vector<std::uint32_t> backs;
  for (std::size_t i = 0; i < sides.size(); ++i) {
    if (sides[i] == Seen::Back) backs.push_back(static_cast<std::uint32_t>(i));
  }
  if (backs.empty()) return;
  const auto nearest = hideFarBehind(splats, flat, view, scale, sides, backs);
  const Tiles tiles(flat, nearest, backs, view);
  const auto count = static_cast<std::ptrdiff_t>(backs.size());
#pragma omp parallel for schedule(dynamic, 1024) num_threads(resolveThreads(view.threads))
  for (std::ptrdiff_t b = 0; b < count; ++b) {
    const std::size_t i = backs[static_cast<std::size_t>(b)];
    const FlatSplat& p = flat[i];
    const float noise = tolerance(splats[i], p, scale);
    if (tiles.any(p.center, [&](std::uint32_t q) { return hides(flat[q], p, noise); })) {
      sides[i] = Seen::Hidden;
    } else if (-p.normal[2] < splats[i].turn) {
      sides[i] = Seen::Front;
    }
  }
}

}  // namespace segorient::program
