// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/automatic/sensor_signs.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "common/dot.h"
#include "features/scan_scale.h"

namespace segorient::detail {
namespace {

// Errors of a normal's angle have long tails, from edges and stray points.
constexpr float kClear = 3.F;  // standard deviations

}  // namespace

bool isClear(float facing) {
  return std::fabs(facing) >= kClear;
}

std::vector<float> facingOf(const SheetField& field, std::size_t points,
                            const KnownSensors& sensors) {
  // A plane over k points with a residual of r spacings is off by about r / (sqrt(k) times the
  // neighbourhood's own rms extent); that is .45 r for eight neighbours and less for more. What
  // curvature does beside is some degrees. Where the residual is large, the scale was chosen so
  // that noise turns the normal by less than kMostNormalError.
  constexpr float kPerResidual = 0.45F;
  constexpr float kBend = 0.03F;
  std::vector<float> out(points, 0.F);
  for (std::size_t i = 0; i < points; ++i) {
    const float* n = field.normals + 4 * i;
    const float error = kBend + std::min(kPerResidual * n[3], detail::kMostNormalError);
    const float cosine = dot(n, sensors.of(i));
    if (std::isfinite(cosine) && std::isfinite(error)) out[i] = cosine / error;
  }
  return out;
}

std::vector<Ballot> facingBySegment(const std::vector<float>& facing,
                                    const Segmentation& segmentation) {
  std::vector<Ballot> out(segmentation.segments.size());
  for (std::size_t i = 0; i < facing.size(); ++i) {
    if (segmentation.labels[i] < 0) continue;
    Ballot& ballot = out[static_cast<std::size_t>(segmentation.labels[i])];
    const float vote = std::clamp(facing[i], -kClear, kClear);
    ballot.balance += static_cast<float>(segmentation.signs[i]) * vote;
    ballot.total += std::fabs(vote);
  }
  return out;
}

std::vector<bool> turnToSensors(const std::vector<Ballot>& ballots,
                                const std::vector<BorderVote>& votes,
                                std::vector<std::int8_t>& signs) {
  std::vector<bool> by_sensors(signs.size(), false);
  // Along its rim a segment has points that belong to the next one and were seen from elsewhere:
  // what few points say must be more than what its borders could.
  std::vector<float> borders(signs.size(), 0.F);
  for (const BorderVote& v : votes) {
    borders[static_cast<std::size_t>(v.a)] += v.absolute;
    borders[static_cast<std::size_t>(v.b)] += v.absolute;
  }
  for (std::size_t s = 0; s < signs.size(); ++s) {
    if (!isClear(ballots[s].balance) || std::fabs(ballots[s].balance) < borders[s]) continue;
    by_sensors[s] = true;
    signs[s] = ballots[s].balance < 0.F ? std::int8_t{-1} : std::int8_t{1};
  }
  // Ring by ring to the end of each component: each undecided segment as its borders to decided
  // ones say together.
  std::vector<bool> decided = by_sensors;
  for (bool grown = true; grown;) {
    std::map<std::int32_t, float> support;
    for (const BorderVote& v : votes) {
      const bool a = decided[static_cast<std::size_t>(v.a)];
      const bool b = decided[static_cast<std::size_t>(v.b)];
      if (a == b) continue;
      const std::int32_t from = a ? v.a : v.b;
      support[a ? v.b : v.a] +=
          v.weight * static_cast<float>(signs[static_cast<std::size_t>(from)]);
    }
    grown = false;
    for (const auto& [s, borders_say] : support) {
      const float weight = borders_say + ballots[static_cast<std::size_t>(s)].balance;
      if (weight == 0.F) continue;
      signs[static_cast<std::size_t>(s)] = weight < 0.F ? std::int8_t{-1} : std::int8_t{1};
      decided[static_cast<std::size_t>(s)] = true;
      grown = true;
    }
  }
  return by_sensors;
}

}  // namespace segorient::detail
