// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Sizes on a background mesh.
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <string>

#include "output/interpolation.hpp"
#include "pgdr/size_fields.hpp"
#include "size/checks.hpp"

namespace pgdr {
namespace {

template <int D>
class MeshValues {
 public:
  MeshValues(const OutputMesh<D>& mesh, std::span<const double> values)
      : values_(values.begin(), values.end()), mesh_(mesh.points, mesh.cells) {
    if (mesh_.empty()) throw UsageError({Errc::bad_option, "the background mesh has no cell with a volume", {}, 0, {}, {}});
  }

  double at(const Point<D>& x) const {
    return mesh_.at(x).mean([this](std::uint32_t v) { return values_[v]; });
  }

 private:
  std::vector<double> values_;
  detail::MeshInterpolation<D> mesh_;
};

}  // namespace

template <int D>
std::vector<double> smallest_at_vertices(const OutputMesh<D>& mesh, std::span<const double> of_cells) {
  if (of_cells.size() != mesh.cells.size())
    throw UsageError({.code = Errc::bad_option,
                      .message = std::to_string(of_cells.size()) + " sizes for " + std::to_string(mesh.cells.size()) + " cells"});
  detail::require_indices<D>(mesh);
  detail::require_positive(of_cells, "cell");
  const double largest = of_cells.empty() ? 1 : std::ranges::max(of_cells);
  std::vector<double> values(mesh.points.size(), largest);
  for (std::size_t c = 0; c < of_cells.size(); ++c)
    for (const std::uint32_t v : mesh.cells[c]) values[v] = std::min(values[v], of_cells[c]);
  return values;
}

template <int D>
SizingField<D> sizes_on_mesh(const OutputMesh<D>& mesh, std::span<const double> values) {
  if (values.size() == mesh.cells.size() && values.size() != mesh.points.size())
    return sizes_on_mesh<D>(mesh, smallest_at_vertices<D>(mesh, values));
  detail::require_sizes<D>(mesh.points, values);
  detail::require_indices<D>(mesh);
  return [source = std::make_shared<const MeshValues<D>>(mesh, values)](const Point<D>& x) { return source->at(x); };
}

template <int D>
SizingField<D> sizes_in_cells(const OutputMesh<D>& mesh, std::span<const double> sizes) {
  if (sizes.size() != mesh.cells.size())
    throw UsageError({.code = Errc::bad_option,
                      .message = std::to_string(sizes.size()) + " sizes for " + std::to_string(mesh.cells.size()) + " cells"});
  detail::require_indices<D>(mesh);
  detail::require_sizes<D>(mesh.points, std::vector<double>(mesh.points.size(), 1));
  std::vector<double> bounds;
  for (std::size_t c = 0; c < sizes.size(); ++c) {
    if (std::isnan(sizes[c]))
      throw UsageError({.code = Errc::bad_size,
                        .message = "the size of cell " + std::to_string(c) + " is not a number",
                        .ids = {static_cast<std::int64_t>(c)}});
    bounds.push_back(sizes[c] > 0 ? sizes[c] : std::numeric_limits<double>::infinity());
  }
  struct Source {
    std::vector<double> bounds;
    detail::MeshInterpolation<D> mesh;
  };
  const auto source = std::make_shared<const Source>(
      Source{std::move(bounds), detail::MeshInterpolation<D>(mesh.points, mesh.cells)});
  if (source->mesh.empty()) throw UsageError({Errc::bad_option, "the mesh has no cell with a volume", {}, 0, {}, {}});
  return [source](const Point<D>& x) {
    const std::uint32_t c = source->mesh.cell_at(x);
    return c == detail::MeshInterpolation<D>::none ? std::numeric_limits<double>::infinity() : source->bounds[c];
  };
}

template PGDR_API SizingField<2> sizes_in_cells<2>(const OutputMesh<2>&, std::span<const double>);
template PGDR_API SizingField<3> sizes_in_cells<3>(const OutputMesh<3>&, std::span<const double>);
template PGDR_API std::vector<double> smallest_at_vertices<2>(const OutputMesh<2>&, std::span<const double>);
template PGDR_API std::vector<double> smallest_at_vertices<3>(const OutputMesh<3>&, std::span<const double>);
template PGDR_API SizingField<2> sizes_on_mesh<2>(const OutputMesh<2>&, std::span<const double>);
template PGDR_API SizingField<3> sizes_on_mesh<3>(const OutputMesh<3>&, std::span<const double>);

}  // namespace pgdr
