// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "tiles/place_order.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "common/compiler.h"

namespace segorient::program {
namespace {

// Powers of two as factors, and their inverses, are doubles down to there; smaller steps are not
// looked at.
constexpr int kLeastStep = -1000;

// The exponent of the last bit that is set; above all for 0.
int lastBit(double x) {
  std::uint64_t bits = 0;
  std::memcpy(&bits, &x, sizeof(bits));
  const auto exponent = static_cast<int>(bits >> 52U & 0x7ffU);
  std::uint64_t digits = bits & ((std::uint64_t{1} << 52U) - 1);
  if (exponent > 0) digits |= std::uint64_t{1} << 52U;
  if (digits == 0) return std::numeric_limits<int>::max();
  const auto low = static_cast<std::uint32_t>(digits);
  const unsigned zeros =
      low != 0 ? lowestBit(low) : 32U + lowestBit(static_cast<std::uint32_t>(digits >> 32U));
  return std::max(exponent, 1) - 1075 + static_cast<int>(zeros);
}

// A number from 0 to `most` in as few whole bits as there is room for: those in the middle, which
// are the likeliest where points are anywhere, may take one less.
class CountCode {
 public:
  explicit CountCode(std::uint64_t most)
      : values_(most + 1),
        bits_(bitsOf(values_) - 1),
        short_((std::uint64_t{2} << bits_) - values_),
        start_((values_ - short_) / 2) {}

  void put(std::uint64_t number, BitWriter& out) const {
    const std::uint64_t v = number >= start_ ? number - start_ : number + values_ - start_;
    if (v < short_) {
      out.put(v, bits_);
    } else {
      out.put((v + short_) >> 1U, bits_);
      out.put((v + short_) & 1U, 1);
    }
  }
  std::uint64_t get(BitReader& in) const {
    std::uint64_t v = in.get(bits_);
    if (v >= short_) v = (v << 1U | in.get(1)) - short_;
    v += start_;
    return v >= values_ ? v - values_ : v;
  }

 private:
  std::uint64_t values_;
  unsigned bits_;
  std::uint64_t short_;  // how many of them take bits_, the others one more
  std::uint64_t start_;  // the least of those
};

using Bits = std::array<std::uint8_t, 3>;

std::size_t widest(const Bits& bits) {
  return static_cast<std::size_t>(std::max_element(bits.begin(), bits.end()) - bits.begin());
}

// Reads boxes as PlaceOrder::split() writes them.
struct BoxReader {
  std::array<double, 3> least;
  std::array<double, 3> step;
  BitReader& in;
  std::vector<PlaceOrder::Place>& out;

  // \param low of the box, in steps
  void read(std::uint64_t count, std::array<std::uint64_t, 3> low, Bits bits) {
    while (count > 1) {
      const std::size_t axis = widest(bits);
      if (bits[axis] == 0) break;
      --bits[axis];
      const std::uint64_t lower = CountCode(count).get(in);
      if (lower == count) continue;
      std::array<std::uint64_t, 3> upper = low;
      upper[axis] |= std::uint64_t{1} << bits[axis];
      if (lower > 0) read(lower, low, bits);
      low = upper;
      count -= lower;
    }
    for (std::size_t a = 0; a < 3 && count == 1; ++a) low[a] |= in.get(bits[a]);
    PlaceOrder::Place place{};
    for (std::size_t a = 0; a < 3; ++a) place[a] = least[a] + static_cast<double>(low[a]) * step[a];
    out.insert(out.end(), static_cast<std::size_t>(count), place);
  }
};

}  // namespace

bool PlaceOrder::isValid(const std::array<PlaceAxis, 3>& axes) {
  return std::all_of(axes.begin(), axes.end(), [](const PlaceAxis& axis) {
    return std::isfinite(axis.least) && axis.bits <= kMostBits + 1 && axis.step >= kLeastStep &&
           axis.step <= std::numeric_limits<double>::max_exponent;
  });
}

void PlaceOrder::findAxes() {
  for (std::size_t a = 0; a < 3; ++a) {
    PlaceAxis& axis = axes_[a];
    axis = PlaceAxis();
    axis.least = places_.empty() ? 0.0 : places_[0].place[a];
    double most = axis.least;
    int exact = std::numeric_limits<int>::max();
    for (const Entry& e : places_) {
      axis.least = std::min(axis.least, e.place[a]);
      most = std::max(most, e.place[a]);
      exact = std::min(exact, lastBit(e.place[a]));
    }
    const double extent = most - axis.least;
    if (!(extent > 0.0) || !std::isfinite(extent)) {
      for (Entry& e : places_) e.steps[a] = 0;
      continue;
    }
    int exponent = 0;
    std::frexp(extent, &exponent);
    const int step = std::max({exact, exponent - kMostBits, kLeastStep});
    axis.step = static_cast<std::int16_t>(step);
    const double factor = std::ldexp(1.0, -step);
    const auto steps = [&](double x) {
      return static_cast<std::uint64_t>((x - axis.least) * factor + 0.5);
    };
    axis.bits = static_cast<std::uint8_t>(bitsOf(steps(most)));
    for (Entry& e : places_) e.steps[a] = steps(e.place[a]);
  }
}

void PlaceOrder::order(BitWriter* out) {
  findAxes();
  if (!places_.empty())
    split(0, places_.size(), {axes_[0].bits, axes_[1].bits, axes_[2].bits}, out);
}

void PlaceOrder::split(std::size_t first, std::size_t last, Bits bits, BitWriter* out) {
  while (last - first > 1) {
    const std::size_t axis = widest(bits);
    if (bits[axis] == 0) break;
    const std::uint64_t bit = std::uint64_t{1} << --bits[axis];
    const auto begin = places_.begin();
    const auto middle = std::partition(begin + static_cast<std::ptrdiff_t>(first),
                                       begin + static_cast<std::ptrdiff_t>(last),
                                       [&](const Entry& e) { return (e.steps[axis] & bit) == 0; });
    const auto half = static_cast<std::size_t>(middle - begin);
    if (out != nullptr) CountCode(last - first).put(half - first, *out);
    if (half == last) continue;
    if (half > first) split(first, half, bits, out);
    first = half;
  }
  if (last - first > 1) {  // all in one place
    std::sort(places_.begin() + static_cast<std::ptrdiff_t>(first),
              places_.begin() + static_cast<std::ptrdiff_t>(last),
              [](const Entry& p, const Entry& q) { return p.number < q.number; });
  } else if (out != nullptr) {
    for (std::size_t a = 0; a < 3; ++a) {
      out->put(places_[first].steps[a] & ((std::uint64_t{1} << bits[a]) - 1), bits[a]);
    }
  }
}

void PlaceOrder::read(const std::array<PlaceAxis, 3>& axes, std::size_t count, BitReader& in,
                      std::vector<Place>& out) {
  if (count == 0) return;
  BoxReader reader{{}, {}, in, out};
  for (std::size_t a = 0; a < 3; ++a) {
    reader.least[a] = axes[a].least;
    reader.step[a] = std::ldexp(1.0, axes[a].step);
  }
  reader.read(count, {0, 0, 0}, {axes[0].bits, axes[1].bits, axes[2].bits});
}

}  // namespace segorient::program
