// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "tiles/piece_graph.h"

#include <algorithm>
#include <map>
#include <utility>

#include "common/at.h"
#include "common/disjoint_sets.h"

namespace segorient::detail {
namespace {

void add(const float* from, Evidence& to) {
  to.add({from[0], from[1], from[2]});
}

// A point that two tiles have says as much as one of a border does: where their pieces were cut in
// different ways, or one mixes two sides, borders must be able to say otherwise.
TileVote voteOf(const PieceTie& tie) {
  TileVote v;
  v.a = tie.a;
  v.b = tie.b;
  v.sheet[0] = tie.weight;
  v.sheet[1] = v.sheet[2] = tie.absolute;
  v.count = tie.count;
  return v;
}

}  // namespace

std::vector<BorderVote> gatherVotes(std::vector<TileVote> votes,
                                    const std::vector<PieceTie>& ties) {
  votes.reserve(votes.size() + ties.size());
  for (const PieceTie& tie : ties) votes.push_back(voteOf(tie));
  for (TileVote& v : votes) {
    if (v.a > v.b) std::swap(v.a, v.b);
  }
  std::stable_sort(votes.begin(), votes.end(), [](const TileVote& x, const TileVote& y) {
    return x.a != y.a ? x.a < y.a : x.b < y.b;
  });
  std::vector<BorderVote> out;
  for (std::size_t i = 0; i < votes.size();) {
    Evidence sheet;
    BorderVote v;
    v.a = votes[i].a;
    v.b = votes[i].b;
    for (; i < votes.size() && votes[i].a == v.a && votes[i].b == v.b; ++i) {
      add(votes[i].sheet, sheet);
      add(votes[i].wall, v.wall);
      v.count += votes[i].count;
    }
    v.wall_counts = sheet.letsCount(v.wall);
    static_cast<Evidence&>(v) = sheet;
    if (v.wall_counts) v.add(v.wall);
    out.push_back(v);
  }
  return out;
}

std::vector<LabelBorder> labelBorders(const Neighborhoods& neighborhoods,
                                      const std::vector<std::int32_t>& labels) {
  constexpr int kNearest = 8;
  constexpr int kLeastPairs = 16;
  std::map<std::pair<std::int32_t, std::int32_t>, int> found;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    for (int j = 1; j < std::min(neighborhoods.count(i), kNearest + 1); ++j) {
      const auto ends = std::minmax(labels[i], labels[at(neighborhoods.indices(i)[j])]);
      if (ends.first >= 0 && ends.first != ends.second) ++found[ends];
    }
  }
  std::vector<LabelBorder> out;
  for (const auto& [ends, pairs] : found) {
    if (pairs >= kLeastPairs) out.push_back({ends.first, ends.second});
  }
  return out;
}

std::vector<std::uint32_t> uniteLabels(const std::vector<std::uint32_t>& sizes,
                                       std::vector<PieceTie> pairs,
                                       const std::vector<LabelBorder>& borders,
                                       std::size_t& count) {
  DisjointSets sets(sizes.size());
  // By root: all that is next to one of its set.
  std::vector<std::vector<std::int32_t>> beside(sizes.size());
  for (const LabelBorder& b : borders) {
    beside[at(b.a)].push_back(b.b);
    beside[at(b.b)].push_back(b.a);
  }
  std::stable_sort(pairs.begin(), pairs.end(),
                   [](const PieceTie& x, const PieceTie& y) { return x.count > y.count; });
  for (const PieceTie& pair : pairs) {
    const std::int32_t a = sets.find(pair.a);
    const std::int32_t b = sets.find(pair.b);
    if (!pair.most || a == b) continue;
    const bool few_of_a = beside[at(a)].size() < beside[at(b)].size();
    std::vector<std::int32_t> less = std::move(beside[at(few_of_a ? a : b)]);
    std::vector<std::int32_t>& more = beside[at(few_of_a ? b : a)];
    const std::int32_t other = few_of_a ? b : a;
    if (std::any_of(less.begin(), less.end(),
                    [&](std::int32_t s) { return sets.find(s) == other; })) {
      beside[at(few_of_a ? a : b)] = std::move(less);
      continue;
    }
    more.insert(more.end(), less.begin(), less.end());
    sets.join(a, b);
    if (sets.find(a) != other) beside[at(sets.find(a))] = std::move(more);
  }
  std::vector<std::uint32_t> united(sizes.size(), 0);
  std::vector<std::int32_t> roots;
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    const std::int32_t root = sets.find(static_cast<std::int32_t>(i));
    united[at(root)] += sizes[i];
    if (at(root) == i) roots.push_back(root);
  }
  std::stable_sort(roots.begin(), roots.end(),
                   [&](std::int32_t a, std::int32_t b) { return united[at(a)] > united[at(b)]; });
  count = 0;
  std::vector<std::uint32_t> number(sizes.size(), 0);
  for (std::size_t r = 0; r < roots.size(); ++r) {
    number[at(roots[r])] = static_cast<std::uint32_t>(r);
    count += united[at(roots[r])] > 0 ? 1 : 0;
  }
  std::vector<std::uint32_t> out(sizes.size());
  for (std::size_t i = 0; i < sizes.size(); ++i) {
    out[i] = number[at(sets.find(static_cast<std::int32_t>(i)))];
  }
  return out;
}

}  // namespace segorient::detail
