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
#include "pgdr/size_fields.hpp"

namespace pgdr::tool {

namespace {

template <int D>
SizingField<D> background_sizes(const std::filesystem::path& file, std::optional<double> growth) {
  if constexpr (D == 2) {
    if (has_extension(file.string(), {".asc"})) {
      SizeRaster raster = read_size_raster(file);
      if (growth) raster.values = limit_growth<2>(raster.mesh, raster.values, *growth);
      return sizes_on_mesh<2>(raster.mesh, raster.values);
    }
  }
  const OutputMesh<D> mesh = read_mesh<D>(file);
  std::vector<double> values = read_vertex_values(std::filesystem::path(file).replace_extension(".sol"), D);
  if (growth) values = limit_growth<D>(mesh, values, *growth);
  return sizes_on_mesh<D>(mesh, values);
}

template <int D>
SizingField<D> sizes_at_lines(const std::filesystem::path& file, std::optional<double> growth) {
  constexpr double usual_growth = 0.2;  // as many mesh generators have it: gentle, and quickly coarse
  std::vector<std::array<Point<D>, 2>> lines;
  std::vector<double> sizes;
  for (const SizedLine<D>& line : read_sized_lines<D>(file)) {
    lines.push_back(line.ends);
    sizes.push_back(line.size);
  }
  return sizes_along<D>(lines, sizes, growth.value_or(usual_growth));
}

}  // namespace

template <int D>
Bounds<D> resolve(const BoundArguments& arguments, double default_radius_edge) {
  const auto refuse = [](const char* sentence) { throw UsageError({.code = Errc::bad_option, .message = sentence}); };
  if (D == 2 && arguments.max_volume) refuse("--max-volume is for 3D; the area bound of a 2D mesh is --size");
  if (D == 3 && arguments.min_angle) refuse("--min-angle is for 2D; use --radius-edge in 3D");
  if (D == 2 && arguments.min_dihedral) refuse("--min-dihedral is for 3D; use --min-angle in 2D");

  Bounds<D> bounds{default_radius_edge, {}, {}, std::numeric_limits<double>::infinity(), arguments.min_dihedral, {}};
  if (arguments.radius_edge) bounds.radius_edge = *arguments.radius_edge;
  if (arguments.min_angle) bounds.radius_edge = min_angle_degrees(*arguments.min_angle);
  if (arguments.size) bounds.size = parse_size<D>(*arguments.size, "--size");
  for (const std::string& text : arguments.region_sizes) {
    const auto [label, size] = split_region_size(text).value();
    SizingField<D> field = parse_size<D>(size, "--region-size");
    if (const std::optional<double> number = label_number(label))
      bounds.region_sizes.push_back({*number, std::move(field)});
    else
      bounds.named_sizes.emplace_back(label, std::move(field));
  }
  if (arguments.size_growth && arguments.size_mesh.empty() && arguments.size_at.empty())
    refuse("--size-growth needs --size-mesh or --size-at");
  if (!arguments.size_at.empty())
    bounds.size = smallest<D>({bounds.size, sizes_at_lines<D>(arguments.size_at, arguments.size_growth)});
  if (!arguments.size_mesh.empty())
    bounds.size = smallest<D>({bounds.size, background_sizes<D>(arguments.size_mesh, arguments.size_growth)});
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
template Bounds<2> resolve<2>(const BoundArguments&, double);
template Bounds<3> resolve<3>(const BoundArguments&, double);

}  // namespace pgdr::tool
