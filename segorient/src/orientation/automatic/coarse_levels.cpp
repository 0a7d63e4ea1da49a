// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/automatic/coarse_levels.h"

#include <segorient/search/median_hash_index.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "common/dot.h"
#include "common/threads.h"
#include "features/sheet_normals.h"
#include "orientation/automatic/blue_noise.h"
#include "orientation/automatic/layer_test.h"
#include "orientation/automatic/sign_energy.h"
#include "search/prepared_cloud.h"

namespace segorient::detail {
namespace {

// Shares of pairs of neighbours that face each other. From the first on, a patch of some ten points
// may be the wrong way, and one level is tried; all are from the second on, as clean clouds, thin
// ones and noise of half a spacing have fewer.
constexpr float kSuspicious = 0.0001F;
constexpr float kContradictory = 0.001F;
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
// Energies of solutions that are equally good differ by less than a tenth, as other points count.
constexpr float kClearlyLess = 0.9F;
// Oriented points of the subset that a point hears: a ring and a little more.
constexpr int kHeard = 8;

// What the points of a level around a point say about its normal.
class Heard {
 public:
  // \return whether this is the weightiest voice so far
  bool add(const float* n, const float* m, float weight, float confidence) {
    const float vote = weight * dot(n, m);
    balance_ += vote;
    total_ += std::fabs(vote);
    sure_ += std::fabs(vote) * confidence;
    for (std::size_t a = 0; a < 3; ++a) sum_[a] += weight * m[a];
    weights_ += weight;
    if (std::fabs(vote) <= most_) return false;
    most_ = std::fabs(vote);
    return true;
  }

  bool against() const { return balance_ < 0.F; }
  float confidence() const {
    return total_ > 0.F ? std::fabs(balance_) / total_ * (sure_ / total_) : 0.F;
  }
  // The mean of the normals as a unit vector, and its length: the cosine of their spread.
  void mean(float* out) const {
    const float length = std::sqrt(dot(sum_.data(), sum_.data()));
    if (!(length > 0.F)) return;
    for (std::size_t a = 0; a < 3; ++a) out[a] = sum_[a] / length;
    out[3] = length / weights_;
  }

 private:
  float balance_ = 0.F;
  float total_ = 0.F;
  float sure_ = 0.F;
  float most_ = 0.F;
  std::array<float, 3> sum_{0.F, 0.F, 0.F};
  float weights_ = 0.F;
};

// What a level says about all points.
struct Handed {
  AutoNormals found;          // their own lines, with the level's signs
  std::vector<float> around;  // 4 floats a point, see Heard::mean(); 0 where nothing was heard
};

// What is known of single points, for the points of a subset. Whether sensors are to be believed
// shows in how densely they see, which an even subset does not: that is taken from the cloud.
PointHints hintsOfSubset(const PointHints& hints, const std::vector<float>& toward,
                         const CoarseLevel& level) {
  PointHints out;
  const std::size_t size = level.cloud.size();
  out.surface = hints.surface;
  out.has_viewpoint = hints.has_viewpoint;
  for (std::size_t a = 0; a < 3; ++a) out.viewpoint[a] = hints.viewpoint[a] / level.cloud.unit();
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

void listen(const PointView& points, CoarseLevel& level, float radius, int threads, Handed& out) {
  const search::MedianHashIndex& index = level.cloud.index();
  const float unit = level.cloud.unit();
  const float softening = (radius / unit) * (radius / unit);
#pragma omp parallel for num_threads(resolveThreads(threads, points.size, 3000.0)) \
    schedule(static, 1024)
  for (std::size_t i = 0; i < points.size; ++i) {
    float* n = &out.found.normals[4 * i];
    if (!isFinite(n)) {
      out.found.confidences[i] = 0.F;
      continue;
    }
    const float x[3] = {points[i][0] / unit, points[i][1] / unit, points[i][2] / unit};
    std::array<pcl::index_t, kHeard> near{};
    std::array<float, kHeard> squares{};
    const int count = index.nearestK(x, kHeard, near.data(), squares.data());
    Heard heard;
    for (std::size_t j = 0; j < static_cast<std::size_t>(count); ++j) {
      const auto q = static_cast<std::size_t>(near[j]);
      const float* m = &level.found.normals[4 * q];
      if (!isFinite(m)) continue;
      const float weight = 1.F / (squares[j] + softening);
      if (heard.add(n, m, weight, level.found.confidences[q])) {
        out.found.components[i] = level.found.components[q];
      }
    }
    heard.mean(&out.around[4 * i]);
    if (!out.found.by_sensor.empty() && out.found.by_sensor[i] != 0) continue;
    out.found.confidences[i] = heard.confidence();
    if (!heard.against()) continue;
    for (std::size_t a = 0; a < 3; ++a) n[a] = -n[a];
  }
}

// What the level knows of its own points, in the cloud's unit and by all its points.
AutoOrientation inTermsOfTheCloud(CoarseLevel& level, const std::vector<std::int32_t>& components,
                                  const AutoOrientation& fine) {
  AutoOrientation out = std::move(level.found.orientation);
  out.sensors = fine.sensors;
  out.toward = fine.toward;
  for (Contradiction& c : out.contradictions) {
    for (float& v : c.where) v *= level.cloud.unit();
  }
  for (ComponentOrientationResult& c : out.result.components) c.points = 0;
  for (const std::int32_t c : components) {
    if (c >= 0) ++out.result.components[static_cast<std::size_t>(c)].points;
  }
  return out;
}

Handed handDown(const PointView& points, CoarseLevel& level, float radius, int threads,
                const AutoNormals& fine) {
  Handed out;
  out.found.spacing = fine.spacing;
  out.found.normals = fine.normals;
  out.found.confidences = fine.confidences;
  out.found.by_sensor = fine.by_sensor;
  out.found.components.assign(points.size, -1);
  out.around.assign(4 * points.size, 0.F);
  listen(points, level, radius, threads, out);
  out.found.orientation = inTermsOfTheCloud(level, out.found.components, fine.orientation);
  return out;
}

// A line far off those of the level around it, and more than twice as far as they are off their
// mean, was fitted to points of several layers: their mean takes its place.
void mendLines(const std::vector<float>& around, std::vector<float>& normals) {
  constexpr float kFarOff = 0.5F;  // 60 degrees
  for (std::size_t i = 0; i < around.size() / 4; ++i) {
    const float* mean = &around[4 * i];
    float* n = &normals[4 * i];
    const float twice = 2.F * mean[3] * mean[3] - 1.F;  // the cosine of twice the angle
    if (!isFinite(n) || std::fabs(dot(n, mean)) >= std::min(kFarOff, twice)) continue;
    std::copy_n(mean, 3, n);
  }
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
        least_(kClearlyLess * own_.total()) {}

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
    if (energy.total() >= least_) return;
    has_less_ = true;
    const bool merges = energy.pairs.backs < 0.5F * own_.pairs.backs;
    if (merges && !layersCross(points_, neighborhoods_, coarse.around, threads_)) return;
    least_ = energy.total();
    chosen_ = f;
    best_ = std::move(coarse);
    best_.found.sheets = sheets;
  }

  bool made() const { return chosen_ > 0.F; }
  /// Whether a level had clearly less energy, be it that it was not chosen for uniting walls.
  bool hasLess() const { return has_less_; }
  bool hasWalls() const { return own_.pairs.backs >= kWalls; }
  bool explainsHalf() const { return least_ < 0.5F * own_.total(); }

  // \return the radius of the best, 0 if it is the cloud itself
  float take(AutoNormals& out) {
    if (chosen_ == 0.F) return chosen_;
    mendLines(best_.around, best_.found.normals);
    out = std::move(best_.found);
    return chosen_;
  }

 private:
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
};

}  // namespace

CoarseLevel makeLevel(const PointView& points, float radius, int threads) {
  CoarseLevel level;
  const BlueNoise even = thinOut(points, radius);
  std::vector<float> places;
  for (const std::uint32_t i : even.kept) {
    places.insert(places.end(), points[i], points[i] + 3);
    places.push_back(0.F);
  }
  level.cloud = PreparedCloud({places.data(), 4, places.size() / 4}, nullptr, threads);
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

void followLevel(const PointView& points, CoarseLevel& level, float radius, int threads,
                 AutoNormals& fine) {
  Handed coarse = handDown(points, level, radius, threads, fine);
  mendLines(coarse.around, coarse.found.normals);
  fine = std::move(coarse.found);
}

float followCoarserLevels(const PointView& points, const Neighborhoods& neighborhoods,
                          const PointHints& hints, const OrientOneScale& orient, int threads,
                          AutoNormals& fine) {
  const float facing = opposedPairs(points, neighborhoods, fine.normals, threads).facing;
  if (facing < kSuspicious) return 0.F;
  Choice choice(points, neighborhoods, hints, orient, threads, fine);
  choice.tryLevel(kFirst);
  if (!choice.made() && facing < kContradictory) return 0.F;
  if (!choice.hasLess() && !choice.hasWalls()) return 0.F;
  for (const float f : kOthers) choice.tryLevel(f);
  if (!choice.explainsHalf()) choice.tryLevel(kFinest);
  return choice.take(fine);
}

}  // namespace segorient::detail
