// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <set>
#include <string>
#include <utility>

#include "io/field_formats.hpp"
#include "io/formats.hpp"
#include "pgdr/field_io.hpp"
#include "scan/line_scanner.hpp"

namespace pgdr {
namespace {

using Path = std::filesystem::path;

[[noreturn]] void refuse(const Path& file, const std::string& what) {
  throw UsageError({.code = Errc::bad_option, .message = what, .file = file.string()});
}

template <int D>
void require_fields(const OutputMesh<D>& mesh, const MeshFields& fields, const Path& file) {
  std::set<std::pair<bool, std::string>> names;
  for (const MeshField& field : fields) {
    const std::size_t rows = field.of_points ? mesh.points.size() : mesh.cells.size();
    if (field.name.empty()) refuse(file, "a field has no name");
    if (!names.emplace(field.of_points, field.name).second) refuse(file, "two fields are called " + field.name);
    if (field.components == 0 || field.values.size() != rows * field.components)
      refuse(file, "the field " + field.name + " has " + std::to_string(field.values.size()) + " values for " +
                       std::to_string(rows) + " rows of " + std::to_string(field.components));
  }
}

/// Values of points in the middles of edges, too: means of the ends, of whole numbers that of the first.
template <int D>
MeshFields with_middles(MeshFields fields, const detail::MidSides<D>& middles) {
  for (MeshField& field : fields) {
    if (!field.of_points) continue;
    for (const auto& [a, b] : middles.edges())
      for (std::size_t k = 0; k < field.components; ++k) {
        const double first = field.values[a * field.components + k], second = field.values[b * field.components + k];
        field.values.push_back(field.is_integer ? first : first / 2 + second / 2);
      }
  }
  return fields;
}

}  // namespace

bool has_room_for_fields(const Path& file) { return detail::lower_extension(file) == ".vtu"; }

std::vector<double> read_cell_bounds(const Path& file) {
  const std::string text = detail::read_whole_file(file);
  detail::LineScanner in(text, file.string());
  constexpr detail::Subject header{"the number of bounds"};
  in.require(header);
  std::vector<double> bounds(in.count(header, 4));
  std::int64_t first = 0;
  for (std::size_t i = 0; i < bounds.size(); ++i) {
    const detail::Subject bound{"bound", static_cast<std::int64_t>(i) + first};
    in.next_line(bound);
    const std::int64_t number = in.integer(bound);
    if (i == 0 && (number == 0 || number == 1)) first = number;
    if (number != static_cast<std::int64_t>(i) + first)
      in.fail(Errc::syntax, "cells are numbered one after the other, from 0 or 1");
    bounds[i] = in.number(bound);
  }
  if (in.advance()) in.fail(Errc::syntax, detail::quoted(in.word({})) + " stands behind the last bound");
  return bounds;
}

template <int D>
void write_mesh(const OutputMesh<D>& mesh, const MeshFields& fields, const Path& file, const WriteOptions& options) {
  require_fields(mesh, fields, file);
  if (fields.empty()) return write_mesh(mesh, file, options);
  if (!has_room_for_fields(file)) refuse(file, "fields are written to .vtu");
  detail::require_order(file, options);
  const detail::OfOrder<D> of_order(mesh, options);
  const detail::MidSides<D>* const middles = of_order.middles();
  detail::FileOutput out(file);
  detail::write_vtu_with_fields<D>(of_order.mesh(), middles ? with_middles<D>(fields, *middles) : fields, options.periodic,
                                   middles, out);
  out.commit();
}

template PGDR_API void write_mesh<2>(const OutputMesh<2>&, const MeshFields&, const Path&, const WriteOptions&);
template PGDR_API void write_mesh<3>(const OutputMesh<3>&, const MeshFields&, const Path&, const WriteOptions&);

}  // namespace pgdr
