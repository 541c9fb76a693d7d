// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The shared models with the sizes they are refined to, and a refinement that goes through the checker.
#pragma once

#include <cmath>
#include <string>

#include "model_plcs.hpp"
#include "pgdr/check.hpp"
#include "pgdr/domain.hpp"
#include "pgdr/refine.hpp"

namespace pgdr::test {

template <int D>
struct Outcome {
  RefineResult<D> result;
  CheckReport report;
};

/// Refines, and checks with the same bounds against the input as given.
template <int D>
Outcome<D> refine_and_check(const Plc<D>& plc, const RefineOptions<D>& options) {
  const Domain<D> domain(plc);
  Outcome<D> outcome{refine<D>(domain, options), {}};
  CheckOptions<D> check_options;
  check_options.input = &plc;
  check_options.tolerance = domain.tolerance();
  check_options.regions = options.regions;
  check_options.radius_edge_bound = options.radius_edge_bound;
  check_options.size = options.size;
  check_options.region_sizes = options.region_sizes;
  check_options.max_measure = options.max_volume;
  check_options.largest_cosine = outcome.result.optimization.claimed_cosine;
  check_options.delaunay = outcome.result.delaunay;
  check_options.reasons = &outcome.result.reasons;
  outcome.report = check<D>(outcome.result.mesh, check_options);
  return outcome;
}

/// The triangles of its facets, which may have holes, each a facet.
inline Plc<3> triangles_of(const Plc<3>& plc) {
  Plc<3> out;
  out.points = plc.points;
  const Domain<3> domain(plc);
  for (EntityId f = 0; f < domain.facets().size(); ++f)
    for (const auto& t : domain.triangles(f)) out.facets.push_back({{{t[0], t[1], t[2]}}, {}, 0});
  return out;
}

inline std::string findings(const CheckReport& report) {
  std::string text;
  for (const auto& f : report.findings) text += std::string(name(f.kind)) + ": " + f.message + "\n";
  return text;
}

struct Model {
  const char* name;
  Plc<3> (*make)();
  double size;       ///< of the circumradius; infinity: none
  double most_poor;  ///< share of the cells that may stay poor
  double fine;       ///< a size for some thousands of cells
};

inline const Model refined_models[] = {
    {"cube", cube, 0.12, 0, 0.11},
    {"cube_with_two_points", cube_with_two_points, INFINITY, 0, 0.11},
    {"two_region_cube", two_region_cube, INFINITY, 0, 0.11},
    {"block_with_cavity", block_with_cavity, 0.3, 0, 0.19},
    {"l_block", l_block, 0.25, 0, 0.155},
    {"u_block", u_block, INFINITY, 0, 0.185},
    {"plate_with_hole", plate_with_hole, INFINITY, 0, 0.18},
    {"cube_with_marked_facet", cube_with_marked_facet, INFINITY, 0, 0.11},
    {"icosahedron", [] { return icosphere(0); }, INFINITY, 0.001, 0.12},
    {"icosphere_1", [] { return icosphere(1); }, 0.3, 0.001, 0.17},
    {"icosphere_2", [] { return icosphere(2); }, INFINITY, 0.001, 0.17},
    {"icosphere_3", [] { return icosphere(3); }, INFINITY, 0.001, 0.17},
};

/// Nothing but bounds that are not met yet.
inline bool unfinished_but_valid(const CheckReport& report) {
  for (const auto& f : report.findings)
    if (f.kind != CheckFinding::Kind::over_size && f.kind != CheckFinding::Kind::over_radius_edge &&
        f.kind != CheckFinding::Kind::bad_reason)
      return false;
  return true;
}

/// Of all cells together; 2D: their area.
template <int D>
double volume_of(const OutputMesh<D>& mesh) {
  double sum = 0;
  for (const auto& cell : mesh.cells) {
    double m[D][D];
    for (int i = 0; i < D; ++i)
      for (int k = 0; k < D; ++k) m[i][k] = mesh.points[cell[i + 1]][k] - mesh.points[cell[0]][k];
    if constexpr (D == 3)
      sum += (m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1]) - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0]) +
              m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0])) /
             6;
    else
      sum += (m[0][0] * m[1][1] - m[0][1] * m[1][0]) / 2;
  }
  return sum;
}

}  // namespace pgdr::test
