// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace segorient::program {

constexpr std::uint32_t kPackedEnd = 1U << 23;

/// Rows of whole numbers as text that HTML takes as it is; unpack() of cloud.js reads it.
///
/// Of each column either the numbers or their differences from the row before, whichever is
/// shorter: how many bits one has by a Huffman code of the column's own, then those bits. So it is
/// short where rows that follow each other are alike, and is read in one pass, from the beginning
/// as far as is wanted. Four bytes are five letters.
///
/// \param numbers row after row, each of `columns` numbers, all below kPackedEnd
std::string packNumbers(const std::vector<std::uint32_t>& numbers, std::size_t columns);

}  // namespace segorient::program
