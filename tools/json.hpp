// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// JSON as text, made from the inside out. Strings and nothing else: unlike a tree of values whose destructors allocate,
// this can be built, and given up, while memory runs out.
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace pgdr::tool {

/// A finished value. Doubles are the shortest that read back to the same bits; what is not finite becomes null.
class Json {
 public:
  Json(std::nullptr_t) : text_("null") {}
  Json(bool value) : text_(value ? "true" : "false") {}
  Json(double value);
  template <std::integral Integer>
  Json(Integer value) : text_(std::to_string(value)) {}
  Json(std::string_view value);  ///< bytes that are not UTF-8 (file names may have some) become U+FFFD
  Json(const std::string& value) : Json(std::string_view(value)) {}
  Json(const char* value) : Json(std::string_view(value)) {}

  template <class Value>
  Json(const std::vector<Value>& values) : Json(begin_array()) {
    append_all(values);
  }
  template <class Value, std::size_t N>
  Json(const std::array<Value, N>& values) : Json(begin_array()) {
    append_all(values);
  }

  const std::string& text() const { return text_; }

 private:
  friend class JsonObject;
  struct Raw {
    std::string text;
  };
  Json(Raw raw) : text_(std::move(raw.text)) {}
  static Raw begin_array() { return {"["}; }
  template <class Values>
  void append_all(const Values& values) {
    bool first = true;
    for (const auto& value : values) {
      if (!first) text_ += ", ";
      first = false;
      text_ += Json(value).text_;
    }
    text_ += ']';
  }

  std::string text_;
};

/// Members in the order in which they were first set.
class JsonObject {
 public:
  JsonObject() = default;
  JsonObject(std::initializer_list<std::pair<std::string_view, Json>> members);
  /// Sets, or replaces, a member.
  void set(std::string_view key, const Json& value);
  bool contains(std::string_view key) const;
  /// On one line.
  operator Json() const;
  /// A line a member, as a file has it.
  std::string pretty() const;

 private:
  std::vector<std::pair<std::string, std::string>> members_;  // both as text
};

}  // namespace pgdr::tool
