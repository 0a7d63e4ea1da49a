// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <vector>

#include "common/parallel_for.h"
#include "segmentation/distinct_points.h"
#include "segmentation/growth_state.h"
#include "segmentation/settling_candidate.h"

namespace segorient::segmentation {
namespace {

/// Flat points that a plane takes at least.
constexpr std::size_t kLeastWitnesses = 3;
/// Neighbours of each row that are looked at, where the table has as many: the normals were taken
/// from them, so that twice as far there are normals that an edge has no part in.
constexpr int kReach = 24;
/// The neighbours' rows and the point's own one.
constexpr std::size_t kMostAround = std::size_t{kReach + 1} * (kReach + 1);
/// 80 degrees. The normal of a point right at an edge may lean far over; near a right angle to the
/// reference normal its sign would be arbitrary.
constexpr double kMostLean = 1.3962634;
/// Where two surfaces meet at less than alpha, a point changes between them only if its own one is
/// this far off, in spacings, and the other one less than half as far: a smooth border stays where
/// it is.
constexpr float kClearlyOff = 0.2F;
/// Points nearer than this to the middle between two faces, in spacings, as all points on an edge
/// are: the smaller label gets them, so that grids have straight borders.
constexpr float kTie = 1e-3F;

/// How many points earlier than it is looked at the memory is asked for a row.
constexpr std::size_t kRowsAhead = 12;

/// Entries of a row that are looked at.
int reachOf(const Neighborhoods& neighborhoods, std::size_t row) {
  return std::min(neighborhoods.count(row), kReach + 1);
}

class Settler {
 public:
  Settler(const SegmentationOptions& options, const GrowthState& state)
      : state_(state), small_size_(options.small_size), cos_alpha_(cosineOf(options.alpha)) {}

  /// Label that a point should have.
  std::int32_t settle(std::size_t p, DistinctPoints& around) const {
    const std::int32_t own = state_.labels[p];
    const bool own_regular = isRegular(own);
    if (own_regular && !meetsOther(p)) return own;
    Candidates candidates;
    const std::size_t count = listCandidates(p, candidates);
    if (count == 0 || (own_regular && count == 1)) return own;
    listAround(p, own_regular, around);
    for (std::size_t i = 0; i < count; ++i) setWitnesses(around, candidates[i]);
    const Candidate* best = nullptr;
    const Candidate* found = nullptr;
    for (std::size_t i = 0; i < count; ++i) {
      if (candidates[i].label == own) found = &candidates[i];
    }
    if (found != nullptr && found->count >= kLeastWitnesses) best = found;
    for (std::size_t i = 0; i < count; ++i) {
      const Candidate& other = candidates[i];
      if (other.label == own || other.count < kLeastWitnesses || !fits(p, other.label)) continue;
      if (best == nullptr || isNearer(p, other, *best)) best = &other;
    }
    if (best == nullptr || best->label == own) return own;
    const float reach = state_.limits.offset * state_.nodes[p].spacing;
    return own_regular || std::abs(offset(p, *best)) <= reach ? best->label : own;
  }

 private:
  bool isRegular(std::int32_t label) const {
    return label >= 0 && state_.isFace(label, small_size_);
  }

  int reach(std::size_t row) const { return reachOf(*state_.neighborhoods, row); }

  std::size_t listCandidates(std::size_t p, Candidates& candidates) const {
    std::size_t count = 0;
    const pcl::index_t* row = state_.neighborhoods->indices(p);
    const int size = reach(p);
    for (int j = 0; j < size && count < kCandidates; ++j) {
      const auto q = static_cast<std::size_t>(row[j]);
      const std::int32_t label = state_.labels[q];
      if (!isRegular(label) || !state_.limits.near(state_.nodes[p], state_.nodes[q])) continue;
      const auto last = candidates.begin() + static_cast<std::ptrdiff_t>(count);
      const auto found = std::find_if(candidates.begin(), last,
                                      [&](const Candidate& c) { return c.label == label; });
      if (found == last) candidates[count++].start(label);
    }
    return count;
  }

  // Whether a point of another segment is in the first ring: farther from the edge its own normals
  // are good enough.
  bool meetsOther(std::size_t p) const {
    const pcl::index_t* row = state_.neighborhoods->indices(p);
    const int size = std::min(state_.rowSize(p), kRing + 1);
    for (int j = 1; j < size; ++j) {
      if (state_.labels[static_cast<std::size_t>(row[j])] != state_.labels[p]) return true;
    }
    return false;
  }

  // The neighbours and their neighbours: those nearest to an edge have its bad normals themselves.
  // For most points the far half of the neighbours will do, whose own ones reach farthest; the few
  // that are in no face yet, at corners first of all, take what they can get.
  void listAround(std::size_t p, bool far_half, DistinctPoints& around) const {
    const pcl::index_t* row = state_.neighborhoods->indices(p);
    const int size = reach(p);
    around.restart();
    addRow(p, p, around);
    for (int j = far_half ? std::max(1, size / 2) : 1; j < size; ++j) {
      const auto middle = static_cast<std::size_t>(row[j]);
      if (state_.limits.near(state_.nodes[p], state_.nodes[middle])) addRow(p, middle, around);
    }
  }

  void addRow(std::size_t p, std::size_t middle, DistinctPoints& around) const {
    const pcl::index_t* row = state_.neighborhoods->indices(middle);
    const int size = reach(middle);
    around.reserve(static_cast<std::size_t>(size));
    for (int j = 0; j < size; ++j) around.add(row[j], static_cast<std::size_t>(row[j]) != p);
  }

  void setWitnesses(const DistinctPoints& around, Candidate& candidate) const {
    std::array<pcl::index_t, kMostAround> members;
    std::size_t count = 0;
    for (std::size_t i = 0; i < around.size(); ++i) {
      members[count] = around[i];
      count += state_.labels[static_cast<std::size_t>(around[i])] == candidate.label ? 1U : 0U;
    }
    for (std::size_t i = 0; i < count; ++i) {
      candidate.offer(members[i], state_.nodes[static_cast<std::size_t>(members[i])].curvature);
    }
    setPlane(candidate);
  }

  // Flat points count more: on exact planes those that an edge has no part in decide alone, under
  // noise all have a say.
  void setPlane(Candidate& candidate) const {
    if (candidate.count == 0) return;
    constexpr float kFloor = 1e-7F;
    const float flattest = std::max(0.F, candidate.curvature[0]) + kFloor;
    Vector center;
    Vector normal;
    float sum = 0.F;
    for (std::size_t i = 0; i < candidate.count; ++i) {
      const Node& q = state_.nodes[static_cast<std::size_t>(candidate.points[i])];
      const float weight = flattest / (std::max(0.F, candidate.curvature[i]) + flattest);
      center = {center.x + weight * q.x, center.y + weight * q.y, center.z + weight * q.z};
      normal = {normal.x + weight * q.nx, normal.y + weight * q.ny, normal.z + weight * q.nz};
      sum += weight;
    }
    const float length = std::sqrt(std::max(normal.dot(normal), 1e-30F));
    candidate.center = {center.x / sum, center.y / sum, center.z / sum};
    candidate.normal = {normal.x / length, normal.y / length, normal.z / length};
  }

  static float offset(const Vector& p, const Candidate& candidate) {
    return candidate.normal.dot(p - candidate.center);
  }
  float offset(std::size_t p, const Candidate& candidate) const {
    const Node& node = state_.nodes[p];
    return offset(Vector{node.x, node.y, node.z}, candidate);
  }

  // Whether p is rather a point of `other` than of `current`. At a sharp edge that is decided by
  // the plane midway between the two faces, also for noisy points off both of them: with each
  // offset counted as negative on the side where the other face is, it is the larger one that wins.
  bool isNearer(std::size_t p, const Candidate& other, const Candidate& current) const {
    const float unit = state_.nodes[p].spacing;
    float to_other = offset(p, other);
    float to_current = offset(p, current);
    if (std::abs(other.normal.dot(current.normal)) >= cos_alpha_) {
      const float clearly_off = std::max(kClearlyOff, state_.typical_offset) * unit;
      return std::abs(to_current) > clearly_off && std::abs(to_other) < 0.5F * std::abs(to_current);
    }
    if (offset(current.center, other) > 0.F) to_other = -to_other;
    if (offset(other.center, current) > 0.F) to_current = -to_current;
    return to_other > to_current + (other.label < current.label ? -kTie : kTie) * unit;
  }

  bool fits(std::size_t p, std::int32_t label) const {
    const NormalSum& reference = state_.clusters[static_cast<std::size_t>(label)].normal;
    return std::abs(reference.dot(state_.nodes[p])) >=
           std::cos(kMostLean) * std::sqrt(reference.squaredNorm());
  }

  const GrowthState& state_;
  std::size_t small_size_;
  float cos_alpha_;
};

// All decide on the old labels; so the order does not matter.
// \return those that moved
std::vector<pcl::index_t> settleOnce(const SegmentationOptions& options,
                                     const std::vector<pcl::index_t>& border, GrowthState& state) {
  std::vector<std::int32_t> wanted(border.size());
  const Settler settler(options, state);
  parallelFor(
      border.size(), options.threads, 1000.0, [] { return DistinctPoints(); },
      [&](std::size_t i, DistinctPoints& around) {
        if (i + kRowsAhead < border.size())
          state.fetchRow(static_cast<std::size_t>(border[i + kRowsAhead]));
        wanted[i] = settler.settle(static_cast<std::size_t>(border[i]), around);
      });
  std::vector<pcl::index_t> moved;
  for (std::size_t i = 0; i < border.size(); ++i) {
    const auto p = static_cast<std::size_t>(border[i]);
    const std::int32_t own = state.labels[p];
    // A regular segment stays one.
    if (wanted[i] == own ||
        (state.clusters[static_cast<std::size_t>(own)].size == options.small_size &&
         state.isFace(own, options.small_size)))
      continue;
    state.move(p, wanted[i]);
    moved.push_back(border[i]);
  }
  return moved;
}

// Of some points, those whose neighbours, or these ones' neighbours, are among the marked.
std::vector<pcl::index_t> listNear(const std::vector<pcl::index_t>& rows,
                                   const std::vector<std::uint8_t>& marked, int threads,
                                   const GrowthState& state) {
  const Neighborhoods& table = *state.neighborhoods;
  const auto seesMarked = [&](std::size_t row) {
    const pcl::index_t* q = table.indices(row);
    return std::any_of(q, q + reachOf(table, row),
                       [&](pcl::index_t i) { return marked[static_cast<std::size_t>(i)] != 0; });
  };
  std::vector<std::uint8_t> near(rows.size(), 0);
  parallelFor(rows.size(), threads, 500.0, [&](std::size_t i) {
    const auto p = static_cast<std::size_t>(rows[i]);
    const pcl::index_t* q = table.indices(p);
    const bool sees = seesMarked(p) || std::any_of(q, q + reachOf(table, p), [&](pcl::index_t j) {
                        return seesMarked(static_cast<std::size_t>(j));
                      });
    near[i] = sees ? 1 : 0;
  });
  std::vector<pcl::index_t> out;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (near[i] != 0) out.push_back(rows[i]);
  }
  return out;
}

}  // namespace

std::size_t settleEdges(const SegmentationOptions& options, GrowthState& state) {
  std::vector<pcl::index_t> moved = settleOnce(options, state.border, state);
  std::size_t total = moved.size();
  if (total == 0) return 0;
  // At a corner the points around it may have been in no face, either.
  const auto settled = [&](pcl::index_t p) {
    return state.isFace(state.labels[static_cast<std::size_t>(p)], options.small_size);
  };
  std::vector<pcl::index_t> loose;
  std::remove_copy_if(state.border.begin(), state.border.end(), std::back_inserter(loose), settled);
  // What a point wants to be follows from the labels that are near it, but for the mean normals of
  // whole faces, which single points hardly turn.
  std::vector<std::uint8_t> marked(state.labels.size(), 0);
  while (!moved.empty()) {
    for (const pcl::index_t p : moved) marked[static_cast<std::size_t>(p)] = 1;
    const std::vector<pcl::index_t> near = listNear(loose, marked, options.threads, state);
    for (const pcl::index_t p : moved) marked[static_cast<std::size_t>(p)] = 0;
    moved = settleOnce(options, near, state);
    total += moved.size();
    loose.erase(std::remove_if(loose.begin(), loose.end(), settled), loose.end());
  }
  return total;
}

}  // namespace segorient::segmentation
