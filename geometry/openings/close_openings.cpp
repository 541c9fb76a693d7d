// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "input/words.hpp"
#include "openings/open_loops.hpp"
#include "openings/planar_caps.hpp"
#include "pgdr/domain.hpp"
#include "pgdr/openings.hpp"

namespace pgdr {
namespace detail {
namespace {

/// Adds facets, with the markers and names that are free, and says so.
class Closing {
 public:
  Closing(const Plc<3>& given, const Domain<3>& domain, std::span<const OpenLoop> loops, std::vector<Diagnostic>& repairs)
      : domain_(domain), loops_(loops), repairs_(repairs), plc_(given), count_(given.points.size()) {
    for (const auto& f : given.facets) markers_.insert(f.marker);
    for (const auto& s : given.segments) markers_.insert(s.marker);
    markers_.insert(given.point_markers.begin(), given.point_markers.end());
    for (const auto& [marker, name] : given.names.markers) {
      markers_.insert(marker);
      names_.insert(name);
    }
  }

  Plc<3> run(std::span<const PlanarCap> caps) {
    place_points(caps);
    for (const PlanarCap& cap : caps) add(cap);
    return std::move(plc_);
  }

 private:
  /// The number of a point of the Domain in the Plc.
  std::uint32_t number(std::uint32_t v) const {
    const std::uint32_t of_input = domain_.input_of_point()[v];
    if (of_input < count_) return of_input;
    return static_cast<std::uint32_t>(count_ + static_cast<std::size_t>(std::ranges::lower_bound(added_, v) - added_.begin()));
  }

  /// Those that the Domain has added on the loops become points of the Plc.
  void place_points(std::span<const PlanarCap> caps) {
    for (const PlanarCap& cap : caps)
      for (const std::uint32_t l : cap.loops)
        for (const std::uint32_t v : loops_[l].points)
          if (domain_.input_of_point()[v] >= count_) added_.push_back(v);
    std::ranges::sort(added_);
    added_.erase(std::unique(added_.begin(), added_.end()), added_.end());
    const std::size_t columns = domain_.attributes_per_point();
    for (const std::uint32_t v : added_) {
      plc_.points.push_back(domain_.points()[v]);
      if (!plc_.point_markers.empty()) plc_.point_markers.push_back(0);
      const auto row = domain_.point_attributes().subspan(v * columns, columns);
      plc_.point_attributes.insert(plc_.point_attributes.end(), row.begin(), row.end());
    }
  }

  int free_marker() {
    while (!markers_.insert(next_marker_).second) ++next_marker_;
    return next_marker_;
  }
  std::string free_name() {
    while (true)
      if (std::string name = "closed_opening_" + std::to_string(next_name_++); names_.insert(name).second) return name;
  }

  void add(const PlanarCap& cap) {
    Plc<3>::Facet facet;
    for (const std::uint32_t l : cap.loops) {
      auto& polygon = facet.polygons.emplace_back();
      for (const std::uint32_t v : loops_[l].points) polygon.push_back(number(v));
    }
    if (cap.turned) std::reverse(facet.polygons[0].begin() + 1, facet.polygons[0].end());
    facet.holes = cap.seeds;
    facet.marker = free_marker();
    const std::string name = free_name();
    plc_.names.markers[facet.marker] = name;
    add_place(cap);
    report(cap, facet, name);
    plc_.facets.push_back(std::move(facet));
  }

  /// Its body, and of the line in its file, which it has not, the file.
  void add_place(const PlanarCap& cap) {
    std::uint32_t first = no_entity;
    for (const OpenEdge& e : loops_[cap.loops[0]].edges) first = std::min(first, e.facet);
    if (!plc_.facet_bodies.empty()) {
      std::uint32_t body = plc_.facet_bodies[first];
      for (const OpenEdge& e : loops_[cap.loops[0]].edges) body = std::min(body, plc_.facet_bodies[e.facet]);
      plc_.facet_bodies.push_back(body);
    }
    if (plc_.source.facet_lines.empty()) return;
    const auto& parts = plc_.source.parts;
    const auto next = std::ranges::upper_bound(parts, plc_.source.facet_lines[first], {}, &PlcSource::Part::first_line);
    plc_.source.facet_lines.push_back(next == parts.begin() ? 0 : std::prev(next)->first_line);
  }

  void report(const PlanarCap& cap, const Plc<3>::Facet& facet, const std::string& name) {
    Diagnostic d;
    d.code = Errc::open_boundary;
    d.file = plc_.source.file;
    for (std::size_t k = 0; k < facet.polygons.size(); ++k) {
      const auto& polygon = facet.polygons[k];
      d.message += (k == 0   ? "the opening in the loop of "
                    : k == 1 ? ", around "
                             : " and ") +
                   std::to_string(polygon.size()) + " edges from point " + std::to_string(polygon[0] + plc_.first_index) + " " +
                   to_text(plc_.points[polygon[0]]) + " on";
      for (const std::uint32_t v : polygon) {
        d.ids.push_back(static_cast<std::int64_t>(v) + plc_.first_index);
        d.points.push_back(plc_.points[v].x);
      }
    }
    d.message += " is closed by facet " + std::to_string(plc_.facets.size() + plc_.first_index) + ", of marker " +
                 std::to_string(facet.marker) + " (" + name + ") and area " + to_text(cap.area);
    repairs_.push_back(std::move(d));
  }

  const Domain<3>& domain_;
  std::span<const OpenLoop> loops_;
  std::vector<Diagnostic>& repairs_;
  Plc<3> plc_;
  const std::size_t count_;           // points of the input
  std::vector<std::uint32_t> added_;  // sorted
  std::set<int> markers_;
  std::set<std::string> names_;
  int next_marker_ = 1, next_name_ = 1;
};

}  // namespace
}  // namespace detail

Plc<3> close_planar_openings(const Plc<3>& plc, std::vector<Diagnostic>& repairs, const std::stop_token& stop) {
  std::optional<Domain<3>> domain;
  try {
    domain.emplace(plc, stop);
  } catch (const InputError&) {  // whoever diagnoses it says so
    return plc;
  }
  const detail::StopCheck stop_check(stop);
  const auto loops = detail::open_loops(*domain, detail::Bulk(true, stop), stop_check);
  const auto caps = detail::planar_caps(*domain, loops, stop_check);
  if (caps.empty()) return plc;
  return detail::Closing(plc, *domain, loops, repairs).run(caps);
}

}  // namespace pgdr
