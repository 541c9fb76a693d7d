// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace pgdr::tool {

/// What --version says: "pgdr 0.1.0 (1b2c3d4e5f60)", with the commit where it is known, and a + behind it where files were
/// changed since.
std::string version_words();

}  // namespace pgdr::tool
