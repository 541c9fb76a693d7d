// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Facets of the input in the mesh. A patch (part of a facet that no segment divides) is covered exactly once if a piece
// of subfacets has the patch's boundary as its boundary, edge by edge, and no subfacet is turned over in the
// projection: the number of times a point is covered is then the winding number of that boundary round it. Both are
// tested, and, per vertex, the distance from the plane.
#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <tuple>

#include "check/pieces.hpp"
#include "pgdr/predicates.hpp"
#include "space/box_tree.hpp"

namespace pgdr::checking {

bool axis_aligned_facet(const Domain<3>& domain, EntityId facet) {
  const DomainFacet& f = domain.facets()[facet];
  const auto points = domain.facet_points(facet);
  return std::all_of(points.begin(), points.end(),
                     [&](std::uint32_t p) { return domain.points()[p][f.axis] == domain.points()[points[0]][f.axis]; });
}

namespace {

constexpr std::uint32_t few_triangles = 32;  // are looked at one after the other

/// Twice the area in the projection of the facet, and a bound of its error.
std::pair<double, double> projected_area(const std::array<Point3, 3>& t, int axis) {
  const int j = (axis + 1) % 3, k = (axis + 2) % 3;
  return signed_measure<2>({{{{t[0][j], t[0][k]}}, {{t[1][j], t[1][k]}}}}, {{t[2][j], t[2][k]}});
}

double longest_edge(const std::array<Point3, 3>& t) {
  return std::sqrt(std::max({squared_distance(t[0], t[1]), squared_distance(t[1], t[2]), squared_distance(t[2], t[0])}));
}

class FacetMatcher {
 public:
  FacetMatcher(const ConformityTask<3>& task, Conformity<3>& out)
      : task_(task), mesh_(task.mesh), input_(task.input), domain_(task.input.domain()), out_(out) {}

  void run() {
    pieces_ = collect_pieces(task_, out_);
    out_.patch_of.assign(mesh_.subfacets.size(), {});
    sums_.resize(input_.patches().size());
    uses_.assign(input_.bounds().size(), 0);
    facet_used_.assign(domain_.facets().size(), false);
    for (EntityId f = 0; f < domain_.facets().size(); ++f) aligned_.push_back(axis_aligned_facet(domain_, f));
    plant_trees();
    for (const Piece& piece : pieces_.list) {
      task_.findings.heed_stop();
      match(piece);
    }
    for (std::uint32_t p = 0; p < input_.patches().size(); ++p)
      if (sums_[p].used)
        check_cover(p);
      else if (input_.wants_patch(p))
        report_missing(p);
    check_bounds();
    check_points();
  }

 private:
  using BoundKey = std::tuple<std::uint32_t, EntityId, bool>;  // patch, segment, reversed
  struct Candidate {
    std::uint32_t patch = none;
    bool reversed = false;  ///< the piece runs against the patch's sense
    std::size_t faults = 0;
  };

  std::array<Point3, 3> corners(std::uint32_t t) const {
    const auto& v = mesh_.subfacets[t].vertices;
    return {mesh_.points[v[0]], mesh_.points[v[1]], mesh_.points[v[2]]};
  }
  EntityId facet(std::uint32_t patch) const { return input_.patches()[patch].entity; }
  Tolerance tolerance(EntityId f) const { return {task_.ulps, domain_.facet_magnitude(f)}; }

  std::vector<std::uint32_t> vertices_of(const Piece& piece) const {
    std::vector<std::uint32_t> v;
    for (const std::uint32_t t : piece.subfacets)
      v.insert(v.end(), mesh_.subfacets[t].vertices.begin(), mesh_.subfacets[t].vertices.end());
    std::sort(v.begin(), v.end());
    v.erase(std::unique(v.begin(), v.end()), v.end());
    return v;
  }

  /// Twice the signed projected area of the piece, in its own sense.
  double area(const Piece& piece, int axis) const {
    CompensatedSum sum;
    for (const std::uint32_t t : piece.subfacets) sum.add(projected_area(corners(t), axis).first * (pieces_.turned[t] ? -1 : 1));
    return sum.value();
  }

  // The patches along one of the piece's segments are few. Of those that lie on the same side of it in their
  // projection, the one whose plane and bounds fit best.
  Candidate best_patch(const Piece& piece, std::span<const std::uint32_t> vertices) const {
    Candidate best;
    for (std::size_t i = 0; i < piece.bounds.size() && i < 16 && best.patch == none; ++i)
      for (const bool reversed : {false, true})
        for (const Bound& bound : input_.bounds(piece.bounds[i].segment, reversed)) {
          const bool against = area(piece, domain_.facets()[facet(bound.patch)].axis) < 0;
          if (bound.reversed != (piece.bounds[i].reversed != against)) continue;
          Candidate c{bound.patch, against, 0};
          for (const std::uint32_t v : vertices) c.faults += !on_facet(bound.patch, v);
          for (const PieceBound& b : piece.bounds) c.faults += !bound_of({bound.patch, b.segment, b.reversed != against});
          if (best.patch == none || c.faults < best.faults) best = c;
        }
    return best;
  }

  void match(const Piece& piece) {
    if (piece.bounds.empty()) return report_stray(piece);
    const auto vertices = vertices_of(piece);
    const Candidate c = best_patch(piece, vertices);
    if (c.patch == none) return report_stray(piece);
    sums_[c.patch].used = true;
    facet_used_[facet(c.patch)] = true;
    for (const PieceBound& b : piece.bounds) {
      const BoundKey key{c.patch, b.segment, b.reversed != c.reversed};
      if (const auto bound = bound_of(key))
        ++uses_[*bound];
      else
        ++inner_uses_[key];
    }
    for (const std::uint32_t v : vertices) place_vertex(c.patch, v);
    for (const std::uint32_t t : piece.subfacets) place_subfacet(c.patch, t, (pieces_.turned[t] != 0) != c.reversed);
  }

  void place_vertex(std::uint32_t patch, std::uint32_t v) {
    const EntityId f = facet(patch);
    if (!on_facet(patch, v)) report_off(patch, v);
    EntityRef& home = out_.home[v];
    if (home.kind == EntityKind::volume) {
      home = {EntityKind::facet, f};
    } else if (home.kind == EntityKind::vertex) {
      points_seen_.push_back({f, home.id});
    } else if (home.kind == EntityKind::facet && home.id != f) {
      task_.findings.add(Kind::facet_not_conforming, {v, f, home.id}, [&] {
        return "The " + vertex_words(mesh_, v) + " is inside facets " + std::to_string(home.id) + " and " + std::to_string(f) +
               ".";
      });
    }
  }

  bool on_facet(std::uint32_t patch, std::uint32_t v) const {
    const EntityId f = facet(patch);
    const EntityRef home = out_.home[v];
    if (home.kind == EntityKind::vertex) {
      const auto points = domain_.facet_points(f);
      if (std::binary_search(points.begin(), points.end(), home.id)) return true;
    } else if (home.kind == EntityKind::segment) {
      const auto facets = domain_.facets_of_segment(home.id);
      if (std::binary_search(facets.begin(), facets.end(), f)) return true;
    }
    const Point3& x = mesh_.points[v];
    const auto& first = domain_.triangles(f)[0];
    const int axis = domain_.facets()[f].axis;
    if (aligned_[f]) return x[axis] == domain_.points()[first[0]][axis];
    if (domain_.facets()[f].planar) return near_plane(triangle(first), x, tolerance(f));
    return on_bent_facet(patch, x);
  }

  std::array<Point3, 3> triangle(const std::array<std::uint32_t, 3>& t) const {
    return {domain_.points()[t[0]], domain_.points()[t[1]], domain_.points()[t[2]]};
  }

  // Of facets that are planar only within rounding and have many triangles: each vertex on one asks which of these it is on.
  void plant_trees() {
    trees_.resize(input_.patches().size());
    for (std::uint32_t patch = 0; patch < trees_.size(); ++patch) {
      const Patch& p = input_.patches()[patch];
      if (p.count < few_triangles || domain_.facets()[p.entity].planar) continue;
      std::vector<detail::Box<3>> boxes;
      for (std::uint32_t i = p.first; i < p.first + p.count; ++i) {
        const auto t = input_.simplex(i);
        boxes.push_back(detail::Box<3>::around(t[0]));
        boxes.back().add(t[1]);
        boxes.back().add(t[2]);
      }
      trees_[patch] = std::make_unique<detail::BoxTree<3>>(boxes);
    }
  }

  /// Calls visit(i) for all triangles of the patch that may be within `slack` of x in its projection, and maybe for others.
  template <class Visit>
  void triangles_near(std::uint32_t patch, const Point3& x, double slack, const Visit& visit) const {
    const Patch& p = input_.patches()[patch];
    if (!trees_[patch]) {
      for (std::uint32_t i = p.first; i < p.first + p.count; ++i) visit(i);
      return;
    }
    const int axis = domain_.facets()[p.entity].axis;
    auto around = detail::Box<3>::around(x);
    for (int k = 0; k < 3; ++k) {
      const double reach = k == axis ? HUGE_VAL : 2 * slack;
      around.low[k] -= reach;
      around.high[k] += reach;
    }
    trees_[patch]->meeting(around, [&](std::uint32_t i) { visit(p.first + i); });
  }

  // A facet that is planar only within rounding is the union of its triangles; the one that contains x in the
  // projection counts. Rounding may put x beyond all of them: then any whose box x is in, up to the tolerance.
  bool on_bent_facet(std::uint32_t patch, const Point3& x) const {
    const EntityId f = facet(patch);
    const int axis = domain_.facets()[f].axis;
    const double width = tolerance(f).width();
    bool contained = false, near = false, near_box = false;
    triangles_near(patch, x, width, [&](std::uint32_t i) {
      if (near) return;
      const auto t = input_.simplex(i);
      bool in_box = true, in = true;
      for (int k = 0; k < 3; ++k) {
        const auto [low, high] = std::minmax({t[0][k], t[1][k], t[2][k]});
        const double slack = k == axis ? HUGE_VAL : width;
        in_box &= x[k] >= low - slack && x[k] <= high + slack;
      }
      if (!in_box) return;
      for (int k = 0; k < 3; ++k) in &= orient_projected(t[k], t[(k + 1) % 3], x, axis) != Sign::negative;
      const bool close = near_plane(t, x, tolerance(f));
      contained |= in;
      near |= in && close;
      near_box |= close;
    });
    return near || (!contained && near_box);
  }

  void place_subfacet(std::uint32_t patch, std::uint32_t t, bool reversed) {
    const EntityId f = facet(patch);
    const DomainFacet& data = domain_.facets()[f];
    out_.patch_of[t] = {patch, reversed};
    const auto s = corners(t);
    const auto [doubled, error] = projected_area(s, data.axis);
    Sums& sums = sums_[patch];
    sums.area.add(reversed ? -doubled : doubled);
    sums.error += error;
    const Sign sense = orient_projected(s[0], s[1], s[2], data.axis);
    // Turned over by no more than what rounding of its vertices can do is the same facet up to k ulps.
    const double rounding = 4 * tolerance(f).width() * longest_edge(s) + error;
    if (sense != (reversed ? Sign::negative : Sign::positive) && std::abs(doubled) > rounding)
      task_.findings.add(Kind::facet_not_conforming, {t, f}, [&] {
        return "Subfacet " + std::to_string(t) + " (" + list_words(mesh_.subfacets[t].vertices) +
               ") is turned over in the projection of facet " + std::to_string(f) + ".";
      });
    if (mesh_.subfacets[t].marker != data.marker)
      task_.findings.add(Kind::wrong_marker, {t, f}, [&] {
        return "Subfacet " + std::to_string(t) + " (" + list_words(mesh_.subfacets[t].vertices) + ") has marker " +
               std::to_string(mesh_.subfacets[t].marker) + ", its facet " + std::to_string(f) + " has " +
               std::to_string(data.marker) + ".";
      });
  }

  // The area inside a boundary whose vertices move by at most w changes by at most w times its length (twice, to be
  // safe against the change of that length); both sums have their own rounding.
  void check_cover(std::uint32_t patch) {
    const Patch& p = input_.patches()[patch];
    const EntityId f = p.entity;
    CompensatedSum wanted;
    double slack = sums_[patch].error, boundary = 0;
    for (std::uint32_t i = p.first; i < p.first + p.count; ++i) {
      const auto [doubled, error] = projected_area(input_.simplex(i), domain_.facets()[f].axis);
      wanted.add(doubled);
      slack += error;
      boundary += 3 * longest_edge(input_.simplex(i));
    }
    const double found = sums_[patch].area.value();
    slack += 4 * tolerance(f).width() * boundary + wanted.error() + sums_[patch].area.error();
    if (std::abs(found - wanted.value()) <= slack) return;
    task_.findings.add(Kind::facet_not_conforming, {f}, [&] {
      return "In its projection, the subfacets of facet " + std::to_string(f) + " cover an area of " + words(found / 2) +
             " instead of " + words(wanted.value() / 2) + ".";
    });
  }

  // A bound of the patch is run along once, over the whole chain; any other segment as often one way as the other (then
  // it lies inside).
  void check_bounds() {
    for (std::size_t i = 0; i < uses_.size(); ++i) {
      const Bound& b = input_.bounds()[i];
      if (sums_[b.patch].used && uses_[i] != out_.pieces[b.segment]) report_bound(b.patch, b.segment, uses_[i]);
    }
    for (const auto& [key, uses] : inner_uses_) {
      const auto& [patch, segment, reversed] = key;
      const auto back = inner_uses_.find({patch, segment, !reversed});
      if (back == inner_uses_.end() || back->second != uses) report_bound(patch, segment, uses);
    }
  }

  void report_bound(std::uint32_t patch, EntityId s, std::uint32_t uses) {
    task_.findings.add(Kind::facet_not_conforming, {facet(patch), s}, [&] {
      return "The subfacets of facet " + std::to_string(facet(patch)) + " have " + std::to_string(uses) +
             " edges along one side of segment " + std::to_string(s) + ", whose chain has " + std::to_string(out_.pieces[s]) +
             ".";
    });
  }

  std::optional<std::size_t> bound_of(const BoundKey& key) const {
    const auto& [patch, segment, reversed] = key;
    for (const Bound& b : input_.bounds(segment, reversed))
      if (b.patch == patch) return static_cast<std::size_t>(&b - input_.bounds().data());
    return {};
  }

  void check_points() {
    std::sort(points_seen_.begin(), points_seen_.end());
    for (EntityId f = 0; f < domain_.facets().size(); ++f)
      for (const std::uint32_t p : domain_.facet_points(f)) {
        if (std::binary_search(points_seen_.begin(), points_seen_.end(), std::pair{f, p})) continue;
        if (!input_.wants_point(p) || out_.vertex_of_point[p] == none || !facet_used_[f]) continue;
        task_.findings.add(Kind::facet_not_conforming, {f, p}, [&] {
          return "No subfacet of facet " + std::to_string(f) + " has its input point " + std::to_string(p) + " " +
                 words(domain_.points()[p]) + " as a vertex.";
        });
      }
  }

  void report_off(std::uint32_t patch, std::uint32_t v) {
    const EntityId f = facet(patch);
    task_.findings.add(Kind::facet_not_conforming, {v, f}, [&] {
      const double off = distance_from_plane(triangle(domain_.triangles(f)[0]), mesh_.points[v]);
      return "The " + vertex_words(mesh_, v) + " is " + words(off) + " off the plane of facet " + std::to_string(f) + ", " +
             words(off / Tolerance{1, domain_.facet_magnitude(f)}.width()) + " ulps.";
    });
  }

  void report_stray(const Piece& piece) {
    for (const std::uint32_t t : piece.subfacets)
      task_.findings.add(Kind::stray_constraint, {t}, [&] {
        return "Subfacet " + std::to_string(t) + " (" + list_words(mesh_.subfacets[t].vertices) + ") belongs to no input facet.";
      });
  }

  void report_missing(std::uint32_t patch) {
    const EntityId f = facet(patch);
    task_.findings.add(Kind::facet_not_conforming, {f}, [&] {
      const auto t = input_.simplex(input_.patches()[patch].first);
      return "No subfacets cover facet " + std::to_string(f) + " at " + words(t[0]) + ", " + words(t[1]) + ", " + words(t[2]) +
             ".";
    });
  }

  struct Sums {
    bool used = false;
    CompensatedSum area;
    double error = 0;
  };

  const ConformityTask<3>& task_;
  const OutputMesh<3>& mesh_;
  const InputVolumes<3>& input_;
  const Domain<3>& domain_;
  Conformity<3>& out_;
  Pieces pieces_;
  std::vector<Sums> sums_;
  std::vector<bool> aligned_, facet_used_;
  std::vector<std::unique_ptr<detail::BoxTree<3>>> trees_;  // of patches
  std::vector<std::uint32_t> uses_;                         ///< of each Bound of the input: edges of pieces along it
  std::map<BoundKey, std::uint32_t> inner_uses_;            ///< along segments that are no bounds of the patch
  std::vector<std::pair<EntityId, std::uint32_t>> points_seen_;
};

}  // namespace

void match_facets(const ConformityTask<3>& task, Conformity<3>& out) { FacetMatcher(task, out).run(); }

}  // namespace pgdr::checking
