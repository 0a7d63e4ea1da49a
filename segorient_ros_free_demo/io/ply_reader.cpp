// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#include <algorithm>
#include <cstring>

#include "io/cloud_stream.h"
#include "io/ply_header.h"
#include "io/readers.h"
#include "io/text_numbers.h"

namespace segorient::program {
namespace {

// Values of a PLY's body one after another, text or binary.
class Body {
 public:
  Body(InputFile& file, const PlyHeader& header) : file_(file), header_(header) {}

  // Whether values are in the file as they are in memory.
  bool isVerbatim() const { return !header_.ascii && !header_.swap; }
  void beginRow() {
    if (!header_.ascii) return;
    do {
      if (!file_.line(line_)) file_.fail("is cut short");
    } while (line_.find_first_not_of(" \t") == std::string_view::npos);
  }
  void value(const PlyType& type, std::uint8_t* out) {
    if (!header_.ascii) {
      file_.read(out, type.size);
      if (header_.swap) std::reverse(out, out + type.size);
      return;
    }
    const std::string_view word = nextWord(line_);
    if (word.empty()) file_.failLine("has fewer numbers than there are properties");
    if (!storeNumber(word, type.type, type.size, out)) {
      file_.failLine("'" + std::string(word) + "' is not a number of its property's type");
    }
  }
  double number(const PlyType& type) {
    std::array<std::uint8_t, 8> bytes{};
    value(type, bytes.data());
    return loadNumber(bytes.data(), type.type, type.size);
  }
  std::uint64_t length(const PlyType& type) {
    const double n = number(type);
    if (n < 0.0) file_.fail("has a list of negative length");
    return static_cast<std::uint64_t>(n);
  }

 private:
  InputFile& file_;
  const PlyHeader& header_;
  std::string_view line_;
};

void skipElement(Body& body, const PlyElement& element) {
  for (std::uint64_t row = 0; row < element.count; ++row) {
    body.beginRow();
    for (const PlyProperty& p : element.properties) {
      const std::uint64_t n = p.is_list ? body.length(p.length) : 1;
      for (std::uint64_t i = 0; i < n; ++i) body.number(p.value);
    }
  }
}

// Polygons as fans of triangles.
void readFaces(InputFile& file, Body& body, const PlyElement& element, CloudTable& table) {
  for (std::uint64_t row = 0; row < element.count; ++row) {
    body.beginRow();
    for (const PlyProperty& p : element.properties) {
      const std::uint64_t n = p.is_list ? body.length(p.length) : 1;
      const bool corners = p.is_list && (p.name == "vertex_indices" || p.name == "vertex_index");
      Triangle t{0, 0, 0};
      for (std::uint64_t i = 0; i < n; ++i) {
        const double v = body.number(p.value);
        if (!corners) continue;
        if (v < 0.0 || v >= static_cast<double>(table.size)) file.fail("a face has no such vertex");
        const auto vertex = static_cast<std::uint32_t>(v);
        if (i == 0) t[0] = vertex;
        if (i >= 2) {
          t[2] = vertex;
          table.triangles.push_back(t);
        }
        t[1] = vertex;
      }
    }
  }
}

// Where red, green and blue of 8 bits go: byte 2, 1, 0 of a packed rgb; -1 for any other property.
int colourByte(const PlyProperty& p) {
  if (p.is_list || p.value.type != 'U' || p.value.size != 1) return -1;
  if (p.name == "red" || p.name == "diffuse_red") return 2;
  if (p.name == "green" || p.name == "diffuse_green") return 1;
  if (p.name == "blue" || p.name == "diffuse_blue") return 0;
  return -1;
}

// What is written beside `label` for CloudCompare says nothing new. If it differs it is somebody's
// own and stays.
void dropTwinOfLabel(CloudTable& table) {
  const Field* label = table.find("label");
  const Field* twin = table.find("scalar_label");
  const bool comparable = label != nullptr && label->type == 'U' && label->size == 4 &&
                          twin != nullptr && twin->type == 'F' && twin->size == 4;
  if (!comparable) return;
  for (std::size_t row = 0; row < table.size; ++row) {
    std::int32_t own = 0;
    float other = 0.F;
    std::memcpy(&own, table.at(*label, row), sizeof(own));
    std::memcpy(&other, table.at(*twin, row), sizeof(other));
    if (static_cast<float>(own) != other) return;
  }
  table.fields.erase(table.fields.begin() + (twin - table.fields.data()));
}

// Gives the table its fields. \return where each property goes; npos: it is dropped. Lists have no
// place in a table.
std::vector<std::size_t> placeProperties(const PlyElement& element, CloudTable& table) {
  const auto& properties = element.properties;
  std::vector<std::size_t> offsets;
  const bool colours = std::count_if(properties.begin(), properties.end(),
                                     [](const PlyProperty& p) { return colourByte(p) >= 0; }) == 3;
  for (const PlyProperty& p : properties) {
    const int byte = colours ? colourByte(p) : -1;
    if (p.is_list) {
      table.dropped.push_back(p.name);
      offsets.push_back(std::string::npos);
    } else if (byte >= 0) {
      if (table.find("rgb") == nullptr) table.addField("rgb", 'F', 4);
      offsets.push_back(table.find("rgb")->offset + static_cast<std::size_t>(byte));
    } else {
      offsets.push_back(table.row_bytes);
      table.addField(pclName(p.name), p.value.type, p.value.size);
    }
  }
  return offsets;
}

// The same without a look at the points: where both are there, we wrote them.
void dropTwinName(CloudTable& table) {
  const Field* twin = table.find("scalar_label");
  if (table.find("label") == nullptr || twin == nullptr) return;
  table.fields.erase(table.fields.begin() + (twin - table.fields.data()));
}

void readVertices(InputFile& file, Body& body, const PlyElement& element, bool ascii,
                  CloudTable& table) {
  const auto& properties = element.properties;
  const std::vector<std::size_t> offsets = placeProperties(element, table);
  allocateRows(file, table, element.count, element.leastBytes(ascii));
  table.width = table.size;
  if (body.isVerbatim() && !element.hasLists() && table.row_bytes == element.leastBytes(false) &&
      std::is_sorted(offsets.begin(), offsets.end())) {
    file.read(table.rows.data(), table.rows.size());
    return;
  }
  std::array<std::uint8_t, 8> ignored{};
  for (std::size_t row = 0; row < table.size; ++row) {
    body.beginRow();
    std::uint8_t* to = table.rows.data() + row * table.row_bytes;
    for (std::size_t i = 0; i < properties.size(); ++i) {
      const bool dropped = offsets[i] == std::string::npos;
      const std::uint64_t n = properties[i].is_list ? body.length(properties[i].length) : 1;
      for (std::uint64_t entry = 0; entry < n; ++entry) {
        body.value(properties[i].value, dropped ? ignored.data() : to + offsets[i]);
      }
    }
  }
}

}  // namespace

CloudTable readPly(InputFile& file) {
  const PlyHeader header = readPlyHeader(file);
  Body body(file, header);
  CloudTable table;
  bool has_vertices = false;
  for (const PlyElement& element : header.elements) {
    const std::uint64_t least = element.leastBytes(header.ascii);
    if (least == 0 && element.name != "vertex") continue;  // rows without properties take no bytes
    if (element.count > (file.remaining() + 1) / std::max<std::uint64_t>(1, least)) {
      file.fail("is cut short: it is too small for its " + std::to_string(element.count) + " " +
                element.name + " rows");
    }
    if (element.name == "vertex") {
      if (has_vertices) file.fail("has two elements of vertices");
      has_vertices = true;
      readVertices(file, body, element, header.ascii, table);
      dropTwinOfLabel(table);
    } else if (element.name == "face" && has_vertices) {
      readFaces(file, body, element, table);
    } else {
      skipElement(body, element);
    }
  }
  if (!has_vertices) file.fail("has no vertices");
  return table;
}

std::optional<RowFormat> plyRows(InputFile& file) {
  const PlyHeader header = readPlyHeader(file);
  const auto is_vertex = [](const PlyElement& e) { return e.name == "vertex"; };
  const auto vertex = std::find_if(header.elements.begin(), header.elements.end(), is_vertex);
  if (vertex == header.elements.end()) file.fail("has no vertices");
  for (auto e = header.elements.begin(); e != vertex; ++e) {
    if (header.ascii || e->hasLists()) return std::nullopt;
    file.skip(e->count * e->leastBytes(false));
  }
  if (header.ascii || vertex->hasLists()) return std::nullopt;
  RowFormat rows;
  rows.size = vertex->count;
  rows.file_bytes = static_cast<std::size_t>(vertex->leastBytes(false));
  const std::vector<std::size_t> offsets = placeProperties(*vertex, rows.layout);
  dropTwinName(rows.layout);
  rows.convert = [offsets, properties = vertex->properties, swap = header.swap](
                     const std::uint8_t* from, CloudTable& block) {
    for (std::size_t row = 0; row < block.size; ++row) {
      std::uint8_t* to = block.rows.data() + row * block.row_bytes;
      for (std::size_t i = 0; i < properties.size(); ++i) {
        const std::size_t bytes = properties[i].value.size;
        std::copy_n(from, bytes, to + offsets[i]);
        if (swap) std::reverse(to + offsets[i], to + offsets[i] + bytes);
        from += bytes;
      }
    }
  };
  return rows;
}

}  // namespace segorient::program
