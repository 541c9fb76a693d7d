// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Diagnosis: how facets hang together. Everything by the edges of their triangles, sorted, and by counting.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "diagnose/diagnoser.hpp"
#include "input/words.hpp"

namespace pgdr::detail {

// What the Domain has merged and left out.
template <int D>
void Diagnoser<D>::find_repairs() {
  const auto point_of = domain_.point_of_input();
  for (std::uint32_t i = 0; i < point_of.size(); ++i) {
    const std::uint32_t first = domain_.input_of_point()[point_of[i]];
    if (first == i) continue;
    ++out_[Finding::duplicate_point].count;
    if (wants_more(Finding::duplicate_point))
      list(Finding::duplicate_point, Errc::duplicate_point,
           "point " + std::to_string(number(i)) + " and point " + point_words(point_of[i]) + " are one",
           domain_.source().place(SourceItem::point, i), {number(i), number(first)}, {p_[point_of[i]]});
  }
  if constexpr (D == 3)
    for (const Diagnostic& repair : domain_.repairs()) {
      if (repair.code != Errc::repeated_facet) continue;
      for (std::size_t k = 0; k + 1 < repair.ids.size(); k += 2) {
        const std::int64_t f = repair.ids[k], first = repair.ids[k + 1];
        ++out_[Finding::repeated_facet].count;
        if (wants_more(Finding::repeated_facet))
          list(Finding::repeated_facet, Errc::repeated_facet,
               "facet " + std::to_string(f) + " repeats facet " + std::to_string(first),
               facet_place(static_cast<std::uint32_t>(f - number(0))), {f, first}, {});
      }
    }
}

template <int D>
void Diagnoser<D>::find_unreferenced() {
  for (const Piece& piece : pieces_) {
    if (piece.count != 1) continue;
    const std::uint32_t v = piece.corners[0];
    ++out_[Finding::unreferenced_point].count;
    if (wants_more(Finding::unreferenced_point))
      list(Finding::unreferenced_point, Errc::unreferenced_point, "point " + point_words(v) + " belongs to nothing",
           point_place(v), {point_number(v)}, {p_[v]});
  }
}

template <int D>
void Diagnoser<D>::find_open_boundary() {
  if constexpr (D == 3) {
    find_open_loops();
  } else {
    std::vector<std::uint32_t> degree(p_.size());
    for (const DomainSegment& s : domain_.segments())
      for (const std::uint32_t v : s.points) ++degree[v];
    for (std::uint32_t v = 0; v < degree.size(); ++v) {
      if (degree[v] != 1) continue;
      ++out_[Finding::open_boundary].count;
      if (wants_more(Finding::open_boundary))
        list(Finding::open_boundary, Errc::open_boundary, "one segment alone ends at point " + point_words(v), point_place(v),
             {point_number(v)}, {p_[v]});
    }
  }
}

// Chains the edges of one triangle each: from the least point on along the edge to the least neighbour not yet taken,
// until there is none. Paths from points of odd degree first, so that what is left are loops.
template <int D>
void Diagnoser<D>::find_open_loops() requires(D == 3) {
  const auto is_alone = [this](std::size_t i) {
    if (i > 0 && uses_[i - 1].key == uses_[i].key) return false;
    return i + 1 == uses_.size() || uses_[i + 1].key != uses_[i].key;
  };
  std::vector<Edge> half = bulk_.gather<Edge>(uses_.size(), [&](std::size_t i, std::vector<Edge>& found) {
    const auto [a, b] = uses_[i].edge();
    if (is_alone(i)) found.insert(found.end(), {{a, b}, {b, a}});
  });
  stop_check_.sort(bulk_, half);
  std::vector<bool> taken(half.size(), false);
  const auto first_at = [&](std::uint32_t v) {
    return static_cast<std::size_t>(std::lower_bound(half.begin(), half.end(), Edge{v, 0}) - half.begin());
  };
  const auto step = [&](std::uint32_t v) {
    for (std::size_t k = first_at(v); k < half.size() && half[k][0] == v; ++k) {
      if (taken[k]) continue;
      taken[k] = true;
      taken[static_cast<std::size_t>(std::lower_bound(half.begin(), half.end(), Edge{half[k][1], v}) - half.begin())] = true;
      return half[k][1];
    }
    return no_entity;
  };
  std::vector<std::uint32_t> loop;
  for (const bool odd_only : {true, false})
    for (std::size_t k = 0, end; k < half.size(); k = end) {
      const std::uint32_t start = half[k][0];
      for (end = k; end < half.size() && half[end][0] == start;) ++end;
      if (odd_only && (end - k) % 2 == 0) continue;
      for (std::uint32_t v = start; (v = step(v)) != no_entity;) {
        if (loop.empty()) loop.push_back(start);
        loop.push_back(v);
        if (v != start) continue;
        list_open_loop(loop);
        loop.clear();
      }
      if (!loop.empty()) list_open_loop(loop);
      loop.clear();
    }
}

template <int D>
void Diagnoser<D>::list_open_loop(const std::vector<std::uint32_t>& loop) {
  ++out_[Finding::open_boundary].count;
  if (!wants_more(Finding::open_boundary)) return;
  double length = 0;
  for (std::size_t k = 1; k < loop.size(); ++k) length += std::sqrt(squared_distance(p_[loop[k - 1]], p_[loop[k]]));
  const bool closed = loop.front() == loop.back();
  const auto vertices = std::span(loop).first(loop.size() - closed);
  Ids ids;
  std::string words;
  for (std::size_t k = 0; k < vertices.size(); ++k) {
    ids.push_back(point_number(vertices[k]));
    if (k < max_listed) words += (k == 0 ? "" : ", ") + point_words(vertices[k]);
    if (k == max_listed) words += ", ...";
  }
  list(Finding::open_boundary, Errc::open_boundary,
       std::string(closed ? "a loop" : "a path") + " of " + std::to_string(loop.size() - 1) +
           " edges of one facet each, through points " + words,
       point_place(vertices[0]), std::move(ids), points_of(vertices), length);
}

template <int D>
void Diagnoser<D>::find_non_manifold_edges() requires(D == 3) {
  for (std::size_t begin = 0, n; begin < uses_.size(); begin += n) {
    const auto uses = uses_at(begin);
    n = uses.size();
    if (n <= 2) continue;
    ++out_[Finding::non_manifold_edge].count;
    if (!wants_more(Finding::non_manifold_edge)) continue;
    const Edge e = uses[0].edge();
    std::vector<std::uint32_t> facets;
    for (const EdgeUse& use : uses) facets.push_back(triangles_[use.triangle].origin.facet);
    std::sort(facets.begin(), facets.end());
    Ids ids{point_number(e[0]), point_number(e[1])};
    std::string words;
    for (const std::uint32_t f : facets) {
      ids.push_back(number(f));
      words += (words.empty() ? "" : ", ") + facet_words(f);
    }
    list(Finding::non_manifold_edge, Errc::non_manifold,
         std::to_string(n) + " facets meet at the edge " + edge_words(e) + ": " + words, facet_place(facets[0]), std::move(ids),
         {p_[e[0]], p_[e[1]]});
  }
}

// Corners of triangles at a point hang together across the edges there; more than one part is a pinch.
template <int D>
void Diagnoser<D>::find_non_manifold_points() requires(D == 3) {
  std::vector<std::uint32_t> parent(3 * triangles_.size());
  std::iota(parent.begin(), parent.end(), 0u);
  const auto root = [&](std::uint32_t c) {
    while (parent[c] != c) c = parent[c] = parent[parent[c]];
    return c;
  };
  const auto corner = [&](std::uint32_t t, std::uint32_t v) {
    const auto& c = triangles_[t].corners;
    return 3 * t + (c[0] == v ? 0u : c[1] == v ? 1u : 2u);
  };
  for (std::size_t k = 1; k < uses_.size(); ++k) {
    if (uses_[k].key != uses_[k - 1].key) continue;
    for (const std::uint32_t v : uses_[k].edge()) {
      const std::uint32_t a = root(corner(uses_[k - 1].triangle, v)), b = root(corner(uses_[k].triangle, v));
      parent[std::max(a, b)] = std::min(a, b);
    }
  }
  std::vector<std::uint32_t> parts(p_.size());
  for (std::uint32_t c = 0; c < parent.size(); ++c)
    if (parent[c] == c) ++parts[triangles_[c / 3].corners[c % 3]];
  for (std::uint32_t v = 0; v < parts.size(); ++v) {
    if (parts[v] <= 1) continue;
    ++out_[Finding::non_manifold_point].count;
    if (wants_more(Finding::non_manifold_point))
      list(Finding::non_manifold_point, Errc::non_manifold,
           std::to_string(parts[v]) + " surfaces touch each other at point " + point_words(v), point_place(v), {point_number(v)},
           {p_[v]});
  }
}

template <int D>
void Diagnoser<D>::find_orientation() requires(D == 3) {
  const auto forward = [&](const EdgeUse& use) {  // in the sense of the input facet
    const auto [a, b] = use.edge();
    const Triangle& t = triangles_[use.triangle];
    for (std::size_t i = 0; i < 3; ++i)
      if (t.corners[i] == a && t.corners[(i + 1) % 3] == b) return !t.origin.reversed;
    return t.origin.reversed;
  };
  for (std::size_t begin = 0, n; begin < uses_.size(); begin += n) {
    const auto uses = uses_at(begin);
    n = uses.size();
    if (n != 2 || forward(uses[0]) != forward(uses[1])) continue;
    std::uint32_t f = triangles_[uses[0].triangle].origin.facet, g = triangles_[uses[1].triangle].origin.facet;
    if (f == g) continue;
    ++out_[Finding::inconsistent_orientation].count;
    if (!wants_more(Finding::inconsistent_orientation)) continue;
    if (f > g) std::swap(f, g);
    const Edge e = uses[0].edge();
    list(Finding::inconsistent_orientation, Errc::inconsistent_orientation,
         "facets " + facet_words(f) + " and " + facet_words(g) + " are oriented against each other at the edge " + edge_words(e),
         facet_place(f), {number(f), number(g), point_number(e[0]), point_number(e[1])}, {p_[e[0]], p_[e[1]]});
  }
}

// Only where nothing else is wrong: a point on an edge leaves a gap in the count that is none in space.
template <int D>
void Diagnoser<D>::find_encloses_nothing() {
  if (out_.error_count() > 0 || !all_collapses()) return;
  ++out_[Finding::encloses_nothing].count;
  const FindingList& open = out_[Finding::open_boundary];
  std::string message = std::string("the ") + (D == 3 ? "facets" : "segments") + " enclose nothing";
  Diagnostic first;
  first.file = domain_.source().file;
  if (!open.listed.empty()) {
    first = open.listed[0].what;
    message += "; open boundaries: " + std::to_string(open.count) + ", the first " + first.message;
  }
  list(Finding::encloses_nothing, Errc::encloses_nothing, std::move(message),
       {first.file, static_cast<std::uint32_t>(first.line)}, first.ids, {});
  out_[Finding::encloses_nothing].listed.back().what.points = first.points;
}

// What has a rim of its own (an edge, or in 2D an end, that nothing else has) bounds nothing. Taken away, it may leave
// others with such; if nothing is left, nothing bounds anything.
template <int D>
bool Diagnoser<D>::all_collapses() const {
  if (out_[Finding::open_boundary].count == 0) return D == 3 ? triangles_.empty() : domain_.segments().empty();
  // Walls by ridges: triangles by edges, segments by points.
  std::vector<std::array<std::uint32_t, D>> ridges_of;
  std::vector<std::uint32_t> begin{0}, walls_at;
  if constexpr (D == 3) {
    ridges_of.assign(triangles_.size(), {no_entity, no_entity, no_entity});
    for (std::size_t k = 0, n; k < uses_.size(); k += n) {
      n = uses_at(k).size();
      for (std::size_t i = k; i < k + n; ++i) {
        auto& mine = ridges_of[uses_[i].triangle];
        *std::find(mine.begin(), mine.end(), no_entity) = static_cast<std::uint32_t>(begin.size() - 1);
        walls_at.push_back(uses_[i].triangle);
      }
      begin.push_back(static_cast<std::uint32_t>(walls_at.size()));
    }
  } else {
    for (const DomainSegment& s : domain_.segments()) ridges_of.push_back(s.points);
    std::vector<std::pair<std::uint32_t, std::uint32_t>> ends;
    for (std::uint32_t s = 0; s < ridges_of.size(); ++s)
      for (const std::uint32_t v : ridges_of[s]) ends.emplace_back(v, s);
    std::sort(ends.begin(), ends.end());
    begin.assign(p_.size() + 1, 0);
    for (const auto& [v, s] : ends) {
      ++begin[v + 1];
      walls_at.push_back(s);
    }
    std::partial_sum(begin.begin(), begin.end(), begin.begin());
  }
  std::vector<std::uint32_t> left(begin.size() - 1), loose;
  for (std::uint32_t r = 0; r < left.size(); ++r)
    if ((left[r] = begin[r + 1] - begin[r]) == 1) loose.push_back(r);
  std::vector<bool> gone(ridges_of.size(), false);
  std::size_t remaining = ridges_of.size();
  while (!loose.empty()) {
    const std::uint32_t r = loose.back();
    loose.pop_back();
    for (std::uint32_t k = begin[r]; k < begin[r + 1]; ++k) {
      const std::uint32_t wall = walls_at[k];
      if (gone[wall]) continue;
      gone[wall] = true;
      --remaining;
      for (const std::uint32_t other : ridges_of[wall])
        if (--left[other] == 1) loose.push_back(other);
    }
  }
  return remaining == 0;
}

#define PGDR_INSTANTIATE(D)                         \
  template void Diagnoser<D>::find_repairs();       \
  template void Diagnoser<D>::find_unreferenced();  \
  template void Diagnoser<D>::find_open_boundary(); \
  template void Diagnoser<D>::find_encloses_nothing();
PGDR_INSTANTIATE(2)
PGDR_INSTANTIATE(3)
#undef PGDR_INSTANTIATE
template void Diagnoser<3>::find_non_manifold_edges();
template void Diagnoser<3>::find_non_manifold_points();
template void Diagnoser<3>::find_orientation();

}  // namespace pgdr::detail
