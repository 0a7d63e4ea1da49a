// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/sensors/known_sensors.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "common/at.h"
#include "common/in_double.h"
#include "common/median.h"
#include "common/unit_vector.h"
#include "orientation/sensors/height_field.h"
#include "orientation/sensors/number_places.h"
#include "orientation/sensors/scan_checks.h"
#include "orientation/sensors/shadows.h"

namespace segorient::detail {
namespace {

// Places with fewer points say too little about their sensor; they are looked at together. Of a
// thousand, shares of a hundredth are off by a third. Of small clouds a place may have fewer, if it
// has a hundredth of all points.
constexpr std::size_t kLeastPoints = 200;
constexpr std::size_t kEnoughPoints = 1000;
constexpr std::size_t kLeastPart = 100;

// What is known of a place by its points, measured on the scans of 39 virtual and real clouds at
// their true places: .09 hidden, .01 contrary, and a density ratio of .03 to .65, up to 1.6 from
// the air and of photographs. Elsewhere most of them have more than .1 hidden or .05 contrary, and
// the ratio is 1.2 to 5.
constexpr float kMostHidden = 0.1F;
// A density that varies, as thinning would not leave it, and far from as the sensor would have it:
// then kFewHidden are enough.
constexpr float kDenied = 1.3F;
constexpr float kVaries = 0.3F;

// At true places of single scans the ratio is .03 to .4, and up to .6 where clouds were thinned; of
// poses that were mixed up or shifted, those that turn points about leave .61 and more.
constexpr float kShown = 0.5F;
// Of the points, one in so many: a scan out of twenty. Fewer do not show that poses were mixed up.
constexpr std::size_t kFewRefused = 20;
// Pairs of two scans, of eight each point, that tell of a hundredth of them.
constexpr double kEnoughPairs = 1000.0;

using Place = std::array<float, 3>;

class Finder {
 public:
  Finder(const PointView& points, const Neighborhoods& nb, const float* spacing,
         const PointHints& hints, int threads)
      : points_(points),
        nb_(nb),
        spacing_(spacing),
        hints_(hints),
        threads_(threads),
        least_(std::clamp(points.size / kLeastPart, kLeastPoints, kEnoughPoints)) {}

  KnownSensors run() {
    std::vector<float> sensors = hints_.sensors;
    if (hints_.has_viewpoint) fillIn(hints_.viewpoint, sensors);
    if (sensors.empty()) return {};
    out_.common = hints_.has_viewpoint && hints_.sensors.empty();
    listScans(sensors);
    if (out_.scans.empty()) return {};
    out_.one_place =
        out_.scans.size() == 1 && !out_.scans[0].moving && out_.scans[0].points == points_.size;
    point(sensors);
    for (std::size_t s = 0; s < out_.scans.size(); ++s) look(s);
    if (!out_.allowed && (out_.scans.size() > 1 || !out_.common)) compare();
    // After the scans were compared: of places that explain densities by chance only, it is such
    // points that show it.
    for (std::size_t i = 0; i < hints_.either_side.size(); ++i) {
      if (hints_.either_side[i] != 0) std::fill_n(&out_.toward[3 * i], 3, 0.F);
    }
    if (out_.one_place) out_.scans[0].confirmed = out_.confirmed;
    out_.countSeen();
    return std::move(out_);
  }

 private:
  void fillIn(const Place& place, std::vector<float>& sensors) const {
    sensors.resize(3 * points_.size, std::numeric_limits<float>::quiet_NaN());
    for (std::size_t i = 0; i < points_.size; ++i) {
      if (!isFinite(&sensors[3 * i])) std::copy(place.begin(), place.end(), &sensors[3 * i]);
    }
  }

  void listScans(const std::vector<float>& sensors) {
    std::vector<std::int32_t> place_of;
    std::vector<Place> places = numberPlaces(sensors, place_of);
    const std::vector<std::int32_t> scan_of_place =
        splitByScan(hints_.scans, least_, places, place_of);
    std::vector<std::uint32_t> size(places.size(), 0);
    for (const std::int32_t p : place_of) {
      if (p >= 0) ++size[at(p)];
    }
    std::vector<std::int32_t> number(places.size(), -1);
    std::array<double, 3> sum{0.0, 0.0, 0.0};
    KnownSensor moving;
    moving.moving = true;
    for (std::size_t p = 0; p < places.size(); ++p) {
      if (size[p] < least_ && places.size() > 1) {
        moving.points += size[p];
        for (std::size_t a = 0; a < 3; ++a) {
          sum[a] += static_cast<double>(places[p][a]) * static_cast<double>(size[p]);
        }
        continue;
      }
      number[p] = static_cast<std::int32_t>(out_.scans.size());
      KnownSensor scan;
      scan.position = places[p];
      scan.points = size[p];
      scan.scan = scan_of_place[p];
      out_.scans.push_back(scan);
    }
    const auto together = static_cast<std::int32_t>(out_.scans.size());
    if (moving.points > 0) {
      for (std::size_t a = 0; a < 3; ++a) {
        moving.position[a] = static_cast<float>(sum[a] / static_cast<double>(moving.points));
      }
      out_.scans.push_back(moving);
    }
    out_.sensor_of.assign(points_.size, -1);
    rows_.resize(out_.scans.size());
    shadows_.resize(out_.scans.size());
    for (std::size_t i = 0; i < points_.size; ++i) {
      if (place_of[i] < 0) continue;
      const std::int32_t n = number[at(place_of[i])];
      out_.sensor_of[i] = n < 0 ? together : n;
      rows_[at(out_.sensor_of[i])].push_back(static_cast<std::uint32_t>(i));
    }
  }

  void point(const std::vector<float>& sensors) {
    out_.toward.assign(3 * points_.size, 0.F);
    for (std::size_t i = 0; i < points_.size; ++i) {
      if (out_.sensor_of[i] < 0) continue;
      directionTo(points_[i], &sensors[3 * i], &out_.toward[3 * i]);
    }
  }

  void look(std::size_t s) {
    KnownSensor& report = out_.scans[s];
    if (report.moving || report.points < least_) return;
    const Scan scan(points_, rows_[s], report.position, &nb_, threads_);
    const Scan::Density density = scan.density();
    report.density = density.ratio;
    const std::vector<std::uint8_t> hidden = scan.hidden();
    report.hidden = shareOf(hidden);
    if (hints_.place.along_way) return;
    // A body that has points inside looks so from within.
    if (out_.one_place && report.hidden > kMostHidden && scan.isOutside() &&
        scan.seesThrough(hidden)) {
      report.hidden = 0.F;
      out_.confirmed = true;
      return;
    }
    if (!out_.one_place && report.hidden > kFewHidden &&
        (scan.stoodElsewhere() || shadowsOf(s).deny())) {
      report.used = false;
      return;
    }
    // Of what was not seen from one place, the part nearest to it may have such a density, too.
    const bool hides = report.hidden > kMostHidden;
    if (report.density < kConfirmed && !(out_.common && hides && !hints_.place.found)) {
      out_.confirmed = out_.one_place;
      return;
    }
    const bool denied =
        report.density > kDenied && density.constant > kVaries && std::isfinite(report.density);
    if (out_.one_place) {
      // Of a thin wall one side lies hardly behind the other, which shadows miss: where points are
      // hidden, they alone do not confirm a place against what closes.
      const bool shown = hints_.place.shadows.reveal() || hints_.place.whole_image;
      out_.confirmed = shown && !hides;
      out_.allowed = hints_.place.shadows.allow();
      out_.hides = hides && !out_.allowed;
      out_.in_a_room = (shown || !hides) && hints_.place.shadows.inARoom();
      out_.enclosed = hints_.place.shadows.enclose();
      if (out_.confirmed) return;
      out_.doubtful = out_.allowed || hides || denied || density.constant < kVaries;
      if (out_.allowed) return;
    }
    // Who was found has passed such tests already.
    if (out_.common || hints_.place.found) return;
    if (out_.one_place && hints_.place.shadows.excuse()) return;
    if (!hides && !(denied && report.hidden > kFewHidden)) return;
    if (out_.one_place || !shadowsOf(s).allow()) report.used = false;
  }

  // Scans against each other, and against themselves: the worst one is in the wrong, which may
  // clear the others.
  void compare() {
    const std::size_t n = out_.scans.size();
    const std::vector<ScanPairs> pairs =
        findContraryPairs(points_, nb_, spacing_, out_.toward, out_.sensor_of, threads_);
    confirm(pairs);
    // With scans that are used, and within each.
    std::vector<double> all(n, 0.0);
    std::vector<double> contrary(n, 0.0);
    for (const ScanPairs& p : pairs) {
      if (!out_.scans[p.other].used && p.other != p.scan) continue;
      all[p.scan] += p.pairs;
      contrary[p.scan] += p.contrary;
    }
    for (;;) {
      std::size_t worst = n;
      float most = kMostContrary;
      // Those whose density confirms them are believed first.
      for (std::size_t s = 0; s < n; ++s) {
        const float share = all[s] > 0.0 ? static_cast<float>(contrary[s] / all[s]) : 0.F;
        out_.scans[s].contrary = share;
        if (!out_.scans[s].used || out_.scans[s].density < kConfirmed || !(share > most)) continue;
        most = share;
        worst = s;
      }
      if (worst == n) break;
      out_.scans[worst].used = false;
      out_.scans[worst].confirmed = false;
      for (const ScanPairs& p : pairs) {
        if (p.other != worst || p.scan == worst) continue;
        all[p.scan] -= p.pairs;
        contrary[p.scan] -= p.contrary;
      }
    }
    askMore();
    out_.dropUnused();
  }

  // Scans whose density confirms their sensor, those that see what these see from the same side,
  // and so on.
  void confirm(const std::vector<ScanPairs>& pairs) {
    for (KnownSensor& scan : out_.scans) {
      scan.confirmed = scan.used && scan.density < kShown && scan.hidden <= kMostHidden;
    }
    const std::size_t n = out_.scans.size();
    for (bool changed = true; changed;) {
      changed = false;
      std::vector<double> all(n, 0.0);
      std::vector<double> contrary(n, 0.0);
      for (const ScanPairs& p : pairs) {
        if (p.other == p.scan || !out_.scans[p.other].confirmed) continue;
        all[p.scan] += p.pairs;
        contrary[p.scan] += p.contrary;
      }
      for (std::size_t s = 0; s < n; ++s) {
        KnownSensor& scan = out_.scans[s];
        const bool agrees = all[s] >= kEnoughPairs && contrary[s] <= kMostContrary * all[s];
        if (scan.confirmed || !scan.used || !agrees) continue;
        scan.confirmed = true;
        changed = true;
      }
    }
  }

  // Poses that were mixed up are wrong together: where some are refused, others need more than that
  // nothing contradicts them, and where most are, they need to be confirmed. Most points of a scan
  // that was mixed with others may still be its own, and have its density. Where most points are of
  // confirmed scans, those show who is wrong.
  void askMore() {
    std::size_t all = 0;
    std::size_t confirmed = 0;
    std::size_t refused = 0;
    for (const KnownSensor& scan : out_.scans) {
      all += scan.points;
      if (!scan.used) refused += scan.points;
      if (scan.used && scan.confirmed) confirmed += scan.points;
    }
    if (kFewRefused * refused < all || 2 * confirmed > all || hints_.place.along_way) return;
    for (std::size_t s = 0; s < out_.scans.size(); ++s) {
      KnownSensor& scan = out_.scans[s];
      if (!scan.used || scan.moving || scan.confirmed) continue;
      if (2 * refused > all) {
        scan.used = false;
        continue;
      }
      const Shadows& shadows = shadowsOf(s);
      scan.used = hints_.even_sample ? !shadows.deny() : shadows.confirm();
    }
  }

  // Whether what the scan saw ends where something nearer hides the rest from its place.
  const Shadows& shadowsOf(std::size_t s) {
    if (shadows_[s]) return *shadows_[s];
    std::vector<float> own;
    for (const std::uint32_t row : rows_[s]) {
      const float* p = points_[row];
      own.insert(own.end(), p, p + 3);
    }
    shadows_[s] = findShadows({own.data(), 3, own.size() / 3}, out_.scans[s].position, threads_);
    return *shadows_[s];
  }

  const PointView& points_;
  const Neighborhoods& nb_;
  const float* spacing_;
  const PointHints& hints_;
  int threads_;
  std::size_t least_;                             // points of a place that is looked at by itself
  std::vector<std::vector<std::uint32_t>> rows_;  // of each scan
  std::vector<std::optional<Shadows>> shadows_;   // of each scan, once they are asked for
  KnownSensors out_;
};

}  // namespace

void KnownSensors::countSeen() {
  for (KnownSensor& s : scans) s.seen = 0;
  for (std::size_t i = 0; i < sensor_of.size(); ++i) {
    const float* v = of(i);
    if (v[0] != 0.F || v[1] != 0.F || v[2] != 0.F) ++scans[at(sensor_of[i])].seen;
  }
}

void KnownSensors::dropUnused() {
  for (std::size_t i = 0; i < sensor_of.size(); ++i) {
    if (sensor_of[i] >= 0 && !scans[at(sensor_of[i])].used) {
      std::fill_n(&toward[3 * i], 3, 0.F);
    }
  }
}

KnownSensors findKnownSensors(const PointView& points, const Neighborhoods& neighborhoods,
                              const float* spacing, const PointHints& hints, int threads) {
  if (!hints.toward.empty()) {
    KnownSensors believed;
    believed.toward = hints.toward;
    return believed;
  }
  if (hints.place.faces_up) {
    KnownSensors above;
    above.toward.assign(3 * points.size, 0.F);
    const float typical = median({spacing, spacing + points.size});
    const std::vector<std::uint8_t> open = openToTheSky(points, typical);
    for (std::size_t i = 0; i < points.size; ++i)
      above.toward[3 * i + 2] = open[i] != 0 ? 1.F : 0.F;
    return above;
  }
  return Finder(points, neighborhoods, spacing, hints, threads).run();
}

bool seeBothSides(PreparedCloud& cloud, const PointHints& hints, int threads) {
  cloud.findNeighbors(kSheetNeighbors, false);
  const Neighborhoods& nb = cloud.neighborhoods();
  std::vector<float> spacing(cloud.size(), 0.F);
  for (std::size_t i = 0; i < spacing.size(); ++i) {
    spacing[i] = meanDistance(cloud.points(), nb, i, kFirstRing);
  }
  return seeBothSides(findKnownSensors(cloud.points(), nb, spacing.data(), hints, threads).scans);
}

}  // namespace segorient::detail
