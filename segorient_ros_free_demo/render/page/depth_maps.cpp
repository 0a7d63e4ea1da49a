// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "render/page/depth_maps.h"

#include <algorithm>
#include <cmath>

namespace segorient::program {
namespace {

// A point counts from directions within 60 degrees of its normal: flatter ones see its
// neighbourhood more than itself.
constexpr float kLeastCosine = 0.5F;
// A square as large as a disc, with eight points of a surface in it.
constexpr float kPixel = 1.77F;
constexpr double kMostPixels = 250'000.0;  // of a map: two of them stay in a core's cache
constexpr std::size_t kMeasured = 10'000;  // points that tell where the cloud is
constexpr float kLift = 0.5F;   // radii: what lies less far before a point's plane is its own
constexpr float kThin = 0.15F;  // radii: the same for what is parallel; walls are thicker

// Directions of half a sphere, evenly: a spiral by the golden angle.
Vec axisOf(int i) {
  const double z = (i + 0.5) / kAxes;
  const double turn = i * M_PI * (3.0 - std::sqrt(5.0));
  const double r = std::sqrt(1.0 - z * z);
  return {static_cast<float>(r * std::cos(turn)), static_cast<float>(r * std::sin(turn)),
          static_cast<float>(z)};
}

Vec cross(const Vec& a, const Vec& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

int cut(float at, int size) {
  return static_cast<int>(std::clamp(at, 0.F, static_cast<float>(size - 1)));
}

}  // namespace

DepthMaps::DepthMaps(const Sample& sample, int axis) : sample_(sample), axis_(axis) {
  towards_ = axisOf(axis);
  right_ = cross(towards_, std::abs(towards_[0]) < 0.6F ? Vec{1.F, 0.F, 0.F} : Vec{0.F, 1.F, 0.F});
  const float length = std::sqrt(dot(right_, right_));
  for (float& v : right_) v /= length;
  up_ = cross(towards_, right_);
  measure();
  draw();
}

void DepthMaps::count(std::vector<std::uint8_t>& front, std::vector<std::uint8_t>& back) const {
  for (const std::uint32_t i : turnOf(sample_.asking)) {
    const float facing = dot(towards_, sample_.normals[i]);
    if (!(std::abs(facing) >= kLeastCosine)) continue;
    const std::size_t pixel = pixelOf(turned(sample_.points[i]));
    for (const bool near : {true, false}) {
      // The viewer sees the front if the normal faces there.
      const bool is_front = (facing > 0.F) == near;
      if (isHidden(i, (near ? near_ : far_)[pixel].point, is_front ? 1.F : -1.F)) continue;
      std::uint8_t& counter = (is_front ? front : back)[i];
#pragma omp atomic
      ++counter;
    }
  }
}

// Whether q lies before the plane of point i, on the side that `sign` says.
bool DepthMaps::isHidden(std::size_t i, std::uint32_t q, float sign) const {
  if (q == kNone) return false;
  const Vec& n = sample_.normals[i];
  const Vec& m = sample_.normals[q];
  const Vec& from = sample_.points[i];
  const Vec& at = sample_.points[q];
  const Vec to{at[0] - from[0], at[1] - from[1], at[2] - from[2]};
  const float height = dot(n, to);
  const float cosine = dot(n, m);
  const float noise = sample_.noise[i];
  const float radius = sample_.radii[i];
  if (std::abs(cosine) < kSameSheet) return sign * height > kLift * radius + noise;
  // Of one surface, however it bends, the planes of both lie as far off the other point, in
  // opposite directions.
  const float level = 0.5F * (height + std::copysign(1.F, cosine) * dot(m, to));
  return sign * level > kThin * radius + noise;
}

void DepthMaps::measure() {
  // Strays far off go to the pixels of the rim; else the rest would be one pixel.
  std::array<float, 2> high{};
  const std::size_t step = sample_.points.size() / kMeasured + 1;
  for (std::size_t a = 0; a < 2; ++a) {
    std::vector<float> values;
    for (std::size_t i = 0; i < sample_.points.size(); i += step) {
      values.push_back(turned(sample_.points[i])[a]);
    }
    if (values.empty()) return;
    std::sort(values.begin(), values.end());
    const std::size_t few = values.size() / 100;
    const float length = values[values.size() - 1 - few] - values[few];
    low_[a] = std::max(values.front(), values[few] - length);
    high[a] = std::min(values.back(), values[values.size() - 1 - few] + length);
  }
  const double width = static_cast<double>(high[0]) - static_cast<double>(low_[0]);
  const double height = static_cast<double>(high[1]) - static_cast<double>(low_[1]);
  double pixel = static_cast<double>(kPixel * sample_.middle);
  pixel = std::max(pixel, std::max(width, height) / kMostPixels);
  pixel = std::max(pixel, std::sqrt(width * height / kMostPixels));
  if (!(pixel > 0.0)) return;
  pixel_ = static_cast<float>(pixel);
  columns_ = static_cast<int>(width / pixel) + 1;
  rows_ = static_cast<int>(height / pixel) + 1;
}

int DepthMaps::column(float x) const {
  return cut((x - low_[0]) / pixel_, columns_);
}

int DepthMaps::row(float y) const {
  return cut((y - low_[1]) / pixel_, rows_);
}

std::size_t DepthMaps::pixelOf(const Vec& p) const {
  return static_cast<std::size_t>(row(p[1])) * static_cast<std::size_t>(columns_) +
         static_cast<std::size_t>(column(p[0]));
}

void DepthMaps::draw() {
  const std::size_t size = static_cast<std::size_t>(rows_) * static_cast<std::size_t>(columns_);
  constexpr float kFar = std::numeric_limits<float>::max();
  near_.assign(size, {-kFar, kNone});
  far_.assign(size, {kFar, kNone});
  for (const std::uint32_t i : turnOf(sample_.drawn)) {
    const Vec p = turned(sample_.points[i]);
    // Where points are far apart, each stands for more than its own pixel.
    const float reach = std::max(0.F, sample_.radii[i] - 0.5F * kPixel * sample_.middle);
    const int right = column(p[0] + reach);
    const int bottom = row(p[1] + reach);
    for (int y = row(p[1] - reach); y <= bottom; ++y) {
      for (int x = column(p[0] - reach); x <= right; ++x) {
        const std::size_t pixel = static_cast<std::size_t>(y) * static_cast<std::size_t>(columns_) +
                                  static_cast<std::size_t>(x);
        if (p[2] > near_[pixel].depth) near_[pixel] = {p[2], i};
        if (p[2] < far_[pixel].depth) far_[pixel] = {p[2], i};
      }
    }
  }
}

}  // namespace segorient::program
