// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "scan/clean_name.hpp"

namespace pgdr::detail {
namespace {

unsigned char byte_at(std::string_view text, std::size_t i) { return static_cast<unsigned char>(text[i]); }

}  // namespace

std::size_t utf8_length(std::string_view text) {
  const unsigned char first = byte_at(text, 0);
  if (first < 0x80) return 1;
  const std::size_t length = first >= 0xf0 && first <= 0xf4 ? 4 : first >= 0xe0 && first < 0xf0 ? 3 : first >= 0xc2 ? 2 : 0;
  if (length == 0 || first > 0xf4 || text.size() < length) return 0;
  for (std::size_t i = 1; i < length; ++i)
    if ((byte_at(text, i) & 0xc0) != 0x80) return 0;
  const unsigned char second = byte_at(text, 1);
  const bool overlong = (first == 0xe0 && second < 0xa0) || (first == 0xf0 && second < 0x90);
  const bool no_character = (first == 0xed && second >= 0xa0) ||
                            (first == 0xf4 && second >= 0x90);  // surrogates; beyond the last
  return overlong || no_character ? 0 : length;
}

std::string clean_name(std::string_view raw) {
  std::string name;
  while (!raw.empty()) {
    const std::size_t length = utf8_length(raw);
    const unsigned char c = byte_at(raw, 0);
    if (length == 0) {  // a character of Latin-1, or a control character of it
      if (c >= 0xa0)
        name.append({static_cast<char>(0xc0 | c >> 6), static_cast<char>(0x80 | (c & 0x3f))});
      else
        name += ' ';
    } else if (c < 0x20 || c == 0x7f || (length == 2 && c == 0xc2 && byte_at(raw, 1) < 0xa0)) {
      name += ' ';
    } else {
      name += raw.substr(0, length);
    }
    raw.remove_prefix(length == 0 ? 1 : length);
  }
  const std::size_t begin = name.find_first_not_of(' '), end = name.find_last_not_of(' ');
  return begin == std::string::npos ? std::string() : name.substr(begin, end + 1 - begin);
}

}  // namespace pgdr::detail
