// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/paper/completion.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "common/dot.h"
#include "orientation/mirrored_agreement.h"

namespace segorient {
namespace {

// The mirrored normal's vote for equal signs; the plain one's where the points coincide.
float mirroredVote(const float* p, const float* np, const float* q, const float* nq) {
  const std::array<float, 3> chord{q[0] - p[0], q[1] - p[1], q[2] - p[2]};
  const float square = dot(chord.data(), chord.data());
  return square > 0.F ? mirroredAgreement(np, nq, chord.data(), square) : dot(np, nq);
}

// The points still to be oriented, by evidence.
class Completion {
 public:
  Completion(const PointView& points, const PointView& normals, const Neighborhoods& neighborhoods,
             OrientationResult& result)
      : points_(points), normals_(normals), neighborhoods_(neighborhoods), result_(result) {
    numberOpenPoints();
    collectReverse();
  }

  void run() {
    for (const pcl::index_t p : open_) {
      const auto row = static_cast<std::size_t>(p);
      forNeighbors(row, [&](std::size_t q) {
        if (result_.point_signs[q] != 0) hear(row, q);
      });
    }
    drain();
    for (const pcl::index_t p : open_) {
      const auto row = static_cast<std::size_t>(p);
      if (result_.point_signs[row] != 0) continue;
      ComponentOrientationResult component;
      component.by = DecidedBy::NOTHING;
      result_.point_components[row] = static_cast<std::int32_t>(result_.components.size());
      result_.components.push_back(component);
      orient(row, 1, 0.F);
      drain();
    }
  }

 private:
  struct Evidence {
    float balance = 0.F;
    float total = 0.F;
    float strongest = 0.F;
    std::uint8_t level = 0;
  };

  // Evidence is sorted into levels, so that the queue costs no more than the votes. Steps of half a
  // vote: a point with several agreeing neighbours goes before one with a single one.
  static constexpr std::size_t kLevels = 64;
  static std::uint8_t levelOf(float balance) {
    return static_cast<std::uint8_t>(std::min(63.F, 2.F * std::abs(balance)));
  }

  void numberOpenPoints() {
    open_row_.assign(points_.size, 0);
    for (std::size_t i = 0; i < points_.size; ++i) {
      if (result_.point_signs[i] != 0 || !isFinite(normals_[i]) || !isFinite(points_[i])) continue;
      open_.push_back(static_cast<pcl::index_t>(i));
      open_row_[i] = static_cast<pcl::index_t>(open_.size());
    }
    evidence_.resize(open_.size());
  }

  // Rows that name an open point which does not name them: neighbourhood is made symmetric.
  void collectReverse() {
    reverse_offsets_.assign(open_.size() + 1, 0);
    if (open_.empty()) return;
    struct Naming {
      pcl::index_t target;  // position in open_
      pcl::index_t row;
    };
    std::vector<Naming> namings;
    for (std::size_t row = 0; row < neighborhoods_.size(); ++row) {
      const pcl::index_t* neighbors = neighborhoods_.indices(row);
      for (int j = 1; j < neighborhoods_.count(row); ++j) {
        const auto q = static_cast<std::size_t>(neighbors[j]);
        if (open_row_[q] == 0 || names(q, row)) continue;
        namings.push_back({open_row_[q] - 1, static_cast<pcl::index_t>(row)});
        ++reverse_offsets_[static_cast<std::size_t>(open_row_[q])];
      }
    }
    for (std::size_t i = 0; i < open_.size(); ++i) reverse_offsets_[i + 1] += reverse_offsets_[i];
    reverse_.resize(namings.size());
    std::vector<std::size_t> cursor(reverse_offsets_.begin(), reverse_offsets_.end() - 1);
    for (const Naming& naming : namings) {
      reverse_[cursor[static_cast<std::size_t>(naming.target)]++] = naming.row;
    }
  }

  bool names(std::size_t row, std::size_t other) const {
    const pcl::index_t* begin = neighborhoods_.indices(row);
    const pcl::index_t* end = begin + neighborhoods_.count(row);
    return std::find(begin, end, static_cast<pcl::index_t>(other)) != end;
  }

  template <typename Visitor>
  void forNeighbors(std::size_t row, Visitor&& visit) const {
    const pcl::index_t* neighbors = neighborhoods_.indices(row);
    for (int j = 1; j < neighborhoods_.count(row); ++j) {
      visit(static_cast<std::size_t>(neighbors[j]));
    }
    const auto local = static_cast<std::size_t>(open_row_[row] - 1);
    for (std::size_t i = reverse_offsets_[local]; i < reverse_offsets_[local + 1]; ++i) {
      visit(static_cast<std::size_t>(reverse_[i]));
    }
  }

  // Open point p takes the vote of oriented point q.
  void hear(std::size_t p, std::size_t q) {
    const float vote = mirroredVote(points_[p], normals_[p], points_[q], normals_[q]);
    if (!std::isfinite(vote)) return;
    Evidence& evidence = evidence_[static_cast<std::size_t>(open_row_[p] - 1)];
    const bool first = result_.point_components[p] < 0;
    evidence.balance += static_cast<float>(result_.point_signs[q]) * vote;
    evidence.total += std::abs(vote);
    if (first || std::abs(vote) > evidence.strongest) {
      evidence.strongest = std::abs(vote);
      result_.point_components[p] = result_.point_components[q];
    }
    const std::uint8_t level = levelOf(evidence.balance);
    if (!first && level == evidence.level) return;
    evidence.level = level;
    levels_[level].push_back(static_cast<pcl::index_t>(p));
    top_ = std::max(top_, static_cast<std::size_t>(level));
  }

  void orient(std::size_t p, int sign, float confidence) {
    result_.point_signs[p] = static_cast<std::int8_t>(sign);
    result_.point_confidences[p] = confidence;
    forNeighbors(p, [&](std::size_t q) {
      if (open_row_[q] != 0 && result_.point_signs[q] == 0) hear(q, p);
    });
  }

  void drain() {
    for (;;) {
      while (top_ > 0 && levels_[top_].empty()) --top_;
      if (levels_[top_].empty()) return;
      const auto p = static_cast<std::size_t>(levels_[top_].back());
      levels_[top_].pop_back();
      const Evidence& evidence = evidence_[static_cast<std::size_t>(open_row_[p] - 1)];
      if (result_.point_signs[p] != 0 || evidence.level != top_) continue;
      const float confidence =
          evidence.total > 0.F ? std::abs(evidence.balance) / evidence.total : 0.F;
      orient(p, evidence.balance < 0.F ? -1 : 1, confidence);
    }
  }

  const PointView& points_;
  const PointView& normals_;
  const Neighborhoods& neighborhoods_;
  OrientationResult& result_;
  std::vector<pcl::index_t> open_;      // ascending
  std::vector<pcl::index_t> open_row_;  // 1 + position in open_, 0 for all others
  std::vector<Evidence> evidence_;      // by position in open_
  std::vector<std::size_t> reverse_offsets_;
  std::vector<pcl::index_t> reverse_;
  std::array<std::vector<pcl::index_t>, kLevels> levels_;
  std::size_t top_ = 0;
};

}  // namespace

void completeOrientation(const PointView& points, const PointView& normals,
                         const Neighborhoods& neighborhoods, OrientationResult& result) {
  Completion(points, normals, neighborhoods, result).run();
}

}  // namespace segorient
