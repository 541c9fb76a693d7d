// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "old_mesh.hpp"

#include <array>
#include <set>
#include <utility>

#include "bounds.hpp"
#include "periodic.hpp"
#include "pgdr/error.hpp"
#include "pgdr/field_io.hpp"
#include "pgdr/transfer.hpp"

namespace pgdr::tool {
namespace {

[[noreturn]] void refuse_flag(const std::string& what) { throw UsageError({.code = Errc::bad_option, .message = what}); }

/// The markers that a text means: a number, or all that are called so.
template <int D>
std::set<int> markers_of(const OutputMesh<D>& mesh, const std::string& text) {
  std::set<int> markers;
  if (const std::optional<double> number = label_number(text); number && *number == static_cast<int>(*number))
    markers.insert(static_cast<int>(*number));
  for (const auto& [marker, name] : mesh.names.markers)
    if (name == text) markers.insert(marker);
  if (markers.empty()) refuse_flag("--required: no marker is called \"" + text + '"');
  return markers;
}

}  // namespace

template <int D>
OldMesh<D>::OldMesh(InputFile& file, bool with_fields) {
  if (with_fields) fields_ = file.read_fields();
  const StatedPeriods stated = periods_of<D>(file);
  mesh_ = file.read_mesh<D>();
  if (stated.pairs.empty()) return;
  Plc<D> points;
  points.points = mesh_.points;
  sides_ = stated_sides<D>(stated);
  if (const auto check = check_periodic(mesh_, sides_, stated, 2 * rounding_tolerance(points)); check.failure)
    throw UsageError(*check.failure);
}

/// A vertex has its own marker, and those of the subsegments and subfacets at it.
template <int D>
std::vector<std::uint8_t> OldMesh<D>::required(const std::vector<std::string>& markers) const {
  std::vector<std::uint8_t> required;
  for (const std::string& text : markers) {
    if (text == all_vertices) return std::vector<std::uint8_t>(mesh_.points.size(), 1);
    const std::set<int> wanted = markers_of(mesh_, text);
    required.resize(mesh_.points.size(), 0);
    bool is_any = false;
    const auto require = [&](const auto& vertices) {
      is_any = true;
      for (const std::uint32_t v : vertices) required[v] = 1;
    };
    for (std::uint32_t v = 0; v < mesh_.point_markers.size(); ++v)
      if (wanted.contains(mesh_.point_markers[v])) require(std::array{v});
    for (const auto& s : mesh_.subsegments)
      if (wanted.contains(s.marker)) require(s.vertices);
    for (const auto& f : mesh_.subfacets)
      if (wanted.contains(f.marker)) require(f.vertices);
    if (!is_any) refuse_flag("--required: nothing has the marker " + text);
  }
  return required;
}

template <int D>
const MeshField& OldMesh<D>::field(const std::string& name) const {
  std::string known;
  for (const MeshField& f : fields_) {
    if (f.name == name && f.components == 1) return f;
    known += (known.empty() ? "" : ", ") + f.name;
  }
  refuse_flag("--size-field: the file has no field of one number each that is called \"" + name + "\"; " +
              (known.empty() ? "it has none at all" : "it has " + known));
}

template <int D>
SizingField<D> OldMesh<D>::sizes(const BoundArguments& arguments) const {
  if (arguments.size_field.empty()) return SizingField<D>();
  const MeshField& f = field(arguments.size_field);
  return sizes_as_asked<D>(mesh_, f.of_points ? f.values : smallest_at_vertices<D>(mesh_, f.values), arguments);
}

template <int D>
SizingField<D> OldMesh<D>::sizes_of_cells(const std::string& file) const {
  if (file.empty()) return {};
  std::vector<double> bounds = read_cell_bounds(file);
  for (double& bound : bounds) bound = in_usual_unit<D>(bound, D == 2 ? SizeUnit::area : SizeUnit::volume);
  return sizes_in_cells<D>(mesh_, bounds);
}

template <int D>
Plc<D> OldMesh<D>::input(const MeshArguments& a) {
  RemeshInputOptions options;
  options.required = required(a.remesh->required);
  options.tolerance = a.reading.tolerance;
  options.is_coarse = a.reading.yes_coarse;
  options.keep_boundary = a.kept.any();
  options.keep_vertices = a.remesh->keep_vertices;
  WholeFacets<D> whole = remesh_input<D>(mesh_, options);
  facet_of_input_ = std::move(whole.facet_of_input);
  return std::move(whole.plc);
}

template <int D>
void OldMesh<D>::rename(std::vector<PoorReason>& reasons) const {
  name_given_facets(facet_of_input_, reasons);
}

template <int D>
MeshFields OldMesh<D>::transferred(const MeshArguments& a, OutputMesh<D>& to, std::vector<Diagnostic>& warnings) const {
  if (to.cells.empty()) return {};
  transfer_attributes<D>(mesh_, to);
  if (a.remesh->no_fields || fields_.empty()) return {};
  if (has_room_for_fields(a.output)) return transfer_fields<D>(mesh_, fields_, to);
  std::string names;
  for (const MeshField& f : fields_) names += (names.empty() ? "" : ", ") + f.name;
  warnings.push_back({.code = Errc::unknown_format,
                      .message = "fields are written to .vtu; these stay behind: " + names,
                      .file = a.output,
                      .ids = {},
                      .points = {}});
  return {};
}

template class OldMesh<2>;
template class OldMesh<3>;

}  // namespace pgdr::tool
