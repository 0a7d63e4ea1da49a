// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "tiles/point_packets.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "tiles/bit_stream.h"
#include "tiles/packed_values.h"

namespace segorient::program {
namespace {

// Numbers one behind the other, as they are in memory.
template <typename T>
void append(const T& value, std::vector<std::uint8_t>& out) {
  const auto* bytes = reinterpret_cast<const std::uint8_t*>(&value);
  out.insert(out.end(), bytes, bytes + sizeof(T));
}

template <typename T>
bool take(const std::vector<std::uint8_t>& from, std::size_t& at, T& value) {
  if (sizeof(T) > from.size() - at) return false;
  std::memcpy(&value, from.data() + at, sizeof(T));
  at += sizeof(T);
  return true;
}

// Unknown ones are NaN: they are compared by their bits.
using Viewpoint = std::array<std::uint32_t, 3>;

Viewpoint bitsOfPlace(const std::array<float, 3>& place) {
  Viewpoint out{};
  std::memcpy(out.data(), place.data(), sizeof(out));
  return out;
}

// The places that a packet's points were seen from, if they are few.
class Viewpoints {
 public:
  void find(const StoredPoint* points, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) {
      const Viewpoint v = bitsOfPlace(points[i].seen_from);
      if (std::find(known_.begin(), known_.end(), v) != known_.end()) continue;
      if (known_.size() == kMost) {
        known_.clear();
        return;
      }
      known_.push_back(v);
    }
  }
  void write(std::vector<std::uint8_t>& out) const {
    append(static_cast<std::uint8_t>(known_.size()), out);
    for (const Viewpoint& v : known_) append(v, out);
  }
  bool read(const std::vector<std::uint8_t>& from, std::size_t& at) {
    std::uint8_t count = 0;
    bool whole = take(from, at, count);
    known_.resize(count);
    for (Viewpoint& v : known_) whole = whole && take(from, at, v);
    return whole;
  }
  void put(const std::array<float, 3>& place, BitWriter& out) const {
    const Viewpoint v = bitsOfPlace(place);
    if (known_.empty()) {
      for (const std::uint32_t x : v) out.put(x, 32);
    } else {
      const auto at = std::find(known_.begin(), known_.end(), v);
      out.put(static_cast<std::uint64_t>(at - known_.begin()), bitsOf(known_.size() - 1));
    }
  }
  bool get(BitReader& in, std::array<float, 3>& place) const {
    Viewpoint v{};
    if (known_.empty()) {
      for (std::uint32_t& x : v) x = static_cast<std::uint32_t>(in.get(32));
    } else {
      const auto at = static_cast<std::size_t>(in.get(bitsOf(known_.size() - 1)));
      if (at >= known_.size()) return false;
      v = known_[at];
    }
    std::memcpy(place.data(), v.data(), sizeof(v));
    return true;
  }

 private:
  static constexpr std::size_t kMost = 16;
  std::vector<Viewpoint> known_;  // none: they are too many
};

std::uint64_t packedNormal(const std::array<float, 3>& n) {
  const float length = std::hypot(n[0], n[1], n[2]);
  return std::isfinite(length) && length > 0.F ? packNormal(n.data(), kNormalBits) : kNoNormal;
}

}  // namespace

void packPoints(const StoredPoint* points, PlaceOrder& order, const PointFields& fields,
                std::vector<std::uint8_t>& out) {
  std::vector<std::uint8_t> code;
  BitWriter bits(code);
  order.order(&bits);
  Viewpoints viewpoints;
  if (fields.viewpoints) viewpoints.find(points, order.size());
  const bool places_only = !fields.viewpoints && !fields.normals;
  for (std::size_t i = 0; i < order.size() && !places_only; ++i) {
    const StoredPoint& p = points[order.at(i)];
    if (fields.viewpoints) viewpoints.put(p.seen_from, bits);
    if (fields.normals) bits.put(packedNormal(p.normal), kNormalBits);
  }
  bits.flush();
  out.clear();
  for (const PlaceAxis& axis : order.axes()) {
    append(axis.least, out);
    append(axis.step, out);
    append(axis.bits, out);
  }
  if (fields.viewpoints) viewpoints.write(out);
  out.insert(out.end(), code.begin(), code.end());
}

bool unpackPoints(const std::vector<std::uint8_t>& packet, std::size_t count,
                  const PointFields& fields, std::vector<StoredPoint>& out) {
  std::array<PlaceAxis, 3> axes;
  std::size_t at = 0;
  bool whole = true;
  for (PlaceAxis& axis : axes) {
    whole = whole && take(packet, at, axis.least) && take(packet, at, axis.step) &&
            take(packet, at, axis.bits);
  }
  Viewpoints viewpoints;
  if (fields.viewpoints) whole = whole && viewpoints.read(packet, at);
  if (!whole || !PlaceOrder::isValid(axes)) return false;
  BitReader bits(packet.data() + at, packet.size() - at);
  std::vector<PlaceOrder::Place> places;
  PlaceOrder::read(axes, count, bits, places);
  StoredPoint p;
  for (const PlaceOrder::Place& place : places) {
    p.place = place;
    if (fields.viewpoints && !viewpoints.get(bits, p.seen_from)) return false;
    if (fields.normals) {
      const std::uint64_t packed = bits.get(kNormalBits);
      p.normal = {0.F, 0.F, 0.F};
      if (packed != kNoNormal) {
        unpackNormal(static_cast<std::uint32_t>(packed), kNormalBits, p.normal.data());
      }
    }
    out.push_back(p);
  }
  return true;
}

}  // namespace segorient::program
