// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// page.html with the viewer in it: generated when pgdr is built (cmake/pgdr_page.cmake).
#pragma once

#include <string_view>

namespace pgdr::tool {

extern const std::string_view page_head, page_tail;  ///< before and behind the arrays; empty: built without three.js

}  // namespace pgdr::tool
