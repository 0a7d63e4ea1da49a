// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "tiles/row_file.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "tiles/bit_stream.h"
#include "tiles/packed_values.h"

namespace segorient::program {
namespace {

constexpr std::size_t kBlockRows = 2048;

std::uint64_t pairOf(const RowRecord& r) {
  return static_cast<std::uint64_t>(static_cast<std::uint32_t>(r.label)) << 32 |
         static_cast<std::uint32_t>(r.followed);
}

void pack(const RowRecord* rows, std::size_t count, const std::vector<std::uint64_t>& pairs,
          std::vector<std::uint8_t>& out) {
  out.clear();
  BitWriter bits(out);
  const unsigned pair_bits = bitsOf(pairs.size());
  for (std::size_t i = 0; i < count; ++i) {
    const RowRecord& r = rows[i];
    const bool has_normal = std::isfinite(r.normal[0]);
    bits.put(has_normal ? packNormal(r.normal, kNormalBits) : kNoNormal, kNormalBits);
    bits.put(packCurvature(r.normal[3]), kCurvatureBits);
    const auto pair = std::lower_bound(pairs.begin(), pairs.end(), pairOf(r));
    bits.put(static_cast<std::uint64_t>(pair - pairs.begin()), pair_bits);
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

void RowReader::load(std::size_t number) {
  block_ = number;
  at_ = 0;
  rows_.clear();
  if (number >= blocks_.size()) return;
  const std::vector<std::uint8_t> bytes = file_.part(blocks_[number]);
  BitReader bits(bytes.data(), bytes.size());
  const auto count = std::min<std::uint64_t>(kBlockRows, count_ - number * kBlockRows);
  const unsigned pair_bits = bitsOf(pairs_.size());
  RowRecord r;
  for (std::uint64_t i = 0; i < count; ++i) {
    const std::uint64_t normal = bits.get(kNormalBits);
    const auto curvature = static_cast<std::uint32_t>(bits.get(kCurvatureBits));
    if (normal == kNoNormal) {
      std::fill_n(r.normal, 4, std::numeric_limits<float>::quiet_NaN());
    } else {
      unpackNormal(static_cast<std::uint32_t>(normal), kNormalBits, r.normal);
      r.normal[3] = unpackCurvature(curvature);
    }
    const auto pair = static_cast<std::size_t>(bits.get(pair_bits));
    if (pair >= pairs_.size()) file_.fail();
    r.label = static_cast<std::int32_t>(pairs_[pair] >> 32);
    r.followed = static_cast<std::int32_t>(pairs_[pair] & 0xffffffffU);
    rows_.push_back(r);
  }
}

}  // namespace segorient::program
