// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "io/las_format.h"

#include <cctype>

namespace segorient::program {
namespace {

// Other programs know normals by these names.
constexpr std::array<std::array<const char*, 2>, 4> kNames{{{"normal_x", "NormalX"},
                                                            {"normal_y", "NormalY"},
                                                            {"normal_z", "NormalZ"},
                                                            {"curvature", "Curvature"}}};

}  // namespace

std::size_t lasColorOffset(int format) {
  if (!lasHasColor(format)) return 0;
  if (lasIsExtended(format)) return 30;
  return format == 2 ? 20 : 28;
}

std::vector<LasItem> lasItems(int format) {
  using Kind = LasItem::Kind;
  std::vector<LasItem> items{{"intensity", Kind::Intensity, 12, 'F', 4}};
  if (lasIsExtended(format)) {
    items.insert(items.end(), {{"return_number", Kind::Bits, 14, 'U', 1, 0, 15},
                               {"number_of_returns", Kind::Bits, 14, 'U', 1, 4, 15},
                               {"classification_flags", Kind::Bits, 15, 'U', 1, 0, 15},
                               {"scanner_channel", Kind::Bits, 15, 'U', 1, 4, 3},
                               {"scan_direction_flag", Kind::Bits, 15, 'U', 1, 6, 1},
                               {"edge_of_flight_line", Kind::Bits, 15, 'U', 1, 7, 1},
                               {"classification", Kind::Number, 16, 'U', 1},
                               {"user_data", Kind::Number, 17, 'U', 1},
                               {"scan_angle", Kind::Angle, 18, 'F', 4},
                               {"point_source_id", Kind::Number, 20, 'U', 2},
                               {"gps_time", Kind::Number, 22, 'F', 8}});
  } else {
    items.insert(items.end(), {{"return_number", Kind::Bits, 14, 'U', 1, 0, 7},
                               {"number_of_returns", Kind::Bits, 14, 'U', 1, 3, 7},
                               {"scan_direction_flag", Kind::Bits, 14, 'U', 1, 6, 1},
                               {"edge_of_flight_line", Kind::Bits, 14, 'U', 1, 7, 1},
                               {"classification", Kind::Bits, 15, 'U', 1, 0, 31},
                               {"classification_flags", Kind::Bits, 15, 'U', 1, 5, 7},
                               {"scan_angle", Kind::Rank, 16, 'F', 4},
                               {"user_data", Kind::Number, 17, 'U', 1},
                               {"point_source_id", Kind::Number, 18, 'U', 2}});
    if (lasHasTime(format)) items.push_back({"gps_time", Kind::Number, 20, 'F', 8});
  }
  if (lasHasColor(format)) {
    const std::size_t first = lasColorOffset(format);
    items.push_back({"red16", Kind::Number, first, 'U', 2});
    items.push_back({"green16", Kind::Number, first + 2, 'U', 2});
    items.push_back({"blue16", Kind::Number, first + 4, 'U', 2});
  }
  if (lasHasInfrared(format)) items.push_back({"infrared", Kind::Number, 36, 'U', 2});
  return items;
}

std::string lasName(const std::string& field_name) {
  for (const auto& [field, las] : kNames) {
    if (field_name == field) return las;
  }
  return field_name;
}

std::string fieldNameOfLas(const std::string& las_name) {
  for (const auto& [field, las] : kNames) {
    if (las_name == las) return field;
  }
  std::string out;
  for (const char c : las_name) {  // headers of PCD and PLY part names by spaces
    out += std::isgraph(static_cast<unsigned char>(c)) != 0 ? c : '_';
  }
  return pclName(out);
}

}  // namespace segorient::program
