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
class SurestFirst {
 public:
  SurestFirst(const std::vector<Ballot>& ballots, const std::vector<BorderVote>& votes,
              std::vector<std::int8_t>& signs)
      : votes_(votes), signs_(signs), decided_(signs.size(), false), borders_(signs.size()) {
    for (const Ballot& b : ballots) {
      balance_.push_back(b.balance);
      all_.push_back(b.total);
    }
    for (std::size_t v = 0; v < votes.size(); ++v) {
      for (const std::int32_t s : {votes[v].a, votes[v].b}) {
        borders_[at(s)].push_back(static_cast<std::uint32_t>(v));
        all_[at(s)] += votes[v].absolute;
      }
    }
  }

  bool isDecided(std::size_t s) const { return decided_[s]; }

  /// Of all that is said of a segment, what one side has more than the other.
  float sureness(std::size_t s) const { return std::fabs(balance_[s]) / all_[s]; }

  /// As what is known of it by now says.
  void decide(std::size_t s) {
    signs_[s] = balance_[s] < 0.F ? std::int8_t{-1} : std::int8_t{1};
    decided_[s] = true;
  }

  void tellNeighbors(std::size_t s) {
    for (const std::uint32_t v : borders_[s]) {
      const std::size_t other = at(at(votes_[v].a) == s ? votes_[v].b : votes_[v].a);
      if (decided_[other] || votes_[v].weight == 0.F) continue;
      balance_[other] += votes_[v].weight * static_cast<float>(signs_[s]);
      queue_.push({sureness(other), other});
    }
  }

  void followDecided() {
    while (!queue_.empty()) {
      const Candidate next = queue_.top();
      queue_.pop();
      const std::size_t s = next.segment;
      // What has heard more since is in the queue again.
      if (decided_[s] || next.sureness != sureness(s) || balance_[s] == 0.F) continue;
      decide(s);
      tellNeighbors(s);
    }
  }

 private:
  struct Candidate {
    float sureness;
    std::size_t segment;
    bool operator<(const Candidate& o) const {
      return sureness != o.sureness ? sureness < o.sureness : segment > o.segment;
    }
  };

  const std::vector<BorderVote>& votes_;
  std::vector<std::int8_t>& signs_;
  std::vector<bool> decided_;
  std::vector<std::vector<std::uint32_t>> borders_;
  std::vector<float> balance_;
  std::vector<float> all_;
  std::priority_queue<Candidate> queue_;
};

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
  SurestFirst sides(ballots, votes, signs);
  std::vector<std::size_t> left;
  for (std::size_t s = 0; s < signs.size(); ++s) {
    if (!isClear(ballots[s].balance)) continue;
    by_sensors[s] = std::fabs(ballots[s].balance) >= borders[s];
    if (by_sensors[s]) {
      sides.decide(s);
    } else {
      left.push_back(s);
    }
  }
  for (std::size_t s = 0; s < signs.size(); ++s) {
    if (by_sensors[s]) sides.tellNeighbors(s);
  }
  sides.followDecided();
  // Where the borders of all are longer, as of pieces that tiles overlap on, none knows better.
  std::stable_sort(left.begin(), left.end(), [&](std::size_t a, std::size_t b) {
    return sides.sureness(a) > sides.sureness(b);
  });
  for (const std::size_t s : left) {
    if (sides.isDecided(s)) continue;
    by_sensors[s] = true;
    sides.decide(s);
    sides.tellNeighbors(s);
    sides.followDecided();
  }
  return by_sensors;
}

}  // namespace segorient::detail
