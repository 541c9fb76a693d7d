// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "version.hpp"

#include <pgdr/version.hpp>

#include "pgdr_commit.hpp"  // of the build folder: cmake/pgdr_commit.cmake

namespace pgdr::tool {

std::string version_words() { return "pgdr " PGDR_VERSION_STRING PGDR_COMMIT_WORDS; }

}  // namespace pgdr::tool
