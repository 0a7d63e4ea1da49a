// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <segorient/orientation/winding_number.h>

#include <algorithm>
#include <cmath>

namespace segorient {
namespace {

constexpr std::uint32_t kLeaf = 16;
// A node counts as one dipole beyond this many of its radii: errors of some hundredths of the sum
// of absolute terms.
constexpr float kFar = 4.F;
constexpr float kOneOver4Pi = 0.07957747F;

}  // namespace

void WindingNumber::build(const PointView& points, const std::vector<float>& dipoles,
                          const std::vector<std::uint32_t>& rows) {
  count_ = rows.empty() ? points.size : rows.size();
  data_.resize(8 * count_);
  for (std::size_t i = 0; i < count_; ++i) {
    const std::size_t r = rows.empty() ? i : rows[i];
    const float* p = points[r];
    float* d = data_.data() + 8 * i;
    std::copy(p, p + 3, d);
    d[3] = 0.F;
    std::copy(dipoles.data() + 4 * r, dipoles.data() + 4 * r + 4, d + 4);
  }
  nodes_.clear();
  if (count_ == 0) return;
  nodes_.reserve(count_ / 4 + 2);
  buildNode(0, static_cast<std::uint32_t>(count_));
}

std::uint32_t WindingNumber::buildNode(std::uint32_t first, std::uint32_t last) {
  const auto index = static_cast<std::uint32_t>(nodes_.size());
  nodes_.emplace_back();
  double center[3] = {0, 0, 0};
  double dipole[3] = {0, 0, 0};
  double area = 0.0;
  for (std::uint32_t i = first; i < last; ++i) {
    const float* d = data_.data() + 8 * static_cast<std::size_t>(i);
    const double a = static_cast<double>(d[7]) + 1e-30;
    area += a;
    for (int k = 0; k < 3; ++k) {
      center[k] += a * static_cast<double>(d[k]);
      dipole[k] += static_cast<double>(d[4 + k]);
    }
  }
  Node node{};
  for (int k = 0; k < 3; ++k) {
    node.center[k] = static_cast<float>(center[k] / area);
    node.dipole[k] = static_cast<float>(dipole[k]);
  }
  float r2 = 0.F;
  for (std::uint32_t i = first; i < last; ++i) {
    const float* d = data_.data() + 8 * static_cast<std::size_t>(i);
    float s = 0.F;
    for (int k = 0; k < 3; ++k) s += (d[k] - node.center[k]) * (d[k] - node.center[k]);
    r2 = std::max(r2, s);
  }
  node.radius = std::sqrt(r2);
  node.first = first;
  if (last - first <= kLeaf) {
    node.size = last - first;
  } else {
    const std::uint32_t middle = first + (last - first) / 2;
    buildNode(first, middle);
    buildNode(middle, last);
  }
  node.skip = static_cast<std::uint32_t>(nodes_.size());
  nodes_[index] = node;
  return index;
}

float WindingNumber::evaluate(const float* x, float radius) const {
  const float r2 = radius * radius;
  double sum = 0.0;
  for (std::uint32_t i = 0; i < nodes_.size();) {
    const Node& node = nodes_[i];
    const float d[3] = {node.center[0] - x[0], node.center[1] - x[1], node.center[2] - x[2]};
    const float s = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
    if (s > kFar * kFar * node.radius * node.radius && s > 4.F * r2) {
      sum += static_cast<double>(
          (node.dipole[0] * d[0] + node.dipole[1] * d[1] + node.dipole[2] * d[2]) /
          (s * std::sqrt(s)));
      i = node.skip;
      continue;
    }
    for (std::uint32_t j = 0; j < node.size; ++j) {
      const float* q = data_.data() + 8 * static_cast<std::size_t>(node.first + j);
      const float e[3] = {q[0] - x[0], q[1] - x[1], q[2] - x[2]};
      const float t = std::max(e[0] * e[0] + e[1] * e[1] + e[2] * e[2], r2);
      sum += static_cast<double>((q[4] * e[0] + q[5] * e[1] + q[6] * e[2]) / (t * std::sqrt(t)));
    }
    ++i;
  }
  return static_cast<float>(sum) * kOneOver4Pi;
}

}  // namespace segorient
