// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Vertices are sorted by samples: each rank gets those of a stretch of the curve, from all ranks that have them, numbers them,
// and sends the numbers back. Then cells and constraints go to the rank of the range of their first vertex, are sorted there, and
// are shared out by rows; at last each rank asks for the points that its rows have.
#include "ranks/numbering.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <numeric>
#include <tuple>
#include <utility>
#include <variant>

#include "compact/canonical.hpp"
#include "compact/stripped_cells.hpp"
#include "ranks/exchange.hpp"
#include "ranks/vertex_numbering.hpp"
#include "space/bulk.hpp"

namespace pgdr::detail {
namespace {

/// A subfacet or subsegment by the numbers of its vertices.
template <std::size_t N>
struct Numbered {
  std::array<Number, N> vertices;
  EntityId label;
};

/// A cell by the numbers of its vertices, in canonical order. N: an unsigned type that has all numbers.
template <int D, class N>
struct CellRow {
  std::array<N, D + 1> vertices;
  std::uint32_t label;  ///< the number of its region
};

/// The rows by the ranks in whose part of the points their first vertices are.
template <class Row>
std::vector<std::vector<Row>> rows_for_ranks(const Collectives& ranks, const std::vector<Row>& rows, Number points) {
  std::vector<std::vector<Row>> to_each(static_cast<std::size_t>(ranks.size()));
  for (const Row& row : rows)
    to_each[static_cast<std::size_t>(part_of_row(row.vertices[0], points, ranks.size()))].push_back(row);
  return to_each;
}

/// Sorts by vertices what ranks have for each, after `tidy`, which may take some out, has seen all with the same first vertex
/// together.
/// @returns the rows of this rank's part, and how many there are on all
template <class Row, class Tidy>
std::pair<std::vector<Row>, Number> sort_rows(Collectives& ranks, const Bulk& bulk, std::vector<std::vector<Row>> to_each,
                                              const Tidy& tidy) {
  std::vector<Row> rows = exchange_joined(ranks, std::move(to_each));
  bulk.sort(rows, [](const Row& a, const Row& b) { return a.vertices < b.vertices; });
  tidy(rows);
  const std::uint64_t count = rows.size(), first = ranks.exclusive_sum(count), all = ranks.sum(count);
  return {share_rows(ranks, std::move(rows), first, all), all};
}
constexpr auto as_they_are = [](const auto&) {};

/// A constraint of a cell of this rank.
template <std::size_t N>
struct OwnConstraint {
  std::array<VertexId, N> vertices;
  EntityId entity;
};

template <int D>
class RankNumbering {
 public:
  RankNumbering(Collectives& ranks, Mesh<D>& mesh, const Domain<D>& domain, const Bulk& bulk, bool drop)
      : ranks_(ranks), mesh_(mesh), domain_(domain), bulk_(bulk), drop_(drop), vertices_(ranks, mesh, domain, bulk, drop) {}

  MeshPiece<D> run(const IsOwnCell& is_own, std::span<const double> region_attributes, const PointData<D>& data,
                   const Pieces& pieces, Number most_narrow) {
    collect_constraints(is_own);
    StrippedCells<D> own(mesh_, bulk_, !region_attributes.empty(), is_own);
    vertices_.run(own);
    mesh_.discard_vertices();
    piece_.total.input_points = vertices_.input_points();
    piece_.total.points = vertices_.points();
    if (vertices_.points() <= most_narrow)
      number_cells<std::uint32_t>(own, region_attributes);
    else
      number_cells<std::uint64_t>(own, region_attributes);
    number_faces();
    if constexpr (D == 3) number_edges();
    take_own_points(data, pieces);
    fetch_points();
    return std::move(piece_);
  }
  const std::vector<std::uint32_t>& unused() const { return vertices_.unused(); }

 private:
  using Face = Numbered<D>;
  using Edge = Numbered<2>;

  template <std::size_t N>
  std::array<Number, N> numbered(const std::array<VertexId, N>& v) const {
    std::array<Number, N> n;
    for (std::size_t j = 0; j < N; ++j) n[j] = vertices_.numbers()[index(v[j])];
    return n;
  }

  /// The constraints of the rank's own cells: afterwards the cells themselves are not needed.
  void collect_constraints(const IsOwnCell& is_own) {
    for (std::uint32_t i = 0; i < mesh_.cell_bound(); ++i) {
      const CellId c{i};
      const auto* k = mesh_.constraints(c);
      if (!k || !mesh_.alive(c) || !is_own(c)) continue;
      for (int f = 0; f <= D; ++f)
        if (k->has_face(f)) own_faces_.push_back({face_vertices<D>(mesh_.cell(c), f), k->face_entity[f]});
      if constexpr (D == 3)
        for (int e = 0; e < 6; ++e)
          if (k->has_edge(e)) own_edges_.push_back({ends_of_edge(mesh_.cell(c).vertices, e), k->edge_entity[e]});
    }
  }

  /// N: wide enough for all numbers of points. The memory of a block of the mesh is given back once its cells are rows.
  template <class N>
  void number_cells(StrippedCells<D>& own, std::span<const double> region_attributes) {
    std::vector<std::vector<CellRow<D, N>>> to_each(static_cast<std::size_t>(ranks_.size()));
    const auto rank_of = [&](Number first) {
      return static_cast<std::size_t>(part_of_row(first, vertices_.points(), ranks_.size()));
    };
    std::vector<std::size_t> counts(to_each.size());
    for (std::size_t block = 0; block < own.block_count(); ++block)
      for (const auto& cell : own.block(block)) {
        Number first = vertices_.numbers()[cell[0]];
        for (const std::uint32_t v : cell) first = std::min(first, vertices_.numbers()[v]);
        ++counts[rank_of(first)];
      }
    for (std::size_t q = 0; q < counts.size(); ++q) to_each[q].reserve(counts[q]);
    for (std::size_t block = 0; block < own.block_count(); ++block) {
      const auto regions = own.regions(block);
      std::size_t i = 0;
      for (const auto& cell : own.block(block)) {
        CellRow<D, N> row{{}, regions.empty() ? 0u : regions[i++]};
        for (std::size_t j = 0; j <= D; ++j) row.vertices[j] = static_cast<N>(vertices_.numbers()[cell[j]]);
        row.vertices = canonical(row.vertices);
        to_each[rank_of(row.vertices[0])].push_back(row);
      }
      own.discard(mesh_, block);
    }
    auto [rows, total] = sort_rows(ranks_, bulk_, std::move(to_each), as_they_are);
    piece_.total.cells = total;
    piece_.first_cell = RowRange(total, ranks_).first;
    piece_.total.regions = !region_attributes.empty() && total > 0;
    if (piece_.total.regions)
      for (const auto& c : rows) piece_.mesh.regions.push_back(region_attributes[c.label]);
    cells_ = std::move(rows);
  }

  /// Constrained faces come from the cells on both sides, or from one, which is on the hull.
  void number_faces() {
    std::vector<std::vector<Face>> to_each(static_cast<std::size_t>(ranks_.size()));
    for (const OwnConstraint<D>& own : own_faces_) {
      const Face face{numbered(own.vertices), own.entity};
      const Number least = *std::min_element(face.vertices.begin(), face.vertices.end());
      to_each[static_cast<std::size_t>(part_of_row(least, vertices_.points(), ranks_.size()))].push_back(face);
    }
    std::vector<Face> sides = exchange_joined(ranks_, std::move(to_each)), faces;
    const auto sorted = [](const Face& f) { return canonical_face(f.vertices, false); };
    bulk_.sort(sides, [&](const Face& a, const Face& b) { return sorted(a) < sorted(b); });
    for (std::size_t i = 0; i < sides.size(); ++i) {
      const bool on_hull = i + 1 == sides.size() || sorted(sides[i]) != sorted(sides[i + 1]);
      faces.push_back({canonical_face(sides[i].vertices, on_hull), sides[i].label});
      if (!on_hull) ++i;
    }
    auto [first, total] = D == 3 ? std::tie(piece_.first_subfacet, piece_.total.subfacets)
                                 : std::tie(piece_.first_subsegment, piece_.total.subsegments);
    std::tie(faces_, total) = sort_rows(ranks_, bulk_, rows_for_ranks(ranks_, faces, vertices_.points()), as_they_are);
    first = RowRange(total, ranks_).first;
  }

  /// 3D: subsegments, which come from every cell at them.
  void number_edges() {
    std::vector<Edge> edges;
    for (const OwnConstraint<2>& own : own_edges_) {
      auto v = numbered(own.vertices);
      std::sort(v.begin(), v.end());
      edges.push_back({v, own.entity});
    }
    const auto same = [](const Edge& a, const Edge& b) { return a.vertices == b.vertices; };
    const auto once = [&](std::vector<Edge>& rows) { rows.erase(std::unique(rows.begin(), rows.end(), same), rows.end()); };
    std::tie(edges_, piece_.total.subsegments) = sort_rows(ranks_, bulk_, rows_for_ranks(ranks_, edges, vertices_.points()),
                                                           once);
    piece_.first_subsegment = RowRange(piece_.total.subsegments, ranks_).first;
  }

  /// The points of the Domain that the mesh has.
  std::vector<std::uint32_t> kept_points() const {
    std::vector<std::uint32_t> all(domain_.points().size()), kept;
    std::iota(all.begin(), all.end(), 0u);
    if (!drop_) return all;
    std::set_difference(all.begin(), all.end(), unused().begin(), unused().end(), std::back_inserter(kept));
    return kept;
  }

  /// The rows of points of this rank, with their data.
  void take_own_points(const PointData<D>& data, const Pieces& pieces) {
    const RowRange rows(vertices_.points(), ranks_);
    piece_.first_point = rows.first;
    piece_.own_points = rows.count;
    std::vector<VertexRecord<D>> records;
    records.reserve(static_cast<std::size_t>(rows.count));
    const std::vector<std::uint32_t> kept = kept_points();
    for (Number row = rows.first; row < std::min(rows.first + rows.count, piece_.total.input_points); ++row)
      records.push_back({domain_.points()[kept[row]], Home(EntityKind::vertex, kept[row])});
    for (const Placed<D>& v : share_rows(ranks_, vertices_.take_stretch(), vertices_.first_of_stretch(), vertices_.points()))
      records.push_back({v.point, v.home});
    data.fill_rows(records, own_points_, pieces);
    own_points_.points.reserve(records.size());
    for (const VertexRecord<D>& v : records) own_points_.points.push_back(v.point);
    piece_.total.point_markers = piece_.total.points > 0;
    piece_.total.attributes_per_point = domain_.attributes_per_point();
  }

  /// The numbers of the points that the rows of the piece have, ascending, and those of its own rows.
  void list_points() {
    std::vector<Number>& numbers = piece_.point_numbers;
    const auto add = [&](const auto& rows) {
      for (const auto& row : rows)
        for (const Number v : row.vertices)
          if (!is_own(v)) numbers.push_back(v);
    };
    std::visit(add, cells_);
    add(faces_);
    add(edges_);
    bulk_.sort(numbers, std::less<>());
    numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
    own_begin_ = static_cast<std::size_t>(std::lower_bound(numbers.begin(), numbers.end(), piece_.first_point) - numbers.begin());
    std::vector<Number> own(static_cast<std::size_t>(piece_.own_points));
    for (std::size_t i = 0; i < own.size(); ++i) own[i] = piece_.first_point + i;
    numbers.insert(numbers.begin() + static_cast<std::ptrdiff_t>(own_begin_), own.begin(), own.end());
  }

  void fetch_points() {
    list_points();
    const std::vector<Number>& numbers = piece_.point_numbers;
    std::vector<std::vector<Number>> wanted(static_cast<std::size_t>(ranks_.size()));
    for (const Number p : numbers)
      if (!is_own(p)) wanted[static_cast<std::size_t>(part_of_row(p, piece_.total.points, ranks_.size()))].push_back(p);
    const auto columns = static_cast<std::size_t>(piece_.total.attributes_per_point);
    std::vector<std::vector<Point<D>>> points;
    std::vector<std::vector<int>> markers;
    std::vector<std::vector<double>> attributes;
    for (const std::vector<Number>& of_rank : exchange_lists(ranks_, std::move(wanted))) {
      auto& p = points.emplace_back();
      auto& m = markers.emplace_back();
      auto& a = attributes.emplace_back();
      for (const Number number : of_rank) {
        const auto i = static_cast<std::size_t>(number - piece_.first_point);
        p.push_back(own_points_.points.at(i));
        m.push_back(own_points_.point_markers[i]);
        for (std::size_t k = 0; k < columns; ++k) a.push_back(own_points_.point_attributes[i * columns + k]);
      }
    }
    const auto own = static_cast<std::size_t>(ranks_.rank());
    points[own] = std::move(own_points_.points);
    markers[own] = std::move(own_points_.point_markers);
    attributes[own] = std::move(own_points_.point_attributes);
    piece_.mesh.points = exchange_joined(ranks_, std::move(points));
    piece_.mesh.point_markers = exchange_joined(ranks_, std::move(markers));
    piece_.mesh.point_attributes = exchange_joined(ranks_, std::move(attributes));
    piece_.mesh.input_points = static_cast<std::size_t>(
        std::lower_bound(numbers.begin(), numbers.end(), piece_.total.input_points) - numbers.begin());
    take_rows();
  }

  bool is_own(Number v) const { return v - piece_.first_point < piece_.own_points; }
  std::uint32_t place_of(Number v) const {
    if (is_own(v)) return static_cast<std::uint32_t>(own_begin_ + (v - piece_.first_point));
    const std::vector<Number>& numbers = piece_.point_numbers;
    return static_cast<std::uint32_t>(std::lower_bound(numbers.begin(), numbers.end(), v) - numbers.begin());
  }
  template <class Any, std::size_t N>
  std::array<std::uint32_t, N> places_of(const std::array<Any, N>& v) const {
    std::array<std::uint32_t, N> out;
    for (std::size_t j = 0; j < N; ++j) out[j] = place_of(v[j]);
    return out;
  }
  template <class Rows, class Entities, class Out>
  void take_constraints(const Rows& rows, const Entities& entities, Out& out) const {
    out.reserve(rows.size());
    for (const auto& row : rows) out.push_back({places_of(row.vertices), entities[row.label].marker, row.label});
  }

  void take_rows() {
    std::visit(
        [this](auto& rows) {
          piece_.mesh.cells.reserve(rows.size());
          for (const auto& c : rows) piece_.mesh.cells.push_back(places_of(c.vertices));
          rows = {};
        },
        cells_);
    if constexpr (D == 3) {
      take_constraints(faces_, domain_.facets(), piece_.mesh.subfacets);
      take_constraints(edges_, domain_.segments(), piece_.mesh.subsegments);
    } else {
      take_constraints(faces_, domain_.segments(), piece_.mesh.subsegments);
    }
  }

  Collectives& ranks_;
  Mesh<D>& mesh_;
  const Domain<D>& domain_;
  const Bulk& bulk_;
  const bool drop_;
  VertexNumbering<D> vertices_;
  std::vector<OwnConstraint<D>> own_faces_;
  std::vector<OwnConstraint<2>> own_edges_;
  // Of the piece, by numbers of the whole mesh:
  std::variant<std::vector<CellRow<D, std::uint32_t>>, std::vector<CellRow<D, std::uint64_t>>> cells_;
  std::vector<Face> faces_;
  std::vector<Edge> edges_;
  OutputMesh<D> own_points_;
  std::size_t own_begin_ = 0;  // in the numbers of the piece, of its own rows
  MeshPiece<D> piece_;
};

}  // namespace

template <int D>
MeshPiece<D> number_on_ranks(Collectives& ranks, Mesh<D>& mesh, const IsOwnCell& is_own, const Domain<D>& domain,
                             std::span<const double> region_attributes, const PointData<D>& data, const Pieces& pieces,
                             std::vector<std::uint32_t>& unused, bool drop, std::uint64_t most_narrow) {
  const Bulk bulk(pieces);
  RankNumbering<D> numbering(ranks, mesh, domain, bulk, drop);
  MeshPiece<D> piece = numbering.run(is_own, region_attributes, data, pieces, most_narrow);
  unused = numbering.unused();
  return piece;
}

template <int D>
SharingRanks sharing_of(Collectives& ranks, const MeshPiece<D>& piece) {
  const auto size = static_cast<std::size_t>(ranks.size());
  std::vector<std::vector<Number>> held(size);  // by the rank whose row it is
  for (const Number p : piece.point_numbers)
    held[static_cast<std::size_t>(part_of_row(p, piece.total.points, ranks.size()))].push_back(p);
  const std::vector<std::vector<Number>> of_each = exchange_lists(ranks, std::move(held));
  // The ranks that have each point of this one's rows, ascending, in compressed rows.
  const auto place = [&piece](Number p) { return static_cast<std::size_t>(p - piece.first_point); };
  std::vector<std::uint64_t> begin(static_cast<std::size_t>(piece.own_points) + 2, 0);
  for (const std::vector<Number>& points : of_each)
    for (const Number p : points) ++begin.at(place(p) + 2);
  for (std::size_t i = 2; i < begin.size(); ++i) begin[i] += begin[i - 1];
  std::vector<int> holders(static_cast<std::size_t>(begin.back()));
  for (std::size_t r = 0; r < size; ++r)
    for (const Number p : of_each[r]) holders[static_cast<std::size_t>(begin[place(p) + 1]++)] = static_cast<int>(r);
  std::vector<std::vector<int>> answers(size);  // of each point, how many others have it, and which
  for (std::size_t r = 0; r < size; ++r)
    for (const Number p : of_each[r]) {
      const std::span all(holders.begin() + static_cast<std::ptrdiff_t>(begin[place(p)]),
                          holders.begin() + static_cast<std::ptrdiff_t>(begin[place(p) + 1]));
      answers[r].push_back(static_cast<int>(all.size()) - 1);
      for (const int q : all)
        if (q != static_cast<int>(r)) answers[r].push_back(q);
    }
  const std::vector<int> list = exchange_joined(ranks, std::move(answers));
  SharingRanks sharing;
  for (std::size_t at = 0; at < list.size();) {
    const auto first = list.begin() + static_cast<std::ptrdiff_t>(at) + 1;
    sharing.ranks.insert(sharing.ranks.end(), first, first + list[at]);
    sharing.begin.push_back(sharing.ranks.size());
    at += static_cast<std::size_t>(list[at]) + 1;
  }
  return sharing;
}

template MeshPiece<2> number_on_ranks<2>(Collectives&, Mesh<2>&, const IsOwnCell&, const Domain<2>&, std::span<const double>,
                                         const PointData<2>&, const Pieces&, std::vector<std::uint32_t>&, bool, std::uint64_t);
template MeshPiece<3> number_on_ranks<3>(Collectives&, Mesh<3>&, const IsOwnCell&, const Domain<3>&, std::span<const double>,
                                         const PointData<3>&, const Pieces&, std::vector<std::uint32_t>&, bool, std::uint64_t);
template SharingRanks sharing_of<2>(Collectives&, const MeshPiece<2>&);
template SharingRanks sharing_of<3>(Collectives&, const MeshPiece<3>&);

}  // namespace pgdr::detail
