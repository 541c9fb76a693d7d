// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "files.hpp"

#include <strings.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>

#include "pgdr/error.hpp"
#include "pgdr/io.hpp"

namespace pgdr::tool {

namespace fs = std::filesystem;

bool has_extension(const std::string& file, std::initializer_list<const char*> extensions) {
  const std::string own = fs::path(file).extension().string();
  return std::any_of(extensions.begin(), extensions.end(),
                     [&own](const char* extension) { return strcasecmp(own.c_str(), extension) == 0; });
}

void require_writable(const std::string& file) {
  const fs::path path(file);
  const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  std::error_code ignored;
  if (fs::is_directory(path, ignored) || !fs::is_directory(folder, ignored) || access(folder.c_str(), W_OK | X_OK) != 0)
    throw FileError({.code = Errc::cannot_write, .message = "no file can be written there", .file = file});
}

void require_mesh_writable(const std::string& output) {
  if (!is_mesh_format(output))
    throw InputError({.code = Errc::unknown_format,
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

void write_whole(const std::string& file, const char* what, const std::function<void(std::ostream&)>& write) {
  struct Temporary {
    std::string name;
    ~Temporary() { std::remove(name.c_str()); }  // gone already if all went well
  } const temporary{file + '.' + std::to_string(getpid()) + ".tmp"};
  std::ofstream out(temporary.name, std::ios::binary);
  if (out) write(out);
  out.close();
  if (!out || std::rename(temporary.name.c_str(), file.c_str()) != 0)
    throw FileError({.code = Errc::cannot_write, .message = std::string(what) + " cannot be written", .file = file});
}

}  // namespace pgdr::tool
