// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The complex of a Domain: its triangles, the edges that are kept, the curves that these form, and which vertices may change.
#include <map>
#include <utility>

#include "input/edges.hpp"
#include "pgdr/predicates.hpp"
#include "replace/complex.hpp"
#include "replace/creases.hpp"
#include "replace/numbers.hpp"
#include "space/disjoint_sets.hpp"
#include "space/distances.hpp"

namespace pgdr::detail {
namespace {

using Edge = std::array<std::uint32_t, 2>;

/// Kept edges of one kind go on into each other.
struct EdgeKind {
  SurfaceCurve what;
  std::vector<std::uint32_t> classes;  ///< of its faces, ascending
  bool operator<(const EdgeKind& o) const {
    return std::tie(what.is_explicit, what.marker, what.is_crease, classes) <
           std::tie(o.what.is_explicit, o.what.marker, o.what.is_crease, o.classes);
  }
};

class ComplexMaker {
 public:
  ComplexMaker(const Plc<3>& input, const Domain<3>& domain, double tolerance, const SurfaceOptions& options)
      : input_(input), domain_(domain), bodies_(input.facet_bodies), tolerance_(tolerance), options_(options) {}

  SurfaceComplex make(LoosePieces& loose, std::uint64_t& crease_count) {
    const auto points = domain_.points();
    s_.points.assign(points.begin(), points.end());
    s_.faces_at.resize(points.size());
    s_.kept_at.resize(points.size());
    s_.order.assign(points.size(), VertexOrder::fixed);
    pinned_.assign(points.size(), false);
    add_faces();
    collect_explicit(loose);
    const std::vector<Edge> candidates = keep_edges();
    for (const Edge& e : find_creases(s_, candidates, tolerance_, options_.feature_angle)) {
      keep(e, {.is_explicit = false, .marker = 0, .is_crease = true});
      ++crease_count;
    }
    for (std::uint32_t v = 0; v < s_.points.size(); ++v) {
      s_.order[v] = order_of(v);
      if (s_.faces_at[v].empty() && s_.kept_at[v].empty()) loose.points.push_back(v);
    }
    number_curves();
    return std::move(s_);
  }

 private:
  void add_faces() {
    std::map<std::pair<int, std::uint32_t>, std::uint32_t> numbers;
    const auto facets = domain_.facets();
    const auto class_of = [&](EntityId f, std::size_t k) {
      const std::uint32_t input = domain_.triangle_origins(f)[k].facet;
      return std::pair{facets[f].marker, input < bodies_.size() ? bodies_[input] : 0};
    };
    for (EntityId f = 0; f < facets.size(); ++f)
      for (std::size_t k = 0; k < facets[f].triangle_count; ++k) numbers.emplace(class_of(f, k), 0);
    for (auto& [klass, number] : numbers) {
      number = static_cast<std::uint32_t>(s_.classes.size());
      const auto& fixed = options_.fixed_markers;
      s_.classes.push_back({klass.first, klass.second, std::find(fixed.begin(), fixed.end(), klass.first) != fixed.end()});
    }
    for (EntityId f = 0; f < facets.size(); ++f) {
      const auto triangles = domain_.triangles(f);
      for (std::size_t k = 0; k < triangles.size(); ++k) {
        // From the least corner on: what is computed of a face is rounded, and may not depend on how the triangle was given.
        auto corners = triangles[k];
        const auto less = [this](std::uint32_t a, std::uint32_t b) { return lex_less(s_.at(a), s_.at(b)); };
        std::rotate(corners.begin(), std::min_element(corners.begin(), corners.end(), less), corners.end());
        s_.add_face({.corners = corners, .klass = numbers.at(class_of(f, k))});
        facet_of_face_.push_back(f);
      }
    }
  }

  /// Segments of the input, edges inside of its polygons, and edges without faces.
  void collect_explicit(LoosePieces& loose) {
    const auto segments = domain_.segments();
    for (EntityId e = 0; e < segments.size(); ++e) {
      const auto& [a, b] = segments[e].points;
      const auto faces = s_.faces_of_edge(a, b);
      const bool is_inner = faces.size() == 2 && facet_of_face_[faces[0]] == facet_of_face_[faces[1]];
      if (!segments[e].explicit_in_input && !is_inner && !faces.empty()) continue;
      pinned_[a] = pinned_[b] = true;
      explicit_.emplace(edge_key(a, b), segments[e].marker);
      if (!faces.empty()) continue;
      loose.edges.push_back({a, b});
      keep({a, b}, {.is_explicit = true, .marker = segments[e].marker});
    }
    const auto markers = domain_.point_markers();
    for (std::uint32_t v = 0; v < markers.size(); ++v)
      if (markers[v] != 0) pinned_[v] = true;
    pin_points_of_no_facet();
    for (std::uint32_t f = 0; f < s_.faces.size(); ++f)
      if (s_.is_fixed(f))
        for (const std::uint32_t v : s_.faces[f].corners) pinned_[v] = true;
  }

  /// Whoever gives one wants a vertex there, also where it stands on a facet, whose triangles have it then.
  void pin_points_of_no_facet() {
    std::vector<bool> is_of_facet(input_.points.size(), false);
    for (const auto& facet : input_.facets)
      for (const auto& polygon : facet.polygons)
        for (const std::uint32_t p : polygon) is_of_facet[p] = true;
    for (std::uint32_t p = 0; p < is_of_facet.size(); ++p)
      if (!is_of_facet[p]) pinned_[domain_.point_of_input()[p]] = true;
  }

  /// Keeps all edges that are no creases. @returns the others
  std::vector<Edge> keep_edges() {
    std::vector<std::uint64_t> keys;
    for (const SurfaceFace& f : s_.faces)
      for (std::size_t i = 0; i < 3; ++i) keys.push_back(edge_key(f.corners[i], f.corners[(i + 1) % 3]));
    std::sort(keys.begin(), keys.end());
    keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
    std::vector<Edge> others;
    for (const std::uint64_t key : keys) {
      const auto [a, b] = edge_of(key);
      const auto given = explicit_.find(key);
      const auto faces = s_.faces_of_edge(a, b);
      if (given != explicit_.end())
        keep({a, b}, {.is_explicit = true, .marker = given->second});
      else if (faces.size() != 2 || s_.faces[faces[0]].klass != s_.faces[faces[1]].klass)
        keep({a, b}, {});
      else
        others.push_back({a, b});
    }
    return others;
  }

  void keep(const Edge& e, const SurfaceCurve& what) {
    EdgeKind kind{what, {}};
    s_.each_face_at(e[0], e[1], [&](std::uint32_t f) { kind.classes.push_back(s_.faces[f].klass); });
    std::sort(kind.classes.begin(), kind.classes.end());
    const auto number = kinds_.emplace(kind, static_cast<std::uint32_t>(kinds_.size())).first->second;
    s_.keep(e[0], e[1], number);
  }

  VertexOrder order_of(std::uint32_t v) const {
    const auto& kept = s_.kept_at[v];
    if (pinned_[v] || s_.faces_at[v].empty() || (!kept.empty() && kept.size() != 2)) return VertexOrder::fixed;
    if (!are_fans_regular(v)) return VertexOrder::fixed;
    if (kept.empty()) return VertexOrder::free;
    if (kept[0].curve != kept[1].curve || is_corner(v)) return VertexOrder::fixed;
    return VertexOrder::on_curve;
  }

  /// Without kept edges: the faces are one fan. With two: each fan is from one of them to the other.
  bool are_fans_regular(std::uint32_t v) const {
    std::vector<std::uint32_t> left = s_.faces_at[v];
    std::size_t fans = 0;
    while (!left.empty()) {
      ++fans;
      std::array<int, 2> ends{};
      std::vector<std::uint32_t> stack{left.back()};
      left.pop_back();
      while (!stack.empty()) {
        const std::uint32_t f = stack.back();
        stack.pop_back();
        for (const std::uint32_t w : s_.faces[f].corners) {
          if (w == v) continue;
          if (s_.is_kept(v, w)) {
            ++ends[w == s_.kept_at[v][0].other ? 0 : 1];
            continue;
          }
          const auto at = std::find(left.begin(), left.end(), s_.beyond(f, v, w));
          if (at == left.end()) continue;
          stack.push_back(*at);
          left.erase(at);
        }
      }
      if (!s_.kept_at[v].empty() && (ends[0] != 1 || ends[1] != 1)) return false;
    }
    return !s_.kept_at[v].empty() || fans == 1;
  }

  /// The curve turns by more than the feature angle.
  bool is_corner(std::uint32_t v) const {
    const Point3 &p = s_.at(v), &a = s_.at(s_.kept_at[v][0].other), &b = s_.at(s_.kept_at[v][1].other);
    const double least = numbers::corner_edges * tolerance_;
    if (options_.feature_angle >= 180 || !(distance(p, a) > least) || !(distance(p, b) > least)) return false;
    const auto in = difference(p, a), out = difference(b, p);
    return dot(in, out) < claimed_cosine(options_.feature_angle) * std::sqrt(dot(in, in) * dot(out, out));
  }

  /// Kinds become curves: edges of one kind that hang together across vertices of order 1. A curve without an end gets one.
  void number_curves() {
    std::vector<std::pair<std::uint64_t, std::uint32_t>> edges;  // key, kind
    for (std::uint32_t v = 0; v < s_.points.size(); ++v)
      for (const KeptEdge& e : s_.kept_at[v])
        if (v < e.other) edges.emplace_back(edge_key(v, e.other), e.curve);
    std::sort(edges.begin(), edges.end());
    const auto number_of = [&](std::uint32_t a, std::uint32_t b) {
      const auto at = std::lower_bound(edges.begin(), edges.end(), std::pair{edge_key(a, b), 0u});
      return static_cast<std::uint32_t>(at - edges.begin());
    };
    DisjointSets sets(edges.size());
    for (std::uint32_t v = 0; v < s_.points.size(); ++v)
      if (s_.order[v] == VertexOrder::on_curve)
        sets.unite(number_of(v, s_.kept_at[v][0].other), number_of(v, s_.kept_at[v][1].other));
    std::vector<const EdgeKind*> kinds(kinds_.size());
    for (const auto& [kind, number] : kinds_) kinds[number] = &kind;
    std::vector<std::uint32_t> curve_of(edges.size(), no_index);
    std::vector<std::uint32_t> least;  // of each curve the least vertex, if it has no end
    std::vector<bool> has_end;
    for (std::uint32_t k = 0; k < edges.size(); ++k) {
      std::uint32_t& curve = curve_of[sets.find(k)];
      if (curve == no_index) {
        curve = static_cast<std::uint32_t>(s_.curves.size());
        s_.curves.push_back(kinds[edges[k].second]->what);
        least.push_back(no_index);
        has_end.push_back(false);
      }
      for (const std::uint32_t v : edge_of(edges[k].first)) {
        if (s_.order[v] != VertexOrder::on_curve) has_end[curve] = true;
        if (least[curve] == no_index || lex_less(s_.at(v), s_.at(least[curve]))) least[curve] = v;
      }
    }
    for (std::uint32_t v = 0; v < s_.points.size(); ++v)
      for (KeptEdge& e : s_.kept_at[v]) e.curve = curve_of[sets.find(number_of(v, e.other))];
    for (std::size_t c = 0; c < least.size(); ++c)
      if (!has_end[c]) s_.order[least[c]] = VertexOrder::fixed;
  }

  const Plc<3>& input_;
  const Domain<3>& domain_;
  std::span<const std::uint32_t> bodies_;
  double tolerance_;
  const SurfaceOptions& options_;
  SurfaceComplex s_;
  std::vector<EntityId> facet_of_face_;
  std::vector<bool> pinned_;
  std::map<std::uint64_t, int> explicit_;  // marker by key of the edge
  std::map<EdgeKind, std::uint32_t> kinds_;
};

}  // namespace

SurfaceComplex make_complex(const Plc<3>& input, const Domain<3>& domain, double tolerance, const SurfaceOptions& options,
                            LoosePieces& loose, std::uint64_t& crease_count) {
  return ComplexMaker(input, domain, tolerance, options).make(loose, crease_count);
}

}  // namespace pgdr::detail
