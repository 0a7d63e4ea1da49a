// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026, the segorient authors
#pragma once

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <string>
#include <type_traits>

namespace segorient::program {

/// Builds one JSON text, indented. Numbers that JSON cannot hold (NaN, infinite) become null.
class JsonWriter {
 public:
  JsonWriter() { open('{'); }

  void beginObject(const std::string& key) { begin(key, '{'); }
  void beginArray(const std::string& key) { begin(key, '['); }
  void beginItem() { begin("", '{'); }  ///< an object in an array
  void endObject() { close('}'); }
  void endArray() { close(']'); }

  void field(const std::string& key, const std::string& value) {
    name(key);
    text_ += quoted(value);
  }
  void field(const std::string& key, const char* value) { field(key, std::string(value)); }
  template <typename T, typename = std::enable_if_t<std::is_arithmetic_v<T>>>
  void field(const std::string& key, T value) {
    name(key);
    if constexpr (std::is_same_v<T, bool>) {
      text_ += value ? "true" : "false";
    } else if constexpr (std::is_integral_v<T>) {
      text_ += std::to_string(value);
    } else {
      text_ += number(static_cast<double>(value));
    }
  }
  template <typename T>
  void item(T value) {
    field("", value);
  }

  /// Closes the outermost object; nothing may follow.
  std::string finish() {
    close('}');
    return text_ + "\n";
  }

 private:
  static std::string number(double value) {
    if (!std::isfinite(value)) return "null";
    char text[32];
    std::snprintf(text, sizeof(text), "%.9g", value);
    return text;
  }
  static std::string quoted(const std::string& value) {
    std::string out = "\"";
    for (const char c : value) {
      if (c == '"' || c == '\\') {
        out += {'\\', c};
      } else if (static_cast<unsigned char>(c) < 0x20) {
        char text[8];
        std::snprintf(text, sizeof(text), "\\u%04x", static_cast<unsigned>(c));
        out += text;
      } else {
        out += c;
      }
    }
    return out + "\"";
  }
  void name(const std::string& key) {
    if (!first_) text_ += ",";
    first_ = false;
    text_ += "\n" + std::string(2 * depth_, ' ');
    if (!key.empty()) text_ += quoted(key) + ": ";
  }
  void open(char bracket) {
    text_ += bracket;
    ++depth_;
    first_ = true;
  }
  void begin(const std::string& key, char bracket) {
    name(key);
    open(bracket);
  }
  void close(char bracket) {
    --depth_;
    if (!first_) text_ += "\n" + std::string(2 * depth_, ' ');
    text_ += bracket;
    first_ = false;
  }

  std::string text_;
  std::size_t depth_ = 0;
  bool first_ = true;
};

}  // namespace segorient::program
