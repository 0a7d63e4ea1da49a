// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <array>
#include <cstdint>

namespace segorient::program {

constexpr int kLetterWidth = 5;
constexpr int kLetterHeight = 7;

/// A letter as rows of five bits, from the top, the highest bit at the left: digits, capitals and
/// what numbers need. Small letters are drawn as capitals, everything else as a blank.
std::array<std::uint8_t, kLetterHeight> letterRows(char letter);

}  // namespace segorient::program
