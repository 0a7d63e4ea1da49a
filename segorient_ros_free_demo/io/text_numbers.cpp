// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "io/text_numbers.h"

#include <charconv>
#include <cmath>
#include <cstring>
#include <limits>

namespace segorient::program {
namespace {

template <typename T>
bool parse(std::string_view word, T& out) {
  if (word.size() > 1 && word.front() == '+') word.remove_prefix(1);
  const char* end = word.data() + word.size();
  const auto result = std::from_chars(word.data(), end, out);
  return result.ec == std::errc() && result.ptr == end;
}

template <typename T>
bool store(T value, std::uint8_t* out) {
  std::memcpy(out, &value, sizeof(T));
  return true;
}

// Integers may be written as "3.0"; they must fit.
template <typename T>
bool storeInteger(std::string_view word, std::uint8_t* out) {
  T value = 0;
  if (parse(word, value)) return store(value, out);
  double real = 0.0;
  if (!parse(word, real) || real != std::floor(real)) return false;
  // The upper limit as a double may be one above the largest value.
  if (real < static_cast<double>(std::numeric_limits<T>::lowest()) ||
      real >= std::ldexp(1.0, std::numeric_limits<T>::digits)) {
    return false;
  }
  return store(static_cast<T>(real), out);
}

}  // namespace

std::string_view nextWord(std::string_view& line, std::string_view separators) {
  const std::size_t first = line.find_first_not_of(separators);
  if (first == std::string_view::npos) {
    line = {};
    return {};
  }
  line.remove_prefix(first);
  const std::size_t end = std::min(line.find_first_of(separators), line.size());
  const std::string_view word = line.substr(0, end);
  line.remove_prefix(end);
  return word;
}

bool parseNumber(std::string_view word, double& out) {
  if (parse(word, out)) return true;
  // from_chars leaves what is out of range to the caller; such numbers are tiny or huge, not wrong.
  std::string_view rest = word;
  if (!rest.empty() && (rest.front() == '+' || rest.front() == '-')) rest.remove_prefix(1);
  double ignored = 0.0;
  const auto result = std::from_chars(rest.data(), rest.data() + rest.size(), ignored);
  if (result.ec != std::errc::result_out_of_range || result.ptr != rest.data() + rest.size()) {
    return false;
  }
  const bool tiny =
      rest.find("e-") != std::string_view::npos || rest.find("E-") != std::string_view::npos;
  out = tiny ? 0.0 : std::numeric_limits<double>::infinity();
  if (word.front() == '-') out = -out;
  return true;
}

bool parseNumber(std::string_view word, std::uint64_t& out) {
  return parse(word, out);
}

bool parseNumbers(std::string_view line, std::vector<double>& out) {
  out.clear();
  for (auto word = nextWord(line, kTextSeparators); !word.empty();
       word = nextWord(line, kTextSeparators)) {
    double v = 0.0;
    if (!parseNumber(word, v)) return false;
    out.push_back(v);
  }
  return true;
}

bool storeNumber(std::string_view word, char type, std::uint32_t size, std::uint8_t* out) {
  if (type == 'F') {
    double value = 0.0;
    if (!parseNumber(word, value)) return false;
    return size == 8 ? store(value, out) : store(static_cast<float>(value), out);
  }
  const bool is_signed = type == 'I';
  switch (size) {
    case 1:
      return is_signed ? storeInteger<std::int8_t>(word, out)
                       : storeInteger<std::uint8_t>(word, out);
    case 2:
      return is_signed ? storeInteger<std::int16_t>(word, out)
                       : storeInteger<std::uint16_t>(word, out);
    case 4:
      return is_signed ? storeInteger<std::int32_t>(word, out)
                       : storeInteger<std::uint32_t>(word, out);
    default:
      return is_signed ? storeInteger<std::int64_t>(word, out)
                       : storeInteger<std::uint64_t>(word, out);
  }
}

}  // namespace segorient::program
