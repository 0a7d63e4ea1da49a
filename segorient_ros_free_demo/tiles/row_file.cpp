// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "tiles/row_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "tiles/bit_stream.h"
#include "tiles/packed_values.h"

namespace segorient::program {
namespace {

constexpr std::size_t kBlockRows = 2048;
constexpr unsigned kHalf = kNormalBits / 2;

std::uint64_t pairOf(const RowRecord& r) {
  return static_cast<std::uint64_t>(static_cast<std::uint32_t>(r.label)) << 32 |
         static_cast<std::uint32_t>(r.followed);
}

// The numbers of a row, and by how many bits each goes on from 0 again: two of the normal, one of
// the curvature.
using Numbers = std::array<std::uint32_t, 3>;
constexpr std::array<unsigned, 3> kBits{kHalf, kHalf, kCurvatureBits};

Numbers numbersOf(const RowRecord& r) {
  const bool has_normal = std::isfinite(r.normal[0]);
  const auto normal =
      static_cast<std::uint32_t>(has_normal ? packNormal(r.normal, kNormalBits) : kNoNormal);
  return {normal & ((1U << kHalf) - 1U), normal >> kHalf, packCurvature(r.normal[3])};
}

void setNumbers(const Numbers& numbers, RowRecord& r) {
  const std::uint32_t normal = numbers[0] | numbers[1] << kHalf;
  if (normal == kNoNormal) {
    std::fill_n(r.normal, 4, std::numeric_limits<float>::quiet_NaN());
  } else {
    unpackNormal(normal, kNormalBits, r.normal);
    r.normal[3] = unpackCurvature(numbers[2]);
  }
}

// What is added to a number of so many bits, modulo these, to get another one; the sign folded.
std::uint32_t stepOf(std::uint32_t from, std::uint32_t to, unsigned bits) {
  const std::uint32_t step = (to - from) & ((1U << bits) - 1U);
  const auto whole = static_cast<std::int32_t>(1U << bits);
  const auto up = static_cast<std::int32_t>(step);
  return foldSign(2 * up < whole ? up : up - whole);
}

std::uint32_t stepFrom(std::uint32_t from, std::uint32_t folded, unsigned bits) {
  return (from + static_cast<std::uint32_t>(unfoldSign(folded))) & ((1U << bits) - 1U);
}

// Rows lie side by side, so each is told by how it differs from the last one of the same pair.
void pack(const RowRecord* rows, std::size_t count, const std::vector<std::uint64_t>& pairs,
          std::vector<std::uint8_t>& out) {
  std::vector<std::uint32_t> here;  // the block's pairs, as they come
  std::vector<Numbers> last;        // of each of them
  std::vector<std::uint32_t> pair_of(count);
  std::array<std::vector<std::uint32_t>, 3> steps;
  for (std::size_t i = 0; i < count; ++i) {
    const auto pair = static_cast<std::uint32_t>(
        std::lower_bound(pairs.begin(), pairs.end(), pairOf(rows[i])) - pairs.begin());
    const auto at =
        static_cast<std::size_t>(std::find(here.begin(), here.end(), pair) - here.begin());
    if (at == here.size()) {
      here.push_back(pair);
      last.push_back(last.empty() ? Numbers{} : last.back());
    }
    pair_of[i] = static_cast<std::uint32_t>(at);
    const Numbers numbers = numbersOf(rows[i]);
    for (std::size_t a = 0; a < 3; ++a) {
      steps[a].push_back(stepOf(last[at][a], numbers[a], kBits[a]));
    }
    last[at] = numbers;
  }
  out.clear();
  BitWriter bits(out);
  bits.put(here.size(), 16);
  for (const std::uint32_t pair : here) bits.put(pair, bitsOf(pairs.size()));
  std::array<GolombCode, 3> codes;
  for (std::size_t a = 0; a < 3; ++a) {
    codes[a] = GolombCode::best(steps[a], kBits[a]);
    bits.put(codes[a].bits(), 4);
  }
  const unsigned pair_bits = bitsOf(here.size() - 1);
  for (std::size_t i = 0; i < count; ++i) {
    const bool same = i > 0 && pair_of[i] == pair_of[i - 1];
    if (pair_bits > 0) bits.put(same ? 1 : 0, 1);
    if (!same) bits.put(pair_of[i], pair_bits);
    for (std::size_t a = 0; a < 3; ++a) codes[a].put(steps[a][i], bits);
  }
  bits.flush();
}

}  // namespace

void saveRows(const std::vector<RowRecord>& rows, const std::vector<OutputStart>& starts,
              const std::string& path, std::uint64_t run, std::uint32_t tile) {
  std::vector<std::uint64_t> pairs;
  for (const RowRecord& r : rows) {
    if (pairs.empty() || pairs.back() != pairOf(r)) pairs.push_back(pairOf(r));
    if (pairs.size() < pairs.capacity()) continue;
    std::sort(pairs.begin(), pairs.end());
    pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
    pairs.reserve(2 * pairs.size() + kBlockRows);
  }
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  PartsWriter file(path, TileFileKind::ROWS, run, tile);
  std::vector<FilePart> blocks;
  std::vector<std::uint8_t> bytes;
  for (std::size_t first = 0; first < rows.size(); first += kBlockRows) {
    pack(&rows[first], std::min(kBlockRows, rows.size() - first), pairs, bytes);
    blocks.push_back(file.add(bytes));
  }
  ListWriter lists;
  lists.list(pairs);
  lists.list(blocks);
  lists.list(starts);
  lists.list(std::vector<std::uint64_t>{rows.size()});
  file.commit(lists);
}

RowReader::RowReader(const std::string& path, std::uint64_t run, std::uint32_t tile,
                     std::uint32_t output)
    : file_(path, TileFileKind::ROWS, run, tile),
      pairs_(file_.list<std::uint64_t>()),
      blocks_(file_.list<FilePart>()) {
  const auto starts = file_.list<OutputStart>();
  const auto count = file_.list<std::uint64_t>();
  if (count.size() != 1 || blocks_.size() != (count[0] + kBlockRows - 1) / kBlockRows) file_.fail();
  count_ = count[0];
  const auto start = std::find_if(starts.begin(), starts.end(),
                                  [&](const OutputStart& s) { return s.output == output; });
  if (start == starts.end()) return;
  load(static_cast<std::size_t>(start->number / kBlockRows));
  at_ = static_cast<std::size_t>(start->number % kBlockRows);
}

void RowReader::skip(std::uint64_t rows) {
  const std::uint64_t to = block_ * kBlockRows + at_ + rows;
  if (to / kBlockRows != block_) load(static_cast<std::size_t>(to / kBlockRows));
  at_ = static_cast<std::size_t>(to % kBlockRows);
}

void RowReader::load(std::size_t number) {
  block_ = number;
  at_ = 0;
  rows_.clear();
  if (number >= blocks_.size()) return;
  const std::vector<std::uint8_t> bytes = file_.part(blocks_[number]);
  BitReader bits(bytes.data(), bytes.size());
  const auto count = std::min<std::uint64_t>(kBlockRows, count_ - number * kBlockRows);
  std::vector<std::uint64_t> here(static_cast<std::size_t>(bits.get(16)));
  if (here.empty() || here.size() > kBlockRows) file_.fail();
  for (std::uint64_t& pair : here) {
    const auto at = static_cast<std::size_t>(bits.get(bitsOf(pairs_.size())));
    if (at >= pairs_.size()) file_.fail();
    pair = pairs_[at];
  }
  std::array<GolombCode, 3> codes;
  for (GolombCode& code : codes) code = GolombCode(static_cast<unsigned>(bits.get(4)));
  const unsigned pair_bits = bitsOf(here.size() - 1);
  std::vector<Numbers> last(here.size());
  std::size_t known = 0;  // pairs that were there
  std::size_t at = 0;
  RowRecord r;
  for (std::uint64_t i = 0; i < count; ++i) {
    const bool same = i > 0 && (pair_bits == 0 || bits.get(1) != 0);
    if (i == 0 && pair_bits > 0) bits.get(1);
    if (!same) at = static_cast<std::size_t>(bits.get(pair_bits));
    if (at > known || at >= here.size()) file_.fail();
    if (at == known) {
      last[at] = known == 0 ? Numbers{} : last[known - 1];
      ++known;
    }
    for (std::size_t a = 0; a < 3; ++a) {
      last[at][a] = stepFrom(last[at][a], codes[a].get(bits), kBits[a]);
    }
    setNumbers(last[at], r);
    r.label = static_cast<std::int32_t>(here[at] >> 32);
    r.followed = static_cast<std::int32_t>(here[at] & 0xffffffffU);
    rows_.push_back(r);
  }
}

}  // namespace segorient::program
