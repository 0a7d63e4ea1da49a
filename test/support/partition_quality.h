// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <algorithm>
#include <cstddef>
#include <map>
#include <utility>
#include <vector>

namespace segorient::test {

/// Adjusted Rand index of two partitions of the same points (Hubert and Arabie, 1985): 1 where they
/// are the same, 0 in the mean for random ones. A label below 0 is a class like any other.
template <typename LabelA, typename LabelB>
double adjustedRandIndex(const std::vector<LabelA>& a, const std::vector<LabelB>& b) {
  std::map<std::pair<long, long>, double> both;
  std::map<long, double> in_a;
  std::map<long, double> in_b;
  for (std::size_t i = 0; i < a.size(); ++i) {
    both[{a[i], b[i]}] += 1;
    in_a[a[i]] += 1;
    in_b[b[i]] += 1;
  }
  const auto pairs = [](double n) { return n * (n - 1) / 2; };
  double sum = 0;
  double sum_a = 0;
  double sum_b = 0;
  for (const auto& [key, n] : both) sum += pairs(n);
  for (const auto& [key, n] : in_a) sum_a += pairs(n);
  for (const auto& [key, n] : in_b) sum_b += pairs(n);
  const double expected = sum_a * sum_b / pairs(static_cast<double>(a.size()));
  const double most = (sum_a + sum_b) / 2;
  return most == expected ? 1.0 : (sum - expected) / (most - expected);
}

/// Share of the points that belong to the majority face of their segment; unlabelled ones do not
/// count.
template <typename Label>
double purity(const std::vector<Label>& labels, const std::vector<int>& face) {
  std::map<long, std::map<int, std::size_t>> faces;
  std::size_t labelled = 0;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    if (labels[i] < 0) continue;
    ++faces[labels[i]][face[i]];
    ++labelled;
  }
  std::size_t majority = 0;
  for (const auto& [label, counts] : faces) {
    std::size_t most = 0;
    for (const auto& [f, n] : counts) most = std::max(most, n);
    majority += most;
  }
  return labelled == 0 ? 1.0 : static_cast<double>(majority) / static_cast<double>(labelled);
}

}  // namespace segorient::test
