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

RiceCode stepsOf(const RowBlock& block) {
  return RiceCode(block.last_row - block.first_row, static_cast<std::size_t>(block.count));
}

void pack(const RowRecord* rows, const RowBlock& block, const std::vector<std::uint64_t>& pairs,
          std::vector<std::uint8_t>& out) {
  out.clear();
  BitWriter bits(out);
  const RiceCode steps = stepsOf(block);
  const unsigned pair_bits = bitsOf(pairs.size());
  for (std::size_t i = 0; i < block.count; ++i) {
    const RowRecord& r = rows[i];
    if (i > 0) steps.put(r.row - rows[i - 1].row - 1, bits);
    const bool has_normal = std::isfinite(r.normal[0]);
    bits.put(has_normal ? packNormal(r.normal, kNormalBits) : kNoNormal, kNormalBits);
    bits.put(packCurvature(r.normal[3]), kCurvatureBits);
    const auto pair = std::lower_bound(pairs.begin(), pairs.end(), pairOf(r));
    bits.put(static_cast<std::uint64_t>(pair - pairs.begin()), pair_bits);
  }
  bits.flush();
}

}  // namespace

void saveRows(const std::vector<RowRecord>& rows, const std::string& path, std::uint64_t run,
              std::uint32_t tile) {
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
  std::vector<RowBlock> blocks;
  std::vector<std::uint8_t> bytes;
  for (std::size_t first = 0; first < rows.size(); first += kBlockRows) {
    RowBlock block;
    block.count = std::min(kBlockRows, rows.size() - first);
    block.first_row = rows[first].row;
    block.last_row = rows[first + static_cast<std::size_t>(block.count) - 1].row;
    pack(&rows[first], block, pairs, bytes);
    block.part = file.add(bytes);
    blocks.push_back(block);
  }
  ListWriter lists;
  lists.list(pairs);
  lists.list(blocks);
  file.commit(lists);
}

RowReader::RowReader(const std::string& path, std::uint64_t run, std::uint32_t tile,
                     std::uint64_t first_row)
    : file_(path, TileFileKind::ROWS, run, tile),
      pairs_(file_.list<std::uint64_t>()),
      blocks_(file_.list<RowBlock>()) {
  const auto block = std::find_if(blocks_.begin(), blocks_.end(),
                                  [&](const RowBlock& b) { return b.last_row >= first_row; });
  load(static_cast<std::size_t>(block - blocks_.begin()));
  while (!done() && row().row < first_row) next();
}

void RowReader::load(std::size_t number) {
  block_ = number;
  at_ = 0;
  rows_.clear();
  if (number >= blocks_.size()) return;
  const RowBlock& block = blocks_[number];
  if (block.count > kBlockRows || block.last_row < block.first_row) file_.fail();
  const std::vector<std::uint8_t> bytes = file_.part(block.part);
  BitReader bits(bytes.data(), bytes.size());
  const RiceCode steps = stepsOf(block);
  const unsigned pair_bits = bitsOf(pairs_.size());
  RowRecord r;
  r.row = block.first_row;
  for (std::size_t i = 0; i < block.count; ++i) {
    if (i > 0) r.row += steps.get(bits) + 1;
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
