// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "bounds.hpp"

#include <limits>
#include <string>
#include <utility>

#include "expression.hpp"
#include "files.hpp"
#include "pgdr/error.hpp"
#include "pgdr/io.hpp"

namespace pgdr::tool {

namespace {

template <int D>
SizingField<D> background_sizes(const std::filesystem::path& file, const BoundArguments& arguments) {
  if constexpr (D == 2) {
    if (has_extension(file.string(), {".asc"})) {
      SizeRaster raster = read_size_raster(file);
      return sizes_as_asked<2>(raster.mesh, std::move(raster.values), arguments);
    }
  }
  return sizes_as_asked<D>(read_mesh<D>(file), read_vertex_values(std::filesystem::path(file).replace_extension(".sol"), D),
                           arguments);
}

template <int D>
SizingField<D> sizes_at_lines(const std::filesystem::path& file, const BoundArguments& arguments) {
  constexpr double usual_growth = 0.2;  // as many mesh generators have it: gentle, and quickly coarse
  const SizeUnit unit = unit_of<D>(arguments);
  std::vector<std::array<Point<D>, 2>> lines;
  std::vector<double> sizes;
  for (const SizedLine<D>& line : read_sized_lines<D>(file)) {
    lines.push_back(line.ends);
    sizes.push_back(in_usual_unit<D>(line.size, unit));
  }
  return sizes_along<D>(lines, sizes, arguments.size_growth.value_or(usual_growth) * growth_of_unit<D>(unit));
}

}  // namespace

template <int D>
SizingField<D> sizes_as_asked(const OutputMesh<D>& mesh, std::vector<double> values, const BoundArguments& arguments) {
  const SizeUnit unit = unit_of<D>(arguments);
  for (double& value : values) value = in_usual_unit<D>(value, unit);
  if (values.size() == mesh.cells.size() && values.size() != mesh.points.size()) values = smallest_at_vertices<D>(mesh, values);
  if (arguments.size_growth) values = limit_growth<D>(mesh, values, *arguments.size_growth * growth_of_unit<D>(unit));
  return sizes_on_mesh<D>(mesh, values);
}

template <int D>
Bounds<D> resolve(const BoundArguments& arguments, double default_radius_edge) {
  const auto refuse = [](const char* sentence) { throw UsageError({.code = Errc::bad_option, .message = sentence}); };
  if (D == 2 && arguments.max_volume) refuse("--max-volume is for 3D; the area bound of a 2D mesh is --size");
  if (D == 3 && arguments.min_angle) refuse("--min-angle is for 2D; use --radius-edge in 3D");
  if (D == 2 && arguments.min_dihedral) refuse("--min-dihedral is for 3D; use --min-angle in 2D");

  if (arguments.size_growth && arguments.size_mesh.empty() && arguments.size_at.empty() && arguments.size_field.empty())
    refuse("--size-growth needs --size-mesh, --size-at or --size-field");
  if (arguments.size_unit == (D == 2 ? SizeUnit::volume : SizeUnit::area))
    refuse(D == 2 ? "--size-unit volume is for 3D; in 2D there is area" : "--size-unit area is for 2D; in 3D there is volume");

  Bounds<D> bounds{default_radius_edge, {}, {}, std::numeric_limits<double>::infinity(), arguments.min_dihedral, {}};
  if (arguments.radius_edge) bounds.radius_edge = *arguments.radius_edge;
  if (arguments.min_angle) bounds.radius_edge = min_angle_degrees(*arguments.min_angle);
  const SizeUnit unit = unit_of<D>(arguments);
  if (arguments.size) bounds.size = in_usual_unit<D>(parse_size<D>(*arguments.size, "--size"), unit);
  for (const std::string& text : arguments.region_sizes) {
    const auto [label, size] = split_region_size(text).value();
    SizingField<D> field = in_usual_unit<D>(parse_size<D>(size, "--region-size"), unit);
    if (const std::optional<double> number = label_number(label))
      bounds.region_sizes.push_back({*number, std::move(field)});
    else
      bounds.named_sizes.emplace_back(label, std::move(field));
  }
  if (!arguments.size_at.empty()) bounds.size = smallest<D>({bounds.size, sizes_at_lines<D>(arguments.size_at, arguments)});
  if (!arguments.size_mesh.empty()) bounds.size = smallest<D>({bounds.size, background_sizes<D>(arguments.size_mesh, arguments)});
  if (arguments.max_volume) bounds.max_volume = *arguments.max_volume;
  return bounds;
}

template <int D>
void resolve_names(const Names& names, Bounds<D>& bounds) {
  for (const auto& [wanted, size] : bounds.named_sizes) {
    bool is_there = false;
    std::string known;
    for (const auto& [label, name] : names.regions) {
      known += (known.empty() ? "" : ", ") + name;
      if (name != wanted) continue;
      bounds.region_sizes.push_back({label, size});
      is_there = true;
    }
    if (!is_there)
      throw UsageError({.code = Errc::bad_option,
                        .message = "--region-size: no region is called \"" + wanted + "\"; " +
                                   (known.empty() ? "none has a name" : "there are " + known)});
  }
  bounds.named_sizes.clear();
}

template void resolve_names<2>(const Names&, Bounds<2>&);
template void resolve_names<3>(const Names&, Bounds<3>&);
template SizingField<2> sizes_as_asked<2>(const OutputMesh<2>&, std::vector<double>, const BoundArguments&);
template SizingField<3> sizes_as_asked<3>(const OutputMesh<3>&, std::vector<double>, const BoundArguments&);
template Bounds<2> resolve<2>(const BoundArguments&, double);
template Bounds<3> resolve<3>(const BoundArguments&, double);

}  // namespace pgdr::tool
