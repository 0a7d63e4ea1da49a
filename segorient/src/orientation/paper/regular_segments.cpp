// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/paper/regular_segments.h"

#include <segorient/surface/segment_mesh.h>

#include <algorithm>
#include <cstddef>
#include <tuple>
#include <utility>

#include "orientation/paper/combination.h"
#include "orientation/paper/folded_segments.h"
#include "orientation/paper/segment_links.h"
#include "orientation/paper/segment_relations.h"
#include "orientation/paper/triangulated_boundary.h"
#include "segmentation/segment_graph.h"

namespace segorient {
namespace {

// Enough rounds for mixed segments that only show when others are left out.
constexpr int kMostRounds = 4;

std::vector<pcl::index_t> usableRows(const PointView& points, const PointView& normals) {
  std::vector<pcl::index_t> rows;
  rows.reserve(points.size);
  for (std::size_t i = 0; i < points.size; ++i) {
    if (isFinite(points[i]) && isFinite(normals[i])) rows.push_back(static_cast<pcl::index_t>(i));
  }
  return rows;
}

// What angles and boundaries say about each link. That depends on the link's pairs of points alone,
// so it is found once, however often the links are made anew.
class LinkRelations {
 public:
  LinkRelations(const PointView& points, const PointView& normals,
                const Neighborhoods& neighborhoods, const Segmentation& segmentation,
                const OrientationOptions& options)
      : points_(points),
        normals_(normals),
        neighborhoods_(neighborhoods),
        segmentation_(segmentation),
        options_(options) {
    if (options.boundary != BoundaryTest::TRIANGULATED) return;
    const TriangulationOptions triangulation{options.triangulation, options.threads};
    meshes_ = triangulateSegments(points, segmentation, triangulation);
  }

  const SegmentGraph& links() const { return links_; }
  const std::vector<float>& cosines() const { return cosines_; }
  const std::vector<BoundaryVote>& boundary() const { return boundary_; }

  void update(SegmentGraph links) {
    std::vector<std::size_t> known(links.borders.size());  // place among the old ones, or none
    SegmentGraph unknown;                                  // just those, without index by segment
    for (std::size_t l = 0; l < known.size(); ++l) {
      const SegmentBorder& link = links.borders[l];
      known[l] = findOld(links, link);
      if (known[l] < links_.borders.size()) continue;
      unknown.borders.push_back(link);
      unknown.borders.back().first = static_cast<std::uint32_t>(unknown.pairs.size());
      const auto begin = links.pairs.begin() + link.first;
      unknown.pairs.insert(unknown.pairs.end(), begin, begin + link.size);
    }
    const std::vector<float> new_cosines =
        segmentCosines(points_, normals_, segmentation_, unknown, options_.angle, options_.threads);
    const std::vector<BoundaryVote> new_boundary = boundaryVotes(unknown);
    std::vector<float> cosines;
    std::vector<BoundaryVote> boundary;
    std::size_t next = 0;
    for (const std::size_t old : known) {
      const bool is_new = old >= links_.borders.size();
      cosines.push_back(is_new ? new_cosines[next] : cosines_[old]);
      boundary.push_back(is_new ? new_boundary[next] : boundary_[old]);
      if (is_new) ++next;
    }
    links_ = std::move(links);
    cosines_ = std::move(cosines);
    boundary_ = std::move(boundary);
  }

 private:
  std::size_t findOld(const SegmentGraph& links, const SegmentBorder& link) const {
    const auto before = [](const SegmentBorder& l, const SegmentBorder& r) {
      return std::tie(l.a, l.b) < std::tie(r.a, r.b);
    };
    const std::vector<SegmentBorder>& old = links_.borders;
    const auto found = std::lower_bound(old.begin(), old.end(), link, before);
    if (found == old.end() || before(link, *found) || found->size != link.size) return old.size();
    const auto begin = links.pairs.begin() + link.first;
    const bool same = std::equal(begin, begin + link.size, links_.pairs.begin() + found->first,
                                 [](const BorderPair& l, const BorderPair& r) {
                                   return l.in_a == r.in_a && l.in_b == r.in_b;
                                 });
    return same ? static_cast<std::size_t>(found - old.begin()) : old.size();
  }

  std::vector<BoundaryVote> boundaryVotes(const SegmentGraph& links) const {
    if (options_.boundary == BoundaryTest::TRIANGULATED) {
      return triangulatedBoundaryVotes(points_, segmentation_, links, meshes_);
    }
    return localBoundaryVotes(points_, normals_, neighborhoods_, segmentation_, links,
                              options_.threads);
  }

  const PointView& points_;
  const PointView& normals_;
  const Neighborhoods& neighborhoods_;
  const Segmentation& segmentation_;
  const OrientationOptions& options_;
  std::vector<SegmentMesh> meshes_;
  SegmentGraph links_;
  std::vector<float> cosines_;
  std::vector<BoundaryVote> boundary_;
};

std::vector<SegmentOrientationResult> runMethod(const SegmentEvidence& evidence,
                                                const OrientationOptions& options) {
  switch (options.method) {
    case OrientationMethod::PROPAGATION:
      return propagateOrientation(evidence, options);
    case OrientationMethod::BOUNDARY:
      return orientByBoundaries(evidence, options);
    case OrientationMethod::EXTREMAL:
      return orientByExtremalPoints(evidence, options);
    case OrientationMethod::AUTO:  // these two have their own ways, see orientSegments()
    case OrientationMethod::HOPPE:
    case OrientationMethod::COMBINED:
      break;
  }
  return orientCombined(evidence, options);
}

// What the extremal points say about the signs that were found.
void checkByExtremalPoints(const std::vector<ExtremalEvidence>& extremal,
                           std::vector<SegmentOrientationResult>& results) {
  for (std::size_t s = 0; s < results.size(); ++s) {
    results[s].extremal_agreement =
        static_cast<float>(results[s].sign * extremal[s].sign) * extremal[s].agreement;
  }
}

}  // namespace

OrientedRegularSegments orientRegularSegments(const PointView& points, const PointView& normals,
                                              const Neighborhoods& neighborhoods,
                                              const Segmentation& segmentation,
                                              const OrientationOptions& options) {
  const bool asks_extremal = options.method == OrientationMethod::COMBINED ||
                             options.method == OrientationMethod::EXTREMAL;
  OrientedRegularSegments out;
  if (asks_extremal) {
    out.extremal = findExtremalPoints(points, normals, usableRows(points, normals),
                                      options.max_box_points, options.threads);
  }
  // Propagation knows no borders to check by.
  const bool check = options.check_borders && options.method != OrientationMethod::PROPAGATION;
  const SegmentGraph graph = buildSegmentGraph(segmentation, neighborhoods);
  Segmentation current = segmentation;  // mixed segments become connected ones here
  std::vector<std::int32_t> mixed;
  if (check) {
    mixed = findFoldedSegments(points, neighborhoods, segmentation, options.threads);
  }
  LinkRelations relations(points, normals, neighborhoods, segmentation, options);
  for (int round = 1;; ++round) {
    for (const std::int32_t s : mixed) {
      current.segments[static_cast<std::size_t>(s)].kind = SegmentKind::CONNECTED;
    }
    out.mixed.insert(out.mixed.end(), mixed.begin(), mixed.end());
    relations.update(linkRegularSegments(current, graph, neighborhoods));
    const std::vector<ExtremalEvidence> extremal =
        gatherExtremalEvidence(out.extremal, current, options.gamma);
    out.results = runMethod(
        {current, relations.links(), relations.cosines(), relations.boundary(), extremal}, options);
    checkByExtremalPoints(extremal, out.results);
    out.components = balanceComponents(relations.links(), relations.boundary(), out.results);
    if (!check || round == kMostRounds) break;
    mixed = findMixedSegments(relations.links(), relations.boundary(), out.results);
    if (mixed.empty()) break;
  }
  return out;
}

}  // namespace segorient
