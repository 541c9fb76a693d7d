// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Names as files have them, made what `Names` promises, and words of UTF-8.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace pgdr::detail {

/// How many bytes the character of UTF-8 has that the text begins with; 0: these are none. @pre the text is not empty
std::size_t utf8_length(std::string_view text);

/// Control characters become blanks, blanks at either end go, and bytes that are no UTF-8 are read as Latin-1.
std::string clean_name(std::string_view raw);

}  // namespace pgdr::detail
