// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "io/las_writer.h"

#include "support/command_line.h"

namespace segorient::program {

LasWriter::LasWriter(const OutputCloud& block, const LasSummary& summary, OutputFile& file)
    : layout_(block, summary), file_(file) {
  if (summary.skipped() > 0) {
    warn(file.path() + ": " + std::to_string(summary.skipped()) +
         " points without coordinates, or too far away from the others, are left out: LAS has no "
         "such points");
  }
  const std::vector<std::uint8_t> head = layout_.head();
  file_.write(head.data(), head.size());
}

void LasWriter::add(const OutputCloud& block) {
  constexpr std::size_t kRowsAtOnce = 4096;
  std::vector<std::uint8_t> records(kRowsAtOnce * layout_.recordBytes());
  std::size_t filled = 0;
  for (std::size_t row = 0; row < block.size; ++row) {
    if (!layout_.makeRecord(block, row, records.data() + filled * layout_.recordBytes())) continue;
    if (++filled < kRowsAtOnce) continue;
    file_.write(records.data(), records.size());
    filled = 0;
  }
  file_.write(records.data(), filled * layout_.recordBytes());
}

void LasWriter::end() {
  const std::vector<std::uint8_t> tail = layout_.tail();
  file_.write(tail.data(), tail.size());
}

void writeLas(const OutputCloud& cloud, OutputFile& file) {
  const std::array<const Column*, 3> xyz{cloud.find("x"), cloud.find("y"), cloud.find("z")};
  LasSummary summary(bulkBounds(cloud.size, [&](std::size_t i) {
    return std::array<double, 3>{numberOf(*xyz[0], i), numberOf(*xyz[1], i), numberOf(*xyz[2], i)};
  }));
  summary.add(cloud);
  LasWriter writer(cloud, summary, file);
  writer.add(cloud);
  writer.end();
}

}  // namespace segorient::program
