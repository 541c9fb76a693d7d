// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "pgdr/labeling.hpp"

#include <algorithm>
#include <cstdio>
#include <limits>
#include <span>

#include "detail/automatic_regions.hpp"
#include "pgdr/diagnosis.hpp"

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
  std::span<const std::uint32_t> of_cells() const { return component_; }

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

/// What becomes of each component.
template <int D>
class Regions {
 public:
  Regions(const Mesh<D>& mesh, const Labeling<D>& labeling, const Domain<D>& domain, std::vector<Diagnostic>& warnings)
      : mesh_(mesh), labeling_(labeling), domain_(domain), warnings_(warnings), removed_(labeling.components(), false),
        region_(labeling.components(), 0) {
    removed_[0] = true;
    table_.measure = {unbounded};
  }

  RegionTable run(RegionMode mode) {
    place_holes();
    place_regions();
    if (mode == RegionMode::automatic) {
      remove_voids();
      require_something();
      label_rest();
    } else {
      require_something();
    }
    if (!bounded_) table_.measure.clear();
    return std::move(table_);
  }

  bool removed(std::uint32_t component) const { return removed_[component]; }
  std::uint16_t region(std::uint32_t component) const { return region_[component]; }

 private:
  static constexpr double unbounded = std::numeric_limits<double>::infinity();

  void warn(const char* what, const Point<D>& p) {
    warnings_.push_back(about_seed<D>(Errc::seed_on_boundary, what, p));
  }

  void place_holes() {
    for (const Point<D>& hole : domain_.holes()) {
      const std::uint32_t c = labeling_.find(hole, "the hole seed");
      if (c == 0) warn("the hole seed lies outside; it was left out,", hole);
      removed_[c] = true;
    }
  }

  void place_regions() {
    for (const RegionSeed<D>& seed : domain_.regions()) {
      table_.labelled = true;
      const std::uint32_t c = labeling_.find(seed.point, "the region seed");
      if (removed_[c]) {
        warn(c == 0 ? "the region seed lies outside; it was left out,"
                    : "the region seed lies in a hole; it was left out,", seed.point);
      } else if (region_[c] == 0) {
        region_[c] = add(seed.attribute, seed.size > 0 ? seed.size : unbounded);
        bounded_ = bounded_ || seed.size > 0;
      } else if (table_.attribute[region_[c]] != seed.attribute) {
        throw InputError(about_seed<D>(Errc::conflicting_seeds,
                                       "two region seeds with attributes " + std::to_string(table_.attribute[region_[c]]) +
                                           " and " + std::to_string(seed.attribute) + " share a region, the second",
                                       seed.point));
      }
    }
  }

  std::uint16_t add(double attribute, double measure) {
    if (table_.attribute.size() > 0xffff)
      throw ResourceError({Errc::ids_exhausted, "more than 65535 regions", {}, 0, {}, {}});
    table_.attribute.push_back(attribute);
    table_.measure.push_back(measure);
    return static_cast<std::uint16_t>(table_.attribute.size() - 1);
  }

  void remove_voids() {
    const auto solid =
        detail::solid_by_nesting(labeling_.components(), detail::neighbouring_components<D>(mesh_, labeling_.of_cells()));
    for (std::uint32_t c = 0; c < removed_.size(); ++c)
      if (!solid[c] && region_[c] == 0) removed_[c] = true;
  }

  void label_rest() {
    table_.labelled = true;
    std::vector<double> of_seeds(table_.attribute.begin() + 1, table_.attribute.end());
    std::sort(of_seeds.begin(), of_seeds.end());
    double label = 0;
    for (const std::uint32_t c :
         detail::components_in_order<D>(mesh_, domain_, labeling_.of_cells(), labeling_.components())) {
      if (removed_[c] || region_[c] != 0) continue;
      do ++label;
      while (std::binary_search(of_seeds.begin(), of_seeds.end(), label));
      region_[c] = add(label, unbounded);
    }
  }

  // The loops of an open surface say where to look; without any, the culprits are the hole seeds.
  void require_something() const {
    if (std::find(removed_.begin(), removed_.end(), false) != removed_.end()) return;
    Diagnostic d{Errc::encloses_nothing, {}, domain_.source().file, 0, {}, {}};
    if (labeling_.components() > 1) {
      d.message = "nothing is left to mesh: every enclosed " + std::string(D == 3 ? "volume" : "area") +
                  " has a hole seed";
    } else {
      d.message = std::string("the ") + (D == 3 ? "facets" : "segments") +
                  " enclose nothing: the outside reaches every part of the input's convex hull through gaps";
      const Diagnosis<D> diagnosis = diagnose(domain_, {.most_listed = 1});
      if (const FindingList& open = diagnosis[Finding::open_boundary]; !open.listed.empty()) {
        const Diagnostic& first = open.listed[0].what;
        d.message += "; open boundaries: " + std::to_string(open.count) + ", the first " + first.message;
        d.line = first.line;
        d.ids = first.ids;
        d.points = first.points;
      }
    }
    throw InputError(std::move(d));
  }

  const Mesh<D>& mesh_;
  const Labeling<D>& labeling_;
  const Domain<D>& domain_;
  std::vector<Diagnostic>& warnings_;
  RegionTable table_;
  bool bounded_ = false;
  std::vector<bool> removed_;
  std::vector<std::uint16_t> region_;
};

}  // namespace

template <int D>
RegionTable carve(Mesh<D>& mesh, typename Mesh<D>::Pools& pools, const Delaunay<D>& delaunay, const Domain<D>& domain,
                  RegionMode mode, std::vector<Diagnostic>& warnings) {
  const Labeling<D> labeling(mesh, delaunay);
  Regions<D> regions(mesh, labeling, domain, warnings);
  RegionTable table = regions.run(mode);

  const std::uint32_t bound = mesh.cell_bound();
  auto doomed = [&](CellId c) { return regions.removed(labeling.component(c)); };
  for (std::uint32_t i = 0; i < bound; ++i) {
    const CellId c{i};
    if (!mesh.alive(c) || doomed(c)) continue;
    mesh.set_region(c, regions.region(labeling.component(c)));
    for (int f = 0; f <= D; ++f)
      if (doomed(mesh.cell(c).links[f].cell())) mesh.cell(c).links[f] = Link{};
  }
  for (std::uint32_t i = 0; i < bound; ++i)
    if (mesh.alive(CellId{i}) && doomed(CellId{i})) mesh.free_cell(pools, CellId{i});
  mesh.find_pinched_edges(domain.segments().size());
  return table;
}

template RegionTable carve<2>(Mesh<2>&, Mesh<2>::Pools&, const Delaunay<2>&, const Domain<2>&, RegionMode,
                              std::vector<Diagnostic>&);
template RegionTable carve<3>(Mesh<3>&, Mesh<3>::Pools&, const Delaunay<3>&, const Domain<3>&, RegionMode,
                              std::vector<Diagnostic>&);

}  // namespace pgdr
