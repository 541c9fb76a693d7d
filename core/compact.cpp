// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "pgdr/compact.hpp"

#include <algorithm>
#include <tuple>

#include "pgdr/spatial_order.hpp"

namespace pgdr {
namespace {

constexpr std::uint32_t none = 0xffffffffu;

/// Number of each vertex in the output (by index(VertexId)); fills mesh.points.
template <int D>
std::vector<std::uint32_t> number_vertices(const Mesh<D>& mesh, const Domain<D>& domain, OutputMesh<D>& out) {
  std::vector<std::uint32_t> number(mesh.vertex_bound(), none);
  out.points.assign(domain.points().begin(), domain.points().end());
  out.input_points = out.points.size();
  struct Steiner {
    std::uint64_t key;
    std::uint32_t vertex;
  };
  const HilbertCurve<D> curve(domain.points());
  std::vector<Steiner> steiner;
  for (std::uint32_t i = 0; i < mesh.cell_bound(); ++i) {
    if (!mesh.alive(CellId{i})) continue;
    for (const VertexId v : mesh.cell(CellId{i}).vertices) {
      if (number[index(v)] != none) continue;
      const auto& record = mesh.vertex(v);
      number[index(v)] = record.home.id();
      if (record.home.kind() != EntityKind::vertex) {
        number[index(v)] = 0;
        steiner.push_back({curve.key(record.point), index(v)});
      }
    }
  }
  std::sort(steiner.begin(), steiner.end(), [&](const Steiner& a, const Steiner& b) {
    if (a.key != b.key) return a.key < b.key;
    return lex_less(mesh.point(VertexId{a.vertex}), mesh.point(VertexId{b.vertex}));
  });
  out.points.reserve(out.points.size() + steiner.size());
  for (const Steiner& s : steiner) {
    number[s.vertex] = static_cast<std::uint32_t>(out.points.size());
    out.points.push_back(mesh.point(VertexId{s.vertex}));
  }
  return number;
}

/// Sorts the numbers, but for the last two if that is what the orientation asks for.
template <std::size_t N>
std::array<std::uint32_t, N> canonical(std::array<std::uint32_t, N> v) {
  bool odd = false;
  for (std::size_t i = 1; i < N; ++i)
    for (std::size_t j = i; j > 0 && v[j] < v[j - 1]; --j) {
      std::swap(v[j], v[j - 1]);
      odd = !odd;
    }
  if (odd) std::swap(v[N - 2], v[N - 1]);
  return v;
}

template <int D>
void number_cells(const Mesh<D>& mesh, const std::vector<std::uint32_t>& vertex_number, Compacted<D>& out) {
  struct Cell {
    std::array<std::uint32_t, D + 1> vertices;
    std::uint32_t id;
  };
  // Bucketed by the smallest vertex, sorted within a bucket: the smallest is first, except in 2D triangles' last two.
  std::vector<std::uint32_t> begin(out.mesh.points.size() + 1, 0);
  auto numbers = [&](std::uint32_t i) {
    std::array<std::uint32_t, D + 1> v;
    for (int j = 0; j <= D; ++j) v[j] = vertex_number[index(mesh.cell(CellId{i}).vertices[j])];
    return canonical(v);
  };
  std::size_t count = 0;
  for (std::uint32_t i = 0; i < mesh.cell_bound(); ++i)
    if (mesh.alive(CellId{i})) {
      ++begin[numbers(i)[0] + 1];
      ++count;
    }
  for (std::size_t i = 1; i < begin.size(); ++i) begin[i] += begin[i - 1];
  std::vector<Cell> cells(count);
  auto place = begin;
  for (std::uint32_t i = 0; i < mesh.cell_bound(); ++i)
    if (mesh.alive(CellId{i})) {
      const auto v = numbers(i);
      cells[place[v[0]]++] = {v, i};
    }
  out.cell_number.assign(mesh.cell_bound(), none);
  out.mesh.cells.resize(count);
  for (std::size_t b = 0; b + 1 < begin.size(); ++b)
    std::sort(cells.begin() + begin[b], cells.begin() + begin[b + 1],
              [](const Cell& x, const Cell& y) { return x.vertices < y.vertices; });
  for (std::size_t i = 0; i < count; ++i) {
    out.mesh.cells[i] = cells[i].vertices;
    out.cell_number[cells[i].id] = static_cast<std::uint32_t>(i);
  }
}

/// Subsegments and subfacets, each once, sorted by their vertices; hull subfacets (subsegments) face outwards.
template <int D>
void collect_constraints(const Mesh<D>& mesh, const Domain<D>& domain, const std::vector<std::uint32_t>& number,
                         OutputMesh<D>& out) {
  auto by_vertices = [](const auto& a, const auto& b) { return a.vertices < b.vertices; };
  auto same = [](const auto& a, const auto& b) { return a.vertices == b.vertices; };
  for (std::uint32_t i = 0; i < mesh.cell_bound(); ++i) {
    const CellId c{i};
    if (!mesh.alive(c)) continue;
    const auto* k = mesh.constraints(c);
    if (!k) continue;
    const auto& cell = mesh.cell(c);
    for (int f = 0; f <= D; ++f) {
      if (!(k->faces >> f & 1)) continue;
      const bool hull = !cell.links[f];
      if (!hull && cell.links[f].cell() < c) continue;
      // The face of a positive cell opposite f, seen from outside, is counter-clockwise in this order.
      std::array<std::uint32_t, D> face;
      for (int j = 0, n = 0; j <= D; ++j)
        if (j != f) face[n++] = number[index(cell.vertices[j])];
      if constexpr (D == 3) {
        if (f % 2 == 1) std::swap(face[1], face[2]);
        if (!hull) std::sort(face.begin(), face.end());
        std::rotate(face.begin(), std::min_element(face.begin(), face.end()), face.end());
        out.subfacets.push_back({face, domain.facets()[k->face_entity[f]].marker});
      } else {
        if (f == 1) std::swap(face[0], face[1]);
        if (!hull) std::sort(face.begin(), face.end());
        out.subsegments.push_back({face, domain.segments()[k->face_entity[f]].marker});
      }
    }
    if constexpr (D == 3) {
      for (int e = 0; e < 6; ++e) {
        if (!(k->edges >> e & 1)) continue;
        auto a = number[index(cell.vertices[edge_ends[e][0]])], b = number[index(cell.vertices[edge_ends[e][1]])];
        out.subsegments.push_back({{std::min(a, b), std::max(a, b)}, domain.segments()[k->edge_entity[e]].marker});
      }
    }
  }
  std::sort(out.subsegments.begin(), out.subsegments.end(), by_vertices);
  out.subsegments.erase(std::unique(out.subsegments.begin(), out.subsegments.end(), same), out.subsegments.end());
  std::sort(out.subfacets.begin(), out.subfacets.end(), by_vertices);
}

}  // namespace

template <int D>
Compacted<D> compact(const Mesh<D>& mesh, const Domain<D>& domain, std::span<const double> region_attributes) {
  Compacted<D> out;
  const auto number = number_vertices<D>(mesh, domain, out.mesh);
  number_cells<D>(mesh, number, out);
  collect_constraints<D>(mesh, domain, number, out.mesh);
  const auto markers = domain.point_markers();
  if (!markers.empty()) {
    out.mesh.point_markers.assign(markers.begin(), markers.end());
    out.mesh.point_markers.resize(out.mesh.points.size(), 0);
  }
  if (!region_attributes.empty()) {
    out.mesh.regions.resize(out.mesh.cells.size());
    for (std::uint32_t i = 0; i < mesh.cell_bound(); ++i)
      if (out.cell_number[i] != none) out.mesh.regions[out.cell_number[i]] = region_attributes[mesh.region(CellId{i})];
  }
  return out;
}

template Compacted<2> compact<2>(const Mesh<2>&, const Domain<2>&, std::span<const double>);
template Compacted<3> compact<3>(const Mesh<3>&, const Domain<3>&, std::span<const double>);

}  // namespace pgdr
