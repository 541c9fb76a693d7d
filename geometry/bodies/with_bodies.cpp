// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <string>
#include <utility>

#include "bodies/body_volumes.hpp"
#include "bodies/kept_facets.hpp"
#include "bodies/region_groups.hpp"
#include "pgdr/bodies.hpp"
#include "pgdr/diagnosis.hpp"

namespace pgdr {
namespace {

using detail::Bulk;
using detail::RegionGroups;

/// Leaves out points that the input had for facets and segments, and that nothing has any more.
class PointsLeft {
 public:
  PointsLeft(const Plc<3>& before, Plc<3>& plc) : new_index_(plc.points.size(), 0) {
    std::vector<char> had(plc.points.size(), 0), has(plc.points.size(), 0);
    mark(before, had);
    mark(plc, has);
    std::uint32_t left = 0;
    for (std::uint32_t v = 0; v < had.size(); ++v) {
      const bool is_new = v >= before.points.size();
      new_index_[v] = has[v] != 0 || (had[v] == 0 && !is_new) ? left++ : no_entity;
    }
    const std::size_t attributes = before.points.empty() ? 0 : before.point_attributes.size() / before.points.size();
    keep(plc.points, 1);
    keep(plc.point_markers, 1);
    keep(plc.point_attributes, attributes);
    keep(plc.source.point_lines, 1);
    for (auto& f : plc.facets)
      for (auto& polygon : f.polygons)
        for (std::uint32_t& v : polygon) v = new_index_[v];
    for (auto& s : plc.segments)
      for (std::uint32_t& v : s.points) v = new_index_[v];
  }

 private:
  static void mark(const Plc<3>& plc, std::vector<char>& used) {
    for (const auto& f : plc.facets)
      for (const auto& polygon : f.polygons)
        for (const std::uint32_t v : polygon) used[v] = 1;
    for (const auto& s : plc.segments)
      for (const std::uint32_t v : s.points) used[v] = 1;
  }
  /// So many values a point, as far as the list goes.
  template <class T>
  void keep(std::vector<T>& values, std::size_t each) const {
    std::size_t to = 0;
    for (std::size_t i = 0; i < values.size(); ++i)
      if (new_index_[i / each] != no_entity) values[to++] = values[i];
    values.resize(to);
  }

  std::vector<std::uint32_t> new_index_;
};

Plc<3> make_plc(const Plc<3>& plc, const Arrangement& pieces, const RegionGroups& groups, bool are_cut) {
  const detail::KeptFacets kept(plc, pieces, groups, are_cut);
  Plc<3> made = plc;
  made.facets.clear();
  made.facet_bodies.clear();
  made.source.facet_lines.clear();
  for (std::size_t i = 0; i < kept.count(); ++i) {
    const std::uint32_t f = kept.facet(i);
    made.facets.push_back(kept.make(i));
    if (!plc.facet_bodies.empty()) made.facet_bodies.push_back(plc.facet_bodies[f]);
    if (!plc.source.facet_lines.empty()) made.source.facet_lines.push_back(plc.source.facet_lines[f]);
  }
  if (are_cut) {
    made.points = pieces.points;
    made.segments = pieces.segments;
    made.source.segment_lines = pieces.segment_lines;
    made.are_floats = plc.are_floats && pieces.tolerance > tolerance_of(plc) / 2;  // else it is that of doubles
  } else {
    made.points.insert(made.points.end(), pieces.points.begin() + static_cast<std::ptrdiff_t>(plc.points.size()),
                       pieces.points.end());
  }
  if (!made.point_markers.empty()) made.point_markers.resize(made.points.size());
  made.point_attributes = pieces.point_attributes;  // of points of the input those that it has
  const PointsLeft numbered_anew(plc, made);
  return made;
}

/// One for each solid and each void that has none.
void add_seeds(const detail::BodyVolumes& volumes, const RegionGroups& groups, Plc<3>& plc) {
  for (const RegionGroups::Group& g : groups.groups()) {
    if (g.is_outside || g.has_seed || g.has_hole) continue;
    const auto size = [&](std::uint32_t v) { return volumes.inside(v) ? volumes.measure(v).divided_by(6) : 0; };
    const Point<3>& x = volumes.inside(*std::ranges::max_element(g.volumes, {}, size)).value();
    if (g.is_solid)
      plc.regions.push_back({x, g.label, 0});
    else
      plc.holes.push_back(x);
  }
}

void require_arrays(const Plc<3>& plc) {
  if (!plc.facet_bodies.empty() && plc.facet_bodies.size() != plc.facets.size())
    throw UsageError({Errc::bad_option, "facet_bodies needs one entry a facet", {}, 0, {}, {}});
}

/// The names of its bodies; "" if one has none.
std::string name_of(const BodyRegion& region, const std::vector<std::string>& names) {
  std::string all;
  for (const std::uint32_t b : region.bodies) {
    if (names[b].empty()) return {};
    all += (all.empty() ? "" : "+") + names[b];
  }
  return all;
}

WithBodies label(const Plc<3>& plc, const Arrangement& pieces, bool are_cut, BodyMode mode, const Bulk& bulk,
                 const detail::StopCheck& stop_check) {
  const detail::BodyVolumes volumes(plc, pieces, bulk, stop_check);
  const RegionGroups groups(plc, pieces, volumes, mode, bulk);
  WithBodies made{make_plc(plc, pieces, groups, are_cut), groups.regions(), {}, {}, volumes.warnings()};
  add_seeds(volumes, groups, made.plc);
  made.body_names.resize(volumes.bodies());
  for (std::size_t b = 0; b < made.body_names.size() && b < plc.body_names.size(); ++b) made.body_names[b] = plc.body_names[b];
  for (const BodyRegion& r : made.regions)
    if (const std::string name = name_of(r, made.body_names); !name.empty()) made.plc.names.regions.try_emplace(r.label, name);
  return made;
}

}  // namespace

WithBodies with_bodies(const Plc<3>& plc, BodyMode mode, const BodyOptions& options) {
  require_arrays(plc);
  std::vector<Diagnostic> repairs;
  const ArrangementOptions how{options.markers, options.stop};
  const Arrangement pieces = arrange(plc, repairs, how);
  const bool crosses = std::ranges::any_of(repairs, [](const Diagnostic& d) { return d.code == Errc::entities_intersect; });
  if (crosses && !options.resolve_crossings) require_no_errors(Domain<3>(plc, options.stop), options.stop);
  const Bulk bulk(true, options.stop);
  WithBodies made = label(plc, pieces, crosses, mode, bulk, detail::StopCheck(options.stop));
  if (options.resolve_crossings) made.repairs = std::move(repairs);
  return made;
}

}  // namespace pgdr
