// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/automatic/final_normals.h"

#include <segorient/orientation/first_stages.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "common/dot.h"
#include "common/parallel_for.h"
#include "features/automatic_normals.h"
#include "features/recompute_scene.h"
#include "features/sheet_normals.h"
#include "features/surface_sizes.h"

namespace segorient::detail {
namespace {

// Without noise, surfaces of the fewest neighbours are all that is tried.
constexpr int kFewest = 10;
// For the surfaces on both sides of an edge, as `normals --recompute` has them.
constexpr int kEdgeNeighbors = FirstStages::kDefaultNeighbors;
// The first round's labels are those of means over the edge, the next ones' of its own result.
// Of 144 clouds, a second round takes 1.1 % of the mean rms, a third .2, and a fourth .1.
constexpr int kRounds = 3;
// 143 degrees: normals of two walls, or of both sides of a blade.
constexpr float kOtherWall = -0.8F;
// 45 degrees: beyond, near edges, the fit and the surroundings speak of different faces.
constexpr float kSameFace = 0.7F;
// 20 degrees: what noise explains, and the surroundings confirm, is nobody else's to average.
constexpr float kConfirmed = 0.94F;
// 70 degrees: beyond, which side of the fit the surroundings are on is a guess.
constexpr float kSureSide = 0.35F;

/// How the fit at a point came about.
enum class Fit : std::uint8_t { EXPLAINED, UNEXPLAINED, ONE_SIDED, ON_EDGE };

class FinalNormals {
 public:
  FinalNormals(const PreparedCloud& cloud, MoreNeighbors& more, const Segmentation& segments,
               int threads, const FinalTraits* known, const AutoNormals& oriented)
      : more_(more),
        points_(cloud.points()),
        table_(cloud.neighborhoods()),
        segments_(segments),
        threads_(threads),
        known_(known),
        oriented_(oriented),
        toward_(oriented.orientation.toward) {}

  /// Normals of all points, 4 floats each; empty where the filtered ones are the best there are.
  std::vector<float> run(bool only_known) {
    // Depth cameras round what they measure: that is no noise which a mean could lessen.
    if (!toward_.empty() && tooNoisy()) return {};
    fitSurfaces(only_known);
    if (static_cast<double>(noise_) <= kCubicNoise) recomputeAtEdges();
    if (known_ != nullptr) {
      has_edges_ = known_->edges;
      edges_sampled_ = known_->edges_sampled;
    }
    traits_.edges = has_edges_;
    traits_.edges_sampled = edges_sampled_;
    sure_.assign(points_.size, 0);
    parallelFor(points_.size, threads_, 50.0, [&](std::size_t i) {
      std::array<float, 4> chosen;
      std::copy_n(filtered(i), 4, chosen.begin());
      choose(i, chosen.data());
      std::copy(chosen.begin(), chosen.end(), &fitted_[4 * i]);
    });
    return std::move(fitted_);
  }
  const FinalTraits& traits() const { return traits_; }
  /// See AutoNormals::sure.
  std::vector<std::uint8_t> sure() { return std::move(sure_); }

 private:
  const float* filtered(std::size_t i) const { return &oriented_.normals[4 * i]; }

  bool has(std::size_t i, Around what) const { return (oriented_.around[i] & what) != 0; }

  bool tooNoisy() {
    traits_.surfaces.noise =
        known_ != nullptr ? known_->surfaces.noise : sampleNoise(points_, table_, threads_);
    const double noise = traits_.surfaces.noise.in_spacings;
    // What planes leave and surfaces of a few neighbours do not is noise that these were fitted to,
    // where it asks for larger scales, as where points lie on few depths.
    const bool hides = noise < static_cast<double>(kCleanFit) && oriented_.sheets.scan_scales &&
                       oriented_.sheets.noise.fine >= kFewTellNothing;
    return hides || noise > kCubicNoise;
  }

  void fitSurfaces(bool only_known) {
    fitted_ = oriented_.normals;
    std::vector<pcl::index_t> rows;
    for (std::size_t i = 0; i < points_.size; ++i) {
      // Where all around is one plane, there is nothing to gain.
      if (!has(i, ONE_PLANE)) rows.push_back(static_cast<pcl::index_t>(i));
    }
    std::vector<pcl::index_t> unexplained;
    const AutomaticNormalTraits* known = known_ != nullptr ? &known_->surfaces : nullptr;
    const bool wider =
        !only_known && automaticNeighbors(points_, table_, threads_, known) > table_.k() - 1;
    const AutomaticNormalReport report =
        wider ? estimateNormalsAutomatically(points_, more_.index(), table_, threads_,
                                             fitted_.data(), &unexplained, &rows, known)
              : estimateNormalsAutomatically(points_, table_, threads_, fitted_.data(),
                                             &unexplained, &rows, known);
    traits_.surfaces = report.traits;
    noise_ = static_cast<float>(report.traits.noise.in_spacings);
    most_ = report.surfaces.empty() ? kFewest : report.surfaces.front().first;
    fits_.assign(points_.size, Fit::EXPLAINED);
    for (const pcl::index_t i : unexplained) fits_[static_cast<std::size_t>(i)] = Fit::UNEXPLAINED;
    for (const pcl::index_t row : rows) {
      const auto i = static_cast<std::size_t>(row);
      float* n = &fitted_[4 * i];
      if (!(dot(n, filtered(i)) < 0.F)) continue;
      for (std::size_t a = 0; a < 3; ++a) n[a] = -n[a];
    }
  }

  // Without noise, what a surface explains needs no other one.
  bool mayRecompute(std::size_t i) const {
    return noise_ >= kCleanFit || fits_[i] != Fit::EXPLAINED;
  }

  void recomputeAtEdges() {
    std::vector<std::int32_t> labels = segments_.labels;
    std::vector<std::uint8_t> regular;
    for (const Segment& s : segments_.segments) {
      regular.push_back(s.kind == SegmentKind::REGULAR ? 1 : 0);
    }
    const int entries = std::min(kEdgeNeighbors + 1, table_.k());
    std::optional<KnownEdges> known;
    if (known_ != nullptr)
      known = KnownEdges{known_->edges || known_->edges_sampled, known_->edges_sampled};
    OneSidedRule rule({}, OneSidedNormal::EXPECTED, known);
    for (int round = 0; round < kRounds; ++round) {
      const RecomputationScene scene{points_, table_, regular, labels, fitted_, entries, threads_};
      for (const Recomputed& r : rule.apply(scene)) {
        if (r.on_edge) fits_[r.point] = Fit::ON_EDGE;
        edges_sampled_ = edges_sampled_ || r.on_edge;
        if (!r.accepted || !isFinite(r.normal)) continue;
        has_edges_ = true;
        labels[r.point] = r.label;
        if (!mayRecompute(r.point)) continue;
        fits_[r.point] = Fit::ONE_SIDED;
        std::copy_n(r.normal, 3, &fitted_[4 * r.point]);
      }
    }
  }

  // Whether the neighbours that a surface was fitted to are all of the point's own wall.
  bool isOneWall(std::size_t i) const {
    const pcl::index_t* row = table_.indices(i);
    int most = most_;
    if (fits_[i] == Fit::UNEXPLAINED) {
      most = has(i, SECOND_WALL) ? kSheetNeighbors : kEdgeNeighbors;
    }
    const int count = std::min(table_.count(i), most + 1);
    for (int j = 1; j < count; ++j) {
      if (dot(filtered(i), filtered(static_cast<std::size_t>(row[j]))) < kOtherWall) return false;
    }
    return true;
  }

  void choose(std::size_t i, float* result) {
    const float* f = &fitted_[4 * i];
    if (!isFinite(f) || !isFinite(result)) return;
    const bool fits_one_side = fits_[i] == Fit::ONE_SIDED;
    const bool small = noise_ < kCleanFit && most_ <= kFewest;
    // A few neighbours that one surface explains are of one wall.
    const bool ask_walls = small ? fits_[i] != Fit::EXPLAINED && !fits_one_side : true;
    if (ask_walls && !isOneWall(i)) return;
    if (noise_ < kCleanFit) {
      takeFit(i, f, result);
    } else {
      const bool explained = fits_[i] == Fit::EXPLAINED && !has(i, ONE_PLANE);
      sure_[i] = explained && dot(f, result) > kConfirmed ? 1 : 0;
      takeMean(f, fits_one_side ? noise_ / static_cast<float>(kCubicNoise) : 1.F, result);
    }
  }

  void takeFit(std::size_t i, const float* f, float* result) {
    // Points on the edges themselves keep the faces apart, and triangulations do not reach over.
    if (fits_[i] == Fit::UNEXPLAINED && !edges_sampled_) {
      if (has(i, ON_A_FACE)) return;
      if (has_edges_) {
        takeMean(f, 1.F, result);
        return;
      }
    }
    const float along = dot(f, result);
    // Nothing that a sensor saw turns its back to it.
    if (!toward_.empty() && along * dot(f, &toward_[3 * i]) < 0.F) return;
    const float sure = fits_[i] == Fit::ONE_SIDED ? 0.F : has_edges_ ? kSameFace : kSureSide;
    if (along > sure) {
      std::copy_n(f, 3, result);
      const bool fits = fits_[i] == Fit::EXPLAINED || fits_[i] == Fit::ONE_SIDED;
      sure_[i] = fits && along > kSameFace ? 1 : 0;
    } else if (fits_[i] != Fit::ONE_SIDED) {
      addUnit(f, along, result);
    }
  }

  // The less the two agree, the more the filtered one counts, which knows its side. Beside an edge
  // in little noise, that is for the face to say.
  // \param share of the filtered one where they are at right angles: all. Beside an edge, where it
  //        is a mean over both faces, how near the noise comes to what hides that there are two
  static void takeMean(const float* f, float share, float* result) {
    const float along = dot(f, result);
    addUnit(f, (1.F - share) / share + along * along * along, result);
  }

  static void addUnit(const float* f, float weight, float* result) {
    std::array<float, 3> sum;
    for (std::size_t a = 0; a < 3; ++a) sum[a] = result[a] + weight * f[a];
    const float length = std::sqrt(dot(sum.data(), sum.data()));
    if (!(length > 0.F)) return;  // opposite to the last bit
    for (std::size_t a = 0; a < 3; ++a) result[a] = sum[a] / length;
  }

  MoreNeighbors& more_;
  PointView points_;
  const Neighborhoods& table_;
  const Segmentation& segments_;
  int threads_;
  const FinalTraits* known_;
  FinalTraits traits_;
  const AutoNormals& oriented_;
  const std::vector<float>& toward_;
  std::vector<float> fitted_;
  std::vector<Fit> fits_;
  std::vector<std::uint8_t> sure_;
  float noise_ = 0.F;
  int most_ = kFewest;          ///< neighbours of the largest surfaces
  bool has_edges_ = false;      ///< sharp ones
  bool edges_sampled_ = false;  ///< and points on them, as vertices of meshes are
};

}  // namespace

FinalTraits fitFinalNormals(const PreparedCloud& cloud, MoreNeighbors& more,
                            const Segmentation& segments, bool only_known, int threads,
                            const FinalTraits* known, AutoNormals& oriented) {
  FinalNormals final_normals(cloud, more, segments, threads, known, oriented);
  std::vector<float> normals = final_normals.run(only_known);
  if (!normals.empty()) {
    oriented.normals = std::move(normals);
    oriented.sure = final_normals.sure();
  }
  return final_normals.traits();
}

}  // namespace segorient::detail
