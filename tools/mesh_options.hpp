// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The arguments of `pgdr mesh` as options of the library.
#pragma once

#include <string>

#include "bounds.hpp"
#include "console.hpp"
#include "options.hpp"
#include "pgdr/io.hpp"
#include "pgdr/refine.hpp"
#include "selector.hpp"

namespace pgdr::tool {

inline constexpr double most_min_angle = 34;  // degrees; beyond, the number of points explodes

template <int D>
RefineOptions<D> make_options(const MeshArguments& a, const Bounds<D>& bounds) {
  RefineOptions<D> options;
  options.radius_edge_bound = bounds.radius_edge;
  options.size = bounds.size;
  options.region_sizes = bounds.region_sizes;
  options.max_volume = bounds.max_volume;
  options.min_dihedral = a.no_optimize ? 0 : bounds.min_dihedral;
  const std::string selector = a.selector.value_or(usual_selector<D>());
  options.selector = make_selector<D>(selector);
  options.disk = {a.disk.value_or(a.delta > 0 ? DiskType::type2 : usual_disk(selector)), a.delta};
  options.keep_boundary = a.kept.any();
  options.kept_markers = a.kept.markers();
  options.conforming_delaunay = a.conforming_delaunay;
  options.drop_unused_points = a.drop_unused_points;
  options.refine = !a.no_refine;
  options.leaves = a.leaves;
  options.regions = a.regions;
  options.min_edge = a.min_edge;
  if (a.max_vertices) options.max_vertices = *a.max_vertices;
  options.schedule.threads = a.threads.value_or(0);
  options.schedule.schedule = a.schedule;
  options.schedule.claims = a.claims;
  options.schedule.lattice = a.lattice.value_or(0);
  if (a.granularity) options.schedule.granularity = *a.granularity;
  options.schedule.trace = !a.trace.empty();
  options.memory_guard = false;  // asked with the estimate, which is printed anyway
  return options;
}

template <int D>
Bounds<D> bounds_of(const MeshArguments& a) {
  Bounds<D> bounds = resolve<D>(a.bounds, smallest_proved_bound<D>());
  if (D == 2 && a.bounds.min_angle.value_or(0) > most_min_angle)
    throw UsageError({.code = Errc::bad_option,
                      .message = format("--min-angle takes up to %.0f degrees: few elements meet more", most_min_angle)});
  return bounds;
}

}  // namespace pgdr::tool
