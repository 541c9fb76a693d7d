// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Vertices are sorted by samples: each rank gets those of a stretch of the curve, from all ranks that have them, numbers them,
// and sends the numbers back. Then cells and constraints go to the rank of the range of their first vertex, are sorted there, and
// are shared out by rows; at last each rank asks for the points that its rows have.
#include "ranks/numbering.hpp"

#include <algorithm>
#include <array>
#include <tuple>
#include <type_traits>

#include "compact/canonical.hpp"
#include "ranks/exchange.hpp"
#include "space/bulk.hpp"
#include "space/spatial_order.hpp"

namespace pgdr::detail {
namespace {

using Number = std::uint64_t;
constexpr Number no_number = ~Number{0};

/// A vertex on its way.
template <int D>
struct Placed {
  Point<D> point;
  Home home;
};

/// A Steiner vertex by its place on the curve, which is all that its number depends on.
template <int D>
struct OnCurve {
  std::uint64_t key;
  Point<D> point;
  friend bool operator<(const OnCurve& a, const OnCurve& b) {
    return a.key != b.key ? a.key < b.key : lex_less(a.point, b.point);
  }
};

/// Numbers the vertices of this rank's cells.
template <int D>
class VertexNumbering {
 public:
  VertexNumbering(Collectives& ranks, const Mesh<D>& mesh, const Domain<D>& domain, const Bulk& bulk)
      : ranks_(ranks), mesh_(mesh), bulk_(bulk), curve_(domain.points()), input_(domain.points().size()) {}

  void run(std::span<const CellId> own) {
    list(own);
    const std::vector<OnCurve<D>> splitters = choose_splitters();
    std::vector<std::vector<Placed<D>>> to_each(static_cast<std::size_t>(ranks_.size()));
    std::vector<std::size_t> rank_of(own_.size());
    for (std::size_t i = 0; i < own_.size(); ++i) {
      rank_of[i] = static_cast<std::size_t>(std::upper_bound(splitters.begin(), splitters.end(), own_[i].place) -
                                            splitters.begin());
      to_each[rank_of[i]].push_back({own_[i].place.point, mesh_.vertex(own_[i].vertex).home});
    }
    const auto numbers = exchange_lists(ranks_, number(exchange_lists(ranks_, std::move(to_each))));
    std::vector<std::size_t> next(numbers.size(), 0);
    for (std::size_t i = 0; i < own_.size(); ++i) numbers_[index(own_[i].vertex)] = numbers[rank_of[i]].at(next[rank_of[i]]++);
  }

  Number points() const { return points_; }  ///< of the whole mesh
  /// By index(VertexId), of the vertices of the rank's own cells.
  const std::vector<Number>& numbers() const { return numbers_; }
  /// The Steiner vertices of this rank's stretch, in their order, and the number of the first.
  const std::vector<Placed<D>>& stretch() const { return stretch_; }
  Number first_of_stretch() const { return first_; }

 private:
  struct Own {
    OnCurve<D> place;
    VertexId vertex;
  };

  /// The Steiner vertices of the cells, along the curve. Input points have their numbers already.
  void list(std::span<const CellId> own) {
    numbers_.assign(mesh_.vertex_bound(), no_number);
    for (const CellId c : own)
      for (const VertexId v : mesh_.cell(c).vertices) {
        if (numbers_[index(v)] != no_number) continue;
        const VertexRecord<D>& record = mesh_.vertex(v);
        const bool is_input = record.home.kind() == EntityKind::vertex;
        numbers_[index(v)] = is_input ? record.home.id() : 0;
        if (!is_input) own_.push_back({{curve_.key(record.point), record.point}, v});
      }
    bulk_.sort(own_, [](const Own& a, const Own& b) { return a.place < b.place; });
  }

  /// Places that cut the curve into stretches of about as many vertices, counted once for each rank that has them.
  std::vector<OnCurve<D>> choose_splitters() {
    constexpr std::uint64_t samples_a_rank = 32;
    const auto ranks = static_cast<std::uint64_t>(ranks_.size());
    const std::uint64_t step = std::max<std::uint64_t>(1, ranks_.sum(std::uint64_t{own_.size()}) / (samples_a_rank * ranks));
    MessageWriter message;
    std::vector<OnCurve<D>> samples;
    for (std::size_t i = 0; i < own_.size(); i += static_cast<std::size_t>(step)) samples.push_back(own_[i].place);
    message.put(samples);
    samples.clear();
    for (const Bytes& bytes : ranks_.all_gather(message.take())) {
      const std::vector<OnCurve<D>> more = MessageReader(bytes).get_all<OnCurve<D>>();
      samples.insert(samples.end(), more.begin(), more.end());
    }
    std::sort(samples.begin(), samples.end());
    std::vector<OnCurve<D>> splitters;
    for (std::uint64_t r = 1; r < ranks && !samples.empty(); ++r)
      splitters.push_back(samples[static_cast<std::size_t>(first_row_of_part(samples.size(), r, ranks))]);
    return splitters;
  }

  /// Of the vertices that each rank has on this rank's stretch, their numbers, in its order.
  std::vector<std::vector<Number>> number(const std::vector<std::vector<Placed<D>>>& of_each) {
    struct Asked {
      OnCurve<D> place;
      Home home;
      std::uint32_t rank, at;
    };
    std::vector<Asked> asked;
    std::vector<std::vector<Number>> numbers(of_each.size());
    for (std::uint32_t r = 0; r < of_each.size(); ++r) {
      numbers[r].resize(of_each[r].size());
      for (std::uint32_t i = 0; i < of_each[r].size(); ++i) {
        const Placed<D>& v = of_each[r][i];
        asked.push_back({{curve_.key(v.point), v.point}, v.home, r, i});
      }
    }
    bulk_.sort(asked, [](const Asked& a, const Asked& b) { return a.place < b.place; });
    for (const Asked& a : asked) {
      if (stretch_.empty() || stretch_.back().point != a.place.point) stretch_.push_back({a.place.point, a.home});
      numbers[a.rank][a.at] = stretch_.size() - 1;
    }
    const std::uint64_t count = stretch_.size();
    first_ = input_ + ranks_.exclusive_sum(count);
    points_ = input_ + ranks_.sum(count);
    for (std::vector<Number>& list : numbers)
      for (Number& n : list) n += first_;
    return numbers;
  }

  Collectives& ranks_;
  const Mesh<D>& mesh_;
  const Bulk& bulk_;
  const HilbertCurve<D> curve_;
  const Number input_;
  std::vector<Own> own_;
  std::vector<Number> numbers_;
  std::vector<Placed<D>> stretch_;
  Number first_ = 0, points_ = 0;
};

/// A cell, subfacet or subsegment by the numbers of its vertices.
template <std::size_t N, class Label>
struct Numbered {
  std::array<Number, N> vertices;
  Label label;  ///< region, or entity
};

/// Sorts what the ranks have by vertices, after `tidy`, which may take some out, has seen all with the same first vertex
/// together.
/// @returns the rows of this rank's part, and how many there are on all
template <class Row, class Tidy>
std::pair<std::vector<Row>, Number> sort_rows(Collectives& ranks, const Bulk& bulk, std::vector<Row> rows, Number points,
                                              const Tidy& tidy) {
  std::vector<std::vector<Row>> to_each(static_cast<std::size_t>(ranks.size()));
  for (const Row& row : rows)
    to_each[static_cast<std::size_t>(part_of_row(row.vertices[0], points, ranks.size()))].push_back(row);
  rows = exchange_joined(ranks, std::move(to_each));
  bulk.sort(rows, [](const Row& a, const Row& b) { return a.vertices < b.vertices; });
  tidy(rows);
  const std::uint64_t count = rows.size(), first = ranks.exclusive_sum(count), all = ranks.sum(count);
  return {share_rows(ranks, rows, first, all), all};
}

template <int D>
class RankNumbering {
 public:
  RankNumbering(Collectives& ranks, const Mesh<D>& mesh, std::span<const CellId> own, const Domain<D>& domain, const Bulk& bulk)
      : ranks_(ranks), mesh_(mesh), own_(own), domain_(domain), bulk_(bulk), vertices_(ranks, mesh, domain, bulk) {}

  MeshPiece<D> run(std::span<const double> region_attributes, const PointData<D>& data, const Pieces& pieces) {
    vertices_.run(own_);
    piece_.total.input_points = domain_.points().size();
    piece_.total.points = vertices_.points();
    number_cells(region_attributes);
    number_faces();
    if constexpr (D == 3) number_edges();
    take_own_points(data, pieces);
    fetch_points();
    return std::move(piece_);
  }

 private:
  using Cell = Numbered<D + 1, std::uint32_t>;
  using Face = Numbered<D, EntityId>;
  using Edge = Numbered<2, EntityId>;

  template <std::size_t N>
  std::array<Number, N> numbered(const std::array<VertexId, N>& v) const {
    std::array<Number, N> n;
    for (std::size_t j = 0; j < N; ++j) n[j] = vertices_.numbers()[index(v[j])];
    return n;
  }

  void number_cells(std::span<const double> region_attributes) {
    std::vector<Cell> cells;
    cells.reserve(own_.size());
    for (const CellId c : own_) cells.push_back({canonical(numbered(mesh_.cell(c).vertices)), mesh_.region(c)});
    const auto nothing = [](std::vector<Cell>&) {};
    std::tie(cells_, piece_.total.cells) = sort_rows(ranks_, bulk_, std::move(cells), vertices_.points(), nothing);
    piece_.first_cell = RowRange(piece_.total.cells, ranks_).first;
    piece_.total.regions = !region_attributes.empty() && piece_.total.cells > 0;
    if (piece_.total.regions)
      for (const Cell& c : cells_) piece_.mesh.regions.push_back(region_attributes[c.label]);
  }

  /// Constrained faces come from the cells on both sides, or from one, which is on the hull.
  void number_faces() {
    std::vector<std::vector<Face>> to_each(static_cast<std::size_t>(ranks_.size()));
    for (const CellId c : own_) {
      const auto* k = mesh_.constraints(c);
      for (int f = 0; k && f <= D; ++f) {
        if (!k->has_face(f)) continue;
        const Face face{numbered(face_vertices<D>(mesh_.cell(c), f)), k->face_entity[f]};
        const Number least = *std::min_element(face.vertices.begin(), face.vertices.end());
        to_each[static_cast<std::size_t>(part_of_row(least, vertices_.points(), ranks_.size()))].push_back(face);
      }
    }
    std::vector<Face> sides = exchange_joined(ranks_, std::move(to_each)), faces;
    const auto sorted = [](const Face& f) { return canonical_face(f.vertices, false); };
    bulk_.sort(sides, [&](const Face& a, const Face& b) { return sorted(a) < sorted(b); });
    for (std::size_t i = 0; i < sides.size(); ++i) {
      const bool on_hull = i + 1 == sides.size() || sorted(sides[i]) != sorted(sides[i + 1]);
      faces.push_back({canonical_face(sides[i].vertices, on_hull), sides[i].label});
      if (!on_hull) ++i;
    }
    const auto nothing = [](std::vector<Face>&) {};
    auto [first, total] = D == 3 ? std::tie(piece_.first_subfacet, piece_.total.subfacets)
                                 : std::tie(piece_.first_subsegment, piece_.total.subsegments);
    std::tie(faces_, total) = sort_rows(ranks_, bulk_, std::move(faces), vertices_.points(), nothing);
    first = RowRange(total, ranks_).first;
  }

  /// 3D: subsegments, which come from every cell at them.
  void number_edges() {
    std::vector<Edge> edges;
    for (const CellId c : own_) {
      const auto* k = mesh_.constraints(c);
      for (int e = 0; k && e < 6; ++e) {
        if (!k->has_edge(e)) continue;
        auto v = numbered(ends_of_edge(mesh_.cell(c).vertices, e));
        std::sort(v.begin(), v.end());
        edges.push_back({v, k->edge_entity[e]});
      }
    }
    const auto same = [](const Edge& a, const Edge& b) { return a.vertices == b.vertices; };
    const auto once = [&](std::vector<Edge>& rows) { rows.erase(std::unique(rows.begin(), rows.end(), same), rows.end()); };
    std::tie(edges_, piece_.total.subsegments) = sort_rows(ranks_, bulk_, std::move(edges), vertices_.points(), once);
    piece_.first_subsegment = RowRange(piece_.total.subsegments, ranks_).first;
  }

  /// The rows of points of this rank, with their data.
  void take_own_points(const PointData<D>& data, const Pieces& pieces) {
    const RowRange rows(vertices_.points(), ranks_);
    piece_.first_point = rows.first;
    piece_.own_points = rows.count;
    std::vector<VertexRecord<D>> records;
    for (Number p = rows.first; p < std::min(rows.first + rows.count, piece_.total.input_points); ++p)
      records.push_back({domain_.points()[p], Home(EntityKind::vertex, static_cast<EntityId>(p))});
    for (const Placed<D>& v : share_rows(ranks_, vertices_.stretch(), vertices_.first_of_stretch(), vertices_.points()))
      records.push_back({v.point, v.home});
    for (const VertexRecord<D>& v : records) own_points_.points.push_back(v.point);
    data.fill_rows(records, own_points_, pieces);
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
    add(cells_);
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
      wanted[static_cast<std::size_t>(part_of_row(p, piece_.total.points, ranks_.size()))].push_back(p);
    wanted[static_cast<std::size_t>(ranks_.rank())].clear();
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
  template <std::size_t N>
  std::array<std::uint32_t, N> places_of(const std::array<Number, N>& v) const {
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
    piece_.mesh.cells.reserve(cells_.size());
    for (const Cell& c : cells_) piece_.mesh.cells.push_back(places_of(c.vertices));
    if constexpr (D == 3) {
      take_constraints(faces_, domain_.facets(), piece_.mesh.subfacets);
      take_constraints(edges_, domain_.segments(), piece_.mesh.subsegments);
    } else {
      take_constraints(faces_, domain_.segments(), piece_.mesh.subsegments);
    }
  }

  Collectives& ranks_;
  const Mesh<D>& mesh_;
  std::span<const CellId> own_;
  const Domain<D>& domain_;
  const Bulk& bulk_;
  VertexNumbering<D> vertices_;
  std::vector<Cell> cells_;  // of the piece, by numbers of the whole mesh
  std::vector<Face> faces_;
  std::vector<Edge> edges_;
  OutputMesh<D> own_points_;
  std::size_t own_begin_ = 0;  // in the numbers of the piece, of its own rows
  MeshPiece<D> piece_;
};

}  // namespace

template <int D>
MeshPiece<D> number_on_ranks(Collectives& ranks, const Mesh<D>& mesh, std::span<const CellId> own, const Domain<D>& domain,
                             std::span<const double> region_attributes, const PointData<D>& data, const Pieces& pieces) {
  const Bulk bulk(pieces);
  return RankNumbering<D>(ranks, mesh, own, domain, bulk).run(region_attributes, data, pieces);
}

template <int D>
SharingRanks sharing_of(Collectives& ranks, const MeshPiece<D>& piece) {
  const auto size = static_cast<std::size_t>(ranks.size());
  std::vector<std::vector<Number>> held(size);  // by the rank whose row it is
  for (const Number p : piece.point_numbers)
    held[static_cast<std::size_t>(part_of_row(p, piece.total.points, ranks.size()))].push_back(p);
  const std::vector<std::vector<Number>> of_each = exchange_lists(ranks, std::move(held));
  std::vector<std::vector<int>> holders(static_cast<std::size_t>(piece.own_points));
  for (std::size_t r = 0; r < size; ++r)
    for (const Number p : of_each[r]) holders[static_cast<std::size_t>(p - piece.first_point)].push_back(static_cast<int>(r));
  std::vector<std::vector<int>> answers(size);  // of each point, how many others have it, and which
  for (std::size_t r = 0; r < size; ++r)
    for (const Number p : of_each[r]) {
      const std::vector<int>& all = holders[static_cast<std::size_t>(p - piece.first_point)];
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

template MeshPiece<2> number_on_ranks<2>(Collectives&, const Mesh<2>&, std::span<const CellId>, const Domain<2>&,
                                         std::span<const double>, const PointData<2>&, const Pieces&);
template MeshPiece<3> number_on_ranks<3>(Collectives&, const Mesh<3>&, std::span<const CellId>, const Domain<3>&,
                                         std::span<const double>, const PointData<3>&, const Pieces&);
template SharingRanks sharing_of<2>(Collectives&, const MeshPiece<2>&);
template SharingRanks sharing_of<3>(Collectives&, const MeshPiece<3>&);

}  // namespace pgdr::detail
