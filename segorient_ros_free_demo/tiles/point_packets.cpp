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

// What a double holds.
constexpr int kMostBits = 52;

// How one coordinate of a packet's points is stored.
struct Axis {
  double least = 0.0;
  std::int16_t step = 0;  // its exponent
  std::uint8_t bits = 0;
};

// Numbers one behind the other, as they are in memory.
template <typename T>
void put(const T& value, std::vector<std::uint8_t>& out) {
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

// What stands before the points.
struct Head {
  std::uint32_t number = 0;
  std::uint32_t span = 0;  // of numbers
  std::array<Axis, 3> axes;
  std::array<float, 3> seen_from{0, 0, 0};
  std::uint8_t one_place = 1;  // whether all were seen from there

  void write(const PointFields& fields, std::vector<std::uint8_t>& out) const {
    put(number, out);
    put(span, out);
    for (const Axis& axis : axes) {
      put(axis.least, out);
      put(axis.step, out);
      put(axis.bits, out);
    }
    if (!fields.viewpoints) return;
    put(seen_from, out);
    put(one_place, out);
  }
  // \return false where it is none
  bool read(const PointFields& fields, const std::vector<std::uint8_t>& from, std::size_t& at) {
    bool whole = take(from, at, number) && take(from, at, span);
    for (Axis& axis : axes) {
      whole = whole && take(from, at, axis.least) && take(from, at, axis.step) &&
              take(from, at, axis.bits) && axis.bits <= kMostBits + 1;
    }
    if (fields.viewpoints) whole = whole && take(from, at, seen_from) && take(from, at, one_place);
    return whole;
  }
};

// The exponent of the last bit that is set.
int lastBit(double x) {
  int exponent = 0;
  const double mantissa = std::frexp(x, &exponent);
  const auto digits = static_cast<std::uint64_t>(std::ldexp(std::fabs(mantissa), 53));
  if (digits == 0) return 1024;
  return exponent - 53 + std::ilogb(static_cast<double>(digits & (~digits + 1)));
}

std::uint64_t stepsOf(const Axis& axis, double x) {
  return static_cast<std::uint64_t>(std::llround(std::ldexp(x - axis.least, -axis.step)));
}

Axis axisOf(const StoredPoint* points, std::size_t count, std::size_t a) {
  Axis axis;
  axis.least = points[0].place[a];
  double most = axis.least;
  int exact = 1024;
  for (std::size_t i = 0; i < count; ++i) {
    const double x = points[i].place[a];
    axis.least = std::min(axis.least, x);
    most = std::max(most, x);
    exact = std::min(exact, lastBit(x));
  }
  const double extent = most - axis.least;
  if (!(extent > 0.0) || !std::isfinite(extent)) return axis;
  int exponent = 0;
  std::frexp(extent, &exponent);
  axis.step = static_cast<std::int16_t>(std::max(exact, exponent - kMostBits));
  axis.bits = static_cast<std::uint8_t>(bitsOf(stepsOf(axis, most)));
  return axis;
}

std::uint64_t packedNormal(const std::array<float, 3>& n) {
  const float length = std::hypot(n[0], n[1], n[2]);
  return std::isfinite(length) && length > 0.F ? packNormal(n.data(), kNormalBits) : kNoNormal;
}

bool sameViewpoints(const StoredPoint* points, std::size_t count) {
  // By bits: unknown ones are NaN.
  return std::all_of(points, points + count, [&](const StoredPoint& p) {
    return std::memcmp(p.seen_from.data(), points[0].seen_from.data(), sizeof(p.seen_from)) == 0;
  });
}

}  // namespace

void packPoints(const StoredPoint* points, std::size_t count, const PointFields& fields,
                std::vector<std::uint8_t>& out) {
  out.clear();
  if (count == 0) return;
  Head head;
  head.number = points[0].number;
  head.span = points[count - 1].number - points[0].number;
  for (std::size_t a = 0; a < 3; ++a) head.axes[a] = axisOf(points, count, a);
  head.one_place = !fields.viewpoints || sameViewpoints(points, count) ? 1 : 0;
  if (fields.viewpoints) head.seen_from = points[0].seen_from;
  head.write(fields, out);
  BitWriter bits(out);
  const RiceCode numbers(head.span, count);
  for (std::size_t i = 0; i < count; ++i) {
    if (i > 0) numbers.put(points[i].number - points[i - 1].number - 1, bits);
    for (std::size_t a = 0; a < 3; ++a) {
      if (head.axes[a].bits > 0)
        bits.put(stepsOf(head.axes[a], points[i].place[a]), head.axes[a].bits);
    }
    for (std::size_t a = 0; head.one_place == 0 && a < 3; ++a) {
      std::uint32_t raw = 0;
      std::memcpy(&raw, &points[i].seen_from[a], sizeof(raw));
      bits.put(raw, 32);
    }
    if (fields.normals) bits.put(packedNormal(points[i].normal), kNormalBits);
  }
  bits.flush();
}

bool unpackPoints(const std::vector<std::uint8_t>& packet, std::size_t count,
                  const PointFields& fields, std::vector<StoredPoint>& out) {
  if (count == 0) return packet.empty();
  Head head;
  std::size_t at = 0;
  if (!head.read(fields, packet, at)) return false;
  BitReader bits(packet.data() + at, packet.size() - at);
  const RiceCode numbers(head.span, count);
  StoredPoint p;
  p.number = head.number;
  if (fields.viewpoints) p.seen_from = head.seen_from;
  for (std::size_t i = 0; i < count; ++i) {
    if (i > 0) p.number += static_cast<std::uint32_t>(numbers.get(bits)) + 1;
    for (std::size_t a = 0; a < 3; ++a) {
      const Axis& axis = head.axes[a];
      const auto steps = static_cast<double>(bits.get(axis.bits));
      p.place[a] = axis.least + std::ldexp(steps, axis.step);
    }
    for (std::size_t a = 0; head.one_place == 0 && a < 3; ++a) {
      const auto raw = static_cast<std::uint32_t>(bits.get(32));
      std::memcpy(&p.seen_from[a], &raw, sizeof(raw));
    }
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
