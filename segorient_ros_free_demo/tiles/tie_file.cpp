// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "tiles/tie_file.h"

#include <algorithm>
#include <cmath>

#include "tiles/bit_stream.h"
#include "tiles/packed_values.h"

namespace segorient::program {
namespace {

// To a degree: two normals of a point are compared by their cosine.
constexpr unsigned kTieNormalBits = 16;

// Bits of the numbers of pieces and of labels, 0 standing for none.
struct Widths {
  std::uint8_t piece = 0;
  std::uint8_t label = 0;
};

const TileTie& tieOf(const std::vector<TileTie>& ties, std::uint32_t row) {
  static const TileTie kNone;
  const auto at = std::lower_bound(ties.begin(), ties.end(), row,
                                   [](const TileTie& t, std::uint32_t r) { return t.row < r; });
  return at != ties.end() && at->row == row ? *at : kNone;
}

void pack(const SharedPoints& shared, const std::vector<TileTie>& ties,
          std::vector<std::uint8_t>& out) {
  std::uint64_t most_piece = 0;
  std::uint64_t most_label = 0;
  for (const std::uint32_t row : shared.points) {
    const TileTie& tie = tieOf(ties, row);
    most_piece = std::max<std::uint64_t>(most_piece, static_cast<std::uint64_t>(tie.piece + 1));
    most_label = std::max<std::uint64_t>(most_label, static_cast<std::uint64_t>(tie.label + 1));
  }
  const Widths widths{static_cast<std::uint8_t>(bitsOf(most_piece)),
                      static_cast<std::uint8_t>(bitsOf(most_label))};
  out.assign({widths.piece, widths.label});
  BitWriter bits(out);
  TileTie last;
  for (const std::uint32_t row : shared.points) {
    const TileTie& tie = tieOf(ties, row);
    const bool same = tie.piece == last.piece && tie.label == last.label;
    bits.put(same ? 1 : 0, 1);
    if (!same) {
      bits.put(static_cast<std::uint64_t>(tie.piece + 1), widths.piece);
      bits.put(static_cast<std::uint64_t>(tie.label + 1), widths.label);
    }
    last = tie;
    if (tie.piece >= 0) bits.put(packNormal(tie.normal, kTieNormalBits), kTieNormalBits);
  }
  bits.flush();
}

}  // namespace

void saveTies(const std::vector<SharedPoints>& shared, const TileShare& share,
              const std::string& path, std::uint64_t run, std::uint32_t tile) {
  PartsWriter file(path, TileFileKind::TIES, run, tile);
  std::vector<TieSlice> slices;
  std::vector<std::uint8_t> bytes;
  for (const SharedPoints& s : shared) {
    pack(s, share.ties, bytes);
    slices.push_back({s.other, s.owner, s.points.size(), file.add(bytes)});
  }
  ListWriter lists;
  lists.list(slices);
  lists.list(share.segment_sizes);
  lists.list(share.segment_borders);
  file.commit(lists);
}

TieReader::TieReader(const std::string& path, std::uint64_t run, std::uint32_t tile)
    : file_(path, TileFileKind::TIES, run, tile),
      slices_(file_.list<TieSlice>()),
      segment_sizes_(file_.list<std::uint32_t>()),
      segment_borders_(file_.list<LabelBorder>()) {
  const auto count = static_cast<std::int32_t>(segment_sizes_.size());
  for (const LabelBorder& b : segment_borders_) {
    if (b.a < 0 || b.a >= b.b || b.b >= count) fail();
  }
}

std::vector<TileTie> TieReader::about(std::uint32_t other, std::uint32_t owner) const {
  const auto slice = std::find_if(slices_.begin(), slices_.end(), [&](const TieSlice& s) {
    return s.other == other && s.owner == owner;
  });
  std::vector<TileTie> out;
  if (slice == slices_.end()) return out;
  const std::vector<std::uint8_t> bytes = file_.part(slice->part);
  if (bytes.size() < 2 || bytes[0] > 32 || bytes[1] > 32) fail();
  const Widths widths{bytes[0], bytes[1]};
  BitReader bits(bytes.data() + 2, bytes.size() - 2);
  out.resize(static_cast<std::size_t>(slice->count));
  TileTie last;
  for (TileTie& tie : out) {
    if (bits.get(1) == 0) {
      last.piece = static_cast<std::int32_t>(bits.get(widths.piece)) - 1;
      last.label = static_cast<std::int32_t>(bits.get(widths.label)) - 1;
    }
    tie.piece = last.piece;
    tie.label = last.label;
    if (tie.piece < 0) continue;
    unpackNormal(static_cast<std::uint32_t>(bits.get(kTieNormalBits)), kTieNormalBits, tie.normal);
  }
  return out;
}

}  // namespace segorient::program
