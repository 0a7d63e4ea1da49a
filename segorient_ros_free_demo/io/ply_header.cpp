// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include "io/ply_header.h"

#include <map>
#include <string_view>

#include "io/text_numbers.h"

namespace segorient::program {
namespace {

PlyType plyType(const InputFile& file, std::string_view name) {
  static const std::map<std::string_view, PlyType> kTypes{
      {"char", {'I', 1}},  {"int8", {'I', 1}},    {"uchar", {'U', 1}},  {"uint8", {'U', 1}},
      {"short", {'I', 2}}, {"int16", {'I', 2}},   {"ushort", {'U', 2}}, {"uint16", {'U', 2}},
      {"int", {'I', 4}},   {"int32", {'I', 4}},   {"uint", {'U', 4}},   {"uint32", {'U', 4}},
      {"float", {'F', 4}}, {"float32", {'F', 4}}, {"double", {'F', 8}}, {"float64", {'F', 8}}};
  const auto it = kTypes.find(name);
  if (it == kTypes.end()) file.failLine("'" + std::string(name) + "' is no type of a PLY property");
  return it->second;
}

void readFormat(const InputFile& file, std::string_view line, PlyHeader& header) {
  const std::string_view format = nextWord(line);
  header.ascii = format == "ascii";
  header.swap = format == "binary_big_endian";
  if (!header.ascii && !header.swap && format != "binary_little_endian") {
    file.failLine("'" + std::string(format) + "' is no format of PLY");
  }
}

void readElement(const InputFile& file, std::string_view line, PlyHeader& header) {
  PlyElement element;
  element.name = std::string(nextWord(line));
  if (!parseNumber(nextWord(line), element.count))
    file.failLine("the element's count is no number");
  header.elements.push_back(std::move(element));
}

void readProperty(const InputFile& file, std::string_view line, PlyHeader& header) {
  if (header.elements.empty()) file.failLine("is a property of no element");
  PlyProperty p;
  std::string_view word = nextWord(line);
  p.is_list = word == "list";
  if (p.is_list) {
    p.length = plyType(file, nextWord(line));
    if (p.length.type == 'F') file.failLine("a list's length is no whole number");
    word = nextWord(line);
  }
  p.value = plyType(file, word);
  p.name = std::string(nextWord(line));
  if (p.name.empty()) file.failLine("the property has no name");
  header.elements.back().properties.push_back(std::move(p));
}

}  // namespace

PlyHeader readPlyHeader(InputFile& file) {
  PlyHeader header;
  std::string_view line;
  if (!file.line(line) || nextWord(line) != "ply") file.fail("is not a PLY file");
  bool has_format = false;
  for (;;) {
    if (!file.line(line)) file.fail("is cut short: its header has no end");
    const std::string_view key = nextWord(line);
    if (key == "end_header") break;
    if (key == "format") {
      readFormat(file, line, header);
      has_format = true;
    } else if (key == "element") {
      readElement(file, line, header);
    } else if (key == "property") {
      readProperty(file, line, header);
    } else if (!key.empty() && key != "comment" && key != "obj_info") {
      file.failLine("is not of a PLY header");
    }
  }
  if (!has_format) file.fail("its header does not name a format");
  return header;
}

}  // namespace segorient::program
