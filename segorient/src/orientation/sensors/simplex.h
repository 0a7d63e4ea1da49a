// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace segorient::detail {

/// Least value of a function of few parameters without derivatives (Nelder and Mead, A simplex
/// method for function minimization, 1965), always by the same steps.
/// \param steps of the first simplex along each parameter
/// \param values the start, then the best parameters found
/// \return the value there, not above that of the start
template <typename Function>
double minimize(const Function& f, const std::vector<double>& steps, int evaluations,
                std::vector<double>& values) {
  using Vertex = std::pair<double, std::vector<double>>;
  const std::size_t n = values.size();
  std::vector<Vertex> simplex;
  simplex.emplace_back(f(values), values);
  for (std::size_t a = 0; a < n; ++a) {
    std::vector<double> moved = values;
    moved[a] += steps[a];
    const double value = f(moved);
    simplex.emplace_back(value, std::move(moved));
  }
  const auto byValue = [](const Vertex& a, const Vertex& b) { return a.first < b.first; };
  int left = evaluations - static_cast<int>(n) - 1;
  while (left > 0) {
    std::stable_sort(simplex.begin(), simplex.end(), byValue);
    std::vector<double> center(n, 0.0);
    for (std::size_t v = 0; v < n; ++v) {
      for (std::size_t a = 0; a < n; ++a)
        center[a] += simplex[v].second[a] / static_cast<double>(n);
    }
    Vertex& worst = simplex.back();
    const auto along = [&](double factor) {
      std::vector<double> p(n);
      for (std::size_t a = 0; a < n; ++a) p[a] = center[a] + factor * (worst.second[a] - center[a]);
      const double value = f(p);
      --left;
      return Vertex(value, std::move(p));
    };
    Vertex next = along(-1.0);
    if (next.first < simplex.front().first) {
      Vertex farther = along(-2.0);
      worst = farther.first < next.first ? std::move(farther) : std::move(next);
    } else if (next.first < simplex[n - 1].first) {
      worst = std::move(next);
    } else {
      Vertex nearer = along(next.first < worst.first ? -0.5 : 0.5);
      if (nearer.first < std::min(next.first, worst.first)) {
        worst = std::move(nearer);
      } else {
        for (std::size_t v = 1; v <= n; ++v) {
          for (std::size_t a = 0; a < n; ++a) {
            simplex[v].second[a] = 0.5 * (simplex[v].second[a] + simplex.front().second[a]);
          }
          simplex[v].first = f(simplex[v].second);
          --left;
        }
      }
    }
  }
  const auto best = std::min_element(simplex.begin(), simplex.end(), byValue);
  values = best->second;
  return best->first;
}

}  // namespace segorient::detail
