// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/sensors/viewpoint_fit.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "common/threads.h"

namespace segorient {
namespace {

struct Sample {
  std::array<float, 3> p;  // relative to the centre, in units of the extent
  std::array<float, 3> n;
};

struct Frame {
  std::array<double, 3> center{0.0, 0.0, 0.0};
  double extent = 0.0;
};

Frame boundingFrame(const PointView& points, const std::vector<std::uint32_t>& rows) {
  std::array<double, 3> low;
  std::array<double, 3> high;
  low.fill(std::numeric_limits<double>::max());
  high.fill(std::numeric_limits<double>::lowest());
  for (const std::uint32_t i : rows) {
    for (std::size_t a = 0; a < 3; ++a) {
      low[a] = std::min(low[a], static_cast<double>(points[i][a]));
      high[a] = std::max(high[a], static_cast<double>(points[i][a]));
    }
  }
  Frame frame;
  for (std::size_t a = 0; a < 3; ++a) {
    frame.center[a] = 0.5 * (low[a] + high[a]);
    frame.extent = std::max(frame.extent, high[a] - low[a]);
  }
  return frame;
}

std::vector<Sample> takeSamples(const PointView& points, const std::vector<float>& normals,
                                const std::vector<std::uint32_t>& rows, const Frame& frame,
                                std::size_t most) {
  std::vector<Sample> samples;
  const std::size_t n = std::min(rows.size(), most);
  for (std::size_t k = 0; k < n; ++k) {
    const std::size_t i = rows[k * rows.size() / n];
    Sample s;
    for (std::size_t a = 0; a < 3; ++a) {
      s.p[a] =
          static_cast<float>((static_cast<double>(points[i][a]) - frame.center[a]) / frame.extent);
      s.n[a] = normals[4 * i + a];
    }
    if (std::isfinite(s.n[0])) samples.push_back(s);
  }
  return samples;
}

// Share of samples whose normal points to v, from 0 to 1.
float facingShare(const std::vector<Sample>& samples, const std::array<float, 3>& v) {
  std::size_t facing = 0;
  for (const Sample& s : samples) {
    const float d = s.n[0] * (v[0] - s.p[0]) + s.n[1] * (v[1] - s.p[1]) + s.n[2] * (v[2] - s.p[2]);
    facing += d > 0.F ? 1 : 0;
  }
  return static_cast<float>(facing) / static_cast<float>(samples.size());
}

float agreementAt(const std::vector<Sample>& samples, const std::array<float, 3>& v) {
  const float f = facingShare(samples, v);
  return std::max(f, 1.F - f);
}

// A grid over the box and half its extent around it, and directions far away.
std::vector<std::array<float, 3>> candidates() {
  std::vector<std::array<float, 3>> out;
  constexpr int kGrid = 14;
  for (int x = 0; x < kGrid; ++x) {
    for (int y = 0; y < kGrid; ++y) {
      for (int z = 0; z < kGrid; ++z) {
        const auto place = [](int i) { return 2.F * (static_cast<float>(i) + 0.5F) / kGrid - 1.F; };
        out.push_back({place(x), place(y), place(z)});
      }
    }
  }
  constexpr int kDirections = 200;  // a spiral over the sphere, about 16 degrees apart
  for (int i = 0; i < kDirections; ++i) {
    const float z = 1.F - 2.F * (static_cast<float>(i) + 0.5F) / kDirections;
    const float r = std::sqrt(1.F - z * z);
    const float angle = 2.3999632F * static_cast<float>(i);
    for (const float far : {3.F, 30.F}) {
      out.push_back({far * r * std::cos(angle), far * r * std::sin(angle), far * z});
    }
  }
  return out;
}

std::array<float, 3> refine(const std::vector<Sample>& samples, std::array<float, 3> v) {
  float best = agreementAt(samples, v);
  const float far = std::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
  for (float step = 0.1F * std::max(1.F, far); step > 0.002F; step *= 0.5F) {
    for (bool moved = true; moved;) {
      moved = false;
      for (std::size_t a = 0; a < 3; ++a) {
        for (const float s : {-step, step}) {
          std::array<float, 3> next = v;
          next[a] += s;
          const float value = agreementAt(samples, next);
          if (value > best) {
            best = value;
            v = next;
            moved = true;
          }
        }
      }
    }
  }
  return v;
}

}  // namespace

ViewpointFit fitViewpoint(const PointView& points, const std::vector<float>& normals,
                          const std::vector<std::uint32_t>& rows, int threads) {
  ViewpointFit fit;
  const Frame frame = boundingFrame(points, rows);
  if (rows.size() < 3 || !(frame.extent > 0.0)) return fit;
  const std::vector<Sample> few = takeSamples(points, normals, rows, frame, 600);
  const std::vector<Sample> many = takeSamples(points, normals, rows, frame, 4000);
  if (few.size() < 3) return fit;

  const std::vector<std::array<float, 3>> places = candidates();
  std::vector<float> scores(places.size());
  const int t = resolveThreads(threads, places.size(), 3000.0);
#pragma omp parallel for num_threads(t) schedule(static)
  for (std::size_t c = 0; c < places.size(); ++c) scores[c] = agreementAt(few, places[c]);

  constexpr int kStarts = 5;
  std::array<float, 3> best{0.F, 0.F, 0.F};
  for (int start = 0; start < kStarts; ++start) {
    const auto it = std::max_element(scores.begin(), scores.end());
    const std::array<float, 3> v =
        refine(many, places[static_cast<std::size_t>(it - scores.begin())]);
    *it = -1.F;
    const float value = agreementAt(many, v);
    if (value > fit.agreement) {
      fit.agreement = value;
      best = v;
    }
  }
  fit.facing = facingShare(many, best) >= 0.5F ? 1 : -1;
  for (std::size_t a = 0; a < 3; ++a) {
    fit.position[a] =
        static_cast<float>(frame.center[a] + frame.extent * static_cast<double>(best[a]));
  }
  return fit;
}

}  // namespace segorient
