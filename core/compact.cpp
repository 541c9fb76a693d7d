// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "pgdr/compact.hpp"

#include <algorithm>
#include <atomic>
#include <type_traits>

#include "detail/bulk.hpp"
#include "pgdr/spatial_order.hpp"

namespace pgdr {
namespace {

constexpr std::uint32_t none = 0xffffffffu;

/// A block of slots, so many that a loop over it is much work.
constexpr std::uint32_t slots_a_part = 1 << 15;

template <int D>
void copy_input_points(const Domain<D>& domain, OutputMesh<D>& out) {
  out.points.assign(domain.points().begin(), domain.points().end());
  out.input_points = out.points.size();
}

/// Number of each vertex in the output (by index(VertexId)); fills mesh.points.
template <int D>
std::vector<std::uint32_t> number_vertices(const Mesh<D>& mesh, const Domain<D>& domain, const detail::Bulk& bulk,
                                           OutputMesh<D>& out) {
  constexpr std::uint32_t used = 0;
  std::vector<std::uint32_t> number(mesh.vertex_bound(), none);
  bulk.each(mesh.cell_bound(), [&](std::size_t i) {
    const CellId c{static_cast<std::uint32_t>(i)};
    if (!mesh.alive(c)) return;
    for (const VertexId v : mesh.cell(c).vertices) std::atomic_ref(number[index(v)]).store(used, std::memory_order_relaxed);
  });
  copy_input_points(domain, out);
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
  if (bulk.stopped()) return number;
  out.points.resize(out.input_points + steiner.size());
  bulk.each(steiner.size(), [&](std::size_t i) {
    number[steiner[i].vertex] = static_cast<std::uint32_t>(out.input_points + i);
    out.points[out.input_points + i] = mesh.point(VertexId{steiner[i].vertex});
  });
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
std::array<std::uint32_t, D + 1> numbers_of(const Mesh<D>& mesh, CellId c, const std::vector<std::uint32_t>& vertex_number) {
  std::array<std::uint32_t, D + 1> v;
  for (int j = 0; j <= D; ++j) v[j] = vertex_number[index(mesh.cell(c).vertices[j])];
  return v;
}

/// Bucketed by the smallest vertex, which is the first, and sorted within a bucket: in place, so that nothing but the result
/// takes memory for each cell.
template <int D>
void number_cells(const Mesh<D>& mesh, const detail::Bulk& bulk, Compacted<D>& out) {
  using Cell = std::array<std::uint32_t, D + 1>;
  std::vector<std::uint32_t>& begin = out.first_cell;
  begin.assign(out.mesh.points.size() + 1, 0);
  auto each_cell = [&](auto f) {
    bulk.each(mesh.cell_bound(), [&](std::size_t i) {
      if (const CellId c{static_cast<std::uint32_t>(i)}; mesh.alive(c)) f(numbers_of<D>(mesh, c, out.vertex_number));
    });
  };
  auto next = [&](std::uint32_t& counter) {
    return bulk.parallel() ? std::atomic_ref(counter).fetch_add(1, std::memory_order_relaxed) : counter++;
  };
  each_cell([&](const Cell& v) { next(begin[*std::min_element(v.begin(), v.end()) + 1]); });
  for (std::size_t i = 1; i < begin.size(); ++i) begin[i] += begin[i - 1];
  auto& cells = out.mesh.cells;
  cells.resize(begin.back());
  auto place = begin;
  each_cell([&](const Cell& v) {
    const Cell sorted = canonical(v);
    cells[next(place[sorted[0]])] = sorted;
  });
  // Within a bucket the first vertex is the same; the next two are compared as one number.
  auto less = [](const Cell& a, const Cell& b) {
    const std::uint64_t x = std::uint64_t{a[1]} << 32 | a[2], y = std::uint64_t{b[1]} << 32 | b[2];
    return x != y ? x < y : a[D] < b[D];
  };
  bulk.each(begin.size() - 1, [&](std::size_t b) { std::sort(cells.begin() + begin[b], cells.begin() + begin[b + 1], less); });
}

/// Vertices and cells in the order of their slots, in two passes over the cells.
template <int D>
void number_hastily(const Mesh<D>& mesh, const Domain<D>& domain, std::span<const double> region_attributes,
                    const detail::Bulk& bulk, Compacted<D>& out) {
  constexpr std::uint32_t used = 0;
  auto& number = out.vertex_number;
  number.assign(mesh.vertex_bound(), none);
  const std::size_t parts = mesh.cell_bound() / slots_a_part + 1;
  auto each_cell = [&](std::size_t part, auto f) {
    const auto first = static_cast<std::uint32_t>(part) * slots_a_part, last = std::min(mesh.cell_bound(), first + slots_a_part);
    for (std::uint32_t i = first; i < last; ++i)
      if (mesh.alive(CellId{i})) f(CellId{i});
  };
  std::vector<std::size_t> begin(parts + 1, 0);
  bulk.parts(parts, [&](std::size_t part) {
    std::size_t count = 0;
    each_cell(part, [&](CellId c) {
      ++count;
      for (const VertexId v : mesh.cell(c).vertices) std::atomic_ref(number[index(v)]).store(used, std::memory_order_relaxed);
    });
    begin[part + 1] = count;
  });
  for (std::size_t i = 0; i < parts; ++i) begin[i + 1] += begin[i];

  copy_input_points(domain, out.mesh);
  out.mesh.points.reserve(number.size());
  for (std::uint32_t i = 0; i < number.size(); ++i) {
    if (number[i] == none) continue;
    const auto& record = mesh.vertex(VertexId{i});
    number[i] = record.home.id();
    if (record.home.kind() == EntityKind::vertex) continue;
    number[i] = static_cast<std::uint32_t>(out.mesh.points.size());
    out.mesh.points.push_back(record.point);
  }

  out.mesh.cells.resize(begin.back());
  if (!region_attributes.empty()) out.mesh.regions.resize(begin.back());
  bulk.parts(parts, [&](std::size_t part) {
    std::size_t at = begin[part];
    each_cell(part, [&](CellId c) {
      out.mesh.cells[at] = numbers_of<D>(mesh, c, number);
      if (!region_attributes.empty()) out.mesh.regions[at] = region_attributes[mesh.region(c)];
      ++at;
    });
  });
}

/// The vertices of face f of a cell, counter-clockwise seen from outside where it is on the hull, else sorted.
template <int D>
std::array<std::uint32_t, D> face_vertices(const CellRecord<D>& cell, int f, const std::vector<std::uint32_t>& number) {
  std::array<std::uint32_t, D> face;
  for (int j = 0, n = 0; j <= D; ++j)
    if (j != f) face[n++] = number[index(cell.vertices[j])];
  if constexpr (D == 3) {
    if (f % 2 == 1) std::swap(face[1], face[2]);
    if (cell.links[f]) std::sort(face.begin(), face.end());
    std::rotate(face.begin(), std::min_element(face.begin(), face.end()), face.end());
  } else {
    if (f == 1) std::swap(face[0], face[1]);
    if (cell.links[f]) std::sort(face.begin(), face.end());
  }
  return face;
}

/// Subsegments and subfacets, each once, sorted by their vertices; hull subfacets (subsegments) face outwards.
template <int D>
void collect_constraints(const Mesh<D>& mesh, const Domain<D>& domain, const std::vector<std::uint32_t>& number,
                         const detail::Bulk& bulk, OutputMesh<D>& out) {
  auto by_vertices = [](const auto& a, const auto& b) { return a.vertices < b.vertices; };
  auto same = [](const auto& a, const auto& b) { return a.vertices == b.vertices; };
  auto each_face = [&](std::size_t i, auto f) {
    const CellId c{static_cast<std::uint32_t>(i)};
    const auto* k = mesh.constraints(c);  // few have any, which is asked first: it does not touch the cell itself
    if (!k || !mesh.alive(c)) return;
    for (int face = 0; face <= D; ++face)
      if ((k->faces >> face & 1) && !(mesh.cell(c).links[face] && mesh.cell(c).links[face].cell() < c))
        f(mesh.cell(c), face, k->face_entity[face]);
  };
  using Subsegment = typename std::decay_t<decltype(out.subsegments)>::value_type;
  if constexpr (D == 3) {
    using Subfacet = typename std::decay_t<decltype(out.subfacets)>::value_type;
    out.subfacets = bulk.gather<Subfacet>(mesh.cell_bound(), [&](std::size_t i, auto& found) {
      each_face(i, [&](const CellRecord<D>& cell, int f, EntityId facet) {
        found.push_back({face_vertices<D>(cell, f, number), domain.facets()[facet].marker});
      });
    });
    bulk.sort(out.subfacets, by_vertices);
    out.subsegments = bulk.gather<Subsegment>(mesh.cell_bound(), [&](std::size_t i, auto& found) {
      const CellId c{static_cast<std::uint32_t>(i)};
      const auto* k = mesh.constraints(c);
      if (!k || !mesh.alive(c)) return;
      for (int e = 0; e < 6; ++e) {
        if (!(k->edges >> e & 1)) continue;
        const auto& v = mesh.cell(c).vertices;
        const auto a = number[index(v[edge_ends[e][0]])], b = number[index(v[edge_ends[e][1]])];
        found.push_back({{std::min(a, b), std::max(a, b)}, domain.segments()[k->edge_entity[e]].marker});
      }
    });
  } else {
    out.subsegments = bulk.gather<Subsegment>(mesh.cell_bound(), [&](std::size_t i, auto& found) {
      each_face(i, [&](const CellRecord<D>& cell, int f, EntityId segment) {
        found.push_back({face_vertices<D>(cell, f, number), domain.segments()[segment].marker});
      });
    });
  }
  bulk.sort(out.subsegments, by_vertices);
  out.subsegments.erase(std::unique(out.subsegments.begin(), out.subsegments.end(), same), out.subsegments.end());
}

}  // namespace

template <int D>
Compacted<D> compact(const Mesh<D>& mesh, const Domain<D>& domain, std::span<const double> region_attributes, bool parallel,
                     std::stop_token stop, Numbering numbering) {
  const detail::Bulk bulk(parallel, std::move(stop));
  Compacted<D> out;
  if (numbering == Numbering::hasty) {
    number_hastily<D>(mesh, domain, region_attributes, bulk, out);
  } else {
    out.vertex_number = number_vertices<D>(mesh, domain, bulk, out.mesh);
    if (!bulk.stopped()) number_cells<D>(mesh, bulk, out);
  }
  if (bulk.stopped()) return {};
  collect_constraints<D>(mesh, domain, out.vertex_number, bulk, out.mesh);
  if (numbering == Numbering::canonical && !region_attributes.empty()) {
    out.mesh.regions.resize(out.mesh.cells.size());
    bulk.each(mesh.cell_bound(), [&](std::size_t i) {
      if (const CellId c{static_cast<std::uint32_t>(i)}; mesh.alive(c))
        out.mesh.regions[out.cell_number(mesh, c)] = region_attributes[mesh.region(c)];
    });
  }
  return out;
}

template <int D>
std::uint32_t Compacted<D>::cell_number(const Mesh<D>& refined, CellId c) const {
  const auto v = canonical(numbers_of<D>(refined, c, vertex_number));
  const auto first = mesh.cells.begin() + first_cell[v[0]], last = mesh.cells.begin() + first_cell[v[0] + 1];
  return static_cast<std::uint32_t>(std::lower_bound(first, last, v) - mesh.cells.begin());
}

template struct Compacted<2>;
template struct Compacted<3>;
template Compacted<2> compact<2>(const Mesh<2>&, const Domain<2>&, std::span<const double>, bool, std::stop_token,
                                   Numbering);
template Compacted<3> compact<3>(const Mesh<3>&, const Domain<3>&, std::span<const double>, bool, std::stop_token,
                                   Numbering);

}  // namespace pgdr
