// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "files.hpp"

#include <strings.h>

#include <algorithm>
#include <filesystem>

#include "pgdr/error.hpp"
#include "pgdr/io.hpp"
#include "pgdr/output_files.hpp"

namespace pgdr::tool {

namespace fs = std::filesystem;

bool has_extension(const std::string& file, std::initializer_list<const char*> extensions) {
  const std::string own = fs::path(file).extension().string();
  return std::any_of(extensions.begin(), extensions.end(),
                     [&own](const char* extension) { return strcasecmp(own.c_str(), extension) == 0; });
}

void require_mesh_writable(const std::string& output) {
  if (!is_mesh_format(output))
    throw UsageError({.code = Errc::unknown_format,
                      .message = "meshes are written as .vtu, .pvtu, .msh, .mesh, or .node with .ele",
                      .file = output});
  for (const std::string& file : files_of_mesh(output)) require_writable(file);
}

void require_input_format(const std::string& file) {
  if (has_extension(file, {".vtu", ".pvtu", ".ele"}))
    throw InputError(
        {.code = Errc::unknown_format,
         .message = "this is a mesh in a format that is no input: give what it was made of, or write the mesh as .mesh "
                    "or .msh, which are inputs, too",
         .file = file});
}

}  // namespace pgdr::tool
