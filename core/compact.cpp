// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "pgdr/compact.hpp"

#include <algorithm>
#include <atomic>
#include <memory>

#include "detail/bulk.hpp"
#include "pgdr/spatial_order.hpp"

namespace pgdr {
namespace {

constexpr std::uint32_t none = 0xffffffffu;

template <int D>
struct Vertices {
  std::vector<std::uint32_t> number;   ///< in the output, by index(VertexId)
  std::vector<std::uint32_t> steiner;  ///< index(VertexId) of the Steiner points, in the order of the output
};

template <int D>
Vertices<D> number_vertices(const Mesh<D>& mesh, const Domain<D>& domain, const detail::Bulk& bulk) {
  constexpr std::uint32_t used = 0;
  Vertices<D> out;
  std::vector<std::uint32_t>& number = out.number;
  number.assign(mesh.vertex_bound(), none);
  bulk.each(mesh.cell_bound(), [&](std::size_t i) {
    const CellId c{static_cast<std::uint32_t>(i)};
    if (!mesh.alive(c)) return;
    for (const VertexId v : mesh.cell(c).vertices) std::atomic_ref(number[index(v)]).store(used, std::memory_order_relaxed);
  });
  struct Steiner {
    std::uint64_t key;
    std::uint32_t vertex;
  };
  const HilbertCurve<D> curve(domain.points());
  auto steiner = bulk.gather<Steiner>(number.size(), [&](std::size_t i, std::vector<Steiner>& found) {
    if (number[i] == none) return;
    const auto& record = mesh.vertex(VertexId{static_cast<std::uint32_t>(i)});
    number[i] = record.home.id();
    if (record.home.kind() != EntityKind::vertex) found.push_back({curve.key(record.point), static_cast<std::uint32_t>(i)});
  });
  bulk.sort(steiner, [&](const Steiner& a, const Steiner& b) {
    if (a.key != b.key) return a.key < b.key;
    return lex_less(mesh.point(VertexId{a.vertex}), mesh.point(VertexId{b.vertex}));
  });
  out.steiner.resize(steiner.size());
  bulk.each(steiner.size(), [&](std::size_t i) {
    number[steiner[i].vertex] = static_cast<std::uint32_t>(domain.points().size() + i);
    out.steiner[i] = steiner[i].vertex;
  });
  return out;
}

template <int D>
void write_points(const Mesh<D>& mesh, const Domain<D>& domain, const Vertices<D>& vertices, const detail::Bulk& bulk,
                  OutputMesh<D>& out) {
  out.points.assign(domain.points().begin(), domain.points().end());
  out.input_points = out.points.size();
  out.points.resize(out.input_points + vertices.steiner.size());
  bulk.each(vertices.steiner.size(),
            [&](std::size_t i) { out.points[out.input_points + i] = mesh.point(VertexId{vertices.steiner[i]}); });
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

/// An array that is not written before it is used.
template <class T>
struct Array {
  explicit Array(std::size_t n) : items(new T[n]), size(n) {}
  T& operator[](std::size_t i) const { return items[i]; }
  std::unique_ptr<T[]> items;
  std::size_t size;
};

template <int D>
struct NumberedCell {
  std::array<std::uint32_t, D + 1> vertices;
  std::uint32_t id;
};

/// Reads and gives back the cells of the mesh, chunk by chunk.
template <int D>
Array<NumberedCell<D>> take_cells(Mesh<D>& mesh, const std::vector<std::uint32_t>& number, const detail::Bulk& bulk) {
  constexpr std::uint32_t size = Mesh<D>::cells_of_chunk;
  std::vector<std::size_t> begin((mesh.cell_bound() + size - 1) / size + 1, 0);
  auto each_cell = [&](std::size_t chunk, auto f) {
    const auto first = static_cast<std::uint32_t>(chunk * size);
    for (std::uint32_t i = first; i < std::min(mesh.cell_bound(), first + size); ++i)
      if (mesh.alive(CellId{i})) f(i);
  };
  bulk.parts(begin.size() - 1, [&](std::size_t chunk) { each_cell(chunk, [&](std::uint32_t) { ++begin[chunk + 1]; }); });
  for (std::size_t i = 1; i < begin.size(); ++i) begin[i] += begin[i - 1];
  Array<NumberedCell<D>> cells(begin.back());
  bulk.parts(begin.size() - 1, [&](std::size_t chunk) {
    std::size_t next = begin[chunk];
    each_cell(chunk, [&](std::uint32_t i) {
      std::array<std::uint32_t, D + 1> v;
      for (int j = 0; j <= D; ++j) v[j] = number[index(mesh.cell(CellId{i}).vertices[j])];
      cells[next++] = {canonical(v), i};
    });
    mesh.release_cells(static_cast<std::uint32_t>(chunk));
  });
  return cells;
}

template <int D>
void number_cells(Mesh<D>& mesh, const Vertices<D>& vertices, std::size_t points, const detail::Bulk& bulk,
                  Compacted<D>& out) {
  using Cell = NumberedCell<D>;
  const std::uint32_t bound = mesh.cell_bound();
  Array<Cell> taken = take_cells<D>(mesh, vertices.number, bulk);
  // Bucketed by the smallest vertex, sorted within a bucket: the smallest is first, except in 2D triangles' last two.
  std::vector<std::uint32_t> begin(points + 1, 0);
  auto next = [](std::uint32_t& counter) { return std::atomic_ref(counter).fetch_add(1, std::memory_order_relaxed); };
  bulk.each(taken.size, [&](std::size_t i) { next(begin[taken[i].vertices[0] + 1]); });
  for (std::size_t i = 1; i < begin.size(); ++i) begin[i] += begin[i - 1];
  const Array<Cell> cells(taken.size);
  {
    auto place = begin;
    bulk.each(taken.size, [&](std::size_t i) { cells[next(place[taken[i].vertices[0]])] = taken[i]; });
  }
  taken.items.reset();
  out.cell_number.assign(bound, none);
  out.mesh.cells.resize(cells.size);
  bulk.each(begin.size() - 1, [&](std::size_t b) {
    std::sort(&cells[begin[b]], &cells[begin[b]] + (begin[b + 1] - begin[b]),
              [](const Cell& x, const Cell& y) { return x.vertices < y.vertices; });
    for (std::uint32_t i = begin[b]; i < begin[b + 1]; ++i) {
      out.mesh.cells[i] = cells[i].vertices;
      out.cell_number[cells[i].id] = i;
    }
  });
}

/// A subsegment or subfacet by the ids of its vertices.
template <int K>
struct FoundConstraint {
  std::array<VertexId, K> vertices;
  bool on_hull;
  int marker;
};

/// Face f of a cell, counter-clockwise seen from outside.
template <int D>
std::array<VertexId, D> face_vertices(const CellRecord<D>& cell, int f) {
  std::array<VertexId, D> face;
  for (int j = 0, n = 0; j <= D; ++j)
    if (j != f) face[n++] = cell.vertices[j];
  if (D == 3 ? f % 2 == 1 : f == 1) std::swap(face[D - 2], face[D - 1]);
  return face;
}

/// The constrained faces, an inner one once.
template <int D>
std::vector<FoundConstraint<D>> find_faces(const Mesh<D>& mesh, const Domain<D>& domain, const detail::Bulk& bulk) {
  return bulk.gather<FoundConstraint<D>>(mesh.cell_bound(), [&](std::size_t i, auto& found) {
    const CellId c{static_cast<std::uint32_t>(i)};
    const auto* k = mesh.alive(c) ? mesh.constraints(c) : nullptr;
    if (!k) return;
    for (int f = 0; f <= D; ++f) {
      const Link beyond = mesh.cell(c).links[f];
      if (!(k->faces >> f & 1) || (beyond && beyond.cell() < c)) continue;
      const int marker = D == 3 ? domain.facets()[k->face_entity[f]].marker : domain.segments()[k->face_entity[f]].marker;
      found.push_back({face_vertices<D>(mesh.cell(c), f), !beyond, marker});
    }
  });
}

/// 3D: the subsegments, each as often as cells have it.
std::vector<FoundConstraint<2>> find_edges(const Mesh<3>& mesh, const Domain<3>& domain, const detail::Bulk& bulk) {
  return bulk.gather<FoundConstraint<2>>(mesh.cell_bound(), [&](std::size_t i, auto& found) {
    const CellId c{static_cast<std::uint32_t>(i)};
    const auto* k = mesh.alive(c) ? mesh.constraints(c) : nullptr;
    for (int e = 0; k && e < 6; ++e) {
      if (!(k->edges >> e & 1)) continue;
      const auto& v = mesh.cell(c).vertices;
      found.push_back({{v[edge_ends[e][0]], v[edge_ends[e][1]]}, false, domain.segments()[k->edge_entity[e]].marker});
    }
  });
}

/// By the numbers of their vertices, each once, sorted; those on the hull face outwards, the others are sorted themselves.
template <class Constraint, int K>
void number_constraints(const std::vector<FoundConstraint<K>>& found, const std::vector<std::uint32_t>& number,
                        const detail::Bulk& bulk, std::vector<Constraint>& out) {
  out.resize(found.size());
  bulk.each(found.size(), [&](std::size_t i) {
    auto& v = out[i].vertices;
    for (int j = 0; j < K; ++j) v[j] = number[index(found[i].vertices[j])];
    if (!found[i].on_hull) std::sort(v.begin(), v.end());
    if (K == 3) std::rotate(v.begin(), std::min_element(v.begin(), v.end()), v.end());
    out[i].marker = found[i].marker;
  });
  bulk.sort(out, [](const auto& a, const auto& b) { return a.vertices < b.vertices; });
  const auto last = std::unique(out.begin(), out.end(), [](const auto& a, const auto& b) { return a.vertices == b.vertices; });
  out.erase(last, out.end());
}

}  // namespace

template <int D>
Compacted<D> compact(Mesh<D>& mesh, const Domain<D>& domain, std::span<const double> region_attributes, bool parallel) {
  const detail::Bulk bulk(parallel);
  Compacted<D> out;
  const auto faces = find_faces<D>(mesh, domain, bulk);
  std::vector<FoundConstraint<2>> edges;
  if constexpr (D == 3) edges = find_edges(mesh, domain, bulk);
  mesh.release_constraints();
  if (region_attributes.empty()) mesh.release_labels();
  const Vertices<D> vertices = number_vertices<D>(mesh, domain, bulk);
  if constexpr (D == 3) {
    number_constraints(faces, vertices.number, bulk, out.mesh.subfacets);
    number_constraints(edges, vertices.number, bulk, out.mesh.subsegments);
  } else {
    number_constraints(faces, vertices.number, bulk, out.mesh.subsegments);
  }
  const std::uint32_t bound = mesh.cell_bound();
  number_cells<D>(mesh, vertices, domain.points().size() + vertices.steiner.size(), bulk, out);
  write_points<D>(mesh, domain, vertices, bulk, out.mesh);
  mesh.release_vertices();
  const auto markers = domain.point_markers();
  if (!markers.empty()) {
    out.mesh.point_markers.assign(markers.begin(), markers.end());
    out.mesh.point_markers.resize(out.mesh.points.size(), 0);
  }
  if (!region_attributes.empty()) {
    out.mesh.regions.resize(out.mesh.cells.size());
    bulk.each(bound, [&](std::size_t i) {
      if (out.cell_number[i] == none) return;
      out.mesh.regions[out.cell_number[i]] = region_attributes[mesh.region(CellId{static_cast<std::uint32_t>(i)})];
    });
  }
  return out;
}

template Compacted<2> compact<2>(Mesh<2>&, const Domain<2>&, std::span<const double>, bool);
template Compacted<3> compact<3>(Mesh<3>&, const Domain<3>&, std::span<const double>, bool);

}  // namespace pgdr
