// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "run_files.hpp"

#include <filesystem>
#include <type_traits>

#include "files.hpp"
#include "pgdr/error.hpp"
#include "pgdr/io.hpp"
#include "pgdr/output_files.hpp"

namespace pgdr::tool {

namespace fs = std::filesystem;
namespace {

/// The file, and those that may be read with it. Which are is known only once it is open.
std::vector<std::string> family(const std::string& file) {
  std::vector<std::string> files{file};
  const auto add = [&](std::initializer_list<const char*> extensions) {
    for (const char* extension : extensions) files.push_back(fs::path(file).replace_extension(extension).string());
  };
  if (has_extension(file, {".poly", ".smesh"})) add({".node"});
  if (has_extension(file, {".node", ".ele"})) add({".node", ".ele", ".face", ".edge"});
  if (has_extension(file, {".pvtu"})) {  // its pieces: as many as there are
    std::vector<std::string> all = files_of_mesh(file, {.pieces = most_pieces});
    std::error_code ignored;
    for (std::size_t i = 1; i < all.size() && fs::exists(all[i], ignored); ++i) files.push_back(std::move(all[i]));
  }
  return files;
}

/// Where a file is or would be, with its links followed. Empty if that cannot be told.
fs::path place_of(const std::string& file) {
  fs::path place = file;
  try {
    place = place_of_output(file);
  } catch (const FileError&) {  // it may be read all the same
  }
  std::error_code failed;
  place = fs::absolute(place, failed);
  if (!failed) place = fs::weakly_canonical(place, failed);
  return failed ? fs::path() : place;
}

/// By any two names, also if there is none yet.
bool are_same(const std::string& a, const std::string& b) {
  std::error_code ignored;
  if (fs::equivalent(a, b, ignored)) return true;
  const fs::path place = place_of(a);
  return !place.empty() && place == place_of(b);
}

/// Would nothing be replaced by it? What cannot be written at all is refused later.
bool is_stream(const std::string& file) {
  try {
    return is_written_to(file);
  } catch (const FileError&) {
    return false;
  }
}

}  // namespace

RunFiles::RunFiles(const Arguments& arguments) {
  const auto take = [this](const auto& a) {
    using A = std::decay_t<decltype(a)>;
    if constexpr (std::is_same_v<A, MeshArguments>) {
      for (const std::string& file : a.inputs) read(file, "the input");
      read(a.bounds);
      WriteOptions all;
      all.neighbors = a.neighbors;
      all.pieces = static_cast<std::uint32_t>(a.pieces.value_or(0));
      for (const std::string& file : files_of_mesh(a.output, all)) outputs_.push_back({file, "the output"});
      if (!a.voronoi.empty()) outputs_.push_back({a.voronoi, "the file of Voronoi cells"});
      if (!a.trace.empty()) outputs_.push_back({a.trace, "the trace"});
    } else if constexpr (std::is_same_v<A, CheckArguments>) {
      read(a.mesh, "the mesh");
      for (const std::string& file : a.inputs) read(file, "the input");
      read(a.reasons, "the report of --reasons");
      read(a.bounds);
    } else if constexpr (std::is_same_v<A, InfoArguments>) {
      for (const std::string& file : a.files) read(file, "the input");
      if (!a.problems.empty()) outputs_.push_back({a.problems, "the file of problems"});
    } else if constexpr (std::is_same_v<A, JoinArguments>) {
      for (const std::string& file : a.meshes) read(file, "a mesh");
      for (const std::string& file : files_of_mesh(a.output)) outputs_.push_back({file, "the output"});
    } else {
      read(a.mesh, "the mesh");
      outputs_.push_back({a.output, "the picture"});
    }
    if (!a.report.empty()) report_.push_back({a.report, "the report"});
  };
  std::visit(take, arguments);
}

void RunFiles::read(const std::string& file, const char* what) {
  if (file.empty()) return;
  for (const std::string& each : family(file)) read_.push_back({each, what});
}

void RunFiles::read(const BoundArguments& bounds) {
  if (!bounds.size_at.empty()) read(bounds.size_at, "the sizes of --size-at");
  if (bounds.size_mesh.empty()) return;
  read(bounds.size_mesh, "the mesh of --size-mesh");
  if (!has_extension(bounds.size_mesh, {".asc"}))
    read(fs::path(bounds.size_mesh).replace_extension(".sol").string(), "the sizes of --size-mesh");
}

void RunFiles::require_none_of(const std::vector<File>& others, const File& written) const {
  for (const File& other : others)
    if (are_same(written.name, other.name))
      throw UsageError({.code = Errc::bad_option,
                        .message = std::string(written.what) + " would replace " + other.what,
                        .file = written.name});
}

void RunFiles::require_own_report() const {
  for (const File& report : report_) {
    require_none_of(read_, report);
    if (!is_stream(report.name)) require_none_of(outputs_, report);
  }
}

void RunFiles::require_own_outputs() const {
  for (auto output = outputs_.begin(); output != outputs_.end(); ++output) {
    require_none_of(read_, *output);
    if (!is_stream(output->name)) require_none_of({outputs_.begin(), output}, *output);
  }
}

}  // namespace pgdr::tool
