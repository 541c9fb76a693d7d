// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "diagnose/islands.hpp"

#include <algorithm>
#include <numeric>
#include <optional>
#include <utility>

#include "diagnose/meshed_space.hpp"
#include "diagnose/near_pieces.hpp"
#include "space/disjoint_sets.hpp"
#include "space/make_set.hpp"
#include "space/piece_pairs.hpp"

namespace pgdr::detail {
namespace {

/// Which points hang together, by triangles of facets and segments.
DisjointSets hanging_together(const Domain<3>& domain) {
  DisjointSets sets(domain.points().size());
  for (EntityId f = 0; f < domain.facets().size(); ++f)
    for (const auto& t : domain.triangles(f)) {
      sets.unite(t[0], t[1]);
      sets.unite(t[0], t[2]);
    }
  for (const DomainSegment& s : domain.segments()) sets.unite(s.points[0], s.points[1]);
  return sets;
}

bool are_several(const Domain<3>& domain, DisjointSets& sets) {
  for (EntityId f = 1; f < domain.facets().size(); ++f)
    if (sets.find(domain.triangles(f)[0][0]) != sets.find(domain.triangles(0)[0][0])) return true;
  return false;
}

class IslandFinder {
 public:
  IslandFinder(const Domain<3>& domain, DisjointSets sets, const Bulk& bulk, const StopCheck& stop_check)
      : domain_(domain), pieces_(domain, bulk), sets_(std::move(sets)), bulk_(bulk), stop_check_(stop_check) {}

  Islands run(bool voids_by_nesting) {
    if (!domain_.nothing_meets()) join_what_meets();
    if (!are_several(domain_, sets_)) return {};
    space_.emplace(pieces_, voids_by_nesting, bulk_, stop_check_);
    at_volume_.resize(space_->volumes().size());
    is_kept_.resize(domain_.points().size(), 0);
    join_by_volumes();
    place_loose_pieces();
    return numbered();
  }

 private:
  void join_what_meets() {
    using Pairs = std::vector<std::array<std::uint32_t, 2>>;
    const auto& pieces = pieces_.pieces();
    std::vector<std::uint32_t> part(domain_.points().size());
    for (std::uint32_t v = 0; v < part.size(); ++v) part[v] = sets_.find(v);
    const auto look = [&](std::uint32_t i, std::uint32_t j, Pairs& found) {
      const std::uint32_t a = pieces[i].corners[0], b = pieces[j].corners[0];
      if (part[a] == part[b]) return;
      if (contact<3>(pieces_.points(), pieces[i], pieces[j], false).kind != Contact::Kind::none) found.push_back({a, b});
    };
    for (const Pairs& pairs : look_at_pairs<Pairs, 3>(pieces, pieces_.points(), 0, bulk_, stop_check_, look))
      for (const auto& [a, b] : pairs) sets_.unite(a, b);
  }

  /// Walls of what may be meshed: of one volume they are of one island, and so are all of volumes of which nothing is known.
  void join_by_volumes() {
    const auto& walls = space_->walls();
    std::uint32_t unknown = no_entity;
    for (std::uint32_t i = 0; i < walls.hits().count(); ++i) {
      const std::uint32_t here = pieces_.pieces()[i].corners[0];
      for (const bool negative : {false, true}) {
        const std::uint32_t v = walls.beside(i, negative);
        if (v == 0) continue;
        at_volume_[v].push_back(here);
        if (walls.is_known(v) && !space_->volumes()[v].meshed) continue;
        std::uint32_t& first = walls.is_known(v) ? at_volume_[v].front() : unknown;
        if (first == no_entity) first = here;
        sets_.unite(here, first);
        is_kept_[here] = 1;
      }
    }
  }

  /// Segments of no facet, and points.
  void place_loose_pieces() {
    const auto& pieces = pieces_.pieces();
    const auto p = pieces_.points();
    for (std::uint32_t i = space_->walls().hits().count(); i < pieces.size(); ++i) {
      stop_check_();
      const auto corners = pieces[i].points();
      const auto v = space_->walls().find(on_edge(p[corners.front()], p[corners.back()], 0.5));
      if (v && *v != 0 && space_->volumes()[*v].meshed) sets_.unite(corners.front(), at_volume_[*v].front());
    }
  }

  Islands numbered() {
    const auto count = static_cast<std::uint32_t>(domain_.points().size());
    std::vector<char> kept(count, 0);
    for (std::uint32_t v = 0; v < count; ++v)
      if (is_kept_[v] != 0) kept[sets_.find(v)] = 1;
    Islands out;
    out.of_point.assign(count, 0);
    std::vector<std::uint32_t> number(count, no_entity);
    out.count = 0;
    for (std::uint32_t v = 0; v < count; ++v) {
      const std::uint32_t root = sets_.find(v);
      if (kept[root] == 0) continue;
      if (number[root] == no_entity) number[root] = out.count++;
      out.of_point[v] = number[root];
    }
    if (out.count < 2) return {};
    for (auto& at : at_volume_) {  // not points any more, but islands
      for (std::uint32_t& p : at) p = out.of_point[p];
      make_set(at);
    }
    for (const Point3& hole : domain_.holes()) out.of_hole.push_back(around(hole, out.count));
    for (const RegionSeed<3>& seed : domain_.regions()) out.of_region.push_back(around(seed.point, out.count));
    return out;
  }

  /// Islands with walls at the volume that the point is in; all, if nobody knows which that is.
  std::vector<std::uint32_t> around(Point3 x, std::uint32_t count) const {
    stop_check_();
    for (double& c : x.x) c /= pieces_.unit();
    const auto v = space_->walls().find(x);
    if (v) return at_volume_[*v];
    std::vector<std::uint32_t> all(count);
    std::iota(all.begin(), all.end(), 0u);
    return all;
  }

  const Domain<3>& domain_;
  const NearPieces<3> pieces_;
  DisjointSets sets_;  // of points
  const Bulk& bulk_;
  const StopCheck& stop_check_;
  std::optional<MeshedSpace<3>> space_;
  std::vector<std::vector<std::uint32_t>> at_volume_;  // of each volume but the outside: points of its walls, in the end islands
  std::vector<char> is_kept_;                          // of points: on a wall of what may be meshed
};

}  // namespace

template <>
Islands islands_of<2>(const Domain<2>&, bool, const Bulk&, const StopCheck&) {
  return {};
}

template <>
Islands islands_of<3>(const Domain<3>& domain, bool voids_by_nesting, const Bulk& bulk, const StopCheck& stop_check) {
  if (domain.facets().size() < 2) return {};
  DisjointSets sets = hanging_together(domain);
  if (!are_several(domain, sets)) return {};
  return IslandFinder(domain, std::move(sets), bulk, stop_check).run(voids_by_nesting);
}

}  // namespace pgdr::detail
