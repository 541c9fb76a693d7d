// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "bodies/region_groups.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <set>
#include <string>
#include <utility>

#include "input/words.hpp"
#include "space/disjoint_sets.hpp"
#include "space/make_set.hpp"
#include "space/point_ranks.hpp"

namespace pgdr::detail {

RegionGroups::RegionGroups(const Plc<3>& plc, const Arrangement& pieces, const BodyVolumes& volumes, BodyMode mode,
                           const Bulk& bulk)
    : plc_(plc), pieces_(pieces), volumes_(volumes), mode_(mode), dropped_(pieces.triangles.size()) {
  if (mode == BodyMode::disjoint) require_disjoint();
  judge_volumes();
  bulk.each(dropped_.size(), [&](std::size_t p) { dropped_[p] = drops(static_cast<std::uint32_t>(p)); });
  for (const ThinVolume& t : volumes.thin()) dropped_[t.piece] = 1;
  group_volumes();
  place_seeds();
  number_labels(bulk);
}

void RegionGroups::require_disjoint() const {
  std::vector<Diagnostic> all;
  for (std::uint32_t v = 1; v < volumes_.count(); ++v) {
    const auto windings = volumes_.windings(v);
    if (windings.size() < 2 || !volumes_.inside(v)) continue;
    const Point<3>& x = *volumes_.inside(v);
    Diagnostic& d = all.emplace_back(Diagnostic{Errc::bodies_overlap, "bodies ", plc_.source.file, 0, {}, {x.x}});
    for (std::size_t i = 0; i < windings.size(); ++i) {
      d.message += (i == 0 ? "" : i + 1 < windings.size() ? ", " : " and ") + body_name(plc_, windings[i].body);
      d.ids.push_back(windings[i].body);
    }
    d.message += " have a volume of " + to_text(volumes_.measure(v).divided_by(6)) + " in common, as at " + to_text<3>(x);
  }
  if (all.empty()) return;
  Diagnostic first = all.front();
  if (all.size() > 1) first.message += "; and " + std::to_string(all.size() - 1) + " more such volumes";
  first.message += "; --regions fragments gives each set of bodies a label, --regions priority all to the first body";
  throw InputError(std::move(first), std::move(all));
}

void RegionGroups::judge_volumes() {
  bodies_.resize(volumes_.count());
  bool some_positive = false;
  for (std::uint32_t v = 1; v < bodies_.size(); ++v) some_positive = some_positive || volumes_.total(v) > 0;
  for (std::uint32_t v = 1; v < bodies_.size(); ++v) {
    const int total = volumes_.total(v);
    if (mode_ == BodyMode::united && !(some_positive ? total > 0 : total != 0)) continue;
    for (const Winding& w : volumes_.windings(v)) bodies_[v].push_back(w.body);
    if (mode_ == BodyMode::priority && bodies_[v].size() > 1) bodies_[v].resize(1);
  }
  for (const ThinVolume& t : volumes_.thin()) bodies_[t.volume] = bodies_[t.beside];
}

bool RegionGroups::drops(std::uint32_t piece) const {
  const auto &front = bodies_[volumes_.walls().beside(piece, false)], &behind = bodies_[volumes_.walls().beside(piece, true)];
  switch (mode_) {
    case BodyMode::united: return front.empty() == behind.empty();
    case BodyMode::priority: {
      if (front != behind) return false;
      for (std::uint32_t k = pieces_.origins_begin[piece]; k < pieces_.origins_begin[piece + 1] && !front.empty(); ++k)
        if (volumes_.body_of_facet(pieces_.origins[k].facet) == front[0]) return false;
      return true;
    }
    case BodyMode::fragments:
    case BodyMode::disjoint: break;
  }
  return false;
}

void RegionGroups::group_volumes() {
  DisjointSets sets(volumes_.count());
  for (std::uint32_t p = 0; p < dropped_.size(); ++p)
    if (is_dropped(p)) sets.unite(volumes_.walls().beside(p, false), volumes_.walls().beside(p, true));
  group_of_.resize(volumes_.count());
  for (std::uint32_t v = 0; v < group_of_.size(); ++v) {
    const std::uint32_t first = sets.find(v);
    if (first == v) {
      group_of_[v] = static_cast<std::uint32_t>(groups_.size());
      Group& g = groups_.emplace_back();
      g.is_outside = v == 0;
      g.is_solid = !bodies_[v].empty();
    }
    Group& g = groups_[group_of_[v] = group_of_[first]];
    g.volumes.push_back(v);
    g.bodies.insert(g.bodies.end(), bodies_[v].begin(), bodies_[v].end());
  }
  for (Group& g : groups_) make_set(g.bodies);
}

/// None on a wall that stays: whose seed that is nobody knows.
std::optional<std::uint32_t> RegionGroups::group_at(const Point<3>& x) const {
  if (const auto v = volumes_.walls().find(x)) return group_of_[*v];
  const FirstHits<3>& hits = volumes_.walls().hits();
  const auto hit = hits.first(hits.ray(x, 0));
  if (hit.kind != FirstHits<3>::Kind::on_wall || !is_dropped(hit.wall)) return std::nullopt;
  return group_of_[volumes_.walls().beside(hit.wall, false)];
}

void RegionGroups::place_seeds() {
  for (const RegionSeed<3>& seed : plc_.regions)
    if (const auto g = group_at(seed.point); g && !groups_[*g].is_outside) {
      groups_[*g].has_seed = true;
      groups_[*g].label = seed.attribute;
    }
  for (const Point<3>& hole : plc_.holes)
    if (const auto g = group_at(hole)) groups_[*g].has_hole = true;
}

/// Of each class the points that bound it and the triangles, by their places in the order of coordinates: no two have the same.
std::vector<std::vector<std::uint32_t>> RegionGroups::names_by_points(std::span<const std::uint32_t> class_of_group,
                                                                      std::size_t classes, const Bulk& bulk) const {
  const std::vector<std::uint32_t> rank = point_ranks<3>(pieces_.points, bulk);
  std::vector<std::vector<std::uint32_t>> points(classes);
  std::vector<std::vector<std::array<std::uint32_t, 3>>> triangles(classes);
  for (std::uint32_t p = 0; p < dropped_.size(); ++p) {
    if (is_dropped(p)) continue;
    std::array<std::uint32_t, 3> t;
    for (std::size_t k = 0; k < 3; ++k) t[k] = rank[pieces_.triangles[p][k]];
    std::sort(t.begin(), t.end());
    for (const bool negative : {false, true}) {
      const std::uint32_t c = class_of_group[group_of_[volumes_.walls().beside(p, negative)]];
      if (c == no_entity) continue;
      points[c].insert(points[c].end(), t.begin(), t.end());
      triangles[c].push_back(t);
    }
  }
  for (std::size_t c = 0; c < classes; ++c) {
    make_set(points[c]);
    std::sort(triangles[c].begin(), triangles[c].end());
    for (const auto& t : triangles[c]) points[c].insert(points[c].end(), t.begin(), t.end());
  }
  return points;
}

void RegionGroups::number_labels(const Bulk& bulk) {
  std::set<double> taken;
  for (const RegionSeed<3>& seed : plc_.regions) taken.insert(seed.attribute);
  std::map<std::vector<std::uint32_t>, std::uint32_t> class_of_bodies;  // united: a class each group
  std::vector<std::uint32_t> class_of_group(groups_.size(), no_entity);
  std::uint32_t classes = 0;
  for (std::size_t i = 0; i < groups_.size(); ++i) {
    const Group& g = groups_[i];
    if (!g.is_solid || g.has_seed || g.has_hole || g.is_outside) continue;
    if (mode_ == BodyMode::united)
      class_of_group[i] = classes++;
    else if (const auto [at, is_new] = class_of_bodies.try_emplace(g.bodies, classes); class_of_group[i] = at->second, is_new)
      ++classes;
  }
  std::vector<std::uint32_t> order(classes);
  std::iota(order.begin(), order.end(), 0u);
  if (mode_ == BodyMode::priority) {
    order.clear();
    for (const auto& [bodies, c] : class_of_bodies) order.push_back(c);
  } else {
    const auto names = names_by_points(class_of_group, classes, bulk);
    std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return names[a] < names[b]; });
  }
  std::vector<double> labels(classes);
  double next = 1;
  for (const std::uint32_t c : order) {
    while (taken.contains(next)) ++next;
    labels[c] = next++;
  }
  for (std::size_t i = 0; i < groups_.size(); ++i)
    if (class_of_group[i] != no_entity) groups_[i].label = labels[class_of_group[i]];
}

std::vector<BodyRegion> RegionGroups::regions() const {
  struct Sums {
    ExactSum volume;
    std::vector<std::uint32_t> bodies;
  };
  std::map<double, Sums> by_label;
  for (const Group& g : groups_) {
    if (g.is_outside || g.has_hole || (!g.is_solid && !g.has_seed)) continue;
    Sums& s = by_label[g.label];
    for (const std::uint32_t v : g.volumes) s.volume.add(volumes_.measure(v));
    s.bodies.insert(s.bodies.end(), g.bodies.begin(), g.bodies.end());
  }
  std::vector<BodyRegion> found;
  for (auto& [label, s] : by_label) {
    make_set(s.bodies);
    found.push_back({label, s.volume.divided_by(6), std::move(s.bodies)});
  }
  return found;
}

}  // namespace pgdr::detail
