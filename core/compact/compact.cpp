// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "compact/compact.hpp"

#include <algorithm>
#include <atomic>
#include <bit>
#include <type_traits>
#include <utility>

#include "compact/canonical.hpp"
#include "compact/stripped_cells.hpp"
#include "space/bulk.hpp"
#include "space/spatial_order.hpp"

namespace pgdr {
namespace {

constexpr std::uint32_t none = 0xffffffffu;

/// A block of slots, so many that a loop over it is much work.
constexpr std::uint32_t slots_a_block = 1 << 15;

/// With room for so many more.
template <int D>
void copy_input_points(const Domain<D>& domain, std::size_t more, OutputMesh<D>& out) {
  out.points = detail::vector_of_capacity<Point<D>>(domain.points().size() + more);
  out.points.assign(domain.points().begin(), domain.points().end());
  out.input_points = out.points.size();
}

/// Number of each vertex in the output (by index(VertexId)); fills mesh.points.
template <int D>
std::vector<std::uint32_t> number_vertices(const Mesh<D>& mesh, const detail::StrippedCells<D>& cells, const Domain<D>& domain,
                                           const detail::Bulk& bulk, const std::stop_token& hurry, OutputMesh<D>& out) {
  constexpr std::uint32_t used = 0;
  auto number = detail::vector_of_capacity<std::uint32_t>(mesh.vertex_bound());
  number.resize(mesh.vertex_bound(), none);
  cells.each([&](const auto& cell, std::uint16_t) {
    for (const std::uint32_t v : cell) std::atomic_ref(number[v]).store(used, std::memory_order_relaxed);
  });
  struct Steiner {
    std::uint64_t key;
    std::uint32_t vertex;
  };
  const HilbertCurve<D> curve(domain.points());
  const auto record = [&](std::size_t i) -> const auto& { return mesh.vertex(VertexId{static_cast<std::uint32_t>(i)}); };
  auto steiner = bulk.collect<Steiner>(
      number.size(), [&](std::size_t i) { return number[i] != none && record(i).home.kind() != EntityKind::vertex; },
      [&](std::size_t i) {
        return Steiner{curve.key(record(i).point), static_cast<std::uint32_t>(i)};
      });
  bulk.each(number.size(), [&](std::size_t i) {
    if (number[i] != none) number[i] = record(i).home.id();
  });
  auto along_curve = [&](const Steiner& a, const Steiner& b) {
    if (a.key != b.key) return a.key < b.key;
    return lex_less(mesh.point(VertexId{a.vertex}), mesh.point(VertexId{b.vertex}));
  };
  if (!hurry.stop_requested()) bulk.sort(steiner, along_curve);
  if (bulk.stopped()) return number;
  copy_input_points(domain, steiner.size(), out);
  out.points.resize(out.input_points + steiner.size());
  bulk.each(steiner.size(), [&](std::size_t i) {
    number[steiner[i].vertex] = static_cast<std::uint32_t>(out.input_points + i);
    out.points[out.input_points + i] = mesh.point(VertexId{steiner[i].vertex});
  });
  return number;
}

/// Sorts cells whose first vertex is the same. Few, as most are, by their ranks, without branches that depend on the order.
template <std::size_t N>
void sort_few(std::array<std::uint32_t, N>* cells, std::size_t count) {
  using Cell = std::array<std::uint32_t, N>;
  constexpr std::size_t few = 16;
  const auto less = [](const Cell& a, const Cell& b) {
    const std::uint64_t x = std::uint64_t{a[1]} << 32 | a[2], y = std::uint64_t{b[1]} << 32 | b[2];
    return (x < y) | ((x == y) & (a[N - 1] < b[N - 1]));
  };
  if (count > few) return std::sort(cells, cells + count, less);
  std::array<Cell, few> unsorted;
  std::array<std::uint8_t, few> rank{};
  for (std::size_t i = 0; i < count; ++i) {
    unsorted[i] = cells[i];
    for (std::size_t j = 0; j < i; ++j) {
      const bool before = less(unsorted[i], unsorted[j]);
      rank[j] += before ? 1 : 0;
      rank[i] += before ? 0 : 1;
    }
  }
  for (std::size_t i = 0; i < count; ++i) cells[rank[i]] = unsorted[i];
}

/// Cells by their smallest vertex, which is the first: in buckets of so many vertices, then in each bucket. Threads share no
/// counter, and what is written at one time is as many streams as buckets, then one bucket.
template <int D>
class CellOrder {
 public:
  using Cell = std::array<std::uint32_t, D + 1>;

  CellOrder(const detail::StrippedCells<D>& stripped, std::size_t vertices, const detail::Bulk& bulk)
      : stripped_(&stripped),
        bulk_(&bulk),
        vertices_(vertices),
        shift_(static_cast<int>(std::bit_width(std::max<std::size_t>(vertices / most_buckets, fewest_vertices)))),
        buckets_((vertices >> shift_) + 1),
        begin_(stripped.block_count() * buckets_ + 1, 0) {}

  /// Gives the cells their numbers of vertices, in the memory of the stripped ones.
  void renumber(const std::vector<std::uint32_t>& number) {
    bulk_->parts(stripped_->block_count(), [&](std::size_t block) {
      for (Cell& cell : stripped_->block(block)) {
        Cell numbers;
        for (int j = 0; j <= D; ++j) numbers[j] = number[cell[j]];
        cell = detail::canonical(numbers);
        ++slot(block, cell);
      }
    });
    std::uint32_t all = 0;
    for (std::size_t bucket = 0; bucket < buckets_; ++bucket)
      for (std::size_t block = 0; block < stripped_->block_count(); ++block)
        all += std::exchange(begin_[block * buckets_ + bucket], all);
    begin_.back() = all;
  }
  /// How many cells there are.
  std::uint32_t size() const { return begin_.back(); }
  /// Moves them to `cells`, of their size, by buckets. What the counters say is lost but for where each bucket ends.
  void distribute(std::vector<Cell>& cells) {
    bulk_->parts(stripped_->block_count(), [&](std::size_t block) {
      for (const Cell& cell : stripped_->block(block)) cells[slot(block, cell)++] = cell;
    });
  }
  /// Sorts each bucket; `first_cell` has room for all vertices and one more, and is zero.
  void sort(std::vector<Cell>& cells, std::vector<std::uint32_t>& first_cell, const std::stop_token& hurry) const {
    bulk_->parts(size() == 0 ? 0 : buckets_, [&](std::size_t bucket) {
      const std::uint32_t begin = bucket == 0 ? 0 : end_of(bucket - 1), end = end_of(bucket);
      const std::vector<Cell> unsorted(cells.begin() + begin, cells.begin() + end);
      const std::size_t first = bucket << shift_, last = std::min(vertices_, (bucket + 1) << shift_);
      for (const Cell& cell : unsorted) ++first_cell[cell[0] + 1];
      std::uint32_t next = begin;  // from here on first_cell[v + 1] is where the next cell of v goes, at last that of v + 1
      for (std::size_t v = first; v < last; ++v) next += std::exchange(first_cell[v + 1], next);
      for (const Cell& cell : unsorted) cells[first_cell[cell[0] + 1]++] = cell;
      for (std::size_t v = first; v < last && !hurry.stop_requested(); ++v) {
        const std::uint32_t at = v == first ? begin : first_cell[v];
        sort_few(cells.data() + at, first_cell[v + 1] - at);
      }
    });
  }

 private:
  static constexpr std::size_t most_buckets = 512, fewest_vertices = 255;

  std::uint32_t& slot(std::size_t block, const Cell& cell) { return begin_[block * buckets_ + (cell[0] >> shift_)]; }
  std::uint32_t end_of(std::size_t bucket) const { return begin_[(stripped_->block_count() - 1) * buckets_ + bucket]; }

  const detail::StrippedCells<D>* stripped_;
  const detail::Bulk* bulk_;
  std::size_t vertices_;
  int shift_;  // of a vertex to its bucket
  std::size_t buckets_;
  std::vector<std::uint32_t> begin_;  // of the cells of each block in each bucket, blocks first; the number of all
};

/// By the smallest vertex, which is the first, and sorted among cells that have the same.
template <int D>
void number_cells(const detail::StrippedCells<D>& stripped, const detail::Bulk& bulk, const std::stop_token& hurry,
                  Compacted<D>& out) {
  CellOrder<D> order(stripped, out.mesh.points.size(), bulk);
  order.renumber(out.vertex_number);
  auto& cells = out.mesh.cells;
  cells = detail::vector_of_capacity<std::array<std::uint32_t, D + 1>>(order.size());
  cells.resize(order.size());
  order.distribute(cells);
  out.first_cell = detail::vector_of_capacity<std::uint32_t>(out.mesh.points.size() + 1);
  out.first_cell.resize(out.mesh.points.size() + 1, 0);
  order.sort(cells, out.first_cell, hurry);
}

/// Steiner points in the order of their slots, behind those of the input. `number`, by slot: those in use have another than none.
template <int D>
void number_vertices_by_slots(const Mesh<D>& mesh, const Domain<D>& domain, const detail::Bulk& bulk,
                              std::vector<std::uint32_t>& number, OutputMesh<D>& out) {
  const auto is_steiner = [&](std::size_t i) {
    return number[i] != none && mesh.vertex(VertexId{static_cast<std::uint32_t>(i)}).home.kind() != EntityKind::vertex;
  };
  const auto steiner = bulk.collect<std::uint32_t>(number.size(), is_steiner,
                                                   [](std::size_t i) { return static_cast<std::uint32_t>(i); });
  copy_input_points(domain, steiner.size(), out);
  out.points.resize(out.input_points + steiner.size());
  bulk.each(number.size(), [&](std::size_t i) {
    if (number[i] != none) number[i] = mesh.vertex(VertexId{static_cast<std::uint32_t>(i)}).home.id();
  });
  bulk.each(steiner.size(), [&](std::size_t i) {
    number[steiner[i]] = static_cast<std::uint32_t>(out.input_points + i);
    out.points[out.input_points + i] = mesh.point(VertexId{steiner[i]});
  });
}

/// Vertices and cells in the order of their slots, in two passes over the cells.
template <int D>
void number_by_slots(const Mesh<D>& mesh, const Domain<D>& domain, std::span<const double> region_attributes,
                     const detail::Bulk& bulk, Compacted<D>& out) {
  constexpr std::uint32_t used = 0;
  auto& number = out.vertex_number;
  number.assign(mesh.vertex_bound(), none);
  const std::size_t parts = mesh.cell_bound() / slots_a_block + 1;
  auto each_cell = [&](std::size_t part, auto f) {
    const auto first = static_cast<std::uint32_t>(part) * slots_a_block,
               last = std::min(mesh.cell_bound(), first + slots_a_block);
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

  number_vertices_by_slots(mesh, domain, bulk, number, out.mesh);
  out.mesh.cells.resize(begin.back());
  if (!region_attributes.empty()) out.mesh.regions.resize(begin.back());
  bulk.parts(parts, [&](std::size_t part) {
    std::size_t at = begin[part];
    each_cell(part, [&](CellId c) {
      auto& cell = out.mesh.cells[at];
      for (int j = 0; j <= D; ++j) cell[j] = number[index(mesh.cell(c).vertices[j])];
      cell = detail::canonical(cell);
      if (!region_attributes.empty()) out.mesh.regions[at] = region_attributes[mesh.region(c)];
      ++at;
    });
  });
}

template <int D>
std::uint32_t position_of(const Compacted<D>& out, const std::array<std::uint32_t, D + 1>& cell) {
  const auto begin = out.mesh.cells.begin(), last = begin + out.first_cell[cell[0] + 1];
  return static_cast<std::uint32_t>(std::lower_bound(begin + out.first_cell[cell[0]], last, cell) - begin);
}

/// A constrained face as a cell has it, and a constrained edge.
template <int D>
struct MarkedFaces {
  struct Face {
    std::array<VertexId, D> vertices;  ///< counter-clockwise seen from outside the cell
    EntityId entity;
    bool on_hull;
  };
  struct Edge {
    std::array<VertexId, 2> vertices;
    EntityId entity;
  };
  std::vector<Face> faces;  ///< each once
  std::vector<Edge> edges;  ///< 3D: subsegments, from every cell that has them
};

template <int D>
MarkedFaces<D> gather_constraints(const Mesh<D>& mesh, const detail::Bulk& bulk) {
  using Face = typename MarkedFaces<D>::Face;
  using Edge = typename MarkedFaces<D>::Edge;
  // Few cells have constraints: those that are dead are asked last.
  const auto constrained = bulk.gather<CellId>(mesh.cell_bound(), [&](std::size_t i, std::vector<CellId>& cells) {
    const CellId c{static_cast<std::uint32_t>(i)};
    if (mesh.constraints(c) && mesh.alive(c)) cells.push_back(c);
  });
  MarkedFaces<D> found;
  found.faces = bulk.gather<Face>(constrained.size(), [&](std::size_t i, std::vector<Face>& faces) {
    const CellId c = constrained[i];
    const auto* k = mesh.constraints(c);
    for (int f = 0; f <= D; ++f) {
      const Link beyond = mesh.cell(c).links[f];
      if (k->has_face(f) && !(beyond && beyond.cell() < c))
        faces.push_back({detail::face_vertices<D>(mesh.cell(c), f), k->face_entity[f], !beyond});
    }
  });
  if constexpr (D == 3)
    found.edges = bulk.gather<Edge>(constrained.size(), [&](std::size_t i, std::vector<Edge>& edges) {
      const auto* k = mesh.constraints(constrained[i]);
      const auto& v = mesh.cell(constrained[i]).vertices;
      for (int e = 0; e < 6; ++e)
        if (k->has_edge(e)) edges.push_back({ends_of_edge(v, e), k->edge_entity[e]});
    });
  return found;
}

/// Subsegments and subfacets, each once, sorted by their vertices; hull subfacets (subsegments) face outwards.
template <int D>
void number_constraints(const MarkedFaces<D>& found, const Domain<D>& domain, const std::vector<std::uint32_t>& number,
                        const detail::Bulk& bulk, OutputMesh<D>& out) {
  auto numbered = [&]<std::size_t N>(const std::array<VertexId, N>& v) {
    std::array<std::uint32_t, N> n;
    for (std::size_t j = 0; j < N; ++j) n[j] = number[index(v[j])];
    return n;
  };
  auto number_faces = [&](auto& constraints, const auto& entities) {
    constraints.resize(found.faces.size());
    bulk.each(constraints.size(), [&](std::size_t i) {
      const auto& f = found.faces[i];
      constraints[i] = {detail::canonical_face(numbered(f.vertices), f.on_hull), entities[f.entity].marker, f.entity};
    });
  };
  auto by_vertices = [](const auto& a, const auto& b) { return a.vertices < b.vertices; };
  if constexpr (D == 3) {
    number_faces(out.subfacets, domain.facets());
    bulk.sort(out.subfacets, by_vertices);
    auto edges = decltype(out.subsegments)(found.edges.size());
    bulk.each(edges.size(), [&](std::size_t i) {
      auto v = numbered(found.edges[i].vertices);
      std::sort(v.begin(), v.end());
      edges[i] = {v, domain.segments()[found.edges[i].entity].marker, found.edges[i].entity};
    });
    bulk.sort(edges, by_vertices);
    using Edge = typename decltype(edges)::value_type;
    out.subsegments = bulk.collect<Edge>(
        edges.size(), [&](std::size_t i) { return i == 0 || edges[i].vertices != edges[i - 1].vertices; },
        [&](std::size_t i) { return edges[i]; });
  } else {
    number_faces(out.subsegments, domain.segments());
    bulk.sort(out.subsegments, by_vertices);
  }
}

}  // namespace

template <int D>
Compacted<D> compact(Mesh<D>&& mesh, const Domain<D>& domain, std::span<const double> region_attributes,
                     const detail::Pieces& pieces, std::stop_token stop, const FillPoints<D>& fill, std::stop_token hurry) {
  if (!region_attributes.empty()) hurry = {};  // cells are looked up to label them
  const detail::Bulk bulk(pieces, std::move(stop));
  Compacted<D> out;
  const MarkedFaces<D> constraints = gather_constraints<D>(mesh, bulk);
  const detail::StrippedCells<D> stripped(mesh, bulk, !region_attributes.empty());
  if (bulk.stopped()) return {};
  out.vertex_number = number_vertices<D>(mesh, stripped, domain, bulk, hurry, out.mesh);
  if (fill && !bulk.stopped()) fill(mesh, out);
  mesh.discard_vertices();
  if (!bulk.stopped()) number_cells<D>(stripped, bulk, hurry, out);
  if (bulk.stopped()) return {};
  number_constraints<D>(constraints, domain, out.vertex_number, bulk, out.mesh);
  if (!region_attributes.empty()) {
    out.mesh.regions.resize(out.mesh.cells.size());
    stripped.each(
        [&](const auto& cell, std::uint16_t region) { out.mesh.regions[position_of<D>(out, cell)] = region_attributes[region]; });
  }
  return out;
}

template <int D>
Compacted<D> compact_by_slots(const Mesh<D>& mesh, const Domain<D>& domain, std::span<const double> region_attributes,
                              const detail::Pieces& pieces, const FillPoints<D>& fill) {
  const detail::Bulk bulk(pieces);
  Compacted<D> out;
  number_by_slots<D>(mesh, domain, region_attributes, bulk, out);
  if (fill) fill(mesh, out);
  number_constraints<D>(gather_constraints<D>(mesh, bulk), domain, out.vertex_number, bulk, out.mesh);
  return out;
}

template <int D>
std::uint32_t Compacted<D>::cell_number(const std::array<VertexId, D + 1>& vertices) const {
  std::array<std::uint32_t, D + 1> v;
  for (int j = 0; j <= D; ++j) v[j] = vertex_number[index(vertices[j])];
  return position_of<D>(*this, detail::canonical(v));
}

template struct Compacted<2>;
template struct Compacted<3>;
template Compacted<2> compact<2>(Mesh<2>&&, const Domain<2>&, std::span<const double>, const detail::Pieces&, std::stop_token,
                                 const FillPoints<2>&, std::stop_token);
template Compacted<3> compact<3>(Mesh<3>&&, const Domain<3>&, std::span<const double>, const detail::Pieces&, std::stop_token,
                                 const FillPoints<3>&, std::stop_token);
template Compacted<2> compact_by_slots<2>(const Mesh<2>&, const Domain<2>&, std::span<const double>, const detail::Pieces&,
                                          const FillPoints<2>&);
template Compacted<3> compact_by_slots<3>(const Mesh<3>&, const Domain<3>&, std::span<const double>, const detail::Pieces&,
                                          const FillPoints<3>&);

}  // namespace pgdr
