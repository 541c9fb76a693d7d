// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The checker's stages in order. Each one survives whatever the earlier ones found, except indices and coordinates that
// cannot be used at all.
#include "pgdr/check.hpp"

#include <optional>

#include "check/bounds.hpp"
#include "check/given/volumes.hpp"
#include "pgdr/planar_plc.hpp"

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

template <int D>
void check_against_domain(const OutputMesh<D>& mesh, const CheckOptions<D>& options, const Links<D>& links,
                          std::span<const std::uint32_t> sorted, Components& components, Findings& findings) {
  const Domain<D>& domain = *options.domain;
  const InputVolumes<D> input(domain, options.regions);
  const ConformityTask<D> task{mesh, input, options.conformity_ulps, findings};
  const Conformity<D> conformity = check_conformity(task, sorted);
  check_regions(task, links, conformity, components);
  Reasons<D> reasons(mesh, options, links, &conformity, findings);
  if (options.delaunay)
    check_delaunay<D>(mesh, links, slack_of_vertices<D>(domain, conformity.home, options.conformity_ulps),
                      reasons.vertices_at_refused(input), findings);
  check_bounds(mesh, options, links, components, &input, reasons, findings);
}

Plc<2> without_crossings(const Plc<2>& plc) {
  std::vector<Diagnostic> repairs;
  return resolve_crossings(plc, repairs);
}
const Plc<3>& without_crossings(const Plc<3>& plc) { return plc; }

/// The volumes by the walls of a Domain, which has taken apart what overlaps outside of the mesh.
template <int D>
InputVolumes<D> check_volumes_of_domain(const GivenTask<D>& task, const CheckOptions<D>& options, const Domain<D>& domain,
                                        std::span<const std::uint32_t> sorted, const Links<D>& links, Components& components) {
  InputVolumes<D> volumes(domain, options.regions);
  CheckReport unheard;
  Findings ignored(unheard, 0, options.stop);
  const Conformity<D> homes = check_conformity(ConformityTask<D>{task.mesh, volumes, options.conformity_ulps, ignored}, sorted);
  check_regions(ConformityTask<D>{task.mesh, volumes, options.conformity_ulps, task.findings}, links, homes, components);
  return volumes;
}

/// The volumes of the input, once everything in the mesh lies on something given and the other way round; none if its walls
/// bound no volumes. `made`: room for the Domain of the input, where no other is at hand and it is needed.
template <int D>
std::optional<InputVolumes<D>> check_volumes(const GivenTask<D>& task, const CheckOptions<D>& options, const GivenMatch<D>& match,
                                             std::span<const std::uint32_t> sorted, const Links<D>& links, Components& components,
                                             std::optional<Domain<D>>& made) {
  std::optional<InputVolumes<D>> volumes;
  try {
    volumes.emplace(walls_of_mesh(task, match), options.regions);
  } catch (const InputError& e) {
    try {
      if (match.leftovers.empty()) throw;
      const Domain<D>& domain = options.domain ? *options.domain : made.emplace(without_crossings(*options.input), options.stop);
      return check_volumes_of_domain(task, options, domain, sorted, links, components);
    } catch (const InputError&) {
    }
    task.findings.add(Kind::wrong_volume, {},
                      [&] { return std::string("What the walls of the mesh bound cannot be told: ") + e.what(); });
    return {};
  }
  Conformity<D> own;  // each wall is its own entity
  for (std::uint32_t w = 0; w < walls(task.mesh).size(); ++w) own.patch_of.push_back({w, false});
  check_regions(ConformityTask<D>{task.mesh, *volumes, 0, task.findings}, links, own, components);
  check_further_walls(task, *volumes);
  check_given_measures(task, match, *volumes);
  return volumes;
}

template <int D>
void check_against_given(const OutputMesh<D>& mesh, const CheckOptions<D>& options, const Links<D>& links,
                         std::span<const std::uint32_t> sorted, Components& components, Findings& findings) {
  const GivenInput<D> input(*options.input, options.tolerance, findings);
  const GivenTask<D> task{mesh, input, findings};
  GivenMatch<D> match;
  match_given_points(task, sorted, match);
  match_given_segments(task, match);
  if constexpr (D == 3) {
    match_given_facets(task, match);
    check_creases(task, match);
  }
  check_leftovers(task, match);
  std::optional<Domain<D>> made;
  const std::optional<InputVolumes<D>> volumes = check_volumes(task, options, match, sorted, links, components, made);
  const InputVolumes<D>* known = volumes ? &*volumes : nullptr;
  if (!options.domain) {
    Reasons<D> reasons(mesh, options, links, nullptr, findings);
    if (options.delaunay) check_delaunay<D>(mesh, links, slack_without_input(mesh, options.conformity_ulps), {}, findings);
    check_bounds(mesh, options, links, components, known, reasons, findings);
    return;
  }
  // Reasons name entities of the Domain: where these are in the mesh, is asked, and what is found amiss there is not a verdict.
  CheckReport unheard;
  Findings ignored(unheard, 0, options.stop);
  const InputVolumes<D> of_domain(*options.domain, options.regions);
  const Conformity<D> conformity = check_conformity(ConformityTask<D>{mesh, of_domain, options.conformity_ulps, ignored}, sorted);
  Reasons<D> reasons(mesh, options, links, &conformity, findings);
  if (options.delaunay)
    check_delaunay<D>(mesh, links, slack_of_vertices<D>(*options.domain, conformity.home, options.conformity_ulps),
                      reasons.vertices_at_refused(of_domain), findings);
  check_bounds(mesh, options, links, components, known, reasons, findings);
}

}  // namespace

template <int D>
CheckReport check(const OutputMesh<D>& mesh, const CheckOptions<D>& options) {
  if (options.domain && options.domain->points().empty())
    throw UsageError({Errc::bad_option, "the Domain is empty: it was moved from", {}, 0, {}, {}});
  CheckReport report;
  Findings findings(report, options.max_listed, options.stop);
  if (!check_indices(mesh, findings)) return report;
  const auto sorted = sort_points(mesh, findings);
  findings.heed_stop();
  const Links<D> links = link_cells(mesh, findings);
  check_subsegments_used(mesh, findings);
  if (findings.clean()) check_stars(mesh, links, findings);
  Components components = flood_cells(mesh, links, findings);
  if (options.input) {
    check_against_given(mesh, options, links, sorted, components, findings);
    return report;
  }
  if (options.domain) {
    check_against_domain(mesh, options, links, sorted, components, findings);
    return report;
  }
  check_loose_points(mesh, findings);
  Reasons<D> reasons(mesh, options, links, nullptr, findings);
  if (options.delaunay) check_delaunay<D>(mesh, links, slack_without_input(mesh, options.conformity_ulps), {}, findings);
  check_bounds<D>(mesh, options, links, components, nullptr, reasons, findings);
  return report;
}

template PGDR_API CheckReport check(const OutputMesh<2>&, const CheckOptions<2>&);
template PGDR_API CheckReport check(const OutputMesh<3>&, const CheckOptions<3>&);

}  // namespace pgdr
