// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "pgdr/labeling.hpp"

#include <cstdio>
#include <limits>

namespace pgdr {
namespace {

constexpr std::uint32_t unlabelled = 0xffffffffu;

template <int D>
std::string coordinates(const Point<D>& p) {
  char text[96];
  if constexpr (D == 3) {
    std::snprintf(text, sizeof text, "(%.17g, %.17g, %.17g)", p[0], p[1], p[2]);
  } else {
    std::snprintf(text, sizeof text, "(%.17g, %.17g)", p[0], p[1]);
  }
  return text;
}

template <int D>
Diagnostic about_seed(Errc code, const std::string& what, const Point<D>& p) {
  return {code, what + " at " + coordinates<D>(p), {}, 0, {}, {{p[0], p[1], D == 3 ? p[D - 1] : 0.0}}};
}

template <int D>
class Labeling {
 public:
  Labeling(Mesh<D>& mesh, const Delaunay<D>& delaunay)
      : mesh_(mesh), delaunay_(delaunay), component_(mesh.cell_bound(), unlabelled) {
    // The ghosts' component is number 0, so it is flooded first.
    for (const bool ghosts : {true, false})
      for (std::uint32_t i = 0; i < mesh.cell_bound(); ++i)
        if (mesh.alive(CellId{i}) && component_[i] == unlabelled && (!ghosts || mesh.is_ghost(CellId{i})))
          flood(CellId{i});
  }

  std::uint32_t components() const { return count_; }
  std::uint32_t component(CellId c) const { return component_[index(c)]; }

  /// Component of the seed; 0 if it lies outside.
  std::uint32_t find(const Point<D>& seed, const char* what) const {
    const CellId c = locate<D>(mesh_, seed, delaunay_.cell_at(delaunay_.vertices()[0]));
    if (!mesh_.is_ghost(c))
      for (int i = 0; i <= D; ++i) {
        Simplex<D> s = mesh_.simplex(c);
        s[i] = seed;
        if (mesh_.constrained(c, i) && orient<D>(s) == Sign::zero)
          throw InputError(about_seed<D>(Errc::seed_on_boundary, std::string(what) + " lies on a facet or segment,", seed));
      }
    return component(c);
  }

 private:
  void flood(CellId from) {
    std::vector<CellId> stack{from};
    component_[index(from)] = count_;
    while (!stack.empty()) {
      const CellId c = stack.back();
      stack.pop_back();
      for (int f = 0; f <= D; ++f) {
        if (mesh_.constrained(c, f)) continue;
        const CellId next = mesh_.cell(c).links[f].cell();
        if (component_[index(next)] != unlabelled) continue;
        component_[index(next)] = count_;
        stack.push_back(next);
      }
    }
    ++count_;
  }

  Mesh<D>& mesh_;
  const Delaunay<D>& delaunay_;
  std::vector<std::uint32_t> component_;
  std::uint32_t count_ = 0;
};

/// Region number of each component, from the seeds.
template <int D>
std::vector<std::uint16_t> assign_regions(const Labeling<D>& labeling, const Domain<D>& domain, RegionTable& table,
                                          std::vector<Diagnostic>& warnings) {
  std::vector<std::uint16_t> region(labeling.components(), 0);
  bool bounded = false;
  table.measure = {std::numeric_limits<double>::infinity()};
  for (const RegionSeed<D>& seed : domain.regions()) {
    table.labelled = true;
    const std::uint32_t c = labeling.find(seed.point, "the region seed");
    if (c == 0) {
      warnings.push_back(about_seed<D>(Errc::seed_on_boundary, "the region seed lies outside; it was left out,", seed.point));
      continue;
    }
    if (region[c] != 0) {
      if (table.attribute[region[c]] != seed.attribute)
        throw InputError(about_seed<D>(Errc::conflicting_seeds,
                                       "two region seeds with attributes " + std::to_string(table.attribute[region[c]]) +
                                           " and " + std::to_string(seed.attribute) + " share a region, the second",
                                       seed.point));
      continue;
    }
    if (table.attribute.size() > 0xffff)
      throw ResourceError({Errc::ids_exhausted, "more than 65535 regions", {}, 0, {}, {}});
    region[c] = static_cast<std::uint16_t>(table.attribute.size());
    table.attribute.push_back(seed.attribute);
    table.measure.push_back(seed.size > 0 ? seed.size : std::numeric_limits<double>::infinity());
    bounded = bounded || seed.size > 0;
  }
  if (!bounded) table.measure.clear();
  return region;
}

/// Names the points at which one segment alone ends (2D), where the gaps are.
template <int D>
[[noreturn]] void fail_nothing_left(const Domain<D>& domain) {
  Diagnostic d{Errc::encloses_nothing,
               std::string("the ") + (D == 3 ? "facets" : "segments") +
                   " enclose nothing: the outside, or a hole, reaches every part of the input's convex hull through gaps",
               domain.source().file, 0, {}, {}};
  if constexpr (D == 2) {
    constexpr std::size_t most = 20;
    std::vector<int> segments(domain.points().size(), 0);
    for (const DomainSegment& s : domain.segments())
      for (const std::uint32_t v : s.points) ++segments[v];
    for (std::uint32_t v = 0; v < segments.size() && d.ids.size() < most; ++v) {
      if (segments[v] != 1) continue;
      d.message += (d.ids.empty() ? "; one segment alone ends at points " : ", ");
      d.ids.push_back(std::int64_t{domain.input_of_point()[v]} + domain.first_index());
      d.points.push_back({domain.points()[v][0], domain.points()[v][1], 0});
      d.message += std::to_string(d.ids.back());
    }
  }
  throw InputError(std::move(d));
}

}  // namespace

template <int D>
RegionTable carve(Mesh<D>& mesh, typename Mesh<D>::Pools& pools, const Delaunay<D>& delaunay, const Domain<D>& domain,
                  std::vector<Diagnostic>& warnings) {
  const Labeling<D> labeling(mesh, delaunay);
  std::vector<bool> removed(labeling.components(), false);
  removed[0] = true;
  for (const Point<D>& hole : domain.holes()) {
    const std::uint32_t c = labeling.find(hole, "the hole seed");
    if (c == 0) warnings.push_back(about_seed<D>(Errc::seed_on_boundary, "the hole seed lies outside; it was left out,", hole));
    removed[c] = true;
  }
  RegionTable table;
  const std::vector<std::uint16_t> region = assign_regions<D>(labeling, domain, table, warnings);
  bool nothing_left = true;
  for (std::size_t c = 0; c < removed.size(); ++c) nothing_left = nothing_left && removed[c];
  if (nothing_left) fail_nothing_left(domain);

  const std::uint32_t bound = mesh.cell_bound();
  auto doomed = [&](CellId c) { return removed[labeling.component(c)]; };
  for (std::uint32_t i = 0; i < bound; ++i) {
    const CellId c{i};
    if (!mesh.alive(c) || doomed(c)) continue;
    mesh.set_region(c, region[labeling.component(c)]);
    for (int f = 0; f <= D; ++f)
      if (doomed(mesh.cell(c).links[f].cell())) mesh.cell(c).links[f] = Link{};
  }
  for (std::uint32_t i = 0; i < bound; ++i)
    if (mesh.alive(CellId{i}) && doomed(CellId{i})) mesh.free_cell(pools, CellId{i});
  return table;
}

template RegionTable carve<2>(Mesh<2>&, Mesh<2>::Pools&, const Delaunay<2>&, const Domain<2>&, std::vector<Diagnostic>&);
template RegionTable carve<3>(Mesh<3>&, Mesh<3>::Pools&, const Delaunay<3>&, const Domain<3>&, std::vector<Diagnostic>&);

}  // namespace pgdr
