// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// A component of cells fills the volume of the input that the walls round it bound. Every wall of a kept volume must
// have a cell on that side, no wall of the outside or a hole may; then seeds and measures are compared.
#include "given/regions.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "pgdr/predicates.hpp"
#include "space/box.hpp"

namespace pgdr::checking {

template <int D>
Components flood_cells(const OutputMesh<D>& mesh, const Links<D>& links, Findings& findings) {
  Components out;
  out.of_cell.assign(mesh.cells.size(), none);
  std::vector<std::uint32_t> stack;
  for (std::uint32_t start = 0; start < mesh.cells.size(); ++start) {
    if (out.of_cell[start] != none) continue;
    const auto number = static_cast<std::uint32_t>(out.volume.size());
    out.volume.push_back(none);
    out.of_cell[start] = number;
    stack.push_back(start);
    while (!stack.empty()) {
      findings.heed_stop();
      const std::uint32_t c = stack.back();
      stack.pop_back();
      for (std::uint32_t face = (D + 1) * c; face < (D + 1) * (c + 1); ++face) {
        if (links.neighbour[face] == none || links.is_wall(face)) continue;
        const std::uint32_t other = links.neighbour[face] / (D + 1);
        if (!mesh.regions.empty() && other > c && mesh.regions[other] != mesh.regions[c])
          findings.add(Kind::wrong_region, {c, other}, [&] {
            return "The label changes from " + words(mesh.regions[c]) + " to " + words(mesh.regions[other]) + " between " +
                   cell_words(mesh, c) + " and " + cell_words(mesh, other) + ", with no constraint between them.";
          });
        if (out.of_cell[other] != none) continue;
        out.of_cell[other] = number;
        stack.push_back(other);
      }
    }
  }
  return out;
}

namespace {

template <int D>
class RegionChecker {
 public:
  RegionChecker(const OutputMesh<D>& mesh, const Links<D>& links, const InputVolumes<D>& volumes, Components& components,
                Findings& findings)
      : mesh_(mesh), input_(volumes), links_(links), components_(components), findings_(findings) {}

  void run() {
    bad_side_.assign(components_.volume.size(), 0);
    for (std::uint32_t w = 0; w < walls(mesh_).size(); ++w) check_wall(w);
    check_measures();
    check_seeds();
    check_labels_without_seed();
  }

 private:
  void check_wall(std::uint32_t w) {
    for (const std::size_t side : {0, 1}) {
      const std::uint32_t volume = input_.volumes_of(w)[side];
      const std::uint32_t face = links_.wall_sides[w][side];
      if (face != none && !links_.positive(face / (D + 1))) continue;  // reported, and its side means nothing
      if (face != none)
        enter(components_.of_cell[face / (D + 1)], volume, face);
      else if (input_.volumes()[volume].kept)
        report_empty_side(w);
    }
  }

  void enter(std::uint32_t component, std::uint32_t volume, std::uint32_t face) {
    std::uint32_t& known = components_.volume[component];
    if (bad_side_[component]) return;
    if (!input_.volumes()[volume].kept) {
      bad_side_[component] = 1;
      findings_.add(Kind::hole_filled, {face / (D + 1)}, [&] {
        return "The " + cell_words(mesh_, face / (D + 1)) + (volume == 0 ? " lies outside the domain." : " lies in a hole.");
      });
    } else if (known == none) {
      known = volume;
    } else if (known != volume) {
      bad_side_[component] = 1;
      findings_.add(Kind::wrong_volume, {face / (D + 1)}, [&] {
        return "Cells connected to " + cell_words(mesh_, face / (D + 1)) +
               " without a constraint between them lie in two volumes of the input.";
      });
    }
  }

  void report_empty_side(std::uint32_t w) {
    findings_.add(Kind::wrong_volume, {w}, [&] {
      return std::string(D == 2 ? "Subsegment " : "Subfacet ") + std::to_string(w) + " (" + list_words(walls(mesh_)[w].vertices) +
             ") has no cell on a side that belongs to the domain.";
    });
  }

  void check_measures() {
    constexpr double parts = D == 2 ? 2 : 6;
    std::vector<CompensatedSum> sums(input_.volumes().size());
    std::vector<double> errors(input_.volumes().size(), 0);
    std::vector<std::uint32_t> components(input_.volumes().size(), 0);
    for (const std::uint32_t v : components_.volume)
      if (v != none) ++components[v];
    for (std::uint32_t c = 0; c < mesh_.cells.size(); ++c) {
      const std::uint32_t volume = components_.volume[components_.of_cell[c]];
      if (volume == none) continue;
      const Simplex<D> s = corners_of(mesh_, c);
      std::array<Point<D>, D> base;
      std::copy_n(s.begin(), D, base.begin());
      const auto [value, error] = signed_measure<D>(base, s[D]);
      sums[volume].add(value / parts);
      errors[volume] += error / parts;
    }
    for (std::uint32_t v = 0; v < sums.size(); ++v) {
      const Volume& wanted = input_.volumes()[v];
      if (!wanted.kept) continue;
      const double slack = errors[v] + sums[v].error() + wanted.measure_error;
      if (components[v] == 1 && std::abs(sums[v].value() - wanted.measure) <= slack) continue;
      findings_.add(Kind::wrong_volume, {v}, [&] {
        return "Volume " + std::to_string(v) + " of the input measures " + words(wanted.measure) + " and is filled by " +
               std::to_string(components[v]) + " connected sets of cells, which measure " + words(sums[v].value()) + ".";
      });
    }
  }

  // Every seed is located twice: in the input (its volume, by a line) and in the mesh (the cells that contain it).
  void check_seeds() {
    for (std::uint32_t i = 0; i < input_.regions().size(); ++i) {
      seeds_.push_back({input_.regions()[i].point, i, false});
      if (!input_.region_volumes()[i]) report_seed(i, "on a wall");  // outside or in a hole, it has no say
    }
    for (std::uint32_t i = 0; i < input_.holes().size(); ++i) seeds_.push_back({input_.holes()[i], i, true});
    std::sort(seeds_.begin(), seeds_.end(), [](const Seed& a, const Seed& b) { return a.point[0] < b.point[0]; });
    found_.assign(input_.regions().size(), false);
    for (std::uint32_t c = 0; c < mesh_.cells.size() && !seeds_.empty(); ++c) visit_seeds(c);
    for (std::uint32_t i = 0; i < input_.regions().size(); ++i)
      if (!found_[i] && input_.region_volumes()[i] && input_.volumes()[*input_.region_volumes()[i]].kept)
        report_seed(i, "in no cell");
  }

  // What flood_cells found to be one component has one label, or was reported. Where volumes are not numbered it is 0 where no
  // seed is; an input without any seed says nothing of labels.
  void check_labels_without_seed() {
    std::vector<double> label_of(components_.volume.size(), 0);
    for (std::uint32_t c = 0; c < mesh_.cells.size() && !mesh_.regions.empty(); ++c)
      label_of[components_.of_cell[c]] = mesh_.regions[c];
    std::vector<double> used;
    for (std::uint32_t i = 0; i < label_of.size(); ++i) {
      if (components_.volume[i] == none) continue;
      const Volume& volume = input_.volumes()[components_.volume[i]];
      std::optional<std::array<double, 2>> wanted = volume.numbered;
      if (!wanted && volume.seeds.empty() && !input_.regions().empty()) wanted = {0, 0};
      if (!wanted) continue;
      if (volume.numbered) used.push_back(label_of[i]);
      if (label_of[i] >= (*wanted)[0] && label_of[i] <= (*wanted)[1]) continue;
      findings_.add(Kind::wrong_region, {components_.volume[i]}, [&] {
        return "Volume " + std::to_string(components_.volume[i]) + " of the input has label " + words(label_of[i]) +
               " instead of " + words((*wanted)[0]) + ".";
      });
    }
    std::sort(used.begin(), used.end());
    if (const auto twice = std::adjacent_find(used.begin(), used.end()); twice != used.end())
      findings_.add(Kind::wrong_region, {}, [&] { return "Two volumes have the label " + words(*twice) + "."; });
  }

  void report_seed(std::uint32_t i, const char* where) {
    findings_.add(Kind::wrong_region, {i}, [&] {
      return "The seed of region " + std::to_string(i) + " " + words(input_.regions()[i].point) + " lies " + where + ".";
    });
  }

  void visit_seeds(std::uint32_t c) {
    const Simplex<D> s = corners_of(mesh_, c);
    const auto [low, high] = detail::Box<D>::of(s);
    auto seed = std::lower_bound(seeds_.begin(), seeds_.end(), low[0], [](const Seed& a, double x) { return a.point[0] < x; });
    for (; seed != seeds_.end() && seed->point[0] <= high[0]; ++seed) {
      bool in_box = true;
      for (int i = 1; i < D; ++i) in_box &= low[i] <= seed->point[i] && seed->point[i] <= high[i];
      if (in_box && contains(s, seed->point)) visit_seed(c, *seed);
    }
  }

  static bool contains(const Simplex<D>& s, const Point<D>& p) {
    for (int i = 0; i <= D; ++i) {
      Simplex<D> t = s;
      t[i] = p;
      if (orient<D>(t) == Sign::negative) return false;
    }
    return true;
  }

  struct Seed {
    Point<D> point;
    std::uint32_t index;
    bool hole;
  };

  void visit_seed(std::uint32_t c, const Seed& seed) {
    if (seed.hole) {
      findings_.add(Kind::hole_filled, {c, seed.index}, [&] {
        return "The " + cell_words(mesh_, c) + " contains the seed of hole " + std::to_string(seed.index) + " " +
               words(seed.point) + ".";
      });
      return;
    }
    found_[seed.index] = true;
    const double label = mesh_.regions.empty() ? 0 : mesh_.regions[c];
    const double wanted = input_.regions()[seed.index].attribute;
    if (label == wanted) return;
    findings_.add(Kind::wrong_region, {c, seed.index}, [&] {
      return "The " + cell_words(mesh_, c) + " contains the seed of region " + std::to_string(seed.index) + " and has label " +
             words(label) + " instead of " + words(wanted) + ".";
    });
  }

  const OutputMesh<D>& mesh_;
  const InputVolumes<D>& input_;
  const Links<D>& links_;
  Components& components_;
  Findings& findings_;
  std::vector<std::uint8_t> bad_side_;  ///< of each component: reported already
  std::vector<Seed> seeds_;             ///< by x
  std::vector<bool> found_;
};

}  // namespace

template <int D>
void check_regions(const OutputMesh<D>& mesh, const Links<D>& links, const InputVolumes<D>& volumes, Components& components,
                   Findings& findings) {
  RegionChecker<D>(mesh, links, volumes, components, findings).run();
}

#define PGDR_INSTANTIATE(D)                                                          \
  template Components flood_cells(const OutputMesh<D>&, const Links<D>&, Findings&); \
  template void check_regions(const OutputMesh<D>&, const Links<D>&, const InputVolumes<D>&, Components&, Findings&);
PGDR_INSTANTIATE(2)
PGDR_INSTANTIATE(3)
#undef PGDR_INSTANTIATE

}  // namespace pgdr::checking
