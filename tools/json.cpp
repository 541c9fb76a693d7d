// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "json.hpp"

#include <charconv>
#include <cmath>
#include <cstdint>

namespace pgdr::tool {
namespace {

/// Length of the UTF-8 sequence that `s` begins with; 0 if it is none (Unicode 15, table 3-7).
std::size_t sequence_length(std::string_view s) {
  const auto byte = [s](std::size_t i) { return i < s.size() ? static_cast<std::uint8_t>(s[i]) : 0; };
  const auto tail = [&byte](std::size_t i) { return byte(i) >> 6 == 2; };
  const unsigned b0 = byte(0), b1 = byte(1);
  if (b0 < 0x80) return 1;
  if (b0 >= 0xc2 && b0 <= 0xdf) return tail(1) ? 2 : 0;
  if (b0 >= 0xe0 && b0 <= 0xef) {
    const bool overlong = b0 == 0xe0 && b1 < 0xa0, surrogate = b0 == 0xed && b1 > 0x9f;
    return tail(1) && tail(2) && !overlong && !surrogate ? 3 : 0;
  }
  if (b0 >= 0xf0 && b0 <= 0xf4) {
    const bool overlong = b0 == 0xf0 && b1 < 0x90, too_large = b0 == 0xf4 && b1 > 0x8f;
    return tail(1) && tail(2) && tail(3) && !overlong && !too_large ? 4 : 0;
  }
  return 0;
}

std::string quoted(std::string_view s) {
  constexpr const char* hex = "0123456789abcdef";
  std::string text = "\"";
  while (!s.empty()) {
    const std::size_t length = sequence_length(s);
    const auto c = static_cast<unsigned char>(s[0]);
    if (length == 0)
      text += "\\ufffd";
    else if (c == '"' || c == '\\')
      text.append({'\\', s[0]});
    else if (c < 0x20)
      text.append("\\u00").append({hex[c >> 4], hex[c & 15]});
    else
      text.append(s.substr(0, length));
    s.remove_prefix(length ? length : 1);
  }
  return text += '"';
}

}  // namespace

Json::Json(double value) : text_("null") {
  if (!std::isfinite(value)) return;
  char buffer[32];
  const auto end = std::to_chars(buffer, buffer + sizeof buffer, value).ptr;
  text_.assign(buffer, end);
  if (text_.find_first_of(".e") == std::string::npos) text_ += ".0";
}

Json::Json(std::string_view value) : text_(quoted(value)) {}

JsonObject::JsonObject(std::initializer_list<std::pair<std::string_view, Json>> members) {
  for (const auto& [key, value] : members) set(key, value);
}

void JsonObject::set(std::string_view key, const Json& value) {
  std::string name = quoted(key);
  for (auto& member : members_)
    if (member.first == name) {
      member.second = value.text();
      return;
    }
  members_.emplace_back(std::move(name), value.text());
}

bool JsonObject::contains(std::string_view key) const {
  const std::string name = quoted(key);
  for (const auto& member : members_)
    if (member.first == name) return true;
  return false;
}

JsonObject::operator Json() const {
  std::string text = "{";
  for (const auto& [key, value] : members_) {
    if (text.size() > 1) text += ", ";
    text.append(key).append(": ").append(value);
  }
  return Json(Json::Raw{text += '}'});
}

std::string JsonObject::pretty() const {
  std::string text = "{";
  for (const auto& [key, value] : members_) {
    text.append(text.size() > 1 ? ",\n  " : "\n  ").append(key).append(": ").append(value);
  }
  return text += "\n}\n";
}

}  // namespace pgdr::tool
