// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <map>
#include <set>

#include "nearness/nearness.hpp"
#include "pgdr/surface_counts.hpp"
#include "space/make_set.hpp"

namespace pgdr::checking {
namespace {

/// What no homeomorphism changes.
struct Topology {
  SurfaceCounts counts;
  std::int64_t characteristic = 0;  ///< vertices less edges plus triangles: with handles where counts have none
  bool operator==(const Topology&) const = default;
};

/// Triangles of one marker, or of all.
class Complex {
 public:
  explicit Complex(std::span<const Point3> points) : points_(points) {}
  void add(const std::array<std::uint32_t, 3>& t) { triangles_.push_back(t); }

  Topology topology() const {
    Plc<3> plc;
    std::vector<std::uint32_t> vertices;
    std::vector<std::array<std::uint32_t, 2>> edges;
    for (const auto& t : triangles_) vertices.insert(vertices.end(), t.begin(), t.end());
    detail::make_set(vertices);
    for (const std::uint32_t v : vertices) plc.points.push_back(points_[v]);
    const auto number = [&](std::uint32_t v) {
      return static_cast<std::uint32_t>(std::ranges::lower_bound(vertices, v) - vertices.begin());
    };
    for (const auto& t : triangles_) {
      plc.facets.push_back({{{number(t[0]), number(t[1]), number(t[2])}}, {}, 0});
      for (std::size_t i = 0; i < 3; ++i) {
        const auto [a, b] = std::minmax(t[i], t[(i + 1) % 3]);
        edges.push_back({a, b});
      }
    }
    detail::make_set(edges);
    return {surface_counts(plc),
            static_cast<std::int64_t>(vertices.size() + triangles_.size()) - static_cast<std::int64_t>(edges.size())};
  }

 private:
  std::span<const Point3> points_;
  std::vector<std::array<std::uint32_t, 3>> triangles_;
};

std::string words_of(const Topology& t) {
  return std::to_string(t.counts.components) + " components, " + std::to_string(t.counts.open_loops) + " open loops" +
         (t.counts.handles ? ", " + std::to_string(*t.counts.handles) + " handles" : std::string()) + ", Euler characteristic " +
         std::to_string(t.characteristic);
}

void compare(const NearTask& task, const Complex& given, const Complex& meshed, const std::string& whose) {
  const Topology of_given = given.topology(), of_mesh = meshed.topology();
  if (of_given == of_mesh) return;
  task.findings.add(Kind::other_topology, {}, [&] {
    return "The surface of the mesh" + whose + " has " + words_of(of_mesh) +
           "; that of the input, as far as it is to be meshed, " + words_of(of_given) + ".";
  });
}

}  // namespace

/// Of each marker by itself, too, unless facets of several markers overlap, so that it is open which of them has a place.
void check_same_topology(const NearTask& task) {
  const GivenSurface& given = task.given;
  if (!given.volumes()) return;  // which is a finding
  Complex of_given(given.points()), of_mesh(task.mesh.points);
  std::map<int, std::array<Complex, 2>> by_marker;
  const auto of = [&](int marker) -> std::array<Complex, 2>& {
    return by_marker.try_emplace(marker, std::array{Complex(given.points()), Complex(task.mesh.points)}).first->second;
  };
  bool overlaps = false;
  for (std::uint32_t t = 0; t < given.triangles().size(); ++t) {
    if (!given.is_wanted(t)) continue;
    of_given.add(given.triangles()[t]);
    overlaps = overlaps || given.markers(t).size() > 1;
    for (const int marker : given.markers(t)) of(marker)[0].add(given.triangles()[t]);
  }
  for (const auto& s : task.mesh.subfacets) {
    of_mesh.add(s.vertices);
    of(s.marker)[1].add(s.vertices);
  }
  compare(task, of_given, of_mesh, "");
  if (overlaps || by_marker.size() < 2) return;
  for (const auto& [marker, both] : by_marker) compare(task, both[0], both[1], " of marker " + std::to_string(marker));
}

}  // namespace pgdr::checking
