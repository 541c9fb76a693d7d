// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "run/valid_options.hpp"

#include <limits>

#include "input/words.hpp"
#include "pgdr/error.hpp"
#include "rule/cell_bounds.hpp"
#include "size/region_sizes.hpp"

namespace pgdr::detail {

void bad_option(const std::string& what) { throw UsageError({Errc::bad_option, what, {}, 0, {}, {}}); }

template <int D>
void validate(const RefineOptions<D>& options) {
  if (!(options.radius_edge_bound > 0)) bad_option("the radius-edge bound must be positive");
  if (options.size.is_constant() && !(options.size.at({}) > 0)) bad_option("the size must be positive");
  for (const RegionSize<D>& s : options.region_sizes)
    if (s.size.is_constant() && !(s.size.at({}) > 0))
      bad_option("the size of the region with label " + label_words(s.label) + " must be positive");
  if (!(options.max_volume > 0)) bad_option("the volume bound must be positive");
  if (D == 2 && options.max_volume < std::numeric_limits<double>::infinity())
    bad_option("the volume bound is for 3D; in 2D the size bounds the area");
  if (!(options.min_edge >= 0)) bad_option("the shortest edge allowed must not be negative");
  if (options.time_limit && !(options.time_limit->count() >= 0)) bad_option("the time limit must not be negative");
  if (options.min_dihedral && !(*options.min_dihedral >= 0 && *options.min_dihedral <= most_min_dihedral))
    bad_option("the bound on dihedral angles must lie between 0 and " + to_text(most_min_dihedral) + " degrees");
  if (!options.refine && options.min_dihedral.value_or(0) > 0)
    bad_option("a bound on dihedral angles needs the refinement: the optimiser follows it");
  if (D == 2 && options.min_dihedral.value_or(0) > 0)
    bad_option("the bound on dihedral angles is for 3D; in 2D the radius-edge bound is one on angles");
  if (!options.kept_markers.empty() && !options.keep_boundary) bad_option("kept markers need that the boundary is kept");
  if (options.conforming_delaunay && (D == 3 || !options.refine || options.keep_boundary))
    bad_option(
        "a conforming Delaunay mesh is made in 2D only, with refinement, and splits segments: the boundary cannot be kept");
  if (options.schedule.threads < 0) bad_option("the number of threads must not be negative");
  if (options.schedule.granularity < 1) bad_option("the granularity must be at least 1");
  if (!(options.schedule.split_ratio > 0)) bad_option("the split ratio must be positive");
  if (options.schedule.lattice < 0 || options.schedule.lattice > most_lattice<D>())
    bad_option("the lattice must lie between 1 and " + std::to_string(most_lattice<D>()));
  const bool is_uniform = options.schedule.schedule == Schedule::uniform;
  if (options.schedule.lattice > 0 && !is_uniform) bad_option("a lattice is for the uniform schedule");
  if (is_uniform && options.schedule.claims != ClaimRule::boxes) bad_option("the uniform schedule claims boxes");
  const double delta = options.disk.delta;
  if (delta != 0 && options.disk.type == DiskType::type1) bad_option("delta is for disks of type 2");
  if (delta != 0 && !(delta >= smallest_proved_bound<D>() / options.radius_edge_bound && delta <= 1))
    bad_option("delta must lie between " + to_text(smallest_proved_bound<D>()) + " / radius-edge bound and 1");
}

template void validate<2>(const RefineOptions<2>&);
template void validate<3>(const RefineOptions<3>&);

}  // namespace pgdr::detail
