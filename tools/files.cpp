// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "files.hpp"

#include <strings.h>
#include <unistd.h>

#include <filesystem>

#include "pgdr/error.hpp"

namespace pgdr::tool {

namespace fs = std::filesystem;

bool is_mesh_file(const std::string& file) {
  const std::string extension = fs::path(file).extension().string();
  return strcasecmp(extension.c_str(), ".vtu") == 0 || strcasecmp(extension.c_str(), ".mesh") == 0;
}

void require_writable(const std::string& output, const std::string& input) {
  if (!is_mesh_file(output))
    throw InputError({.code = Errc::unknown_format, .message = "meshes are written as .vtu or .mesh", .file = output});
  const fs::path path(output);
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  std::error_code ignored;
  if (fs::is_directory(path, ignored) || !fs::is_directory(folder, ignored) || access(folder.c_str(), W_OK | X_OK) != 0)
    throw FileError({.code = Errc::cannot_write, .message = "no file can be written there", .file = output});
  if (fs::equivalent(path, input, ignored))
    throw UsageError({.code = Errc::bad_option, .message = "the output would replace the input", .file = output});
}

}  // namespace pgdr::tool
