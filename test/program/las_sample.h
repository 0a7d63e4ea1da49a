// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

// LAS files byte by byte, after the tables of the specification; not by the program's own writer.
namespace segorient::test {

inline std::size_t lasRecordBytes(int format) {
  return std::vector<std::size_t>{
      20, 28, 26, 34, 57, 63, 30, 36, 38, 59, 67}[static_cast<std::size_t>(format)];
}

template <typename T>
void putAt(std::string& bytes, std::size_t at, T value) {
  if (bytes.size() < at + sizeof(T)) bytes.resize(at + sizeof(T), '\0');
  std::memcpy(&bytes[at], &value, sizeof(T));
}

struct LasSample {
  int minor = 2;
  int format = 0;
  double scale = 0.001;
  double offset[3] = {500000.0, 5400000.0, 100.0};
  std::string records;  ///< variable length records
  std::uint32_t record_count = 0;
  std::vector<std::string> points;

  /// A record of the format; point i is of return i % 3 + 1, class i, ...
  std::string makePoint(int i) const {
    std::string p(lasRecordBytes(format), '\0');
    putAt(p, 0, static_cast<std::int32_t>(1000 * i));
    putAt(p, 4, static_cast<std::int32_t>(-7 * i));
    putAt(p, 8, static_cast<std::int32_t>(i * i));
    putAt(p, 12, static_cast<std::uint16_t>(100 + i));
    const int number = i % 3 + 1;
    if (format >= 6) {
      putAt(p, 14, static_cast<std::uint8_t>(number | 3 << 4));
      putAt(p, 15, static_cast<std::uint8_t>(i % 16 | (i % 4) << 4 | (i % 2) << 6 | 1 << 7));
      putAt(p, 16, static_cast<std::uint8_t>(i));
      putAt(p, 17, static_cast<std::uint8_t>(200 + i));
      putAt(p, 18, static_cast<std::int16_t>(-1000 * i));
      putAt(p, 20, static_cast<std::uint16_t>(7000 + i));
      putAt(p, 22, 1234.5 + i);
    } else {
      putAt(p, 14, static_cast<std::uint8_t>(number | 3 << 3 | (i % 2) << 6 | 1 << 7));
      putAt(p, 15, static_cast<std::uint8_t>(i % 32 | (i % 8) << 5));
      putAt(p, 16, static_cast<std::int8_t>(-i));
      putAt(p, 17, static_cast<std::uint8_t>(200 + i));
      putAt(p, 18, static_cast<std::uint16_t>(7000 + i));
      if (format == 1 || format >= 3) putAt(p, 20, 1234.5 + i);
    }
    const std::size_t color = format == 2 ? 20 : (format == 3 || format == 5 ? 28 : 30);
    if (format == 2 || format == 3 || format == 5 || format == 7 || format == 8 || format == 10) {
      for (std::size_t c = 0; c < 3; ++c) {
        putAt(p, color + 2 * c,
              static_cast<std::uint16_t>(256 * (10 * i + static_cast<int>(c)) + 5));
      }
    }
    if (format == 8 || format == 10) putAt(p, 36, static_cast<std::uint16_t>(900 + i));
    return p;
  }

  std::string bytes() const {
    const std::size_t header = minor == 4 ? 375 : (minor == 3 ? 235 : 227);
    std::string h(header, '\0');
    std::memcpy(&h[0], "LASF", 4);
    putAt(h, 6, std::uint16_t{1});
    putAt(h, 24, std::uint8_t{1});
    putAt(h, 25, static_cast<std::uint8_t>(minor));
    std::memcpy(&h[26], "a scanner", 9);
    putAt(h, 94, static_cast<std::uint16_t>(header));
    putAt(h, 96, static_cast<std::uint32_t>(header + records.size()));
    putAt(h, 100, record_count);
    putAt(h, 104, static_cast<std::uint8_t>(format));
    const std::size_t size = points.empty() ? lasRecordBytes(format) : points[0].size();
    putAt(h, 105, static_cast<std::uint16_t>(size));
    const auto count = static_cast<std::uint32_t>(points.size());
    putAt(h, 107, format >= 6 ? 0U : count);
    for (std::size_t a = 0; a < 3; ++a) {
      putAt(h, 131 + 8 * a, scale);
      putAt(h, 155 + 8 * a, offset[a]);
    }
    if (minor == 4) putAt(h, 247, static_cast<std::uint64_t>(count));
    std::string out = h + records;
    for (const std::string& p : points) out += p;
    return out;
  }
};

inline LasSample lasSample(int format, int size) {
  LasSample out;
  out.format = format;
  out.minor = format >= 6 ? 4 : (format >= 4 ? 3 : 2);
  for (int i = 0; i < size; ++i) out.points.push_back(out.makePoint(i));
  return out;
}

/// A variable length record.
inline std::string lasRecord(const std::string& user, std::uint16_t id,
                             const std::string& content) {
  std::string out(54, '\0');
  std::memcpy(&out[2], user.data(), user.size());
  putAt(out, 18, id);
  putAt(out, 20, static_cast<std::uint16_t>(content.size()));
  return out + content;
}

/// The description of one extra dimension.
inline std::string lasExtra(const std::string& name, std::uint8_t type, std::uint8_t options = 0,
                            double scale = 0.0, double offset = 0.0) {
  std::string out(192, '\0');
  putAt(out, 2, type);
  putAt(out, 3, options);
  std::memcpy(&out[4], name.data(), name.size());
  putAt(out, 112, scale);
  putAt(out, 136, offset);
  return out;
}

}  // namespace segorient::test
