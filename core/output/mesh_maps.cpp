// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "pgdr/mesh_maps.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

#include "output/face_groups.hpp"
#include "output/facet_parts.hpp"
#include "output/simplices.hpp"
#include "pgdr/error.hpp"

namespace pgdr {
namespace {

[[noreturn]] void refuse(const char* what) { throw UsageError({Errc::bad_option, what, {}, 0, {}, {}}); }

/// Pairs (list, number), in the order of the numbers.
using Pairs = std::vector<std::array<std::uint32_t, 2>>;

/// Turns pairs to lists, by counting: in linear time, and each list in the order of the pairs.
NumberLists lists_of(const Pairs& pairs, std::size_t lists) {
  NumberLists out;
  out.begin.assign(lists + 1, 0);
  for (const auto& [list, number] : pairs) ++out.begin[list + 1];
  for (std::size_t i = 1; i <= lists; ++i) out.begin[i] += out.begin[i - 1];
  out.numbers.resize(pairs.size());
  std::vector<std::uint32_t> next(out.begin.begin(), out.begin.end() - 1);
  for (const auto& [list, number] : pairs) out.numbers[next[list]++] = number;
  return out;
}

/// Both ways: the lists of `forward`, and for each of the numbers in them, of which there are so many, the lists that have it.
/// @param forward  by the numbers, and for one number by the lists
std::pair<NumberLists, NumberLists> both_ways(const Pairs& forward, std::size_t lists, std::size_t numbers) {
  Pairs back(forward);
  for (auto& [list, number] : back) std::swap(list, number);
  return {lists_of(forward, lists), lists_of(back, numbers)};
}

template <class Constraint, class Entities>
void require_entities(const std::vector<Constraint>& constraints, const Entities& entities) {
  for (const Constraint& c : constraints)
    if (c.entity >= entities.size()) refuse("a subsegment or subfacet of the mesh is of no segment or facet of this Domain");
}

/// The vertex of each point of the Domain, which are distinct. A mesh has them in their order, but for what was dropped, and
/// before all others.
template <int D>
std::vector<std::uint32_t> vertices_of_domain(const Domain<D>& domain, const OutputMesh<D>& mesh) {
  std::vector<std::uint32_t> vertices(domain.points().size(), dropped_point);
  std::uint32_t next = 0;
  for (std::size_t p = 0; p < vertices.size() && next < mesh.points.size(); ++p)
    if (mesh.points[next] == domain.points()[p]) vertices[p] = next++;
  if (next != mesh.input_points) refuse("the mesh was not made of this Domain: it has other input points");
  return vertices;
}

template <int D>
void map_points(const Domain<D>& domain, const OutputMesh<D>& mesh, InputMap<D>& out) {
  out.vertex_of_point = vertices_of_points(domain, mesh);
  Pairs pairs;
  pairs.reserve(out.vertex_of_point.size());
  for (std::uint32_t i = 0; i < out.vertex_of_point.size(); ++i)
    if (out.vertex_of_point[i] != dropped_point) pairs.push_back({out.vertex_of_point[i], i});
  out.points_of_vertex = lists_of(pairs, mesh.input_points);
}

/// Leaves the rows, of so many numbers each, whose number of a vertex is not dropped_point.
template <class Value>
void keep_rows(std::vector<Value>& values, const std::vector<std::uint32_t>& number) {
  const std::size_t columns = values.size() / number.size();
  for (std::size_t v = 0; v < number.size(); ++v)
    if (number[v] != dropped_point)
      std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(v * columns), columns,
                  values.begin() + static_cast<std::ptrdiff_t>(number[v] * columns));
  const auto kept = static_cast<std::size_t>(
      std::count_if(number.begin(), number.end(), [](auto n) { return n != dropped_point; }));
  values.resize(kept * columns);
}

template <int D>
void map_segments(const Domain<D>& domain, const OutputMesh<D>& mesh, InputMap<D>& out) {
  require_entities(mesh.subsegments, domain.segments());
  Pairs segments, facets;
  for (std::uint32_t i = 0; i < mesh.subsegments.size(); ++i)
    for (const SegmentOrigin& origin : domain.segment_origins(mesh.subsegments[i].entity))
      (origin.is_facet ? facets : segments).push_back({origin.index, i});
  std::tie(out.subsegments_of_segment, out.segments_of_subsegment) = both_ways(segments, domain.input_segments(),
                                                                               mesh.subsegments.size());
  if constexpr (D == 3) out.subsegments_of_facet = lists_of(facets, domain.input_facets());
}

void map_facets(const Domain<3>& domain, const OutputMesh<3>& mesh, InputMap<3>& out) {
  require_entities(mesh.subfacets, domain.facets());
  const detail::FacetParts parts(domain);
  const std::vector<std::uint32_t> part = parts.parts_of_subfacets(mesh);
  Pairs pairs;
  for (std::uint32_t i = 0; i < mesh.subfacets.size(); ++i)
    for (const std::uint32_t facet : parts.inputs(part[i])) pairs.push_back({facet, i});
  std::tie(out.subfacets_of_facet, out.facets_of_subfacet) = both_ways(pairs, domain.input_facets(), mesh.subfacets.size());
}

}  // namespace

template <int D>
std::vector<std::uint32_t> unused_points(const OutputMesh<D>& mesh) {
  std::vector<bool> used(mesh.points.size());
  each_simplex(mesh, [&](const auto& vertices) {
    for (const std::uint32_t v : vertices)
      if (v < used.size()) used[v] = true;
  });
  std::vector<std::uint32_t> unused;
  for (std::uint32_t v = 0; v < used.size(); ++v)
    if (!used[v]) unused.push_back(v);
  return unused;
}

template <int D>
void drop_points(OutputMesh<D>& mesh, std::span<const std::uint32_t> unused) {
  if (unused.empty()) return;
  std::vector<std::uint32_t> number(mesh.points.size());
  std::size_t dropped = 0;
  for (std::uint32_t v = 0; v < number.size(); ++v) {
    const bool drops = dropped < unused.size() && unused[dropped] == v;
    number[v] = drops ? dropped_point : static_cast<std::uint32_t>(v - dropped);
    dropped += drops;
  }
  mesh.input_points -= static_cast<std::size_t>(std::lower_bound(unused.begin(), unused.end(), mesh.input_points) -
                                                unused.begin());
  keep_rows(mesh.points, number);
  keep_rows(mesh.point_markers, number);
  keep_rows(mesh.point_attributes, number);
  each_simplex(mesh, [&](auto& vertices) {
    for (auto& v : vertices) v = number[v];
  });
}

template <int D>
std::vector<std::uint32_t> vertices_of_points(const Domain<D>& domain, const OutputMesh<D>& mesh) {
  const std::vector<std::uint32_t> of_domain = vertices_of_domain(domain, mesh);
  std::vector<std::uint32_t> vertices;
  vertices.reserve(domain.point_of_input().size());
  for (const std::uint32_t p : domain.point_of_input()) vertices.push_back(of_domain[p]);
  return vertices;
}

template <int D>
InputMap<D> input_map(const Domain<D>& domain, const OutputMesh<D>& mesh) {
  InputMap<D> out;
  map_points(domain, mesh, out);
  map_segments(domain, mesh, out);
  if constexpr (D == 3) map_facets(domain, mesh, out);
  return out;
}

template <int D>
std::vector<std::array<std::uint32_t, D + 1>> neighbors_of_cells(const OutputMesh<D>& mesh) {
  std::array<std::uint32_t, D + 1> alone;
  alone.fill(no_cell_beyond);
  std::vector<std::array<std::uint32_t, D + 1>> neighbors(mesh.cells.size(), alone);
  detail::each_face_group<D>(mesh, [&](std::uint32_t, std::span<const detail::CellFace<D>> group) {
    if (group.size() > 2) refuse("the mesh has a face with more than two cells");
    if (group.size() < 2) return;
    neighbors[group[0].cell()][group[0].corner()] = group[1].cell();
    neighbors[group[1].cell()][group[1].corner()] = group[0].cell();
  });
  return neighbors;
}

template PGDR_API std::vector<std::uint32_t> unused_points<2>(const OutputMesh<2>&);
template PGDR_API std::vector<std::uint32_t> unused_points<3>(const OutputMesh<3>&);
template PGDR_API void drop_points<2>(OutputMesh<2>&, std::span<const std::uint32_t>);
template PGDR_API void drop_points<3>(OutputMesh<3>&, std::span<const std::uint32_t>);
template PGDR_API std::vector<std::uint32_t> vertices_of_points<2>(const Domain<2>&, const OutputMesh<2>&);
template PGDR_API std::vector<std::uint32_t> vertices_of_points<3>(const Domain<3>&, const OutputMesh<3>&);
template PGDR_API InputMap<2> input_map<2>(const Domain<2>&, const OutputMesh<2>&);
template PGDR_API InputMap<3> input_map<3>(const Domain<3>&, const OutputMesh<3>&);
template PGDR_API std::vector<std::array<std::uint32_t, 3>> neighbors_of_cells<2>(const OutputMesh<2>&);
template PGDR_API std::vector<std::array<std::uint32_t, 4>> neighbors_of_cells<3>(const OutputMesh<3>&);

}  // namespace pgdr
