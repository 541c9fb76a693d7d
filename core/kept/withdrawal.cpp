// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "kept/withdrawal.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "change/facet_flip.hpp"
#include "change/replacement.hpp"
#include "kept/hull_filling.hpp"
#include "kept/numbers.hpp"
#include "kept/rim_filling.hpp"
#include "kept/vertex_parts.hpp"
#include "numbers/corners.hpp"
#include "pgdr/predicates.hpp"
#include "space/make_set.hpp"

namespace pgdr {
namespace {

constexpr CellId no_cell{0xffffffff};

/// What may be done for a sector that its own vertices do not fill. The last is a point inside as well, about which doubles take
/// some cells for flat: the proof is about their signs alone.
enum class Means { none, growth, point_inside, flat_cells };
constexpr std::array all_means{Means::none, Means::growth, Means::point_inside, Means::flat_cells};

class Withdrawal {
 public:
  Withdrawal(Mesh<3>& mesh, Mesh<3>::Pools& pools, const Domain<3>& domain, const KeptEntities<3>& kept)
      : mesh_(&mesh), pools_(&pools), parts_(mesh, domain), filling_(mesh, domain), rim_(mesh, domain), replacer_(mesh) {
    find_points(kept);
  }

  WithdrawalCounts run(const std::stop_token& stop) {
    WithdrawalCounts counts;
    for (const VertexId v : on_boundary_) ++(on_segment(v) ? counts.on_segments : counts.on_facets);
    for (const Means means : all_means) work_off(on_boundary_, means, stop);
    for (const Means means : {Means::none, Means::growth}) work_off(inside_, means, stop);
    for (const VertexId v : on_boundary_) ++(on_segment(v) ? counts.left_on_segments : counts.left_on_facets);
    counts.inside = inside_.size();
    return counts;
  }

 private:
  using Points = std::vector<VertexId>;

  void find_points(const KeptEntities<3>& kept);
  void work_off(Points& points, Means most, const std::stop_token& stop);
  bool take_off(VertexId v, Means most);
  bool try_filling(Means most, bool with_own);
  bool fill(Hull& hull, Means most);
  bool fill_growing(Hull& hull);
  bool grow(Hull& hull);
  void take_cell(Hull& hull, CellId c);
  bool dig_out(Hull& hull, const Point3& x, bool flat);
  bool fill_about_new_point(const Hull& hull, bool flat);
  bool fill_about_rim(const Hull& hull);
  bool add_star(const Hull& hull, const Point3& x);
  VertexId make_point(const Point3& x, std::span<const VertexId> neighbors);
  void commit();
  /// Have the cells at the vertex changed since these means did nothing for it? Else they will not. A point inside may ask for
  /// cells that are far from it: so any change counts.
  bool is_new(VertexId v, Means means) {
    auto& tried = tried_at_[static_cast<std::size_t>(means)];
    if (tried.size() <= index(v)) tried.resize(mesh_->vertex_bound(), 0xffffffff);
    const std::uint32_t version = means >= Means::point_inside ? changes_ : mesh_->note(v).version;
    return std::exchange(tried[index(v)], version) != version;
  }
  bool on_segment(VertexId v) const { return mesh_->vertex(v).home.kind() == EntityKind::segment; }
  bool is_taken(CellId c) const { return std::find(tried_.old.begin(), tried_.old.end(), c) != tried_.old.end(); }

  Mesh<3>* mesh_;
  Mesh<3>::Pools* pools_;
  VertexParts parts_;
  HullFilling filling_;
  RimFilling rim_;
  Replacer<3> replacer_;
  Replacement<3> tried_;
  VertexId vertex_{};             ///< that is to go
  std::vector<EntityId> facets_;  ///< that may have all corners of a cell
  Points made_;                   ///< by what is tried
  Points on_boundary_, inside_;   ///< those on facets last, in the order in which they came
  std::vector<CellId> cell_at_;   ///< of each vertex, one
  std::array<std::vector<std::uint32_t>, all_means.size()>
      tried_at_;               ///< by means, of each vertex: the version of the cells there, or changes_
  std::uint32_t changes_ = 0;  ///< so many points have gone
};

void Withdrawal::find_points(const KeptEntities<3>& kept) {
  cell_at_.assign(mesh_->vertex_bound(), no_cell);
  for (std::uint32_t i = 0; i < mesh_->cell_bound(); ++i)
    if (mesh_->alive(CellId{i}))
      for (const VertexId v : mesh_->cell(CellId{i}).vertices) cell_at_[index(v)] = CellId{i};
  for (const EntityKind kind : {EntityKind::segment, EntityKind::facet})
    for (std::uint32_t i = 0; i < cell_at_.size(); ++i) {
      const VertexId v{i};
      if (cell_at_[i] == no_cell || mesh_->vertex(v).home.kind() != kind) continue;
      if (kept.has(mesh_->vertex(v).home.entity())) on_boundary_.push_back(v);
    }
}

/// The last first, in rounds, as long as any goes; the last means once, after the lesser ones.
void Withdrawal::work_off(Points& points, Means most, const std::stop_token& stop) {
  for (int round = 0; round < numbers::most_rounds; ++round) {
    Points left;
    for (std::size_t i = points.size(); i-- > 0;) {
      mesh_->make_room(*pools_);
      bool gone = cell_at_[index(points[i])] == no_cell;  // with another one
      for (const Means means : all_means)
        if (!gone && means <= most && !stop.stop_requested() && is_new(points[i], means)) gone = take_off(points[i], means);
      if (!gone) left.push_back(points[i]);
    }
    std::reverse(left.begin(), left.end());
    const bool any = left.size() < points.size();
    points = std::move(left);
    if (!any || stop.stop_requested()) break;
  }
}

/// Makes the mesh do without the vertex, if it can. What the vertices at hand fill may not fit what is around: then each sector
/// gets a point of its own.
bool Withdrawal::take_off(VertexId v, Means most) {
  vertex_ = v;
  if (!parts_.take(v, cell_at_[index(v)])) return false;
  if (try_filling(most, true)) return true;
  return most >= Means::point_inside && try_filling(most, false);
}

bool Withdrawal::try_filling(Means most, bool with_own) {
  tried_.clear();
  tried_.old = parts_.cells();
  for (const auto& t : parts_.triangles()) tried_.walls.push_back({t.corners, t.facet});
  if (const auto& ends = parts_.subsegment()) tried_.subsegments.push_back({*ends, mesh_->vertex(vertex_).home.id()});
  facets_ = facets_at(*mesh_, tried_.old);
  made_.clear();
  bool filled = true;
  for (const Hull& sector : parts_.hulls()) {
    Hull hull = sector;
    filled = filled && ((with_own && filling_.fill(hull, facets_, tried_.cells)) || fill(hull, most));
  }
  if (!filled || !replacer_.fits(tried_)) {
    for (std::size_t i = made_.size(); i-- > 0;) pools_->vertices.give(index(made_[i]));
    return false;
  }
  commit();
  return true;
}

/// By more than its own vertices.
bool Withdrawal::fill(Hull& hull, Means most) {
  if (most == Means::growth) return fill_growing(hull);
  return most >= Means::point_inside && fill_about_new_point(hull, most == Means::flat_cells);
}

bool Withdrawal::fill_growing(Hull& hull) {
  bool grows = true;
  for (std::size_t next = tried_.old.size(); grows && tried_.old.size() < numbers::most_grown_cells;) {
    next += 1 + next / numbers::growth_between_looks;
    while (grows && tried_.old.size() < next) grows = grow(hull);
    facets_ = facets_at(*mesh_, tried_.old);
    if (filling_.fill(hull, facets_, tried_.cells)) return true;
  }
  return false;
}

/// Takes the cells beyond faces whose far corner is one vertex: that which most faces see. False if there is none.
bool Withdrawal::grow(Hull& hull) {
  std::vector<VertexId> corners;
  for (const auto& face : hull.faces) corners.insert(corners.end(), face.begin(), face.end());
  detail::make_set(corners);
  std::vector<std::pair<VertexId, CellId>> beyond;
  for (const Link link : hull.beyond)
    if (link && !is_taken(link.cell())) beyond.emplace_back(mesh_->cell(link.cell()).vertices[link.face()], link.cell());
  std::optional<VertexId> best;
  std::ptrdiff_t most = 0;
  for (const auto& face : beyond) {
    const VertexId v = face.first;
    const bool known = std::binary_search(corners.begin(), corners.end(), v);
    if (v == vertex_ || (!known && corners.size() >= PolyhedronFilling::most_points)) continue;
    const auto faces = std::count_if(beyond.begin(), beyond.end(), [&](const auto& b) { return b.first == v; }) * 2 +
                       (known ? 1 : 0);
    if (best && (faces != most ? faces < most : !lex_less<3>(mesh_->point(v), mesh_->point(*best)))) continue;
    best = v;
    most = faces;
  }
  if (!best) return false;
  for (const auto& [v, c] : beyond)
    if (v == *best && !is_taken(c)) take_cell(hull, c);
  return true;
}

/// Its faces that are faces of the hull, turned over, vanish; the others are new ones.
void Withdrawal::take_cell(Hull& hull, CellId c) {
  tried_.old.push_back(c);
  const auto& k = mesh_->cell(c);
  std::vector<VertexId> may_be_inside;
  for (int f = 0; f < 4; ++f) {
    const Hull::Face face = face_inwards(k.vertices, f);
    const bool is_wall = mesh_->constrained(c, f);
    bool vanishes = false;
    for (std::size_t i = 0; i < hull.faces.size() && !vanishes; ++i)
      if (hull.beyond[i] == Link(c, f)) {
        may_be_inside.insert(may_be_inside.end(), face.begin(), face.end());
        hull.faces.erase(hull.faces.begin() + static_cast<std::ptrdiff_t>(i));
        hull.beyond.erase(hull.beyond.begin() + static_cast<std::ptrdiff_t>(i));
        vanishes = true;
      }
    if (vanishes) continue;
    hull.faces.push_back(face);
    hull.beyond.push_back(is_wall ? Link{} : k.links[f]);
  }
  if (const auto* constraints = mesh_->constraints(c))
    for (int e = 0; e < 6; ++e)
      if (constraints->has_edge(e)) {
        auto ends = ends_of_edge(k.vertices, e);
        if (ends[1] < ends[0]) std::swap(ends[0], ends[1]);
        if (std::find(hull.edges.begin(), hull.edges.end(), ends) == hull.edges.end()) hull.edges.push_back(ends);
      }
  // A vertex that is in no face any more has to stay, unless it is one that the withdrawal has made.
  hull.inside.insert(hull.inside.end(), may_be_inside.begin(), may_be_inside.end());
  detail::make_set(hull.inside);
  std::erase_if(hull.inside, [&](VertexId v) {
    return mesh_->vertex(v).home.kind() == EntityKind::volume ||
           std::any_of(hull.faces.begin(), hull.faces.end(),
                       [&](const Hull::Face& f) { return std::find(f.begin(), f.end(), v) != f.end(); });
  });
}

/// Takes cells across faces that x does not see, until it sees all. False where that ends at a wall, or at too many.
bool Withdrawal::dig_out(Hull& hull, const Point3& x, bool flat) {
  const auto is_seen = [&](const Hull::Face& f) {
    const auto p = mesh_->points(f);
    return orient<3>({p[0], p[1], p[2], x}) == Sign::positive;
  };
  while (true) {
    const auto hidden = std::find_if(hull.faces.begin(), hull.faces.end(), [&](const auto& f) { return !is_seen(f); });
    if (hidden == hull.faces.end()) return filling_.is_seen_from(hull, x, flat);
    const Link beyond = hull.beyond[static_cast<std::size_t>(hidden - hull.faces.begin())];
    if (!beyond || is_taken(beyond.cell()) || tried_.old.size() >= numbers::most_grown_cells) return false;
    take_cell(hull, beyond.cell());
  }
}

/// At the longest step inwards that does, of those that are halved from the size of the hull on.
bool Withdrawal::fill_about_new_point(const Hull& hull, bool flat) {
  const Point3& from = mesh_->point(vertex_);
  const auto& d = hull.inwards;
  const double length = std::sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
  if (!(length > 0)) return fill_about_rim(hull);
  double size = 0;
  for (const auto& face : hull.faces)
    for (const VertexId v : face) size = std::max(size, squared_distance(mesh_->point(v), from));
  double step = std::sqrt(size);
  for (int k = 0; k < numbers::most_halvings; ++k, step /= 2) {
    Point3 x = from;
    for (int i = 0; i < 3; ++i) x[i] += step * d[static_cast<std::size_t>(i)] / length;
    Hull dug = hull;
    const std::size_t before = tried_.old.size();
    if (dig_out(dug, x, flat)) return add_star(dug, filling_.better_place(dug, x));
    tried_.old.resize(before);
  }
  return false;
}

/// At the rim of a sheet both of whose sides the sector is on.
bool Withdrawal::fill_about_rim(const Hull& hull) {
  const auto& rim = parts_.subsegment();
  if (parts_.hulls().size() != 1 || !rim || parts_.triangles().empty()) return false;
  if (!rim_.fill(hull, vertex_, parts_.triangles(), *rim)) return false;
  std::vector<VertexId> vertices = rim_.old_vertices();
  const std::size_t old = vertices.size();
  for (const Point3& x : rim_.new_points()) vertices.push_back(make_point(x, std::span(vertices).first(old)));
  for (const auto& cell : rim_.cells())
    tried_.cells.push_back({{vertices[cell[0]], vertices[cell[1]], vertices[cell[2]], vertices[cell[3]]}, hull.region});
  return true;
}

/// A point inside, with the distance to the nearest of its neighbours.
VertexId Withdrawal::make_point(const Point3& x, std::span<const VertexId> neighbors) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const VertexId v : neighbors) nearest = std::min(nearest, squared_distance(mesh_->point(v), x));
  const float radius = std::nextafter(static_cast<float>(std::sqrt(nearest)), 0.f);
  made_.push_back(mesh_->new_vertex(*pools_, x, Home(EntityKind::volume, 0), radius));
  return made_.back();
}

bool Withdrawal::add_star(const Hull& hull, const Point3& x) {
  std::vector<VertexId> corners;
  for (const auto& face : hull.faces) corners.insert(corners.end(), face.begin(), face.end());
  const VertexId m = make_point(x, corners);
  for (const auto& face : hull.faces) tried_.cells.push_back({{face[0], face[1], face[2], m}, hull.region});
  return true;
}

/// @pre what is tried fits
void Withdrawal::commit() {
  Points before;
  std::vector<CellId> rim;
  for (const CellId c : tried_.old) {
    const auto& k = mesh_->cell(c);
    before.insert(before.end(), k.vertices.begin(), k.vertices.end());
    for (const Link link : k.links)
      if (link && !is_taken(link.cell())) rim.push_back(link.cell());
  }
  replacer_.commit(*pools_, tried_);
  ++changes_;
  cell_at_.resize(mesh_->vertex_bound(), no_cell);
  for (const VertexId v : before) cell_at_[index(v)] = no_cell;
  for (const auto* cells : {&std::as_const(rim), &replacer_.new_cells()})
    for (const CellId c : *cells)
      for (const VertexId v : mesh_->cell(c).vertices) cell_at_[index(v)] = c;
  inside_.insert(inside_.end(), made_.begin(), made_.end());
}

}  // namespace

WithdrawalCounts withdraw_points(Mesh<3>& mesh, Mesh<3>::Pools& pools, const Domain<3>& domain, const KeptEntities<3>& kept,
                                 const std::stop_token& stop) {
  return Withdrawal(mesh, pools, domain, kept).run(stop);
}

}  // namespace pgdr
