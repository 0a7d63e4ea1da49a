// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "tiles/tile_records.h"

#include <algorithm>
#include <utility>

#include "tiles/tile_file.h"

namespace segorient::program {
namespace {

// Records of a block, which has a checksum of its own, so that reading may begin anywhere.
constexpr std::uint64_t kBlock = 2048;

struct RowsHead {
  std::uint64_t count = 0;
  std::uint64_t checksum = 0;
};

std::uint64_t checksumOf(const void* data, std::size_t bytes) {
  Checksum sum;
  sum.add(data, bytes);
  return sum.value();
}

}  // namespace

void saveShare(const ShareFile& share, const std::string& path, std::uint64_t run,
               std::uint32_t tile) {
  TileFileWriter file(path, TileFileKind::SHARE, run, tile);
  file.list(share.piece_sizes);
  file.list(share.piece_signs);
  file.list(share.segment_sizes);
  file.list(share.votes);
  file.list(share.patches);
  file.list(share.viewpoints);
  file.list(share.slices);
  file.commit();
}

ShareFile loadShare(const std::string& path, std::uint64_t run, std::uint32_t tile) {
  TileFileReader file(path, TileFileKind::SHARE, run, tile);
  ShareFile share;
  share.piece_sizes = file.list<std::uint32_t>();
  share.piece_signs = file.list<std::int8_t>();
  share.segment_sizes = file.list<std::uint32_t>();
  share.votes = file.list<TileVote>();
  share.patches = file.list<TilePatch>();
  share.viewpoints = file.list<float>();
  share.slices = file.list<TieSlice>();
  file.end();
  return share;
}

std::vector<TieRecord> loadTies(const std::string& path, std::uint64_t run, std::uint32_t tile,
                                const TieSlice& slice) {
  InputFile file(path);
  requireHeader(file, TileFileKind::TIES, run, tile);
  if (slice.first + slice.count > file.remaining() / sizeof(TieRecord)) file.fail(kDamaged);
  file.skip(slice.first * sizeof(TieRecord));
  std::vector<TieRecord> out(static_cast<std::size_t>(slice.count));
  if (!out.empty()) file.read(out.data(), out.size() * sizeof(TieRecord));
  if (checksumOf(out.data(), out.size() * sizeof(TieRecord)) != slice.checksum) file.fail(kDamaged);
  return out;
}

void saveSigns(const TileSigns& signs, const std::string& path, std::uint64_t run,
               std::uint32_t tile) {
  TileFileWriter file(path, TileFileKind::SIGNS, run, tile);
  file.list(signs.pieces);
  file.list(signs.patches);
  file.list(signs.toward);
  file.commit();
}

TileSigns loadSigns(const std::string& path, std::uint64_t run, std::uint32_t tile) {
  TileFileReader file(path, TileFileKind::SIGNS, run, tile);
  TileSigns signs;
  signs.pieces = file.list<std::int8_t>();
  signs.patches = file.list<std::int8_t>();
  signs.toward = file.list<float>();
  file.end();
  return signs;
}

void saveFinal(const FinalFile& made, const std::string& path, std::uint64_t run,
               std::uint32_t tile) {
  TileFileWriter file(path, TileFileKind::FINAL, run, tile);
  file.value(made.again);
  file.list(made.segment_sizes);
  file.list(made.slices);
  file.commit();
}

FinalFile loadFinal(const std::string& path, std::uint64_t run, std::uint32_t tile) {
  TileFileReader file(path, TileFileKind::FINAL, run, tile);
  FinalFile made;
  made.again = file.value<bool>();
  made.segment_sizes = file.list<std::uint32_t>();
  made.slices = file.list<TieSlice>();
  file.end();
  return made;
}

void saveLabels(const LabelFile& labels, const std::string& path, std::uint64_t run) {
  TileFileWriter file(path, TileFileKind::LABELS, run);
  for (const std::vector<std::uint32_t>& of_tile : labels) file.list(of_tile);
  file.commit();
}

LabelFile loadLabels(const std::string& path, std::uint64_t run, std::size_t tiles) {
  TileFileReader file(path, TileFileKind::LABELS, run);
  LabelFile labels(tiles);
  for (std::vector<std::uint32_t>& of_tile : labels) of_tile = file.list<std::uint32_t>();
  file.end();
  return labels;
}

void saveRows(const std::vector<RowRecord>& rows, const std::string& path, std::uint64_t run,
              std::uint32_t tile) {
  TileFileWriter file(path, TileFileKind::ROWS, run, tile);
  RowsHead head;
  head.count = rows.size();
  head.checksum = checksumOf(&head.count, sizeof(head.count));
  file.value(head);
  for (std::size_t first = 0; first < rows.size(); first += kBlock) {
    const std::size_t bytes =
        std::min<std::size_t>(kBlock, rows.size() - first) * sizeof(RowRecord);
    file.bytes(&rows[first], bytes);
    file.value(checksumOf(&rows[first], bytes));
  }
  file.commitPlain();
}

RowReader::RowReader(std::string path, std::uint64_t run, std::uint32_t tile,
                     std::uint64_t first_row)
    : path_(std::move(path)), run_(run), tile_(tile) {
  InputFile file(path_);
  requireHeader(file, TileFileKind::ROWS, run_, tile_);
  RowsHead head;
  if (file.remaining() < sizeof(head)) file.fail(kDamaged);
  file.read(&head, sizeof(head));
  if (head.checksum != checksumOf(&head.count, sizeof(head.count))) file.fail(kDamaged);
  count_ = head.count;
  // The last block that does not begin behind the row.
  std::uint64_t low = 0;
  std::uint64_t high = (count_ + kBlock - 1) / kBlock;
  while (high - low > 1) {
    const std::uint64_t middle = low + (high - low) / 2;
    load(middle);
    (block_[0].row() <= first_row ? low : high) = middle;
  }
  load(low);
  while (!done() && row().row() < first_row) next();
}

void RowReader::load(std::uint64_t number) {
  block_number_ = number;
  at_ = 0;
  block_.clear();
  const std::uint64_t first = number * kBlock;
  if (first >= count_) return;
  InputFile file(path_);
  const std::uint64_t before = sizeof(TileFileHeader) + sizeof(RowsHead) +
                               number * (kBlock * sizeof(RowRecord) + sizeof(std::uint64_t));
  block_.resize(static_cast<std::size_t>(std::min(kBlock, count_ - first)));
  const std::size_t bytes = block_.size() * sizeof(RowRecord);
  std::uint64_t checksum = 0;
  if (file.remaining() < before + bytes + sizeof(checksum)) file.fail(kDamaged);
  file.seek(before);
  file.read(block_.data(), bytes);
  file.read(&checksum, sizeof(checksum));
  if (checksum != checksumOf(block_.data(), bytes)) file.fail(kDamaged);
}

}  // namespace segorient::program
