// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/automatic/coarse_levels.h"

#include <segorient/search/median_hash_index.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "common/bulk_bounds.h"
#include "common/dot.h"
#include "features/sheet_normals.h"
#include "orientation/automatic/blue_noise.h"
#include "orientation/automatic/hand_down.h"
#include "orientation/automatic/layer_test.h"
#include "orientation/automatic/sign_energy.h"
#include "search/prepared_cloud.h"

namespace segorient::detail {
namespace {

// Radii in mean distances to the six nearest, sqrt(2) apart: layers up to half a radius apart are
// one surface to a level. They keep about a fifth, a third and a tenth of the points; the last
// half of them, which costs as much as all others, for noise on thin walls, where these fail.
constexpr float kFirst = 2.F;
constexpr std::array<float, 2> kOthers{1.5F, 2.8F};
constexpr float kFinest = 1.F;
// Share of pairs of neighbours with their backs to each other if a hundredth of a surface is wall
// so thin that half of a point's neighbours are on its other side. Without such walls all levels
// see the same surface, and where the first is no better, the others are not.
constexpr float kWalls = 0.005F;
// What is in front of points that a level turns, after over before: each pays up to a half where it
// is wrong, so that two of three are right now. Of scans that overlap .40 and less was left, of
// bodies with a gap between them .64 and more.
constexpr float kBetterOff = 0.5F;

// What is known of single points, for the points of a subset. Whether sensors are to be believed
// shows in how densely they see, which an even subset does not: that is taken from the cloud.
PointHints hintsOfSubset(const PointHints& hints, const std::vector<float>& toward,
                         const CoarseLevel& level) {
  PointHints out;
  const std::size_t size = level.cloud.size();
  out.surface = hints.surface;
  out.place.faces_up = hints.place.faces_up;
  out.place.seen_within = hints.place.seen_within;
  out.place.may_be_suggested = hints.place.may_be_suggested;
  out.place.suggestion_suits = hints.place.suggestion_suits;
  out.has_viewpoint = hints.has_viewpoint;
  for (std::size_t a = 0; a < 3; ++a) {
    out.viewpoint[a] = hints.viewpoint[a] / level.cloud.unit();
    out.suggested[a] = hints.suggested[a] / level.cloud.unit();
  }
  if (!hints.directions.empty()) {
    out.directions.assign(3 * size, 0.F);
    for (std::size_t i = 0; i < level.nearest.size(); ++i) {
      float* sum = &out.directions[std::size_t{3} * level.nearest[i]];
      for (std::size_t a = 0; a < 3; ++a) sum[a] += hints.directions[3 * i + a];
    }
  }
  if (!toward.empty()) {
    out.toward.resize(3 * size);
    for (std::size_t i = 0; i < size; ++i) {
      std::copy_n(&toward[std::size_t{3} * level.point[i]], 3, &out.toward[3 * i]);
    }
  }
  for (PointHints::Seed seed : hints.seeds) {
    seed.point = level.nearest[seed.point];
    out.seeds.push_back(seed);
  }
  return out;
}

// The best of the levels that were tried.
class Choice {
 public:
  Choice(const PointView& points, const Neighborhoods& neighborhoods, const PointHints& hints,
         const OrientOneScale& orient, int threads, const AutoNormals& fine)
      : points_(points),
        neighborhoods_(neighborhoods),
        hints_(hints),
        orient_(orient),
        threads_(threads),
        fine_(fine),
        judge_(points, neighborhoods, threads),
        own_(judge_.judge(fine.normals)),
        least_(kClearlyLess * own_.total()) {
    note(0.F, own_, fine.orientation.result.components);
  }

  // \param f radius in mean distances to the six nearest
  void tryLevel(float f) {
    const float radius = f * fine_.spacing;
    CoarseLevel level = makeLevel(points_, radius, threads_);
    if (level.cloud.size() == 0) return;
    level.found = orient_(level.cloud.points(), level.cloud.neighborhoods(),
                          hintsOfSubset(hints_, fine_.orientation.toward, level));
    const SheetTraits sheets = level.found.sheets;
    Handed coarse = handDown(points_, level, radius, threads_, fine_);
    const SignEnergy energy = judge_.judge(coarse.found.normals);
    note(f, energy, coarse.found.orientation.result.components);
    if (energy.total() >= least_) return;
    has_less_ = true;
    const bool merges = energy.pairs.backs < 0.5F * own_.pairs.backs;
    if (merges && !layersCross(points_, neighborhoods_, coarse.around, threads_)) return;
    const bool unites = own_.outside - energy.outside < 0.5F * (own_.total() - energy.total());
    if (unites && !betterOff(coarse.found.normals)) return;
    least_ = energy.total();
    chosen_ = f;
    best_ = std::move(coarse);
    best_.found.sheets = sheets;
  }

  /// Whether a level had clearly less energy, be it that it was not chosen for uniting walls.
  bool hasLess() const { return has_less_; }
  bool hasWalls() const { return own_.pairs.backs >= kWalls; }
  bool explainsHalf() const { return least_ < 0.5F * own_.total(); }

  // \return the radius of the best, 0 if it is the cloud itself
  float take(AutoNormals& out) {
    for (ScaleEnergy& scale : tried_) scale.taken = scale.radius == chosen_;
    if (chosen_ > 0.F) out = std::move(best_.found);
    out.scales = std::move(tried_);
    return chosen_;
  }

 private:
  // Whether what a level turns is better off, where most of the energy is less because fewer points
  // face each other: a gap that is narrower than the spacing looks like one sheet to a level, but
  // what it turns for that is as wrong as before.
  bool betterOff(const std::vector<float>& normals) const {
    std::vector<std::uint32_t> turned;
    for (std::size_t i = 0; i < points_.size; ++i) {
      if (dot(&fine_.normals[4 * i], &normals[4 * i]) < 0.F) {
        turned.push_back(static_cast<std::uint32_t>(i));
      }
    }
    const float before = judge_.outsideAt(turned, fine_.normals);
    return judge_.outsideAt(turned, normals) < kBetterOff * before;
  }

  void note(float f, const SignEnergy& energy,
            const std::vector<ComponentOrientationResult>& components) {
    tried_.push_back(
        {f, energy.outside, energy.pairs.facing, energy.pairs.backs, energy.total(), false, {}});
    for (const ComponentOrientationResult& c : components) {
      tried_.back().components.push_back({c.points, c.contradiction, c.residual, c.against_known});
    }
  }

  const PointView& points_;
  const Neighborhoods& neighborhoods_;
  const PointHints& hints_;
  const OrientOneScale& orient_;
  const int threads_;
  const AutoNormals& fine_;
  const SignJudge judge_;
  const SignEnergy own_;
  float least_;
  float chosen_ = 0.F;
  bool has_less_ = false;
  Handed best_;
  std::vector<ScaleEnergy> tried_;
};

}  // namespace

CoarseLevel makeLevel(const PointView& points, float radius, int threads, const Bounds* frame) {
  CoarseLevel level;
  const BlueNoise even = thinOut(points, radius, threads);
  if (even.kept.empty()) return level;
  const std::vector<float> places = meanPlaces(points, even);
  const Bounds of_points = frame != nullptr ? *frame : bulkBounds(points, threads);
  level.cloud = PreparedCloud({places.data(), 4, places.size() / 4}, nullptr, threads, &of_points);
  if (level.cloud.size() == 0) return level;
  level.cloud.findNeighbors(kSheetNeighbors, false);
  level.nearest.resize(points.size);
  for (std::size_t i = 0; i < points.size; ++i) {
    level.nearest[i] = static_cast<std::uint32_t>(level.cloud.pointOf(even.cell_of[i]));
  }
  level.point.resize(level.cloud.size());
  for (std::size_t s = 0; s < level.point.size(); ++s) {
    level.point[s] = even.kept[level.cloud.rowOf(s)];
  }
  return level;
}

float followCoarserLevels(const PointView& points, const Neighborhoods& neighborhoods,
                          const PointHints& hints, const OrientOneScale& orient, int threads,
                          AutoNormals& fine) {
  const float facing = opposedPairs(points, neighborhoods, fine.normals, threads).facing;
  if (facing < kSuspicious) return 0.F;
  Choice choice(points, neighborhoods, hints, orient, threads, fine);
  choice.tryLevel(kFirst);
  if (choice.hasLess() || choice.hasWalls()) {
    for (const float f : kOthers) choice.tryLevel(f);
    if (!choice.explainsHalf()) choice.tryLevel(kFinest);
  }
  return choice.take(fine);
}

}  // namespace segorient::detail
