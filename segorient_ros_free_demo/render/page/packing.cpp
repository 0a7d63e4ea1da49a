// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "render/page/packing.h"

#include <algorithm>
#include <array>

namespace segorient::program {
namespace {

constexpr std::size_t kLengths = 25;   // bits that a number may have: 0 to 24
constexpr unsigned kLongestCode = 12;  // bits; the reader's tables have 4096 entries
constexpr std::size_t kAhead = 4;      // bytes that the reader may look ahead

using Counts = std::array<std::uint64_t, kLengths>;

struct Code {
  std::uint32_t bits = 0;
  unsigned length = 0;  // 0: does not occur
};
using Codes = std::array<Code, kLengths>;

unsigned lengthOf(std::uint32_t number) {
  unsigned length = 0;
  for (; number != 0; number >>= 1) ++length;
  return length;
}

// Differences of either sign as numbers that are small where the difference is.
std::uint32_t folded(std::uint32_t from, std::uint32_t to) {
  const auto difference = static_cast<std::int32_t>(to - from);
  return static_cast<std::uint32_t>(difference) << 1 ^ (difference < 0 ? ~0U : 0U);
}

// Lengths of Huffman's code: the two rarest are joined until one is left.
std::array<unsigned, kLengths> codeLengths(const Counts& counts) {
  std::array<unsigned, kLengths> lengths{};
  struct Tree {
    std::uint64_t count;
    std::vector<std::size_t> leaves;
  };
  std::vector<Tree> trees;
  for (std::size_t i = 0; i < kLengths; ++i) {
    if (counts[i] != 0) trees.push_back({counts[i], {i}});
  }
  if (trees.size() == 1) lengths[trees[0].leaves[0]] = 1;
  while (trees.size() > 1) {
    std::stable_sort(trees.begin(), trees.end(),
                     [](const Tree& a, const Tree& b) { return a.count > b.count; });
    const Tree rarest = std::move(trees.back());
    trees.pop_back();
    Tree& other = trees.back();
    other.count += rarest.count;
    other.leaves.insert(other.leaves.end(), rarest.leaves.begin(), rarest.leaves.end());
    for (const std::size_t leaf : other.leaves) ++lengths[leaf];
  }
  return lengths;
}

// Codes of at most kLongestCode bits, the shorter ones first.
Codes codesOf(Counts counts) {
  std::array<unsigned, kLengths> lengths = codeLengths(counts);
  while (*std::max_element(lengths.begin(), lengths.end()) > kLongestCode) {
    for (std::uint64_t& c : counts) c = (c + 1) / 2;  // evener, and what occurs still does
    lengths = codeLengths(counts);
  }
  Codes codes{};
  std::uint32_t next = 0;
  for (unsigned length = 1; length <= kLongestCode; ++length, next <<= 1) {
    for (std::size_t i = 0; i < kLengths; ++i) {
      if (lengths[i] == length) codes[i] = {next++, length};
    }
  }
  return codes;
}

std::uint64_t bitsOf(const Counts& counts, const Codes& codes) {
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < kLengths; ++i) {
    bits += counts[i] * (codes[i].length + std::max<std::size_t>(i, 1) - 1);
  }
  return bits;
}

// Bits, the highest first, as letters from ( to ~ without < and \: nothing that HTML or JavaScript
// would read as more than a letter, and shorter than base 64.
class Text {
 public:
  void put(std::uint32_t bits, unsigned length) {
    word_ = word_ << length | (bits & ((1ULL << length) - 1));
    held_ += length;
    if (held_ >= 32) {
      held_ -= 32;
      letters(static_cast<std::uint32_t>(word_ >> held_));
    }
  }
  std::string finish() {
    for (std::size_t i = 0; i < kAhead + 4; ++i) put(0, 8);
    return std::move(text_);
  }

 private:
  void letters(std::uint32_t word) {
    std::array<char, 5> five{};
    for (std::size_t c = 5; c-- > 0; word /= 85) {
      auto letter = static_cast<char>('(' + word % 85);
      if (letter >= '<') ++letter;
      if (letter >= '\\') ++letter;
      five[c] = letter;
    }
    text_.append(five.data(), five.size());
  }

  std::string text_;
  std::uint64_t word_ = 0;
  unsigned held_ = 0;
};

// How one column is written.
struct Column {
  bool differences = false;
  Codes codes{};
};

Column columnOf(const std::vector<std::uint32_t>& numbers, std::size_t columns, std::size_t c) {
  Counts plain{};
  Counts differences{};
  std::uint32_t last = 0;
  for (std::size_t at = c; at < numbers.size(); at += columns) {
    ++plain[lengthOf(numbers[at])];
    ++differences[lengthOf(folded(last, numbers[at]))];
    last = numbers[at];
  }
  Column column;
  column.codes = codesOf(plain);
  const Codes codes = codesOf(differences);
  if (bitsOf(differences, codes) < bitsOf(plain, column.codes)) column = {true, codes};
  return column;
}

}  // namespace

std::string packNumbers(const std::vector<std::uint32_t>& numbers, std::size_t columns) {
  Text text;
  std::vector<Column> how;
  for (std::size_t c = 0; c < columns; ++c) {
    how.push_back(columnOf(numbers, columns, c));
    text.put(how[c].differences ? 1 : 0, 1);
    for (const Code& code : how[c].codes) text.put(code.length, 4);
  }
  std::vector<std::uint32_t> last(columns, 0);
  for (std::size_t at = 0; at + columns <= numbers.size(); at += columns) {
    for (std::size_t c = 0; c < columns; ++c) {
      const std::uint32_t number = numbers[at + c];
      const std::uint32_t out = how[c].differences ? folded(last[c], number) : number;
      const unsigned length = lengthOf(out);
      const Code& code = how[c].codes[length];
      text.put(code.bits, code.length);
      if (length > 1) text.put(out, length - 1);  // the highest is 1
      last[c] = number;
    }
  }
  return text.finish();
}

}  // namespace segorient::program
