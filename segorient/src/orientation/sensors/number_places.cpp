// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "orientation/sensors/number_places.h"

#include <segorient/common/point_view.h>

#include <algorithm>
#include <cstddef>
#include <functional>
#include <map>
#include <numeric>
#include <unordered_map>
#include <utility>

#include "common/at.h"

namespace segorient::detail {
namespace {

using Place = std::array<float, 3>;

}  // namespace

std::vector<Place> numberPlaces(const std::vector<float>& places_of_points,
                                std::vector<std::int32_t>& of) {
  of.assign(places_of_points.size() / 3, -1);
  // Points of one place mostly come one after another, and there are few places or as many as
  // points.
  struct Hash {
    std::size_t operator()(const Place& p) const {
      std::size_t h = 0;
      for (const float v : p) h = h * 1000003U + std::hash<float>()(v);
      return h;
    }
  };
  std::unordered_map<Place, std::int32_t, Hash> found;
  std::vector<Place> places;
  std::int32_t last = -1;
  for (std::size_t i = 0; i < of.size(); ++i) {
    const float* v = &places_of_points[3 * i];
    if (!isFinite(v)) continue;
    const Place place{v[0], v[1], v[2]};
    if (last < 0 || place != places[at(last)]) {
      const auto next = static_cast<std::int32_t>(places.size());
      const auto [entry, is_new] = found.emplace(place, next);
      if (is_new) places.push_back(place);
      last = entry->second;
    }
    of[i] = last;
  }
  std::vector<std::int32_t> order(places.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(),
            [&](std::int32_t a, std::int32_t b) { return places[at(a)] < places[at(b)]; });
  std::vector<std::int32_t> rank(places.size());
  std::vector<Place> sorted;
  for (const std::int32_t p : order) {
    rank[at(p)] = static_cast<std::int32_t>(sorted.size());
    sorted.push_back(places[at(p)]);
  }
  for (std::int32_t& p : of) {
    if (p >= 0) p = rank[at(p)];
  }
  return sorted;
}

std::vector<std::int32_t> splitByScan(const std::vector<std::int32_t>& scan_of_points,
                                      std::size_t least, std::vector<Place>& places,
                                      std::vector<std::int32_t>& of) {
  constexpr std::int32_t kNotSeen = -2;  // no scan, and not none (-1)
  std::vector<std::int32_t> scan_of(places.size(), scan_of_points.empty() ? -1 : kNotSeen);
  // Points of the scans that a place has beside its first.
  std::map<std::pair<std::int32_t, std::int32_t>, std::size_t> others;
  for (std::size_t i = 0; i < scan_of_points.size(); ++i) {
    if (of[i] < 0) continue;
    std::int32_t& first = scan_of[at(of[i])];
    if (first == kNotSeen) first = scan_of_points[i];
    if (first != scan_of_points[i]) ++others[{of[i], scan_of_points[i]}];
  }
  std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> split;
  const bool several = places.size() > 1;
  for (const auto& [part, points] : others) {
    if (several && points >= least) {
      const Place same = places[at(part.first)];
      split.emplace(part, static_cast<std::int32_t>(places.size()));
      places.push_back(same);
      scan_of.push_back(part.second);
    } else {
      scan_of[at(part.first)] = -1;
    }
  }
  for (std::size_t i = 0; !split.empty() && i < scan_of_points.size(); ++i) {
    const auto part = split.find({of[i], scan_of_points[i]});
    if (part != split.end()) of[i] = part->second;
  }
  return scan_of;
}

}  // namespace segorient::detail
