// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "given/named_entities.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "given/cover.hpp"
#include "given/edge_net.hpp"
#include "given/flat_groups.hpp"
#include "given/segment_chain.hpp"
#include "numbers/vectors.hpp"
#include "pgdr/predicates.hpp"
#include "space/distances.hpp"
#include "space/equal_rows.hpp"
#include "space/make_set.hpp"

namespace pgdr::checking {

template <int D>
NamedEntities<D>::NamedEntities(const GivenTask<D>& task, const GivenMatch<D>& match, std::span<const std::uint32_t> sorted,
                                std::optional<OwnFacets> own)
    : mesh_(task.mesh),
      input_(task.input),
      match_(match),
      sorted_(sorted),
      is_given_(mesh_.points.size(), 0),
      own_(std::move(own)) {
  for (const std::uint32_t v : match.vertex_of_point)
    if (v != none) is_given_[v] = 1;
}

template <int D>
const NamedEntity<D>* NamedEntities<D>::find(const GivenEntity& name) {
  if (name.kind == EntityKind::segment) {
    const auto [at, fresh] = segments_.try_emplace(
        std::array{std::min(name.ends[0], name.ends[1]), std::max(name.ends[0], name.ends[1])});
    auto& out = at->second;
    if (fresh) {
      make_segment(name.ends, out.emplace());
      if (out->ends[0] == out->ends[1] || !is_covered(*out)) out.reset();
    }
    return out ? &*out : nullptr;
  }
  if (D != 3 || name.kind != EntityKind::facet) return nullptr;
  const auto [at, fresh] = facets_.try_emplace(name.facet, nullptr);
  if (fresh) at->second = make_facet(name.facet);
  return at->second;
}

template <int D>
std::uint32_t NamedEntities<D>::known_number(const Point<D>& x) const {
  const auto at = std::lower_bound(sorted_.begin(), sorted_.end(), x,
                                   [&](std::uint32_t v, const Point<D>& y) { return lex_less(mesh_.points[v], y); });
  if (at != sorted_.end() && mesh_.points[*at] == x) return *at;
  const auto known = further_numbers_.find(x.x);
  return known != further_numbers_.end() ? known->second : none;
}

template <int D>
std::uint32_t NamedEntities<D>::number_of(const Point<D>& x) {
  if (const std::uint32_t known = known_number(x); known != none) return known;
  further_numbers_[x.x] = static_cast<std::uint32_t>(mesh_.points.size() + further_points_.size());
  further_points_.push_back(x);
  return further_numbers_[x.x];
}

template <int D>
void NamedEntities<D>::make_segment(std::array<std::array<double, 3>, 2> of, NamedEntity<D>& out) {
  out.kind = EntityKind::segment;
  std::sort(of.begin(), of.end());
  std::array<Point<D>, 2> ends;
  for (std::size_t k = 0; k < 2; ++k) {
    for (int i = 0; i < D; ++i) ends[k][i] = of[k][static_cast<std::size_t>(i)];
    for (const double x : ends[k].x)
      if (!std::isfinite(x)) return;
    out.ends[k] = number_of(ends[k]);
    out.points.push_back(out.ends[k]);
  }
  if (!subsegments_) {
    std::vector<detail::Box<D>> boxes;
    for (const auto& s : mesh_.subsegments)
      boxes.push_back(detail::Box<D>::of(std::array{mesh_.points[s.vertices[0]], mesh_.points[s.vertices[1]]}));
    subsegments_ = std::make_unique<detail::BoxTree<D>>(boxes);
  }
  if (out.ends[0] == out.ends[1]) return;
  std::vector<NearEdge<D>> near;
  std::vector<std::uint32_t> numbers;
  subsegments_->meeting(detail::Box<D>::of(ends).widened(input_.reach()), [&](std::uint32_t s) {
    const auto& v = mesh_.subsegments[s].vertices;
    if (!is_near<D>(mesh_.points[v[0]], ends, input_.reach()) || !is_near<D>(mesh_.points[v[1]], ends, input_.reach())) return;
    near.push_back({v, {mesh_.points[v[0]], mesh_.points[v[1]]}});
    numbers.push_back(s);
  });
  std::vector<std::uint32_t> pieces = segment_chain<D>(near, out.ends, ends);
  if (pieces.empty()) {
    pieces.resize(near.size());
    std::iota(pieces.begin(), pieces.end(), 0u);
  }
  for (const std::uint32_t i : pieces) {
    const auto& v = near[i].ends;
    out.edges.push_back({sorted_edge(v[0], v[1]), numbers[i]});
    out.points.insert(out.points.end(), v.begin(), v.end());
  }
  std::sort(out.edges.begin(), out.edges.end());
  detail::make_set(out.points);
}

/// Subsegments have all of it, or what was given and is not in the mesh has the rest.
template <int D>
bool NamedEntities<D>::is_covered(const NamedEntity<D>& segment) const {
  const std::array<Point<D>, 2> ends{point(segment.ends[0]), point(segment.ends[1])};
  std::vector<CoveringSegment<D>> covers;
  for (const auto& [v, s] : segment.edges) covers.push_back({{mesh_.points[v[0]], mesh_.points[v[1]]}, input_.reach()});
  if (uncovered_parts<D>(ends, covers).empty()) return true;
  const double reach = 2 * input_.tolerance() + input_.rounding();
  const auto box = detail::Box<D>::of(ends);
  const auto add = [&](std::uint32_t p, std::uint32_t q) {
    const std::array<Point<D>, 2> given{input_.point(p), input_.point(q)};
    if (detail::Box<D>::of(given).widened(reach).meets(box)) covers.push_back({given, reach});
  };
  for (const GivenSegment& s : input_.segments()) add(s.points[0], s.points[1]);
  for (const GivenTriangle& t : input_.triangles())
    for (int i = 0; i < 3; ++i) add(t.points[i], t.points[(i + 1) % 3]);
  return uncovered_parts<D>(ends, covers).empty();
}

template <int D>
void NamedEntities<D>::add_triangle(const std::array<std::uint32_t, 3>& t, NamedEntity<D>& out) const {
  if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) return;
  const auto number = static_cast<std::uint32_t>(out.triangles.size());
  out.triangles.push_back(t);
  for (std::size_t i = 0; i < 3; ++i) {
    out.edges.push_back({sorted_edge(t[(i + 1) % 3], t[(i + 2) % 3]), t[i]});
    out.at.emplace_back(t[i], number);
    out.points.push_back(t[i]);
  }
}

/// Null if it has no triangles.
template <int D>
const NamedEntity<D>* NamedEntities<D>::make_facet(std::uint32_t facet) {
  if constexpr (D == 3) {
    join_flat_parts();
    const auto triangles = input_.triangles();
    const auto own = detail::equal_rows(std::span<const GivenTriangle>(triangles), facet, &GivenTriangle::facet);
    const auto first = static_cast<std::uint32_t>(own.data() - triangles.data());
    const auto last = first + static_cast<std::uint32_t>(own.size());
    std::vector<std::uint32_t> parts;
    for (std::uint32_t t = first; t < last; ++t) parts.push_back(flat_->find(t));
    detail::make_set(parts);
    for (std::uint32_t t = first; t < last; ++t)  // so that numbers of points that are in no mesh are known
      for (const std::uint32_t p : triangles[t].points)
        if (match_.vertex_of_point[p] == none) number_of(input_.point(p));
    const NamedEntity<D>& all = all_of(parts);
    if (all.triangles.empty()) return nullptr;
    std::vector<const NamedEntity<D>*> faces;
    if (!own_) faces = faces_of(members_alone(first, last));
    if (own_ || (all.is_one_plane && !all.is_loose)) {
      const auto [at, fresh] = plates_.try_emplace({parts, faces}, all);
      if (!fresh) return &at->second;
      at->second.faces = std::move(faces);
      if (own_) at->second.off = std::max(all.off, own_->thickness[own_->sets.find(facet)]);
      return &at->second;
    }
    NamedEntity<D>& out = bent_.try_emplace(facet, all).first->second;
    out.faces = std::move(faces);
    const std::vector<std::uint32_t> members = members_alone(first, last);
    for (const std::size_t count : {members.size(), static_cast<std::size_t>(last - first)}) {
      NamedEntity<D>& alone = out.alone.emplace_back();
      alone.parts = {static_cast<std::uint32_t>(by_flat_.size()) + facet};  // of no set
      fill_facet(std::span(members).first(count), alone);
    }
    // The corners of given triangles are where they are: what may be off is what was put onto them.
    out.alone.back().off = 0;
    out.alone.back().is_loose = false;
    return &out;
  }
  return nullptr;
}

/// All that hangs together with these sets, made once.
template <int D>
const NamedEntity<D>& NamedEntities<D>::all_of(const std::vector<std::uint32_t>& parts) {
  const auto [at, fresh] = groups_.try_emplace(parts);
  NamedEntity<D>& out = at->second;
  if (!fresh) return out;
  const auto triangles = input_.triangles();
  std::vector<std::uint32_t> members;
  for (const std::uint32_t part : parts)
    for (auto row = std::ranges::lower_bound(by_flat_, std::pair{part, 0u}); row != by_flat_.end() && row->first == part; ++row) {
      members.push_back(row->second);
      if (row->second >= triangles.size()) continue;
      for (const std::uint32_t p : triangles[row->second].points)
        if (match_.vertex_of_point[p] == none) number_of(input_.point(p));
    }
  out.parts = parts;
  fill_facet(members, out);
  if (!own_) out.is_one_plane = is_in_one_plane(out);
  return out;
}

/// May the subfacet lie in the plane of the given triangle?
template <int D>
bool NamedEntities<D>::lies_on(std::uint32_t subfacet, std::uint32_t given) const {
  if constexpr (D == 3)
    return std::ranges::all_of(mesh_.subfacets[subfacet].vertices, [&](std::uint32_t v) {
      return may_be_even(input_.corners(input_.triangles()[given]), mesh_.points[v], match_.reach[given]);
    });
  return false;
}

/// The facet's triangles, and the subfacets that lie on these.
template <int D>
std::vector<std::uint32_t> NamedEntities<D>::members_alone(std::uint32_t first, std::uint32_t last) const {
  std::vector<std::uint32_t> members;
  for (std::uint32_t t = first; t < last; ++t) members.push_back(t);
  const auto count = static_cast<std::uint32_t>(input_.triangles().size());
  for (auto on = std::ranges::lower_bound(match_.on_given, first, {}, &OnGiven::given);
       on != match_.on_given.end() && on->given < last; ++on)
    if (lies_on(on->wall, on->given)) members.push_back(count + on->wall);
  return members;
}

/// @param members numbers of given triangles, and of subfacets behind them
template <int D>
void NamedEntities<D>::fill_facet(std::span<const std::uint32_t> members, NamedEntity<D>& out) const {
  if constexpr (D == 3) {
    out.kind = EntityKind::facet;
    const auto triangles = input_.triangles();
    const auto corner = [&](std::uint32_t p) {
      const std::uint32_t v = match_.vertex_of_point[p];
      return v != none ? v : known_number(input_.point(p));
    };
    for (const std::uint32_t i : members) {
      if (i >= triangles.size()) {
        add_triangle(mesh_.subfacets[i - triangles.size()].vertices, out);
      } else {
        const auto& p = triangles[i].points;
        add_triangle({corner(p[0]), corner(p[1]), corner(p[2])}, out);
        out.off = std::max(out.off, own_ ? input_.rounding() : match_.reach[i]);
      }
    }
    std::array<bool, 3> is_level{true, true, true};
    std::vector<detail::Box<3>> boxes;
    for (const auto& t : out.triangles) {
      boxes.push_back(detail::Box<3>::of(std::array{point(t[0]), point(t[1]), point(t[2])}));
      for (int k = 0; k < 3; ++k)
        is_level[k] = is_level[k] && boxes.back().low[k] == boxes[0].low[k] && boxes.back().high[k] == boxes[0].low[k];
    }
    out.is_loose = out.off > 1.5 * input_.reach();
    // In a level plane all points are, exactly; but of the mesh's own surface those on edges are rounded along it.
    if (!own_ && (is_level[0] || is_level[1] || is_level[2])) out.off = 0;
    std::sort(out.edges.begin(), out.edges.end());
    std::sort(out.at.begin(), out.at.end());
    detail::make_set(out.points);
    out.tree = std::make_shared<const detail::BoxTree<3>>(boxes);
  }
}

template <int D>
std::array<Point<D>, 3> NamedEntities<D>::largest_triangle(const NamedEntity<D>& facet) const {
  std::array<Point<D>, 3> largest{};
  if constexpr (D == 3) {
    double most = -1;
    for (const auto& t : facet.triangles) {
      const std::array<Point3, 3> corners{point(t[0]), point(t[1]), point(t[2])};
      const auto n = detail::cross(detail::difference(corners[1], corners[0]), detail::difference(corners[2], corners[0]));
      if (const double area = detail::dot(n, n); area > most) most = area, largest = corners;
    }
  }
  return largest;
}

/// Are all its points within the tolerance of the plane of its largest triangle?
template <int D>
bool NamedEntities<D>::is_in_one_plane(const NamedEntity<D>& facet) const {
  if constexpr (D == 3) {
    const PlaneFrame frame(largest_triangle(facet));
    return std::ranges::all_of(facet.points,
                               [&](std::uint32_t p) { return std::abs(frame.place(point(p))[2]) <= input_.tolerance(); });
  }
  return true;
}

template <int D>
bool NamedEntities<D>::are_in_one_plane(const NamedEntity<D>& facet, const NamedEntity<D>& other) const {
  if constexpr (D == 3) {
    const auto p = largest_triangle(facet);
    const auto is_on = [&](std::uint32_t q) { return orient3d(p[0], p[1], p[2], point(q)) == Sign::zero; };
    return std::ranges::all_of(facet.points, is_on) && std::ranges::all_of(other.points, is_on);
  }
  return false;
}

template <int D>
void NamedEntities<D>::join_flat_parts() {
  if constexpr (D == 3) {
    if (flat_) return;
    if (own_) {
      join_own_parts();
      return;
    }
    const auto count = static_cast<std::uint32_t>(input_.triangles().size());
    flat_ = flat_groups(input_, mesh_.subfacets.size(), nullptr);
    const auto marker = [&](std::uint32_t s) { return mesh_.subfacets[s].marker; };
    const auto corners = [&](std::uint32_t s) {
      const auto& v = mesh_.subfacets[s].vertices;
      return std::array{mesh_.points[v[0]], mesh_.points[v[1]], mesh_.points[v[2]]};
    };
    const auto is_even = [](const std::array<Point3, 3>& triangle, const std::array<Point3, 3>& other, double reach) {
      return std::ranges::all_of(other, [&](const Point3& x) { return may_be_even(triangle, x, reach); });
    };
    for (const OnGiven& on : match_.on_given) {
      if (marker(on.wall) == input_.marker(input_.triangles()[on.given]) && lies_on(on.wall, on.given))
        flat_->unite(on.given, count + on.wall);
    }
    std::vector<NamedEntity<3>::AtEdge> edges;  // with the subfacet in place of its apex
    for (std::uint32_t s = 0; s < mesh_.subfacets.size(); ++s)
      for (std::size_t i = 0; i < 3; ++i) {
        const auto& v = mesh_.subfacets[s].vertices;
        edges.push_back({sorted_edge(v[(i + 1) % 3], v[(i + 2) % 3]), s});
      }
    std::sort(edges.begin(), edges.end());
    join_faces(edges);
    for (std::size_t i = 0, j; i < edges.size(); i = j) {
      for (j = i + 1; j < edges.size() && edges[j].ends == edges[i].ends;) ++j;
      const std::uint32_t s = edges[i].apex, t = edges[j - 1].apex;
      if (j - i != 2 || marker(s) != marker(t)) continue;
      const auto of_s = corners(s), of_t = corners(t);
      if (is_even(of_s, of_t, input_.reach()) && is_even(of_t, of_s, input_.reach())) flat_->unite(count + s, count + t);
    }
    for (std::uint32_t i = 0; i < count + mesh_.subfacets.size(); ++i) by_flat_.emplace_back(flat_->find(i), i);
    std::sort(by_flat_.begin(), by_flat_.end());
  }
}

/// @param edges  of subfacets, with these in place of the apices, sorted
template <int D>
void NamedEntities<D>::join_faces(std::span<const typename NamedEntity<D>::AtEdge> edges) {
  std::vector<detail::PlanarEdge> subsegments;
  for (const auto& s : mesh_.subsegments) subsegments.push_back(sorted_edge(s.vertices[0], s.vertices[1]));
  std::ranges::sort(subsegments);
  detail::DisjointSets sets(mesh_.subfacets.size());
  for (std::size_t i = 1; i < edges.size(); ++i)
    if (edges[i].ends == edges[i - 1].ends && !std::ranges::binary_search(subsegments, edges[i].ends))
      sets.unite(edges[i - 1].apex, edges[i].apex);
  for (std::uint32_t s = 0; s < mesh_.subfacets.size(); ++s) face_of_.push_back(sets.find(s));
  for (std::uint32_t s = 0; s < mesh_.subfacets.size(); ++s) by_face_.emplace_back(face_of_[s], s);
  std::ranges::sort(by_face_);
  off_of_face_.resize(mesh_.subfacets.size(), 0);
  for (const OnGiven& on : match_.on_given) {
    double& off = off_of_face_[face_of_[on.wall]];
    off = std::max(off, match_.reach[on.given]);
  }
}

/// Those with one of these members, each made once.
template <int D>
std::vector<const NamedEntity<D>*> NamedEntities<D>::faces_of(std::span<const std::uint32_t> members) {
  const auto count = static_cast<std::uint32_t>(input_.triangles().size());
  std::vector<std::uint32_t> faces;
  for (const std::uint32_t member : members)
    if (member >= count) faces.push_back(face_of_[member - count]);
  detail::make_set(faces);
  std::vector<const NamedEntity<D>*> out;
  for (const std::uint32_t face : faces) {
    const auto [at, fresh] = faces_.try_emplace(face);
    out.push_back(&at->second);
    if (!fresh) continue;
    std::vector<std::uint32_t> subfacets;
    using Row = std::pair<std::uint32_t, std::uint32_t>;
    for (const auto& row : detail::equal_rows(std::span<const Row>(by_face_), face, &Row::first))
      subfacets.push_back(count + row.second);
    at->second.parts = {static_cast<std::uint32_t>(by_flat_.size()) + count + face};  // of no set
    at->second.off = off_of_face_[face];
    fill_facet(subfacets, at->second);
  }
  return out;
}

template <int D>
void NamedEntities<D>::join_own_parts() {
  const auto count = static_cast<std::uint32_t>(input_.triangles().size());
  flat_.emplace(2 * std::size_t{count});
  for (std::uint32_t s = 0; s < count; ++s) {
    flat_->unite(s, count + s);
    flat_->unite(s, own_->sets.find(s));
  }
  for (std::uint32_t i = 0; i < 2 * count; ++i) by_flat_.emplace_back(flat_->find(i), i);
  std::sort(by_flat_.begin(), by_flat_.end());
}

template <int D>
bool NamedEntities<D>::is_within(const Point<D>& x, double distance, const NamedEntity<D>& entity) const {
  if (entity.kind == EntityKind::segment)
    return std::sqrt(detail::closest_to_edge(x, point(entity.ends[0]), point(entity.ends[1])).square) <= distance;
  bool found = false;
  if constexpr (D == 3)
    entity.tree->meeting(detail::Box<3>::around(x).widened(distance), [&](std::uint32_t t) {
      const auto& v = entity.triangles[t];
      found = found || std::sqrt(detail::closest_to_triangle(x, point(v[0]), point(v[1]), point(v[2])).square) <= distance;
    });
  return found;
}

template class NamedEntities<2>;
template class NamedEntities<3>;

}  // namespace pgdr::checking
