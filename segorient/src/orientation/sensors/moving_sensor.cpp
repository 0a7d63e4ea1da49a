// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/sensors/moving_sensor.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numeric>
#include <utility>

#include "common/directions.h"
#include "common/median.h"
#include "common/parallel_for.h"
#include "orientation/sensors/sampling_law.h"
#include "orientation/sensors/simplex.h"

namespace segorient::detail {
namespace {

// What places near to the path of a sensor that moved have to leave of the constant's deviation at
// most, or no search goes on from there: .39 to .72, 1.0 and more on layers and bodies.
constexpr float kHopeless = 0.8F;

using Position = std::array<double, 3>;
using Line = std::vector<double>;  // x, y of one end, x, y of the other, z

constexpr std::size_t kPieces = 500;  // a hundred for each of the five unknowns of a line
constexpr int kPlaces = 9;            // a line of places is as good as a path once they are near
constexpr int kElevations = 72;       // bins of 2.5 degrees: 16 beams are 2 degrees apart
constexpr int kBeamRounds = 6;
constexpr float kPrior = 0.02F;  // of an even share of the pieces: empty bins stay as they are
// Of path lengths, as parts of the scene's: standing nearly still, and then each about twice the
// last, since a path is found from starts of half its length to twice.
constexpr std::array<double, 4> kLengths{0.02, 0.2, 0.44, 0.9};
// That are followed of each length's 54, as the best may be dead ends.
constexpr std::size_t kStarts = 12;
constexpr int kEvaluations = 160;
constexpr double kStep = 0.04;  // of the extent
constexpr int kFineEvaluations = 60;
constexpr double kFineStep = 0.01;

// The bin of an elevation by its sine, from a table: arcsines are slow.
class ElevationBins {
 public:
  ElevationBins() {
    for (int i = 0; i < kFine; ++i) {
      const double sine = (2.0 * i + 1.0) / kFine - 1.0;
      const int bin = static_cast<int>((std::asin(sine) / kPi + 0.5) * kElevations);
      table_[static_cast<std::size_t>(i)] =
          static_cast<std::uint8_t>(std::min(bin, kElevations - 1));
    }
  }
  std::size_t of(float sine) const {
    const auto i = static_cast<int>((sine + 1.F) * (0.5F * kFine));
    return table_[static_cast<std::size_t>(std::clamp(i, 0, kFine - 1))];
  }

 private:
  static constexpr int kFine = 1024;  // an eighth of a degree, a twentieth of a bin
  std::array<std::uint8_t, kFine> table_{};
};

std::vector<Position> placesAlong(const Line& line) {
  std::vector<Position> out;
  for (int i = 0; i < kPlaces; ++i) {
    const double t = static_cast<double>(i) / (kPlaces - 1);
    out.push_back({line[0] + t * (line[2] - line[0]), line[1] + t * (line[3] - line[1]), line[4]});
  }
  return out;
}

// As an ANGLE_GRID about z would have it, and the elevation's bin.
// \param occupancy what hides pieces from the place, or null: nothing does
void beamShares(const DensityPatches& patches, const Occupancy* occupancy, const Position& place,
                std::vector<float>& row, std::vector<std::uint8_t>& bins) {
  static const ElevationBins kBins;
  ratios(patches, {place, {0.0, 0.0, 1.0}, SamplingLaw::ANGLE_GRID}, row);
  bins.resize(patches.size());
  const std::array<float, 3> at = toFloat(place);
  const float* const columns[3] = {patches.x.data(), patches.y.data(), patches.z.data()};
  for (std::size_t i = 0, n = bins.size(); i < n; ++i) {
    const float x = columns[0][i] - at[0];
    const float y = columns[1][i] - at[1];
    const float z = columns[2][i] - at[2];
    const float d = std::sqrt(std::max(x * x + y * y + z * z, 1e-12F));
    bins[i] = static_cast<std::uint8_t>(kBins.of(z / d));
  }
  if (occupancy == nullptr) return;
  std::vector<float> seen(patches.size());
  occupancy->visibility(patches, place, seen.data());
  for (std::size_t i = 0; i < seen.size(); ++i) row[i] *= seen[i];
}

// What the places leave on the pieces, and how it depends on the beams.
class TrackModel {
 public:
  // \param occupancy as of beamShares()
  explicit TrackModel(const DensityPatches& patches, const Occupancy* occupancy = nullptr)
      : patches_(patches), occupancy_(occupancy) {}

  // The beams that suit the line best, in a few rounds: each bin by what is missing where its
  // beams make most of the density.
  float fit(const std::vector<Position>& places) {
    look(places);
    beams_.assign(kElevations, 1.F);
    for (int round = 0; round < kBeamRounds; ++round) {
      mix();
      const float prior = kPrior * static_cast<float>(patches_.size()) / kElevations;
      std::vector<float> missing(kElevations, 0.F);
      std::vector<float> weight(kElevations, prior);
      for (std::size_t j = 0; j < rows_.size(); ++j) {
        addMissing(rows_[j].data(), bins_[j].data(), missing.data(), weight.data());
      }
      for (std::size_t b = 0; b < beams_.size(); ++b) beams_[b] *= std::exp(missing[b] / weight[b]);
    }
    mix();
    return deviation(logs_);
  }

  const std::vector<float>& beams() const { return beams_; }

 private:
  void look(const std::vector<Position>& places) {
    rows_.resize(places.size());
    bins_.resize(places.size());
    for (std::size_t j = 0; j < places.size(); ++j) {
      beamShares(patches_, occupancy_, places[j], rows_[j], bins_[j]);
    }
  }

  void addMissing(const float* row, const std::uint8_t* bins, float* missing, float* weight) const {
    const float* const beams = beams_.data();
    const float* const inverse = inverse_.data();
    const float* const lacking = lacking_.data();
    for (std::size_t i = 0, n = mixed_.size(); i < n; ++i) {
      const std::uint8_t b = bins[i];
      const float share = beams[b] * row[i] * inverse[i];
      missing[b] += share * lacking[i];
      weight[b] += share;
    }
  }

  // The sum over the places, its logs, and what lacks until it is the median's.
  void mix() {
    const std::size_t n = patches_.size();
    mixed_.assign(n, kNothing);
    const float* const beams = beams_.data();
    float* const mixed = mixed_.data();
    for (std::size_t j = 0; j < rows_.size(); ++j) {
      const float* const row = rows_[j].data();
      const std::uint8_t* const bins = bins_[j].data();
      for (std::size_t i = 0; i < n; ++i) mixed[i] += beams[bins[i]] * row[i];
    }
    logs_ = mixed_;
    takeLogs(logs_);
    const float middle = median(logs_);
    inverse_.resize(n);
    lacking_.resize(n);
    for (std::size_t i = 0; i < n; ++i) {
      inverse_[i] = 1.F / mixed_[i];
      lacking_[i] = std::clamp(middle - logs_[i], -kDeviationCut, kDeviationCut);
    }
  }

  const DensityPatches& patches_;
  const Occupancy* occupancy_;
  std::vector<std::vector<float>> rows_;
  std::vector<std::vector<std::uint8_t>> bins_;
  std::vector<float> beams_;
  std::vector<float> mixed_;
  std::vector<float> logs_;
  std::vector<float> inverse_;
  std::vector<float> lacking_;
};

// The level direction in which the pieces spread most, and how far.
std::array<double, 3> longDirection(const DensityPatches& patches) {
  const double n = static_cast<double>(patches.size());
  double mean[2] = {0.0, 0.0};
  for (std::size_t i = 0; i < patches.size(); ++i) {
    mean[0] += static_cast<double>(patches.x[i]) / n;
    mean[1] += static_cast<double>(patches.y[i]) / n;
  }
  double xx = 0.0;
  double xy = 0.0;
  double yy = 0.0;
  for (std::size_t i = 0; i < patches.size(); ++i) {
    const double x = static_cast<double>(patches.x[i]) - mean[0];
    const double y = static_cast<double>(patches.y[i]) - mean[1];
    xx += x * x;
    xy += x * y;
    yy += y * y;
  }
  const double angle = 0.5 * std::atan2(2.0 * xy, xx - yy);
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  double reach = 0.0;
  for (std::size_t i = 0; i < patches.size(); ++i) {
    reach = std::max(reach, std::fabs(c * (static_cast<double>(patches.x[i]) - mean[0]) +
                                      s * (static_cast<double>(patches.y[i]) - mean[1])));
  }
  return {c, s, 2.0 * reach};
}

// Lines of one length along the scene and across it, in its middle and beside, low and high, as far
// as they are inside.
std::vector<Line> startLines(const DensityPatches& patches, const Extent& extent, double part) {
  const std::array<double, 3> spread = longDirection(patches);
  const double length = spread[2];
  const Position middle = extent.middle();
  std::vector<Line> out;
  for (const auto& [dx, dy] : {std::pair{spread[0], spread[1]}, std::pair{-spread[1], spread[0]}}) {
    for (const double beside : {-0.06, 0.0, 0.06}) {
      for (const double along : {-0.2, 0.0, 0.2}) {
        const double x = middle[0] + length * (along * dx - beside * dy);
        const double y = middle[1] + length * (along * dy + beside * dx);
        for (const double height : {0.12, 0.3, 0.6}) {
          const double z = extent.low[2] + height * (extent.high[2] - extent.low[2]);
          const double half = 0.5 * part * length;
          const auto within = [&](double v, std::size_t a) {
            return std::clamp(v, extent.low[a], extent.high[a]);
          };
          out.push_back({within(x - half * dx, 0), within(y - half * dy, 1),
                         within(x + half * dx, 0), within(y + half * dy, 1), z});
        }
      }
    }
  }
  return out;
}

// No vehicle leaves the scene, where sums of a few places adapt to much. A line is inside where its
// ends are.
bool isInside(const Line& line, const Extent& extent) {
  const auto lies = [&](double v, std::size_t a) {
    return v >= extent.low[a] && v <= extent.high[a];
  };
  return lies(line[0], 0) && lies(line[2], 0) && lies(line[1], 1) && lies(line[3], 1) &&
         lies(line[4], 2);
}

double costOf(const Line& line, const Extent& extent, TrackModel& model) {
  return isInside(line, extent) ? static_cast<double>(model.fit(placesAlong(line)))
                                : std::numeric_limits<double>::infinity();
}

Track trackOf(const Line& line, TrackModel model) {
  Track out;
  out.places = placesAlong(line);
  out.cost = model.fit(out.places);
  out.beams = model.beams();
  return out;
}

}  // namespace

std::optional<Track> searchTrack(const DensityPatches& patches, const Extent& extent, int threads) {
  const DensityPatches some = patches.thinned(kPieces);
  const double most = static_cast<double>(kHopeless * deviation(some.log_density));
  std::vector<Line> lines;
  for (const double part : kLengths) {
    const std::vector<Line> starts = startLines(some, extent, part);
    lines.insert(lines.end(), starts.begin(), starts.end());
  }
  std::vector<double> costs(lines.size());
  constexpr double kFitTime = 1e6;  // ns a line, see resolveThreads()
  parallelFor(
      lines.size(), threads, kFitTime, [&] { return TrackModel(some); },
      [&](std::size_t i, TrackModel& model) { costs[i] = costOf(lines[i], extent, model); });
  std::vector<std::size_t> order;
  const std::size_t each = lines.size() / kLengths.size();
  for (std::size_t first = 0; first < lines.size(); first += each) {
    std::vector<std::size_t> of_length(each);
    std::iota(of_length.begin(), of_length.end(), first);
    std::stable_sort(of_length.begin(), of_length.end(),
                     [&](std::size_t a, std::size_t b) { return costs[a] < costs[b]; });
    for (std::size_t s = 0; s < kStarts; ++s) {
      if (costs[of_length[s]] <= most) order.push_back(of_length[s]);
    }
  }
  if (order.empty()) return std::nullopt;
  const std::vector<double> steps(5, kStep * extent.diagonal());
  parallelFor(
      order.size(), threads, kEvaluations * kFitTime, [&] { return TrackModel(some); },
      [&](std::size_t s, TrackModel& model) {
        const auto cost = [&](const Line& line) { return costOf(line, extent, model); };
        costs[order[s]] = minimize(cost, steps, kEvaluations, lines[order[s]]);
      });
  const std::size_t best =
      *std::min_element(order.begin(), order.end(),
                        [&](std::size_t a, std::size_t b) { return costs[a] < costs[b]; });
  return trackOf(lines[best], TrackModel(patches));
}

namespace {

// What each place leaves on the pieces where it can see them.
std::vector<std::vector<float>> sharesOf(const DensityPatches& patches, const Occupancy& occupancy,
                                         const Track& track) {
  std::vector<std::vector<float>> rows(track.places.size());
  std::vector<std::uint8_t> bins;
  for (std::size_t j = 0; j < rows.size(); ++j) {
    beamShares(patches, &occupancy, track.places[j], rows[j], bins);
    for (std::size_t i = 0; i < bins.size(); ++i) rows[j][i] *= track.beams[bins[i]];
  }
  return rows;
}

}  // namespace

Track settleInSight(const DensityPatches& patches, const Extent& extent, const Occupancy& occupancy,
                    const Track& track) {
  const DensityPatches some = patches.thinned(kPieces);
  TrackModel model(some, &occupancy);
  const auto cost = [&](const Line& l) { return costOf(l, extent, model); };
  const Position& first = track.places.front();
  const Position& last = track.places.back();
  Line line{first[0], first[1], last[0], last[1], first[2]};
  const std::vector<double> steps(line.size(), kFineStep * extent.diagonal());
  minimize(cost, steps, kFineEvaluations, line);
  return trackOf(line, TrackModel(patches, &occupancy));
}

PieceOrigins originsOf(const DensityPatches& patches, const Occupancy& occupancy,
                       const Track& track) {
  return strongestPlaces(patches, track.places, sharesOf(patches, occupancy, track));
}

}  // namespace segorient::detail
