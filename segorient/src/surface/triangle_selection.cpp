// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "surface/triangle_selection.h"

#include <algorithm>
#include <cmath>

#include "common/median.h"

namespace segorient::surface {
namespace {

constexpr std::uint32_t kNone = PlanarTriangulation::kNone;
/// What counts as a pocket of the boundary: its mouth in critical lengths, and its depth in median
/// edges. Notches of the shape itself are deeper, or wider than random gaps.
constexpr float kPocketLength = 2.F;
constexpr float kPocketDepth = 1.F;
/// Random samples of a surface that may have a gap taken for a hole: one in so many.
constexpr double kSamples = 20;

/// Which triangles stay. Once the long ones are gone, triangles only come back: for points that
/// would be in none, and where the mesh would hang together by a single point.
class Selector {
 public:
  Selector(const PlanarTriangulation& mesh, const std::vector<float>& lengths, std::size_t points,
           std::vector<std::uint8_t>& kept)
      : mesh_(mesh),
        lengths_(lengths),
        kept_(kept),
        longest_(mesh.triangles.size()),
        corner_(points, kNone),
        uses_(points, 0) {
    kept_.assign(mesh.triangles.size(), 0);
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      const auto& triangle = mesh.triangles[t];
      longest_[t] = std::max(
          {lengths[triangle.edges[0]], lengths[triangle.edges[1]], lengths[triangle.edges[2]]});
      for (const std::uint32_t p : triangle.points) corner_[p] = t;
    }
  }

  void keepShort(float limit) {
    for (std::uint32_t t = 0; t < kept_.size(); ++t) {
      if (longest_[t] <= limit) keep(t);
    }
  }

  // One peel: what becomes boundary by it stays.
  void peel(float limit) {
    std::vector<std::uint32_t> outer;
    for (std::uint32_t t = 0; t < kept_.size(); ++t) {
      if (kept_[t] != 0 && longest_[t] > limit && onBoundary(t)) outer.push_back(t);
    }
    for (const std::uint32_t t : outer) {
      const auto& p = mesh_.triangles[t].points;
      if (std::any_of(p.begin(), p.end(), [&](std::uint32_t q) { return uses_[q] < 2; })) continue;
      kept_[t] = 0;
      for (const std::uint32_t q : p) --uses_[q];
    }
  }

  // Points in no triangle get their shortest one back.
  void takeInLoosePoints() {
    for (std::uint32_t p = 0; p < corner_.size(); ++p) {
      if (corner_[p] == kNone || uses_[p] > 0) continue;
      listStar(p);
      std::uint32_t best = star_.front();
      for (const std::uint32_t t : star_) {
        if (longest_[t] < longest_[best]) best = t;
      }
      keep(best);
    }
  }

  // A point at which several fans of triangles meet: the gap between two of them is closed that
  // needs the shortest triangles, until one fan is left.
  void closePinches() {
    std::vector<std::uint32_t> queue;
    for (std::uint32_t p = 0; p < corner_.size(); ++p) {
      if (corner_[p] != kNone) queue.push_back(p);
    }
    for (std::size_t head = 0; head < queue.size(); ++head) {
      while (closeGap(queue[head], queue)) {
      }
    }
  }

  // Pockets of the boundary: triangles with two edges on it that are flat over the third one.
  // Random points along a straight side leave many, and with them a part of the area.
  void fillPockets(float limit, float depth) {
    std::vector<std::uint32_t> queue;
    for (std::uint32_t t = 0; t < kept_.size(); ++t) {
      if (kept_[t] == 0) queue.push_back(t);
    }
    for (std::size_t head = 0; head < queue.size(); ++head) {
      const std::uint32_t t = queue[head];
      if (kept_[t] != 0 || longest_[t] > limit || heightOf(t) > depth || !isPocket(t)) continue;
      keep(t);
      for (const std::uint32_t e : mesh_.triangles[t].edges) {
        const std::uint32_t other = across(t, e);
        if (other != kNone && kept_[other] == 0) queue.push_back(other);
      }
    }
  }

  // Holes no larger than the gaps that random sampling leaves.
  void fillHoles() {
    const double most_area = largestGap();
    std::vector<std::uint8_t> seen(kept_);
    std::vector<std::uint32_t> gap;
    for (std::uint32_t t = 0; t < kept_.size(); ++t) {
      if (seen[t] != 0) continue;
      gap.assign(1, t);
      seen[t] = 1;
      bool closed = true;
      double area = 0.;
      for (std::size_t head = 0; head < gap.size(); ++head) {
        area += areaOf(gap[head]);
        for (const std::uint32_t e : mesh_.triangles[gap[head]].edges) {
          const std::uint32_t other = across(gap[head], e);
          if (other == kNone) {
            closed = false;
          } else if (seen[other] == 0) {
            seen[other] = 1;
            gap.push_back(other);
          }
        }
      }
      if (!closed || !(area <= most_area)) continue;
      for (const std::uint32_t g : gap) keep(g);
    }
  }

 private:
  // Of independent, uniform points a circle of x times the area that there is to each is empty with
  // a probability of exp(-x), the circumcircle of a Delaunay triangle with (1 + x) exp(-x); and
  // there are two triangles to a point. The polygon of the points around an empty circle reaches
  // about half a spacing farther.
  double largestGap() const {
    double triangles = 0.;
    double area = 0.;
    for (std::uint32_t t = 0; t < kept_.size(); ++t) {
      if (kept_[t] == 0) continue;
      ++triangles;
      area += areaOf(t);
    }
    double x = 1.;
    for (int i = 0; i < 8; ++i) x = std::log(kSamples * triangles * (1. + x));
    const double radius = std::sqrt(x / M_PI) + 0.5;
    return M_PI * radius * radius * 2. * area / triangles;
  }

  bool isPocket(std::uint32_t t) const {
    int kept = 0;
    for (const std::uint32_t e : mesh_.triangles[t].edges) {
      const std::uint32_t other = across(t, e);
      const bool inside = other != kNone && kept_[other] != 0;
      if (!inside && lengths_[e] < longest_[t]) return false;  // its mouth is the longest edge
      kept += inside ? 1 : 0;
    }
    return kept == 2;
  }

  // By Heron's formula.
  float areaOf(std::uint32_t t) const {
    const auto& edges = mesh_.triangles[t].edges;
    const float a = lengths_[edges[0]];
    const float b = lengths_[edges[1]];
    const float c = lengths_[edges[2]];
    const float square = (a + b + c) * (b + c - a) * (a + c - b) * (a + b - c);
    return 0.25F * std::sqrt(std::max(square, 0.F));
  }

  // Over the longest edge.
  float heightOf(std::uint32_t t) const { return 2.F * areaOf(t) / longest_[t]; }

  void keep(std::uint32_t t) {
    kept_[t] = 1;
    for (const std::uint32_t p : mesh_.triangles[t].points) ++uses_[p];
  }

  std::uint32_t across(std::uint32_t t, std::uint32_t edge) const {
    const auto& sides = mesh_.edges[edge].triangles;
    return sides[0] == t ? sides[1] : sides[0];
  }

  bool onBoundary(std::uint32_t t) const {
    const auto& edges = mesh_.triangles[t].edges;
    return std::any_of(edges.begin(), edges.end(), [&](std::uint32_t e) {
      const std::uint32_t other = across(t, e);
      return other == kNone || kept_[other] == 0;
    });
  }

  static std::size_t cornerOf(const PlanarTriangulation::Triangle& triangle, std::uint32_t p) {
    return triangle.points[0] == p ? 0 : triangle.points[1] == p ? 1 : 2;
  }

  // The triangles around a point, counter-clockwise; from the hull where the point is on it.
  void listStar(std::uint32_t p) {
    std::uint32_t first = corner_[p];
    star_open_ = false;
    for (std::uint32_t t = first;;) {
      const std::uint32_t previous =
          across(t, mesh_.triangles[t].edges[cornerOf(mesh_.triangles[t], p)]);
      if (previous == kNone) {
        star_open_ = true;
        first = t;
        break;
      }
      t = previous;
      if (t == first) break;
    }
    star_.clear();
    std::uint32_t t = first;
    do {
      star_.push_back(t);
      t = across(t, mesh_.triangles[t].edges[(cornerOf(mesh_.triangles[t], p) + 2) % 3]);
    } while (t != kNone && t != first);
  }

  bool closeGap(std::uint32_t p, std::vector<std::uint32_t>& queue) {
    if (uses_[p] < 2) return false;
    listStar(p);
    const std::size_t size = star_.size();
    // Begin behind a fan, so that no gap is cut in two.
    std::size_t begin = 0;
    if (!star_open_) {
      while (begin < size && !(kept_[star_[begin]] != 0 && kept_[star_[(begin + 1) % size]] == 0))
        ++begin;
      if (begin == size) return false;
    }
    std::size_t gaps = 0;
    std::size_t best_from = 0;
    std::size_t best_to = 0;
    float best = 0.F;
    std::size_t from = 0;
    float worst = 0.F;
    bool seen_fan = false;
    bool in_gap = false;
    for (std::size_t i = begin; i <= begin + size; ++i) {
      if (star_open_ && i == size) break;
      const std::uint32_t t = star_[i % size];
      if (kept_[t] == 0) {
        if (!in_gap) from = i;
        worst = in_gap ? std::max(worst, longest_[t]) : longest_[t];
        in_gap = true;
        continue;
      }
      if (in_gap && seen_fan) {
        if (gaps == 0 || worst < best) {
          best = worst;
          best_from = from;
          best_to = i;
        }
        ++gaps;
      }
      in_gap = false;
      seen_fan = true;
    }
    // All around, one gap is the outside of the only fan; at the hull every gap parts two fans.
    if (gaps < (star_open_ ? 1U : 2U)) return false;
    for (std::size_t i = best_from; i < best_to; ++i) {
      const std::uint32_t t = star_[i % size];
      keep(t);
      for (const std::uint32_t q : mesh_.triangles[t].points) {
        if (q != p) queue.push_back(q);
      }
    }
    return true;
  }

  const PlanarTriangulation& mesh_;
  const std::vector<float>& lengths_;  ///< of edges
  std::vector<std::uint8_t>& kept_;
  std::vector<float> longest_;         ///< by triangle, its longest edge
  std::vector<std::uint32_t> corner_;  ///< by point, one of its triangles
  std::vector<std::uint32_t> uses_;    ///< by point, its kept triangles
  std::vector<std::uint32_t> star_;
  bool star_open_ = false;
};

}  // namespace

Selection selectTriangles(const PlanarTriangulation& mesh, const std::vector<float>& lengths,
                          std::size_t points, const TriangulationOptions& options) {
  Selection selection;
  if (mesh.triangles.empty()) return selection;
  const float typical = median(lengths);
  selection.critical_length = criticalLength(lengths, typical, options);
  Selector selector(mesh, lengths, points, selection.kept);
  selector.keepShort(selection.critical_length);
  selector.peel(options.kappa2 * selection.critical_length);
  selector.takeInLoosePoints();
  selector.closePinches();
  if (!options.fill_gaps) return selection;
  selector.fillPockets(kPocketLength * selection.critical_length, kPocketDepth * typical);
  selector.fillHoles();
  return selection;
}

}  // namespace segorient::surface
