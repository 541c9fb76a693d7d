// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "pgdr/io.hpp"

#include <cctype>
#include <new>
#include <stdexcept>
#include <string>
#include <string_view>

#include "detail/file_input.hpp"
#include "detail/file_output.hpp"
#include "detail/io_formats.hpp"

namespace pgdr {
namespace {

std::string lower_extension(const std::filesystem::path& file) {
  std::string e = file.extension().string();
  for (char& c : e) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return e;
}

[[noreturn]] void unknown_format(const std::filesystem::path& file, const std::string& what) {
  const std::string message = "the extension '" + file.extension().string() + "' is not that of " + what;
  throw InputError(Diagnostic{Errc::unknown_format, message, file.string(), 0, {}, {}});
}

/// Runs `work`, and makes what the standard library throws for want of memory an error of ours.
template <class Work>
auto guarded(const std::filesystem::path& file, Work work) {
  const auto fail = [&file]() {
    return ResourceError(Diagnostic{Errc::out_of_memory, "out of memory", file.string(), 0, {}, {}});
  };
  try {
    return work();
  } catch (const std::bad_alloc&) {
    throw fail();
  } catch (const std::length_error&) {
    throw fail();
  }
}

}  // namespace

template <int D>
Plc<D> read_plc(const std::filesystem::path& file) {
  const std::string extension = lower_extension(file);
  using Reader = Plc<D> (*)(std::string_view, const std::filesystem::path&);
  Reader reader = nullptr;
  if (extension == ".poly") reader = detail::read_poly<D>;
  if (extension == ".node") reader = detail::read_node<D>;
  if constexpr (D == 3) {
    if (extension == ".smesh") reader = detail::read_smesh;
    if (extension == ".obj") reader = detail::read_obj;
    if (extension == ".off") reader = detail::read_off;
    if (extension == ".stl") reader = detail::read_stl;
  }
  if (reader == nullptr) unknown_format(file, "an input in " + std::to_string(D) + "D");
  return guarded(file, [&] { return reader(detail::read_whole_file(file), file); });
}

int file_dimension(const std::filesystem::path& file) {
  const std::string extension = lower_extension(file);
  using Reader = int (*)(std::string_view, const std::filesystem::path&);
  Reader reader = nullptr;
  if (extension == ".poly" || extension == ".node") reader = detail::node_dimension;
  if (extension == ".mesh") reader = detail::medit_dimension;
  if (extension == ".vtu") reader = detail::vtu_dimension;
  for (const std::string_view spatial : {".smesh", ".obj", ".off", ".stl"}) {
    if (extension == spatial) return 3;
  }
  if (reader == nullptr) unknown_format(file, "a file that is read");
  return guarded(file, [&] { return reader(detail::read_whole_file(file), file); });
}

template <int D>
OutputMesh<D> read_mesh(const std::filesystem::path& file) {
  const std::string extension = lower_extension(file);
  using Reader = OutputMesh<D> (*)(std::string_view, const std::filesystem::path&);
  Reader reader = nullptr;
  if (extension == ".mesh") reader = detail::read_medit<D>;
  if (extension == ".vtu") reader = detail::read_vtu<D>;
  if (reader == nullptr) unknown_format(file, "a mesh");
  return guarded(file, [&] { return reader(detail::read_whole_file(file), file); });
}

template <int D>
void write_mesh(const OutputMesh<D>& mesh, const std::filesystem::path& file) {
  const std::string extension = lower_extension(file);
  using Writer = void (*)(const OutputMesh<D>&, detail::FileOutput&);
  Writer writer = nullptr;
  if (extension == ".mesh") writer = detail::write_medit<D>;
  if (extension == ".vtu") writer = detail::write_vtu<D>;
  if (writer == nullptr) unknown_format(file, "a mesh that can be written");
  guarded(file, [&] {
    detail::FileOutput out(file);
    writer(mesh, out);
    out.commit();
  });
}

template PGDR_API Plc<2> read_plc<2>(const std::filesystem::path&);
template PGDR_API Plc<3> read_plc<3>(const std::filesystem::path&);
template PGDR_API OutputMesh<2> read_mesh<2>(const std::filesystem::path&);
template PGDR_API OutputMesh<3> read_mesh<3>(const std::filesystem::path&);
template PGDR_API void write_mesh<2>(const OutputMesh<2>&, const std::filesystem::path&);
template PGDR_API void write_mesh<3>(const OutputMesh<3>&, const std::filesystem::path&);

}  // namespace pgdr
