// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "bodies/body_chains.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

#include "bodies/facet_sides.hpp"
#include "numbers/exact_sum.hpp"
#include "space/box.hpp"
#include "space/disjoint_sets.hpp"
#include "space/point_ranks.hpp"

namespace pgdr::detail {
namespace {

/// Numbers of sets from 0 on, in the order of their first members; members that do not count have no_entity.
std::uint32_t number_sets(DisjointSets& sets, std::vector<std::uint32_t>& of_member) {
  std::uint32_t count = 0;
  for (std::uint32_t i = 0; i < of_member.size(); ++i)
    if (of_member[i] != no_entity) {
      const std::uint32_t first = sets.find(i);
      of_member[i] = first == i ? count++ : of_member[first];
    }
  return count;
}

bool has_area(const Plc<3>::Facet& f) { return !f.polygons.empty() && f.polygons[0].size() > 2; }

class ChainMaker {
 public:
  ChainMaker(const Plc<3>& plc, const Arrangement& pieces, std::span<const char> separates, const Bulk& bulk)
      : plc_(plc), pieces_(pieces), separates_(separates), bulk_(bulk), reversed_(plc.facets.size(), 0) {}

  BodyChains make() {
    find_bodies();
    find_open_edges();
    if (plc_.facet_bodies.empty() && !made_.open_edges.empty()) join_along_open_edges();
    if (!made_.open_edges.empty()) turn_over();
    sum_pieces();
    reverse_files();
    return std::move(made_);
  }

 private:
  /// Calls f(piece, facet, reversed) for all facets that cover pieces which count.
  template <class F>
  void each_use(const F& f) const {
    for (std::uint32_t p = 0; p < pieces_.triangles.size(); ++p)
      if (separates_[p] != 0)
        for (std::uint32_t k = pieces_.origins_begin[p]; k < pieces_.origins_begin[p + 1]; ++k) {
          const PieceOrigin& o = pieces_.origins[k];
          f(p, o.facet, o.reversed != (reversed_[o.facet] != 0));
        }
  }

  void find_bodies() {
    made_.body_of_facet.assign(plc_.facets.size(), no_entity);
    if (!plc_.facet_bodies.empty()) {
      for (std::uint32_t f = 0; f < plc_.facets.size(); ++f)
        if (has_area(plc_.facets[f])) made_.body_of_facet[f] = plc_.facet_bodies[f];
      made_.count = 1 + *std::ranges::max_element(plc_.facet_bodies);
      return;
    }
    struct Edge {
      std::uint32_t a, b, facet;
      auto operator<=>(const Edge&) const = default;
    };
    const std::vector<std::uint32_t> rank = point_ranks<3>(plc_.points, bulk_);
    std::vector<Edge> edges;
    for (std::uint32_t f = 0; f < plc_.facets.size(); ++f) {
      if (!has_area(plc_.facets[f])) continue;
      made_.body_of_facet[f] = f;
      for (const auto& polygon : plc_.facets[f].polygons)
        for (std::size_t k = 0; polygon.size() > 2 && k < polygon.size(); ++k) {
          const auto [a, b] = std::minmax(rank[polygon[k]], rank[polygon[(k + 1) % polygon.size()]]);
          edges.push_back({a, b, f});
        }
    }
    bulk_.sort(edges, std::less<>());
    DisjointSets sets(plc_.facets.size());
    for (std::size_t i = 1; i < edges.size(); ++i)
      if (edges[i].a == edges[i - 1].a && edges[i].b == edges[i - 1].b) sets.unite(edges[i].facet, edges[i - 1].facet);
    made_.count = number_sets(sets, made_.body_of_facet);
  }

  void find_open_edges() {
    std::vector<EdgeOfBody> edges;
    each_use([&](std::uint32_t p, std::uint32_t facet, bool reversed) {
      const auto& t = pieces_.triangles[p];
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t a = t[k], b = t[(k + 1) % 3];
        edges.push_back({std::min(a, b), std::max(a, b), made_.body_of_facet[facet], (a < b) != reversed ? 1 : -1});
      }
    });
    const auto key = [](const EdgeOfBody& e) { return std::tuple(e.body, e.a, e.b); };
    bulk_.sort(edges, [&](const EdgeOfBody& x, const EdgeOfBody& y) { return key(x) < key(y); });
    made_.open_edges.clear();
    made_.is_closed.assign(made_.count, 1);
    for (std::size_t i = 0, j = 0; i < edges.size(); i = j) {
      EdgeOfBody sum = edges[i];
      for (j = i + 1; j < edges.size() && key(edges[j]) == key(edges[i]); ++j) sum.times += edges[j].times;
      if (sum.times == 0) continue;
      made_.open_edges.push_back(sum);
      made_.is_closed[sum.body] = 0;
    }
  }

  /// Where a corner of one facet lies on the edge of another, both have it, though not one of their edges in common.
  void join_along_open_edges() {
    std::vector<EdgeOfBody> edges = made_.open_edges;
    std::ranges::sort(edges);
    DisjointSets sets(made_.count);
    for (std::size_t i = 1; i < edges.size(); ++i)
      if (edges[i].a == edges[i - 1].a && edges[i].b == edges[i - 1].b) sets.unite(edges[i].body, edges[i - 1].body);
    std::vector<std::uint32_t> number(made_.count, 0);
    const std::uint32_t count = number_sets(sets, number);
    if (count == made_.count) return;
    made_.count = count;
    for (std::uint32_t& body : made_.body_of_facet)
      if (body != no_entity) body = number[body];
    find_open_edges();
  }

  void turn_over() {
    FacetSides sides(plc_, pieces_);
    each_use([&](std::uint32_t p, std::uint32_t facet, bool reversed) {
      if (made_.is_closed[made_.body_of_facet[facet]] == 0) sides.add(p, facet, made_.body_of_facet[facet], reversed);
    });
    made_.turned_over = sides.minority(bulk_);
    for (const std::uint32_t f : made_.turned_over) reversed_[f] = 1;
    if (!made_.turned_over.empty()) find_open_edges();
  }

  void sum_pieces() {
    std::vector<PieceOfBody> uses;
    each_use([&](std::uint32_t p, std::uint32_t facet, bool reversed) {
      uses.push_back({p, made_.body_of_facet[facet], reversed ? -1 : 1});
    });
    std::ranges::sort(uses);
    for (std::size_t i = 0, j = 0; i < uses.size(); i = j) {
      PieceOfBody sum = uses[i];
      for (j = i + 1; j < uses.size() && uses[j].piece == sum.piece && uses[j].body == sum.body; ++j) sum.times += uses[j].times;
      if (sum.times != 0) made_.pieces.push_back(sum);
    }
  }

  /// The sign of the volume of each file: of its closed bodies; if it has none, of the open ones about the middle of all points.
  std::vector<Sign> signs_of_files(std::span<const std::uint32_t> file_of_body, std::uint32_t files) const {
    const Box<3> box = Box<3>::of(pieces_.points);
    std::vector<char> has_closed(files, 0);
    for (const PieceOfBody& u : made_.pieces)
      if (made_.is_closed[u.body] != 0) has_closed[file_of_body[u.body]] = 1;
    std::vector<ExactSum> sums(files);
    for (const PieceOfBody& u : made_.pieces) {
      const std::uint32_t file = file_of_body[u.body];
      if ((made_.is_closed[u.body] != 0) != (has_closed[file] != 0)) continue;
      std::array<Point<3>, 3> s;
      for (std::size_t k = 0; k < 3; ++k) {
        s[k] = pieces_.points[pieces_.triangles[u.piece][k]];
        for (int i = 0; i < 3 && has_closed[file] == 0; ++i) s[k][i] -= (box.low[i] + box.high[i]) / 2;
      }
      if (u.times < 0) std::swap(s[0], s[1]);
      for (int n = std::abs(u.times); n > 0; --n) sums[file].add_determinant(s[0], s[1], s[2]);
    }
    std::vector<Sign> signs(files);
    for (std::uint32_t i = 0; i < files; ++i) signs[i] = sign_of(sums[i].divided_by(1));
    return signs;
  }

  void reverse_files() {
    std::vector<std::uint32_t> file_of_body(made_.count, 0);
    if (!plc_.facet_bodies.empty())
      for (std::uint32_t b = 0; b < made_.count; ++b) file_of_body[b] = b;
    const std::vector<Sign> signs = signs_of_files(file_of_body, plc_.facet_bodies.empty() ? 1 : made_.count);
    for (PieceOfBody& u : made_.pieces)
      if (signs[file_of_body[u.body]] == Sign::negative) u.times = -u.times;
  }

  const Plc<3>& plc_;
  const Arrangement& pieces_;
  std::span<const char> separates_;
  const Bulk& bulk_;
  std::vector<char> reversed_;  ///< of facets
  BodyChains made_;
};

}  // namespace

std::string body_name(const Plc<3>& plc, std::uint32_t body) {
  const bool is_named = body < plc.body_names.size() && !plc.body_names[body].empty();
  return is_named ? plc.body_names[body] : std::to_string(body);
}

BodyChains make_chains(const Plc<3>& plc, const Arrangement& pieces, std::span<const char> separates, const Bulk& bulk) {
  return ChainMaker(plc, pieces, separates, bulk).make();
}

}  // namespace pgdr::detail
