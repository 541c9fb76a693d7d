// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The checker's stages in order. Each one survives whatever the earlier ones found, except indices and coordinates that
// cannot be used at all.
#include "pgdr/check.hpp"

#include <map>
#include <optional>
#include <string>

#include "check/bounds.hpp"
#include "check/kept.hpp"
#include "check/not_delaunay.hpp"
#include "given/volumes.hpp"
#include "nearness/nearness.hpp"
#include "nearness/own_walls.hpp"
#include "pgdr/facet_places.hpp"

namespace pgdr {
namespace {

using namespace checking;

/// Without the input: a loose vertex is a finding only where the input's points are known to be others.
template <int D>
void check_loose_points(const OutputMesh<D>& mesh, Findings& findings) {
  if (mesh.input_points == 0) return;
  std::vector<std::uint8_t> in_cell(mesh.points.size(), 0);
  for (const auto& cell : mesh.cells)
    for (const std::uint32_t v : cell) in_cell[v] = 1;
  for (std::uint32_t v = static_cast<std::uint32_t>(mesh.input_points); v < mesh.points.size(); ++v)
    if (!in_cell[v])
      findings.add(Kind::unreferenced_point, {v}, [&] { return "The " + vertex_words(mesh, v) + " is in no cell."; });
}

/// Of a name, what every format keeps: signs other than letters and digits may become others.
std::string kept_of(const std::string& name) {
  std::string kept;
  for (const char c : name) {
    const bool is_letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
    if (is_letter || (c >= '0' && c <= '9') || static_cast<unsigned char>(c) >= 0x80) kept += c;
  }
  return kept;
}

/// May a format have made the one of the other? Long names are cut, none of fewer bytes than so many.
bool is_name_of(const std::string& name, const std::string& given) {
  constexpr std::size_t never_cut = 80;
  const std::string kept = kept_of(name), whole = kept_of(given);
  return kept == whole || (name.size() >= never_cut && whole.starts_with(kept));
}

/// What has a name in the mesh and in the input has the same. A mesh may have none.
template <class Number>
void check_names(const char* what, const std::map<Number, std::string>& names, const std::map<Number, std::string>& given,
                 Findings& findings) {
  for (const auto& named : names)
    if (const auto wanted = given.find(named.first); wanted != given.end() && !is_name_of(named.second, wanted->second))
      findings.add(Kind::wrong_name, {static_cast<std::int64_t>(named.first)}, [&] {
        return std::string("The ") + what + " " + words(static_cast<double>(named.first)) + " is called \"" + named.second +
               "\", and in the input \"" + wanted->second + "\".";
      });
}

/// The volumes of the input, once everything in the mesh lies on something given and the other way round; none if its walls
/// bound no volumes.
template <int D>
std::optional<InputVolumes<D>> check_volumes(const GivenTask<D>& task, const GivenMatch<D>& match, RegionMode regions,
                                             const Links<D>& links, Components& components) {
  std::optional<InputVolumes<D>> volumes;
  try {
    volumes.emplace(walls_of_mesh(task, match), regions);
  } catch (const InputError& e) {
    task.findings.add(Kind::wrong_volume, {},
                      [&] { return std::string("What the walls of the mesh bound cannot be told: ") + e.what(); });
    return {};
  }
  check_regions(task.mesh, links, *volumes, components, task.findings);
  check_further_walls(task, *volumes);
  check_given_measures(task, match, *volumes);
  return volumes;
}

/// Faces and bounds, with the reasons of cells that are over these. `volumes` and `named`: null without an input.
template <int D>
void check_shapes(const OutputMesh<D>& mesh, const CheckOptions<D>& options, const Links<D>& links, const Components& components,
                  const InputVolumes<D>* volumes, NamedEntities<D>* named, Findings& findings) {
  Reasons<D> reasons(mesh, options, links, named, findings);
  if (options.delaunay || options.conforming_delaunay) {
    const std::vector<double> slack = slack_of_vertices(mesh, options.conformity_ulps);
    check_delaunay<D>(mesh, links, slack, reasons.vertices_at_refused(), options.not_delaunay_left, findings);
    if constexpr (D == 2)
      if (options.conforming_delaunay) check_conforming(mesh, links, slack, findings);
  }
  check_bounds(mesh, options, links, components, volumes, reasons, findings);
}

/// @throws UsageError bad_option: not one flag a point
template <int D>
const std::vector<std::uint8_t>* required_of(const CheckOptions<D>& options) {
  if (!options.required_points) return nullptr;
  if (options.required_points->size() != options.input->points.size())
    throw UsageError(
        {.code = Errc::bad_option, .message = "the flags of required points are not one for each point of the input"});
  return &*options.required_points;
}

template <int D>
void check_against_given(const OutputMesh<D>& mesh, const CheckOptions<D>& options, const Links<D>& links,
                         std::span<const std::uint32_t> sorted, Components& components, Findings& findings) {
  const GivenInput<D> input(*options.input, options.tolerance, findings);
  const GivenTask<D> task{mesh, input, findings, required_of(options)};
  GivenMatch<D> match;
  match_given_points(task, sorted, match);
  match_given_segments(task, match);
  if constexpr (D == 3) {
    match_given_facets(task, match);
    check_creases(task, match);
  }
  check_leftovers(task, match);
  check_kept(task, match, options);
  check_names("label", mesh.names.regions, options.input->names.regions, findings);
  check_names("marker", mesh.names.markers, options.input->names.markers, findings);
  const std::optional<InputVolumes<D>> volumes = check_volumes(task, match, options.regions, links, components);
  NamedEntities<D> named(task, match, sorted);
  check_shapes(mesh, options, links, components, volumes ? &*volumes : nullptr, &named, findings);
}

/// The walls of the mesh are those of another surface: it is to fill what they bound, and they are to be near the given ones.
void check_against_surface(const OutputMesh<3>& mesh, const CheckOptions<3>& options, const Links<3>& links,
                           std::span<const std::uint32_t> sorted, Components& components, Findings& findings) {
  const GivenInput<3> input(*options.input, options.tolerance, findings);
  const GivenSurface surface(input, options.regions, findings);
  const double distance = *options.surface_tolerance;
  const NearTask near{mesh, input, surface, distance, options.feature_angle, findings, required_of(options)};
  check_loose_points(mesh, findings);
  check_explicit_points(near, sorted);
  check_near_facets(near);
  check_near_curves(near);
  check_same_topology(near);

  const double even = evenness(mesh, input.tolerance(), distance);
  check_edges_of_walls(mesh, even + input.rounding(), findings);
  const Plc<3> walls = walls_as_input(mesh, input);
  const GivenInput<3> own(walls, even, findings);
  const GivenTask<3> task{mesh, own, findings};
  GivenMatch<3> match;
  match_given_points(task, sorted, match);
  match_given_segments(task, match);
  match_given_facets(task, match);
  std::optional<InputVolumes<3>> volumes;
  try {
    volumes.emplace(walls_of_mesh(task, match), options.regions);
    check_regions(mesh, links, *volumes, components, findings);
    check_near_volumes(near, *volumes, components);
  } catch (const InputError& e) {
    findings.add(Kind::wrong_volume, {},
                 [&] { return std::string("What the walls of the mesh bound cannot be told: ") + e.what(); });
  }
  // Points of the mesh that are none of the surface are where facets are only up to rounding.
  for (std::size_t p = mesh.input_points; p < match.vertex_of_point.size(); ++p) match.vertex_of_point[p] = none;
  NamedEntities<3> named(task, match, sorted, own_facets(mesh));
  CheckOptions<3> of_walls = options;
  std::vector<PoorReason> reasons;
  if (options.reasons) {
    reasons = *options.reasons;
    name_facets_by_places(*options.input, reasons);  // those with numbers, of a mesh that is of the given surface after all
    reasons = with_subfacets(reasons, mesh);
    of_walls.reasons = &reasons;
  }
  check_shapes(mesh, of_walls, links, components, volumes ? &*volumes : nullptr, &named, findings);
}

}  // namespace

template <int D>
CheckReport check(const OutputMesh<D>& mesh, const CheckOptions<D>& options) {
  if (D == 3 && options.conforming_delaunay)
    throw UsageError({.code = Errc::bad_option, .message = "conforming Delaunay meshes are of 2D"});
  CheckReport report;
  Findings findings(report, options.max_listed, options.stop);
  if (!check_indices(mesh, findings)) return report;
  const auto sorted = sort_points(mesh, findings);
  findings.heed_stop();
  const Links<D> links = link_cells(mesh, findings);
  check_subsegments_used(mesh, findings);
  if (findings.clean()) check_stars(mesh, links, findings);
  Components components = flood_cells(mesh, links, findings);
  if constexpr (D == 3)
    if (options.input && options.surface_tolerance) {
      check_against_surface(mesh, options, links, sorted, components, findings);
      return report;
    }
  if (options.input) {
    check_against_given(mesh, options, links, sorted, components, findings);
    return report;
  }
  check_loose_points(mesh, findings);
  check_shapes<D>(mesh, options, links, components, nullptr, nullptr, findings);
  return report;
}

template PGDR_API CheckReport check(const OutputMesh<2>&, const CheckOptions<2>&);
template PGDR_API CheckReport check(const OutputMesh<3>&, const CheckOptions<3>&);

}  // namespace pgdr
