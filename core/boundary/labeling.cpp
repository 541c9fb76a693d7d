// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "boundary/labeling.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "boundary/automatic_regions.hpp"
#include "input/words.hpp"
#include "mesh/cell_blocks.hpp"
#include "numbers/rounding.hpp"
#include "pgdr/diagnosis.hpp"
#include "space/box.hpp"
#include "space/bulk.hpp"
#include "space/disjoint_sets.hpp"
#include "space/distances.hpp"
#include "space/nesting.hpp"

namespace pgdr {
namespace {

constexpr std::uint32_t unlabelled = 0xffffffffu;

/// A hole or region seed of the input; one that is in the wrong place is named by its number there, or, where the reader made it
/// for cells of the file, by these.
template <int D>
struct Seed {
  Point<D> point;
  bool of_hole;
  std::uint32_t index;  ///< in Domain::holes or Domain::regions

  bool is_of_cells(const Domain<D>& domain) const {
    const PlcSource& source = domain.source();
    return of_hole ? index < source.void_widths.size() && std::isfinite(source.void_widths[index]) : index < source.cell_regions;
  }
  /// `of_cells`: what is said instead of a void between cells, or of labelled cells.
  Diagnostic diagnostic(const Domain<D>& domain, Errc code, const std::string& what, const std::string& of_cells) const {
    PlcSource::Place place = domain.source().place(of_hole ? SourceItem::hole : SourceItem::region, index);
    Diagnostic d{code, {}, std::move(place.file), 0, {}, {{point[0], point[1], D == 3 ? point[D - 1] : 0.0}}};
    if (is_of_cells(domain)) {
      const std::string subject = of_hole ? "the void between cells at "
                                          : "the cells of label " + detail::to_text(domain.regions()[index].attribute) + " at ";
      d.message = subject + detail::to_text(point) + " " + of_cells;
      return d;
    }
    const std::int64_t number = static_cast<std::int64_t>(index) + domain.first_index();
    d.message = (of_hole ? "hole seed " : "region seed ") + std::to_string(number) + " at " + detail::to_text(point) + " " + what;
    d.line = place.line;
    d.ids = {number};
    return d;
  }
};

template <int D>
std::vector<Seed<D>> seeds_of(const Domain<D>& domain) {
  std::vector<Seed<D>> seeds;
  for (std::uint32_t i = 0; i < domain.holes().size(); ++i) seeds.push_back({domain.holes()[i], true, i});
  for (std::uint32_t i = 0; i < domain.regions().size(); ++i) seeds.push_back({domain.regions()[i].point, false, i});
  return seeds;
}

/// In coordinates of at most 2: squares of others might be 0.
template <int D>
bool is_within(std::array<Point<D>, D> s, Point<D> x, double width) {
  double largest = 0;
  for (const Point<D>& p : s)
    for (const double coordinate : p.x) largest = std::max(largest, std::abs(coordinate));
  const double scale = std::ldexp(1.0, std::min(-std::ilogb(largest), 1022));
  for (Point<D>& p : s)
    for (double& coordinate : p.x) coordinate *= scale;
  for (double& coordinate : x.x) coordinate *= scale;
  const double scaled = width * scale;
  return detail::closest_to_simplex<D>(x, s).square <= scaled * scaled;
}

/// Where Steiner points have rounded a wall, a seed on it or some ulps beside it may be on either side of its mesh: the side
/// would not be the one on which it is in the input. A bent facet's subfacets are off it by up to twice its defect.
/// @throws InputError seed_on_boundary
template <int D>
void refuse_seeds_on_walls(const Domain<D>& domain, std::vector<Seed<D>> seeds, const detail::Bulk& bulk) {
  if (seeds.empty()) return;
  using OnWall = std::pair<const Seed<D>*, std::uint32_t>;  // and the facet
  std::stable_sort(seeds.begin(), seeds.end(), [](const Seed<D>& a, const Seed<D>& b) { return a.point[0] < b.point[0]; });
  const auto look_at = [&](const std::array<std::uint32_t, D>& corners, double width, std::uint32_t facet,
                           std::vector<OnWall>& out) {
    std::array<Point<D>, D> s;
    for (std::size_t k = 0; k < D; ++k) s[k] = domain.points()[corners[k]];
    const detail::Box<D> box = detail::Box<D>::of(s);
    auto seed = std::lower_bound(seeds.begin(), seeds.end(), box.low[0] - width,
                                 [](const Seed<D>& a, double x) { return a.point[0] < x; });
    for (; seed != seeds.end() && seed->point[0] <= box.high[0] + width; ++seed) {
      bool near = true;
      for (int i = 1; i < D; ++i) near &= box.low[i] - width <= seed->point[i] && seed->point[i] <= box.high[i] + width;
      if (near && is_within<D>(s, seed->point, width)) out.emplace_back(&*seed, facet);
    }
  };
  constexpr double ulps = 16 * rounding::ulp;
  std::vector<OnWall> found;
  if constexpr (D == 3) {
    found = bulk.gather<OnWall>(domain.facets().size(), [&](std::size_t i, std::vector<OnWall>& out) {
      const auto f = static_cast<EntityId>(i);
      const double width = ulps * domain.facet_magnitude(f) + 2 * domain.facets()[f].planarity_defect;
      const auto origins = domain.triangle_origins(f);
      for (std::size_t k = 0; k < origins.size(); ++k)
        look_at(domain.triangles(f)[k], width, origins[k].facet + domain.first_index(), out);
    });
  } else {
    found = bulk.gather<OnWall>(domain.segments().size(), [&](std::size_t i, std::vector<OnWall>& out) {
      const auto e = static_cast<EntityId>(i);
      look_at(domain.segments()[e].points, ulps * domain.segment_magnitude(e), no_entity, out);
    });
  }
  if (found.empty()) return;
  const auto& [seed, facet] = found.front();
  throw InputError(seed->diagnostic(
      domain, Errc::seed_on_boundary, D == 2 ? "lies on a segment" : "lies on facet " + std::to_string(facet),
      seed->of_hole ? "is as thin as rounding there, but thicker than the tolerance: faces of neighbouring cells do not match; a "
                      "larger --tolerance joins them"
                    : "are as thin as rounding there"));
}

/// The parts of the mesh that hang together through unconstrained faces. Number 0 is that of the ghosts, the others go by the
/// least slot that they have.
template <int D>
class Labeling {
 public:
  Labeling(const Mesh<D>& mesh, const Delaunay<D>& delaunay, const detail::Bulk& bulk)
      : mesh_(mesh), delaunay_(delaunay), component_(mesh.cell_bound(), unlabelled) {
    std::vector<std::uint32_t> numbers(mesh.cell_bound());
    bulk.each(numbers.size(), [&](std::size_t i) { numbers[i] = static_cast<std::uint32_t>(i); });
    detail::SharedDisjointSets sets(std::move(numbers));
    bulk.each(component_.size(), [&](std::size_t i) { join(CellId{static_cast<std::uint32_t>(i)}, sets); });
    const std::vector<CellId> ghosts = bulk.gather<CellId>(component_.size(), [&](std::size_t i, std::vector<CellId>& out) {
      const CellId c{static_cast<std::uint32_t>(i)};
      if (mesh.alive(c) && mesh.is_ghost(c)) out.push_back(CellId{sets.find(index(c))});
    });
    for (const CellId ghost : ghosts) sets.unite(index(ghosts.front()), index(ghost));  // of all islands
    const auto is_root = [&](std::uint32_t i) { return mesh.alive(CellId{i}) && sets.find(i) == i; };
    first_cells_ = bulk.gather<CellId>(component_.size(), [&](std::size_t i, std::vector<CellId>& out) {
      if (const auto c = static_cast<std::uint32_t>(i); is_root(c)) out.push_back(CellId{c});
    });
    const auto at = std::find(first_cells_.begin(), first_cells_.end(), CellId{sets.find(index(ghosts.front()))});
    std::rotate(first_cells_.begin(), at, at + 1);
    for (std::uint32_t k = 0; k < first_cells_.size(); ++k) component_[index(first_cells_[k])] = k;
    bulk.each(component_.size(), [&](std::size_t i) {
      const auto c = static_cast<std::uint32_t>(i);
      if (const std::uint32_t root = sets.find(c); root != c) component_[c] = component_[root];
    });
  }

  std::uint32_t components() const { return static_cast<std::uint32_t>(first_cells_.size()); }
  std::uint32_t component(CellId c) const { return component_[index(c)]; }
  CellId first_cell(std::uint32_t component) const { return first_cells_[component]; }
  std::span<const std::uint32_t> of_cells() const { return component_; }

  /// Component of a point that is on no wall, in the first of these islands that encloses it; 0 if none does.
  std::uint32_t find(const Point<D>& p, std::span<const std::uint32_t> islands) const {
    std::uint32_t found = 0;
    for (std::size_t i = 0; i < islands.size() && found == 0; ++i)
      found = component(locate<D>(mesh_, p, delaunay_.cell_at(delaunay_.first_vertices()[islands[i]])));
    return found;
  }

 private:
  void join(CellId c, detail::SharedDisjointSets& sets) const {
    if (!mesh_.alive(c)) return;
    for (int f = 0; f <= D; ++f)  // from the larger of two neighbours
      if (const CellId next = mesh_.cell(c).links[f].cell(); next < c && !mesh_.constrained(c, f))
        sets.unite(index(c), index(next));
  }

  const Mesh<D>& mesh_;
  const Delaunay<D>& delaunay_;
  std::vector<std::uint32_t> component_;
  std::vector<CellId> first_cells_;  ///< of the components
};

/// What becomes of each component.
template <int D>
class Regions {
 public:
  Regions(const Mesh<D>& mesh, const Labeling<D>& labeling, const Domain<D>& domain, const detail::Islands& islands,
          std::vector<Diagnostic>& warnings, const detail::Bulk& bulk)
      : mesh_(mesh),
        labeling_(labeling),
        domain_(domain),
        islands_(islands),
        bulk_(bulk),
        warnings_(warnings),
        removed_(labeling.components(), false),
        region_(labeling.components(), 0) {
    removed_[0] = true;
    table_.measure = {unbounded};
  }

  RegionTable run(RegionMode mode) {
    const std::vector<Seed<D>> seeds = seeds_of(domain_);
    refuse_seeds_on_walls(domain_, seeds, bulk_);
    for (const Seed<D>& seed : seeds) {
      const std::uint32_t c = labeling_.find(seed.point, islands_at(seed));
      if (seed.of_hole)
        place_hole(seed, c);
      else
        place_region(seed, c);
    }
    if (mode == RegionMode::automatic) remove_voids();
    require_something();
    if (numbers_volumes(mode)) label_rest();
    if (!bounded_) table_.measure.clear();
    return std::move(table_);
  }

  bool removed(std::uint32_t component) const { return removed_[component]; }
  std::uint16_t region(std::uint32_t component) const { return region_[component]; }

 private:
  static constexpr double unbounded = std::numeric_limits<double>::infinity();

  std::span<const std::uint32_t> islands_at(const Seed<D>& seed) const {
    static constexpr std::uint32_t only = 0;
    if (islands_.count == 1) return {&only, 1};
    return (seed.of_hole ? islands_.of_hole : islands_.of_region)[seed.index];
  }

  void warn(const Seed<D>& seed, const char* what, const char* of_cells) {
    warnings_.push_back(seed.diagnostic(domain_, Errc::seed_on_boundary, what, of_cells));
  }

  void place_hole(const Seed<D>& seed, std::uint32_t c) {
    if (c == 0) warn(seed, "lies outside; it was left out", "is open to the outside");
    removed_[c] = true;
  }

  void place_region(const Seed<D>& seed, std::uint32_t c) {
    table_.labelled = true;
    const auto& [point, attribute, size] = domain_.regions()[seed.index];
    if (removed_[c]) {
      if (c == 0)
        warn(seed, "lies outside; it was left out", "lie outside of all faces that enclose anything; they are left out");
      else
        warn(seed, "lies in a hole; it was left out", "lie in a void between other cells; they are left out");
    } else if (region_[c] == 0) {
      region_[c] = add(attribute, size > 0 ? size : unbounded);
      bounded_ = bounded_ || size > 0;
    } else if (table_.attribute[region_[c]] != attribute) {
      const std::string other = detail::to_text(table_.attribute[region_[c]]);
      throw InputError(
          seed.diagnostic(domain_, Errc::conflicting_seeds,
                          "has the attribute " + detail::to_text(attribute) + ", another seed in its region " + other,
                          "are not divided from cells of label " + other + ": they overlap, or their faces do not match"));
    }
  }

  std::uint16_t add(double attribute, double measure) {
    if (table_.attribute.size() > 0xffff) throw ResourceError({Errc::ids_exhausted, "more than 65535 regions", {}, 0, {}, {}});
    table_.attribute.push_back(attribute);
    table_.measure.push_back(measure);
    return static_cast<std::uint16_t>(table_.attribute.size() - 1);
  }

  void remove_voids() {
    const auto solid = detail::solid_by_nesting(labeling_.components(),
                                                detail::neighbouring_components<D>(mesh_, labeling_.of_cells(), bulk_));
    for (std::uint32_t c = 0; c < removed_.size(); ++c)
      if (!solid[c] && region_[c] == 0) removed_[c] = true;
  }

  void label_rest() {
    table_.labelled = true;
    std::vector<double> of_seeds(table_.attribute.begin() + 1, table_.attribute.end());
    std::sort(of_seeds.begin(), of_seeds.end());
    double label = 0;
    for (const std::uint32_t c :
         detail::components_in_order<D>(mesh_, domain_, labeling_.of_cells(), labeling_.components(), bulk_)) {
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
      const bool of_cells = !domain_.source().void_widths.empty();
      d.message = "nothing is left to mesh: every enclosed " + std::string(D == 3 ? "volume" : "area") +
                  (of_cells ? " is a void between cells" : " has a hole seed");
    } else {
      d.message = std::string("the ") + (D == 3 ? "facets" : "segments") +
                  " enclose nothing: the outside reaches every part of the input's convex hull through gaps";
      const Diagnosis<D> diagnosis = diagnose(domain_, {.most_listed = 1, .parallel = false});
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
  const detail::Islands& islands_;
  const detail::Bulk& bulk_;
  std::vector<Diagnostic>& warnings_;
  RegionTable table_;
  bool bounded_ = false;
  std::vector<bool> removed_;
  std::vector<std::uint16_t> region_;
};

}  // namespace

template <int D>
RegionTable carve(Mesh<D>& mesh, typename Mesh<D>::Pools& pools, const Delaunay<D>& delaunay, const Domain<D>& domain,
                  RegionMode mode, std::vector<Diagnostic>& warnings, const detail::Pieces& pieces,
                  const detail::Islands& islands) {
  const detail::Bulk bulk(pieces);
  const Labeling<D> labeling(mesh, delaunay, bulk);
  Regions<D> regions(mesh, labeling, domain, islands, warnings, bulk);
  RegionTable table = regions.run(mode);

  const auto is_doomed = [&](CellId c) { return regions.removed(labeling.component(c)); };
  for (std::uint32_t k = 0; k < labeling.components(); ++k)  // one thread alone may set the first
    if (!regions.removed(k)) mesh.set_region(labeling.first_cell(k), regions.region(k));
  bulk.each(mesh.cell_bound(), [&](std::size_t i) {
    const CellId c{static_cast<std::uint32_t>(i)};
    if (!mesh.alive(c) || is_doomed(c)) return;
    mesh.set_region(c, regions.region(labeling.component(c)));
    for (int f = 0; f <= D; ++f)
      if (is_doomed(mesh.cell(c).links[f].cell())) mesh.cell(c).links[f] = Link{};
  });
  detail::each_cell(mesh, pools, bulk, [&](CellId c, typename Mesh<D>::Pools& own) {
    if (is_doomed(c)) mesh.free_cell(own, c);
  });
  mesh.find_pinched_edges(domain.segments().size(), bulk);
  return table;
}

template RegionTable carve<2>(Mesh<2>&, Mesh<2>::Pools&, const Delaunay<2>&, const Domain<2>&, RegionMode,
                              std::vector<Diagnostic>&, const detail::Pieces&, const detail::Islands&);
template RegionTable carve<3>(Mesh<3>&, Mesh<3>::Pools&, const Delaunay<3>&, const Domain<3>&, RegionMode,
                              std::vector<Diagnostic>&, const detail::Pieces&, const detail::Islands&);

}  // namespace pgdr
