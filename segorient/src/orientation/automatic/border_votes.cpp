// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/automatic/border_votes.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "common/parallel_for.h"
#include "common/sort_all.h"
#include "orientation/automatic/border_groups.h"
#include "orientation/automatic/wide_votes.h"

namespace segorient {
namespace {

using detail::SheetGroup;
using detail::Vec3;

// Borders of so many votes, of which fewer than nine of ten agree, are voted on again.
constexpr std::uint32_t kLong = 16;
constexpr float kNineOfTen = 0.8F;  // .9 for less .1 against

struct RawVote {
  std::int32_t a, b;
  pcl::index_t point;
  float value;
  bool wall;
  bool reliable;
};

class Voter {
 public:
  Voter(const PointView& points, const Neighborhoods& nb, const SheetField& field,
        const Segmentation& segmentation, const std::vector<std::uint8_t>* voters)
      : points_(points), nb_(nb), field_(field), segmentation_(segmentation), voters_(voters) {}

  void vote(std::size_t p, std::vector<RawVote>& out) const {
    if (!isBorder(p)) return;
    std::array<SheetGroup, kSheetDegree + 1> groups;
    const std::size_t count = collect(p, groups);
    groups[0].finish();
    for (std::size_t g = 1; g < count; ++g) {
      groups[g].finish();
      RawVote v{groups[0].label,
                groups[g].label,
                static_cast<pcl::index_t>(p),
                std::min(groups[0].count, groups[g].count) * groups[0].compare(groups[g]),
                groups[g].wall || groups[0].isAbove(groups[g]),
                field_.reliable[p] != 0};
      if (v.a > v.b) std::swap(v.a, v.b);
      out.push_back(v);
    }
  }

 private:
  int degree(std::size_t p) const { return std::min(nb_.count(p) - 1, kSheetDegree); }

  bool isBorder(std::size_t p) const {
    const std::int32_t own = segmentation_.labels[p];
    if (own < 0 || (voters_ != nullptr && (*voters_)[p] == 0)) return false;
    const pcl::index_t* row = nb_.indices(p) + 1;
    for (int j = 0; j < degree(p); ++j) {
      const std::int32_t l = segmentation_.labels[static_cast<std::size_t>(row[j])];
      if (l >= 0 && l != own) return true;
    }
    return false;
  }

  // The point's own group first.
  std::size_t collect(std::size_t p, std::array<SheetGroup, kSheetDegree + 1>& groups) const {
    const std::int32_t own = segmentation_.labels[p];
    const float* n = field_.normals + 4 * p;
    groups[0].label = own;
    groups[0].add({0.F, 0.F, 0.F}, n, segmentation_.signs[p]);
    std::size_t count = 1;
    const pcl::index_t* row = nb_.indices(p) + 1;
    const float h = field_.spacing[p];
    for (int j = 0; j < degree(p); ++j) {
      const auto q = static_cast<std::size_t>(row[j]);
      const std::int32_t l = segmentation_.labels[q];
      if (l < 0) continue;
      const Vec3 d{points_[q][0] - points_[p][0], points_[q][1] - points_[p][1],
                   points_[q][2] - points_[p][2]};
      const float offset = d[0] * n[0] + d[1] * n[1] + d[2] * n[2];
      const bool wall = l != own && (offset <= field_.below[p] || offset >= field_.above[p]);
      std::size_t g = 0;
      while (g < count && (groups[g].label != l || groups[g].wall != wall)) ++g;
      if (g == count) {
        groups[g].label = l;
        groups[g].wall = wall;
        ++count;
      }
      groups[g].add({d[0] / h, d[1] / h, d[2] / h}, field_.normals + 4 * q, segmentation_.signs[q]);
    }
    return count;
  }

  const PointView& points_;
  const Neighborhoods& nb_;
  const SheetField& field_;
  const Segmentation& segmentation_;
  const std::vector<std::uint8_t>* voters_;
};

struct Tally {
  double weight = 0.0, absolute = 0.0, reliable = 0.0;
  std::uint32_t count = 0;
  void add(const RawVote& v) {
    weight += static_cast<double>(v.value);
    absolute += static_cast<double>(std::fabs(v.value));
    if (v.reliable) reliable += static_cast<double>(std::fabs(v.value));
    ++count;
  }
  void add(const Tally& o) {
    weight += o.weight;
    absolute += o.absolute;
    reliable += o.reliable;
    count += o.count;
  }
  Evidence evidence() const {
    return {static_cast<float>(weight), static_cast<float>(absolute), static_cast<float>(reliable)};
  }
};

std::vector<RawVote> castVotes(const Voter& voter, std::size_t n, int threads) {
  // Chunks of a fixed size, joined in order, so that sums do not depend on the number of threads.
  constexpr std::size_t kChunk = 8192;
  const std::size_t chunks = (n + kChunk - 1) / kChunk;
  std::vector<std::vector<RawVote>> parts(chunks);
  parallelFor(chunks, threads, timeOfEach(chunks, n, 300.0), [&](std::size_t c) {
    for (std::size_t p = c * kChunk; p < std::min(n, (c + 1) * kChunk); ++p)
      voter.vote(p, parts[c]);
  });
  std::vector<RawVote> votes;
  std::size_t total = 0;
  for (const auto& part : parts) total += part.size();
  votes.reserve(total);
  for (auto& part : parts) {
    votes.insert(votes.end(), part.begin(), part.end());
    std::vector<RawVote>().swap(part);
  }
  sortAll(votes, threads, [](const RawVote& x, const RawVote& y) {
    if (x.a != y.a) return x.a < y.a;
    if (x.b != y.b) return x.b < y.b;
    if (x.point != y.point) return x.point < y.point;
    if (x.wall != y.wall) return x.wall < y.wall;
    return x.value < y.value;
  });
  return votes;
}

}  // namespace

std::vector<BorderVote> borderVotes(const PointView& points, const Neighborhoods& neighborhoods,
                                    const SheetField& field, const Segmentation& segmentation,
                                    int threads, const std::vector<std::uint8_t>* voters) {
  const Voter voter(points, neighborhoods, field, segmentation, voters);
  const std::vector<RawVote> votes = castVotes(voter, points.size, threads);
  std::vector<BorderVote> out;
  detail::WideVoter wide(points, neighborhoods, field, segmentation);
  std::vector<pcl::index_t> border;
  for (std::size_t i = 0; i < votes.size();) {
    Tally sheet;
    Tally wall;
    std::size_t j = i;
    for (; j < votes.size() && votes[j].a == votes[i].a && votes[j].b == votes[i].b; ++j) {
      (votes[j].wall ? wall : sheet).add(votes[j]);
    }
    const bool walls_count = sheet.evidence().letsCount(wall.evidence());
    if (walls_count) sheet.add(wall);
    if (sheet.count > 0) {
      BorderVote v;
      v.a = votes[i].a;
      v.b = votes[i].b;
      static_cast<Evidence&>(v) = sheet.evidence();
      v.wall = wall.evidence();
      v.wall_counts = walls_count;
      v.count = sheet.count;
      v.where = votes[i + (j - i) / 2].point;
      const bool unsure = v.unanimity() < kNineOfTen;
      if (v.count >= kLong && (unsure || walls_count)) {
        border.clear();
        for (std::size_t k = i; k < j; ++k) {
          const bool counted = walls_count || !votes[k].wall;
          const bool known = !border.empty() && border.back() == votes[k].point;
          if (counted && !known) border.push_back(votes[k].point);
        }
        const float again = wide.vote(border, v.a, v.b);
        const bool contrary = (again < 0.F) != (v.weight < 0.F);
        v.by_planes = std::fabs(again) > kNineOfTen && (unsure || contrary);
        if (v.by_planes) {
          v.weight = again * v.absolute;
          v.wall = Evidence{};
          v.wall_counts = false;
        }
      }
      out.push_back(v);
    }
    i = j;
  }
  return out;
}

}  // namespace segorient
