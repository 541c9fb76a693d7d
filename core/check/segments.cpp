// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Points and segments of the input in the mesh. Subsegments form paths between input points, since every other vertex
// of theirs joins exactly two; a segment's chain is the path between its ends.
#include <algorithm>
#include <set>
#include <utility>

#include "check/conformity.hpp"
#include "pgdr/predicates.hpp"

namespace pgdr::checking {

template <int D>
bool axis_aligned_segment(const Domain<D>& domain, EntityId segment) {
  const auto& ends = domain.segments()[segment].points;
  int differing = 0;
  for (int i = 0; i < D; ++i) differing += domain.points()[ends[0]][i] != domain.points()[ends[1]][i];
  return differing <= 1;
}

template <int D>
std::vector<double> slack_of_vertices(const Domain<D>& domain, std::span<const EntityRef> home, int ulps) {
  std::vector<double> points(domain.points().size(), 0), segments(domain.segments().size(), 0), facets(domain.facets().size(), 0);
  for (EntityId s = 0; s < segments.size(); ++s)
    if (!axis_aligned_segment(domain, s)) segments[s] = Tolerance{ulps, domain.segment_magnitude(s)}.width();
  if constexpr (D == 3)
    for (EntityId f = 0; f < facets.size(); ++f) {
      if (axis_aligned_facet(domain, f)) continue;
      facets[f] = Tolerance{ulps, domain.facet_magnitude(f)}.width();
      if (domain.facets()[f].planar) continue;
      for (const std::uint32_t p : domain.facet_points(f)) points[p] = std::max(points[p], facets[f]);
    }
  std::vector<double> slack;
  slack.reserve(home.size());
  for (const EntityRef& entity : home)
    slack.push_back(entity.kind == EntityKind::vertex    ? points[entity.id]
                    : entity.kind == EntityKind::segment ? segments[entity.id]
                    : entity.kind == EntityKind::facet   ? facets[entity.id]
                                                         : 0);
  return slack;
}

template <int D>
void match_points(const ConformityTask<D>& task, std::span<const std::uint32_t> sorted, Conformity<D>& out) {
  const auto& mesh = task.mesh;
  const auto& domain = task.input.domain();
  std::vector<std::uint8_t> in_cell(mesh.points.size(), 0);
  for (const auto& cell : mesh.cells)
    for (const std::uint32_t v : cell) in_cell[v] = 1;
  // A point without a marker may have that of a segment that ends there, as Triangle has it.
  std::set<std::pair<std::uint32_t, int>> handed_on;
  for (const DomainSegment& s : domain.segments())
    for (const std::uint32_t p : s.points)
      if (s.marker != 0 && domain.point_markers()[p] == 0) handed_on.emplace(p, s.marker);
  out.home.assign(mesh.points.size(), {});
  out.vertex_of_point.assign(domain.points().size(), none);
  for (std::uint32_t p = 0; p < domain.points().size(); ++p) {
    const Point<D>& x = domain.points()[p];
    const auto at = std::lower_bound(sorted.begin(), sorted.end(), x,
                                     [&](std::uint32_t v, const Point<D>& y) { return lex_less(mesh.points[v], y); });
    const bool found = at != sorted.end() && mesh.points[*at] == x;
    if (found) {
      out.vertex_of_point[p] = *at;
      out.home[*at] = {EntityKind::vertex, p};
    }
    if (found && in_cell[*at]) {
      const int marker = mesh.point_markers.empty() ? 0 : mesh.point_markers[*at];
      if (marker == domain.point_markers()[p] || (domain.point_markers()[p] == 0 && handed_on.count({p, marker}) > 0)) continue;
      task.findings.add(Kind::wrong_marker, {*at}, [&] {
        return "Input point " + std::to_string(p) + ", " + vertex_words(mesh, *at) + ", has marker " + std::to_string(marker) +
               " instead of " + std::to_string(domain.point_markers()[p]) + ".";
      });
    } else if (task.input.wants_point(p)) {
      task.findings.add(Kind::missing_input_point, {p}, [&] {
        return "Input point " + std::to_string(p) + " " + words(x) +
               (found ? " is a vertex of no cell." : " is not in the mesh.");
      });
    }
  }
  for (std::uint32_t v = 0; v < mesh.points.size(); ++v)
    if (!in_cell[v] && out.home[v].kind != EntityKind::vertex)
      task.findings.add(Kind::unreferenced_point, {v},
                        [&] { return "The " + vertex_words(mesh, v) + " is neither an input point nor in a cell."; });
}

namespace {

/// Subsegments from one input point to another.
struct Chain {
  std::vector<std::uint32_t> vertices, subsegments;
};

template <int D>
class SegmentMatcher {
 public:
  SegmentMatcher(const ConformityTask<D>& task, Conformity<D>& out)
      : task_(task), mesh_(task.mesh), domain_(task.input.domain()), out_(out) {}

  void run() {
    collect_incidence();
    collect_chains();
    out_.segment_of.assign(mesh_.subsegments.size(), {});
    out_.pieces.assign(domain_.segments().size(), 0);
    if constexpr (D == 2) out_.patch_of.assign(mesh_.subsegments.size(), {});
    for (EntityId s = 0; s < domain_.segments().size(); ++s) match(s);
    for (std::uint32_t i = 0; i < mesh_.subsegments.size(); ++i) {
      if (out_.segment_of[i].entity != none) continue;
      task_.findings.add(Kind::stray_constraint, {i}, [&] {
        return "Subsegment " + std::to_string(i) + " (" + list_words(mesh_.subsegments[i].vertices) +
               ") belongs to no input segment.";
      });
    }
  }

 private:
  bool is_input(std::uint32_t v) const { return out_.home[v].kind == EntityKind::vertex; }
  std::span<const std::uint32_t> at(std::uint32_t v) const {
    return std::span(incident_).subspan(begin_[v], begin_[v + 1] - begin_[v]);
  }

  void collect_incidence() {
    begin_.assign(mesh_.points.size() + 1, 0);
    for (const auto& s : mesh_.subsegments)
      for (const std::uint32_t v : s.vertices) ++begin_[v + 1];
    for (std::size_t v = 1; v < begin_.size(); ++v) begin_[v] += begin_[v - 1];
    incident_.resize(begin_.back());
    auto next = begin_;
    for (std::uint32_t i = 0; i < mesh_.subsegments.size(); ++i)
      for (const std::uint32_t v : mesh_.subsegments[i].vertices) incident_[next[v]++] = i;
  }

  void collect_chains() {
    used_.assign(mesh_.subsegments.size(), 0);
    for (std::uint32_t v = 0; v < mesh_.points.size(); ++v) {
      if (is_input(v)) {
        for (const std::uint32_t i : at(v))
          if (!used_[i]) walk(v, i);
      } else if (const auto n = at(v).size(); n != 0 && n != 2) {
        task_.findings.add(Kind::segment_not_conforming, {v}, [&] {
          return "At " + vertex_words(mesh_, v) + ", which is no input point, " + std::to_string(n) +
                 " subsegments meet instead of two.";
        });
      }
    }
    std::sort(by_ends_.begin(), by_ends_.end());
  }

  void walk(std::uint32_t v, std::uint32_t i) {
    Chain chain{{v}, {}};
    for (;;) {
      used_[i] = 1;
      const auto& ends = mesh_.subsegments[i].vertices;
      v = ends[0] == v ? ends[1] : ends[0];
      chain.vertices.push_back(v);
      chain.subsegments.push_back(i);
      if (is_input(v)) break;
      if (at(v).size() != 2) return;
      i = at(v)[0] == i ? at(v)[1] : at(v)[0];
      if (used_[i]) return;  // listed twice, or the path closes on itself
    }
    const auto number = static_cast<std::uint32_t>(chains_.size());
    by_ends_.push_back({chain.vertices.front(), v, number});
    by_ends_.push_back({v, chain.vertices.front(), number});
    chains_.push_back(std::move(chain));
  }

  /// Chains from vertex a to vertex b (from a to anywhere, if b is none).
  std::span<const std::array<std::uint32_t, 3>> chains(std::uint32_t a, std::uint32_t b) const {
    const std::array<std::uint32_t, 3> low{a, b == none ? 0 : b, 0}, high{a, b, none};
    const auto first = std::lower_bound(by_ends_.begin(), by_ends_.end(), low);
    return {first, std::upper_bound(first, by_ends_.end(), high)};
  }

  void match(EntityId s) {
    const auto& points = domain_.segments()[s].points;
    const std::uint32_t p = out_.vertex_of_point[points[0]], q = out_.vertex_of_point[points[1]];
    Chain found;
    if (p != none && q != none) {
      for (const auto& candidate : chains(p, q)) {
        const Chain chain = directed(candidate[2], p);
        if (found.vertices.empty() || count_off(s, chain) == 0) found = chain;
      }
      if (found.vertices.empty()) found = along_input_points(s, p, q);
    }
    if (!found.vertices.empty()) return accept(s, found);
    if (!task_.input.wants_segment(s)) return;
    task_.findings.add(Kind::segment_not_conforming, {s}, [&] {
      return "No chain of subsegments joins the ends of segment " + std::to_string(s) + ", input points " +
             std::to_string(points[0]) + " " + words(domain_.points()[points[0]]) + " and " + std::to_string(points[1]) + " " +
             words(domain_.points()[points[1]]) + ".";
    });
  }

  Chain directed(std::uint32_t number, std::uint32_t from) const {
    Chain chain = chains_[number];
    if (chain.vertices.front() != from) {
      std::reverse(chain.vertices.begin(), chain.vertices.end());
      std::reverse(chain.subsegments.begin(), chain.subsegments.end());
    }
    return chain;
  }

  /// A segment may run through input points that lie on it exactly.
  Chain along_input_points(EntityId s, std::uint32_t p, std::uint32_t q) const {
    const auto& points = mesh_.points;
    Chain path{{p}, {}};
    while (path.vertices.back() != q) {
      const std::uint32_t here = path.vertices.back();
      bool stepped = false;
      for (const auto& [from, to, number] : chains(here, none)) {
        if (!collinear(points[p], points[q], points[to]) || !advances(points[p], points[q], points[here], points[to])) continue;
        if (to != q && !advances(points[p], points[q], points[to], points[q])) continue;
        const Chain step = directed(number, from);
        if (count_off(s, step) > 0) continue;
        path.vertices.insert(path.vertices.end(), step.vertices.begin() + 1, step.vertices.end());
        path.subsegments.insert(path.subsegments.end(), step.subsegments.begin(), step.subsegments.end());
        stepped = true;
        break;
      }
      if (!stepped) return {};
    }
    return path;
  }

  bool on_line(EntityId s, const Point<D>& x) const {
    const auto& ends = domain_.segments()[s].points;
    const auto &p = domain_.points()[ends[0]], &q = domain_.points()[ends[1]];
    if (!axis_aligned_segment(domain_, s)) return near_line(p, q, x, {task_.ulps, domain_.segment_magnitude(s)});
    for (int i = 0; i < D; ++i)
      if (p[i] == q[i] && x[i] != p[i]) return false;
    return true;
  }

  bool in_order(EntityId s, std::uint32_t v, std::uint32_t w) const {
    const auto& ends = domain_.segments()[s].points;
    return advances(domain_.points()[ends[0]], domain_.points()[ends[1]], mesh_.points[v], mesh_.points[w]);
  }

  std::size_t count_off(EntityId s, const Chain& chain) const {
    std::size_t off = 0;
    for (std::size_t i = 1; i < chain.vertices.size(); ++i) {
      off += !on_line(s, mesh_.points[chain.vertices[i]]);
      off += !in_order(s, chain.vertices[i - 1], chain.vertices[i]);
    }
    return off;
  }

  void accept(EntityId s, const Chain& chain) {
    out_.pieces[s] = static_cast<std::uint32_t>(chain.subsegments.size());
    for (std::size_t i = 0; i < chain.subsegments.size(); ++i) {
      const std::uint32_t v = chain.vertices[i], w = chain.vertices[i + 1], sub = chain.subsegments[i];
      const bool reversed = mesh_.subsegments[sub].vertices[0] != v;
      out_.segment_of[sub] = {s, reversed};
      if constexpr (D == 2) out_.patch_of[sub] = {s, reversed};  // patches are numbered as segments
      if (!is_input(w)) out_.home[w] = {EntityKind::segment, s};
      check_marker(s, sub);
      if (!on_line(s, mesh_.points[w])) report_off(s, w);
      if (!in_order(s, v, w)) report_order(s, v, w);
    }
  }

  void check_marker(EntityId s, std::uint32_t sub) {
    if (mesh_.subsegments[sub].marker == domain_.segments()[s].marker) return;
    task_.findings.add(Kind::wrong_marker, {sub, s}, [&] {
      return "Subsegment " + std::to_string(sub) + " (" + list_words(mesh_.subsegments[sub].vertices) + ") has marker " +
             std::to_string(mesh_.subsegments[sub].marker) + ", its segment " + std::to_string(s) + " has " +
             std::to_string(domain_.segments()[s].marker) + ".";
    });
  }

  void report_off(EntityId s, std::uint32_t v) {
    task_.findings.add(Kind::segment_not_conforming, {v, s}, [&] {
      const auto& ends = domain_.segments()[s].points;
      const double off = distance_from_line(domain_.points()[ends[0]], domain_.points()[ends[1]], mesh_.points[v]);
      return "The " + vertex_words(mesh_, v) + " is " + words(off) + " off the line of segment " + std::to_string(s) + ", " +
             words(off / Tolerance{1, domain_.segment_magnitude(s)}.width()) + " ulps.";
    });
  }

  void report_order(EntityId s, std::uint32_t v, std::uint32_t w) {
    task_.findings.add(Kind::segment_not_conforming, {v, w, s}, [&] {
      return "Along segment " + std::to_string(s) + " the chain goes back from " + vertex_words(mesh_, v) + " to " +
             vertex_words(mesh_, w) + ".";
    });
  }

  const ConformityTask<D>& task_;
  const OutputMesh<D>& mesh_;
  const Domain<D>& domain_;
  Conformity<D>& out_;
  std::vector<std::size_t> begin_;
  std::vector<std::uint32_t> incident_;
  std::vector<std::uint8_t> used_;
  std::vector<Chain> chains_;
  std::vector<std::array<std::uint32_t, 3>> by_ends_;  ///< from, to, chain; both ways, sorted
};

}  // namespace

template <int D>
void match_segments(const ConformityTask<D>& task, Conformity<D>& out) {
  SegmentMatcher<D>(task, out).run();
}

#define PGDR_INSTANTIATE(D)                                                                             \
  template bool axis_aligned_segment(const Domain<D>&, EntityId);                                       \
  template std::vector<double> slack_of_vertices(const Domain<D>&, std::span<const EntityRef>, int);    \
  template void match_points(const ConformityTask<D>&, std::span<const std::uint32_t>, Conformity<D>&); \
  template void match_segments(const ConformityTask<D>&, Conformity<D>&);
PGDR_INSTANTIATE(2)
PGDR_INSTANTIATE(3)
#undef PGDR_INSTANTIATE

}  // namespace pgdr::checking
