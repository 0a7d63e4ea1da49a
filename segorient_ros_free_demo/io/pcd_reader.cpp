// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>

#include "io/cloud_stream.h"
#include "io/readers.h"
#include "io/text_numbers.h"

namespace segorient::program {
namespace {

constexpr std::uint64_t kMostElements = 1
                                        << 16;  // of one field; the largest features have thousands

// The header's columns, with the padding that is not kept.
struct PcdHeader {
  std::vector<Field> columns;
  std::size_t row_bytes = 0;
  std::optional<std::uint64_t> width;
  std::optional<std::uint64_t> height;
  std::optional<std::uint64_t> points;
  std::array<double, 7> viewpoint{0, 0, 0, 1, 0, 0, 0};
  std::string data;
};

bool isPadding(const Field& f) {
  return f.name == "_";
}

std::vector<std::string_view> words(std::string_view line) {
  std::vector<std::string_view> out;
  for (auto word = nextWord(line); !word.empty(); word = nextWord(line)) out.push_back(word);
  return out;
}

std::uint64_t wholeNumber(const InputFile& file, std::string_view word) {
  std::uint64_t value = 0;
  if (!parseNumber(word, value)) file.failLine("'" + std::string(word) + "' is not a whole number");
  return value;
}

void readViewpoint(const InputFile& file, const std::vector<std::string_view>& values,
                   PcdHeader& header) {
  if (values.size() != 7) file.failLine("VIEWPOINT needs 7 numbers");
  for (std::size_t i = 0; i < 7; ++i) {
    if (!parseNumber(values[i], header.viewpoint[i])) file.failLine("VIEWPOINT is no number");
  }
  // A place that is nowhere is unknown, as 0 is.
  const auto& v = header.viewpoint;
  if (!std::all_of(v.begin(), v.end(), [](double x) { return std::isfinite(x); })) {
    header.viewpoint = PcdHeader().viewpoint;
  }
}

// SIZE, TYPE and COUNT have one word a field.
void readColumnLine(const InputFile& file, const std::string& key,
                    const std::vector<std::string_view>& values, PcdHeader& header) {
  if (values.size() != header.columns.size()) {
    file.failLine(key + " does not have one entry for each of FIELDS");
  }
  for (std::size_t i = 0; i < values.size(); ++i) {
    Field& f = header.columns[i];
    if (key == "TYPE") {
      f.type = values[i].front();
      continue;
    }
    const std::uint64_t value = wholeNumber(file, values[i]);
    if (value == 0 || value > kMostElements) file.failLine(key + " is out of range");
    (key == "SIZE" ? f.size : f.count) = static_cast<std::uint32_t>(value);
  }
}

void checkColumns(const InputFile& file, PcdHeader& header) {
  if (header.columns.empty()) file.fail("has no FIELDS");
  for (Field& f : header.columns) {
    const bool size_ok = f.size == 1 || f.size == 2 || f.size == 4 || f.size == 8;
    const bool type_ok = f.type == 'I' || f.type == 'U' || (f.type == 'F' && f.size >= 4);
    if (!isPadding(f) && (!size_ok || !type_ok)) {
      file.fail("field " + f.name + " is of no known type: " + f.type + std::to_string(f.size));
    }
    f.offset = header.row_bytes;
    header.row_bytes += f.bytes();
  }
}

bool isHeaderKey(const std::string& key) {
  static const std::array<const char*, 9> kKeys{"FIELDS", "COLUMNS", "SIZE",      "TYPE",  "COUNT",
                                                "WIDTH",  "HEIGHT",  "VIEWPOINT", "POINTS"};
  return key == "DATA" || std::find(kKeys.begin(), kKeys.end(), key) != kKeys.end();
}

PcdHeader readHeader(InputFile& file) {
  PcdHeader header;
  std::string_view line;
  while (header.data.empty()) {
    if (!file.line(line)) file.fail("is cut short: its header has no DATA line");
    std::vector<std::string_view> values = words(line);
    if (values.empty() || values.front().front() == '#') continue;
    const std::string key(values.front());
    values.erase(values.begin());
    if (key == "VERSION") continue;
    if (!isHeaderKey(key)) file.failLine("is not of a PCD header");
    if (values.empty()) file.failLine(key + " has no value");
    if (key == "FIELDS" || key == "COLUMNS") {
      for (const auto& name : values) header.columns.push_back({pclName(std::string(name))});
    } else if (key == "SIZE" || key == "TYPE" || key == "COUNT") {
      readColumnLine(file, key, values, header);
    } else if (key == "WIDTH") {
      header.width = wholeNumber(file, values[0]);
    } else if (key == "HEIGHT") {
      header.height = wholeNumber(file, values[0]);
    } else if (key == "POINTS") {
      header.points = wholeNumber(file, values[0]);
    } else if (key == "VIEWPOINT") {
      readViewpoint(file, values, header);
    } else {
      header.data = std::string(values[0]);
    }
  }
  checkColumns(file, header);
  return header;
}

std::uint64_t numberOfPoints(const InputFile& file, PcdHeader& header) {
  if (!header.points && !header.width) file.fail("has neither POINTS nor WIDTH");
  const std::uint64_t width = header.width.value_or(header.points.value_or(0));
  const std::uint64_t height = header.height.value_or(1);
  if (height != 0 && width > std::numeric_limits<std::uint64_t>::max() / height) {
    file.fail("WIDTH times HEIGHT is out of range");
  }
  const std::uint64_t points = header.points.value_or(width * height);
  if (points != width * height) file.fail("POINTS is not WIDTH times HEIGHT");
  header.width = width;
  header.height = height;
  return points;
}

// Copies rows as they are in the file into the table's rows, without the padding.
void copyRows(const PcdHeader& header, const std::uint8_t* from, std::size_t first,
              std::size_t count, CloudTable& table) {
  for (std::size_t i = 0; i < count; ++i) {
    std::size_t f = 0;
    for (const Field& column : header.columns) {
      if (isPadding(column)) continue;
      const Field& field = table.fields[f++];
      std::memcpy(table.at(field, first + i), from + i * header.row_bytes + column.offset,
                  field.bytes());
    }
  }
}

void readBinary(InputFile& file, const PcdHeader& header, CloudTable& table) {
  if (header.row_bytes == table.row_bytes) {
    file.read(table.rows.data(), table.rows.size());
    return;
  }
  const std::size_t step = std::max<std::size_t>(1, (std::size_t{1} << 18) / header.row_bytes);
  std::vector<std::uint8_t> chunk(step * header.row_bytes);
  for (std::size_t first = 0; first < table.size; first += step) {
    const std::size_t count = std::min(step, table.size - first);
    file.read(chunk.data(), count * header.row_bytes);
    copyRows(header, chunk.data(), first, count, table);
  }
}

// Unpacks LZF: runs of literal bytes, and copies of what was unpacked up to 8 KB before. PCL's own
// crashes on empty data. False unless exactly `out` is filled.
bool unpackLzf(const std::vector<std::uint8_t>& packed, std::vector<std::uint8_t>& out) {
  std::size_t from = 0;
  std::size_t to = 0;
  while (from < packed.size()) {
    const std::size_t control = packed[from++];
    if (control < 32) {
      const std::size_t length = control + 1;
      if (length > packed.size() - from || length > out.size() - to) return false;
      std::copy_n(packed.begin() + static_cast<std::ptrdiff_t>(from), length,
                  out.begin() + static_cast<std::ptrdiff_t>(to));
      from += length;
      to += length;
      continue;
    }
    std::size_t length = (control >> 5) + 2;
    if (length == 9) {
      if (from == packed.size()) return false;
      length += packed[from++];
    }
    if (from == packed.size()) return false;
    const std::size_t distance = ((control & 31U) << 8 | packed[from++]) + 1;
    if (distance > to || length > out.size() - to) return false;
    for (const std::size_t end = to + length; to < end; ++to) out[to] = out[to - distance];
  }
  return to == out.size();
}

// One LZF block that holds the columns one after another.
void readCompressed(InputFile& file, const PcdHeader& header, std::uint64_t points,
                    CloudTable& table) {
  std::uint32_t packed_bytes = 0;
  std::uint32_t bytes = 0;
  file.read(&packed_bytes, sizeof(packed_bytes));
  file.read(&bytes, sizeof(bytes));
  if (packed_bytes > file.remaining()) file.fail("is cut short");
  if (points > bytes || points * header.row_bytes != bytes) {
    file.fail("POINTS does not agree with the size of the compressed data");
  }
  // Three bytes of LZF stand for 264 bytes at most.
  if (bytes / 264 > packed_bytes / 3 + 1) file.fail("its compressed data is damaged");
  std::vector<std::uint8_t> packed(packed_bytes);
  file.read(packed.data(), packed.size());
  std::vector<std::uint8_t> columns(bytes);
  if (!unpackLzf(packed, columns)) file.fail("its compressed data is damaged");
  packed = {};
  table.size = static_cast<std::size_t>(points);
  table.rows.resize(table.size * table.row_bytes);
  const std::uint8_t* column_data = columns.data();
  std::size_t f = 0;
  for (const Field& column : header.columns) {
    if (!isPadding(column)) {
      const Field& field = table.fields[f++];
      for (std::size_t i = 0; i < table.size; ++i) {
        std::memcpy(table.at(field, i), column_data + i * column.bytes(), column.bytes());
      }
    }
    column_data += table.size * column.bytes();
  }
}

void readAscii(InputFile& file, const PcdHeader& header, CloudTable& table) {
  std::string_view line;
  for (std::size_t row = 0; row < table.size; ++row) {
    std::string_view word;
    do {  // blank lines are no points
      if (!file.line(line)) file.fail("is cut short: it ends before point " + std::to_string(row));
      word = nextWord(line);
    } while (word.empty());
    std::size_t f = 0;
    for (const Field& column : header.columns) {
      Field* field = isPadding(column) ? nullptr : &table.fields[f++];
      for (std::uint32_t e = 0; e < column.count; ++e) {
        if (word.empty()) file.failLine("has fewer numbers than there are FIELDS");
        if (field != nullptr &&
            !storeNumber(word, field->type, field->size, table.at(*field, row) + e * field->size)) {
          file.failLine("'" + std::string(word) + "' is not a number of type " + field->type +
                        std::to_string(field->size));
        }
        word = nextWord(line);
      }
    }
  }
}

// Without rows.
CloudTable tableOf(const InputFile& file, const PcdHeader& header) {
  CloudTable table;
  for (const Field& column : header.columns) {
    if (!isPadding(column)) table.addField(column.name, column.type, column.size, column.count);
  }
  if (table.fields.empty()) file.fail("has no FIELDS");
  table.width = static_cast<std::size_t>(*header.width);
  table.height = static_cast<std::size_t>(*header.height);
  table.viewpoint = header.viewpoint;
  return table;
}

}  // namespace

CloudTable readPcd(InputFile& file) {
  PcdHeader header = readHeader(file);
  const std::uint64_t points = numberOfPoints(file, header);
  CloudTable table = tableOf(file, header);
  std::uint64_t values = 0;
  for (const Field& column : header.columns) values += column.count;
  if (header.data == "ascii") {
    // A digit and a separator for each number; the last line may lack its end.
    allocateRows(file, table, points, 2 * values);
    readAscii(file, header, table);
  } else if (header.data == "binary") {
    allocateRows(file, table, points, header.row_bytes);
    readBinary(file, header, table);
  } else if (header.data == "binary_compressed") {
    readCompressed(file, header, points, table);
  } else {
    file.fail("DATA " + header.data + " is not known");
  }
  // Colours are stored as integers in text files, where a float's bits could not be kept.
  for (Field& f : table.fields) {
    if (f.name == "rgb" && f.size == 4 && f.count == 1) f.type = 'F';
  }
  return table;
}

std::optional<RowFormat> pcdRows(InputFile& file) {
  PcdHeader header = readHeader(file);
  RowFormat rows;
  rows.size = numberOfPoints(file, header);
  if (header.data != "binary") return std::nullopt;
  rows.file_bytes = header.row_bytes;
  rows.layout = tableOf(file, header);
  rows.convert = [header](const std::uint8_t* from, CloudTable& block) {
    copyRows(header, from, 0, block.size, block);
  };
  return rows;
}

}  // namespace segorient::program
