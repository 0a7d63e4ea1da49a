// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

namespace segorient::program {

/// Cuts the next word off the front of `line`; empty at its end.
std::string_view nextWord(std::string_view& line, std::string_view separators = " \t\v\f\r");

/// The whole word as a number ("nan" and "inf" are numbers); false if it is none.
bool parseNumber(std::string_view word, double& out);
bool parseNumber(std::string_view word, std::uint64_t& out);

/// What parts numbers in text files that are not of one format.
constexpr std::string_view kTextSeparators = " \t\v\f\r,;";

/// All words of a line as numbers; false if one is none.
bool parseNumbers(std::string_view line, std::vector<double>& out);

/// The whole word as an element of the given type (see Field), written to `out`; false if it is no
/// number or does not fit.
bool storeNumber(std::string_view word, char type, std::uint32_t size, std::uint8_t* out);

}  // namespace segorient::program
