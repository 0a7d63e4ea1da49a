// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/automatic/sensor_signs.h"

#include <algorithm>
#include <cmath>
#include <queue>

#include "common/at.h"
#include "common/dot.h"
#include "features/scan_scale.h"

namespace segorient::detail {
namespace {

// Errors of a normal's angle have long tails, from edges and stray points.
constexpr float kClear = 3.F;  // standard deviations

// What borders tie to segments that sensors decided, the surest of the rest first: as its borders
// to decided ones and its own points say together, of all that these could say.
void followDecided(const std::vector<Ballot>& ballots, const std::vector<BorderVote>& votes,
                   std::vector<bool> decided, std::vector<std::int8_t>& signs) {
  const std::size_t n = signs.size();
  std::vector<std::vector<std::uint32_t>> borders(n);
  std::vector<double> balance(n);
  std::vector<double> all(n);
  for (std::size_t s = 0; s < n; ++s) {
    balance[s] = ballots[s].balance;
    all[s] = ballots[s].total;
  }
  for (std::size_t v = 0; v < votes.size(); ++v) {
    for (const std::int32_t s : {votes[v].a, votes[v].b}) {
      borders[at(s)].push_back(static_cast<std::uint32_t>(v));
      all[at(s)] += static_cast<double>(votes[v].absolute);
    }
  }
  struct Candidate {
    double sureness;
    std::size_t segment;
    bool operator<(const Candidate& o) const {
      return sureness != o.sureness ? sureness < o.sureness : segment > o.segment;
    }
  };
  std::priority_queue<Candidate> queue;
  const auto surenessOf = [&](std::size_t s) { return std::fabs(balance[s]) / all[s]; };
  const auto tellNeighbors = [&](std::size_t s) {
    for (const std::uint32_t v : borders[s]) {
      const std::size_t other = at(at(votes[v].a) == s ? votes[v].b : votes[v].a);
      if (decided[other] || votes[v].weight == 0.F) continue;
      balance[other] += static_cast<double>(votes[v].weight) * signs[s];
      queue.push({surenessOf(other), other});
    }
  };
  for (std::size_t s = 0; s < n; ++s) {
    if (decided[s]) tellNeighbors(s);
  }
  while (!queue.empty()) {
    const Candidate next = queue.top();
    queue.pop();
    const std::size_t s = next.segment;
    // What has heard more since is in the queue again.
    if (decided[s] || next.sureness != surenessOf(s) || balance[s] == 0.0) continue;
    signs[s] = balance[s] < 0.0 ? std::int8_t{-1} : std::int8_t{1};
    decided[s] = true;
    tellNeighbors(s);
  }
}

}  // namespace

bool isClear(double facing) {
  return std::fabs(facing) >= static_cast<double>(kClear);
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
    ballot.add(static_cast<float>(segmentation.signs[i]) * std::clamp(facing[i], -kClear, kClear));
  }
  return out;
}

std::vector<bool> turnToSensors(const std::vector<Ballot>& ballots,
                                const std::vector<BorderVote>& votes, bool others_follow,
                                std::vector<std::int8_t>& signs) {
  std::vector<bool> by_sensors(signs.size(), false);
  // Along its rim a segment has points that belong to the next one and were seen from elsewhere:
  // what few points say must be more than what its borders could.
  std::vector<double> borders(signs.size(), 0.0);
  for (const BorderVote& v : votes) {
    borders[static_cast<std::size_t>(v.a)] += static_cast<double>(v.absolute);
    borders[static_cast<std::size_t>(v.b)] += static_cast<double>(v.absolute);
  }
  for (std::size_t s = 0; s < signs.size(); ++s) {
    if (!isClear(ballots[s].balance) || std::fabs(ballots[s].balance) < borders[s]) continue;
    by_sensors[s] = true;
    signs[s] = ballots[s].balance < 0.0 ? std::int8_t{-1} : std::int8_t{1};
  }
  if (others_follow) followDecided(ballots, votes, by_sensors, signs);
  return by_sensors;
}

}  // namespace segorient::detail
