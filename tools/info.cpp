// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// pgdr info: what is in an input or a mesh, and whether pgdr mesh would take it.
#include <algorithm>
#include <array>
#include <exception>
#include <memory>
#include <optional>

#include <tbb/parallel_invoke.h>

#include "command.hpp"
#include "console.hpp"
#include "diagnosis.hpp"
#include "input.hpp"
#include "pgdr/domain.hpp"
#include "pgdr/io.hpp"
#include "pgdr/refine.hpp"
#include "merge_hint.hpp"
#include "precision_hint.hpp"

namespace pgdr::tool {
namespace {

/// Edges that belong to one triangle only (3D), points that end one segment only (2D): 0 where all is closed.
template <int D>
std::uint64_t count_open(const Domain<D>& domain) {
  std::uint64_t open = 0;
  if constexpr (D == 3) {
    std::vector<std::array<std::uint32_t, 2>> edges;
    for (EntityId f = 0; f < domain.facets().size(); ++f)
      for (const auto& t : domain.triangles(f))
        for (std::size_t i = 0; i < 3; ++i) {
          const auto [a, b] = std::minmax(t[i], t[(i + 1) % 3]);
          edges.push_back({a, b});
        }
    std::sort(edges.begin(), edges.end());
    for (std::size_t i = 0, j = 0; i < edges.size(); i = j) {
      while (j < edges.size() && edges[j] == edges[i]) ++j;
      open += j - i == 1;
    }
  } else {
    std::vector<std::uint32_t> degree(domain.points().size());
    for (const DomainSegment& s : domain.segments())
      for (const std::uint32_t p : s.points) ++degree[p];
    open = static_cast<std::uint64_t>(std::count(degree.begin(), degree.end(), 1u));
  }
  return open;
}

/// The smallest angle, in degrees, between two segments with a common point, or two facets with a common segment.
/// Points where more than `most` segments meet are left out: all pairs would take too long.
template <int D>
double smallest_angle(const Domain<D>& domain) {
  constexpr std::size_t most = 1000;
  double smallest = 180;
  std::vector<std::vector<EntityId>> at(domain.points().size());
  for (EntityId s = 0; s < domain.segments().size(); ++s)
    for (const std::uint32_t p : domain.segments()[s].points) at[p].push_back(s);
  const auto take = [&](EntityKind kind, std::span<const EntityId> ids) {
    if (ids.size() > most) return;
    for (std::size_t i = 0; i < ids.size(); ++i)
      for (std::size_t k = i + 1; k < ids.size(); ++k)
        smallest = std::min(smallest, entity_angle(domain, EntityRef{kind, ids[i]}, EntityRef{kind, ids[k]}));
  };
  for (const auto& segments : at) take(EntityKind::segment, segments);
  if constexpr (D == 3)
    for (EntityId s = 0; s < domain.segments().size(); ++s) take(EntityKind::facet, domain.facets_of_segment(s));
  return smallest;
}

/// Of a Domain, all that takes time to find out.
struct Looks {
  std::uint64_t open;
  double smallest_angle;
  std::optional<PrecisionHint> precision_hint;
  std::optional<MergeHint> merge_hint;
};

template <int D>
Looks look_at(const Plc<D>& plc, const Domain<D>& domain, const InfoArguments& a) {
  return {count_open(domain), smallest_angle(domain), find_precision_hint(plc, &domain, a.reading),
          find_merge_hint(plc, &domain)};
}

/// What the input is without repetitions, its maximal entities, and how these meet.
template <int D>
void describe(const Domain<D>& domain, const Looks& looks, bool quiet, JsonObject& d) {
  const std::uint64_t open = looks.open;
  d.set("distinct_points", domain.points().size());
  d.set("maximal_segments", domain.segments().size());
  if (D == 3) d.set("maximal_facets", domain.facets().size());
  d.set("closed", open == 0);
  d.set("open", open);
  d.set("smallest_angle_deg", looks.smallest_angle);
  double defect = 0;
  std::uint64_t warped = 0;
  for (const DomainFacet& f : domain.facets()) {
    warped += !f.planar;
    defect = std::max(defect, f.planarity_defect);
  }
  if (D == 3) {
    d.set("not_planar", warped);
    d.set("planarity_defect", defect);
  }
  if (!quiet) {
    std::string counts = count(domain.points().size(), "distinct point", "distinct points") + ", " +
                         count(domain.segments().size(), "segment", "segments");
    if (D == 3) counts += ", " + count(domain.facets().size(), "facet", "facets");
    print_row("maximal", counts);
    if (open == 0) print_row("closed", "yes");
    else print_row("closed", "no: " + count(open, D == 3 ? "edge of one facet only" : "end of one segment only",
                                            D == 3 ? "edges of one facet only" : "ends of one segment only"));
    if (warped > 0)
      print_row("planar", count(warped, "facet is not", "facets are not") + format(", by up to %.3g", defect));
    print_row("angles", format("%.3f degrees is the smallest between segments, or facets at a segment", looks.smallest_angle));
  }
}

/// Boundary recovery alone decides the rest: seeds, whether anything is enclosed. `domain`, of `plc` if it is there, gets the one
/// that was used.
template <int D>
RefineResult<D> recover(const Plc<D>& plc, std::shared_ptr<const Domain<D>>& domain) {
  RefineOptions<D> options;
  options.refine = false;
  return with_fitting_precision(plc, [&](const Plc<D>& input) {
    if (!domain || &input != &plc) domain = std::make_shared<const Domain<D>>(input);
    return refine(*domain, options);
  });
}

template <int D>
int info_of_input(const InfoArguments& a, Report& report) {
  const Stopwatch clock;
  std::vector<Diagnostic> repairs;
  const Plc<D> plc = read_input<D>(a.file, a.reading, repairs);
  JsonObject seconds{{"read", clock.seconds()}};
  report.set("kind", "input");
  JsonObject d;
  d.set("accepted", false);
  d.set("points", plc.points.size());
  d.set("segments", plc.segments.size());
  if (D == 3) d.set("facets", plc.facets.size());
  d.set("holes", plc.holes.size());
  d.set("regions", plc.regions.size());
  report.set("diagnosis", d);  // what is known so far, should the next step refuse the input
  if (!a.quiet) {
    print_row("input", format("%s (%dD)", a.file.c_str(), D));
    std::string counts = count(plc.points.size(), "point", "points") + ", " +
                         count(plc.segments.size(), "segment", "segments");
    if (D == 3) counts += ", " + count(plc.facets.size(), "facet", "facets");
    print_row("file", counts + ", " + count(plc.holes.size(), "hole", "holes") + ", " +
                          count(plc.regions.size(), "region", "regions"));
  }

  std::optional<Domain<D>> prepared;
  const double diagnosis_at = clock.seconds();
  const Diagnosis<D> diagnosis = diagnose(plc, {}, prepared);
  const double recovery_at = clock.seconds();
  seconds.set("diagnosis", recovery_at - diagnosis_at);
  set_findings(d, diagnosis);
  report.set("seconds", seconds);
  report.set("diagnosis", d);
  if (!a.quiet) print_findings(diagnosis);
  if (diagnosis.error_count() > 0) return refuse(plc, diagnosis, report);

  const auto first = std::make_shared<const Domain<D>>(*std::move(prepared));
  auto domain = first;
  std::optional<RefineResult<D>> recovered;
  std::exception_ptr refused;
  std::optional<Looks> looks;
  tbb::parallel_invoke(
      [&] {
        try {
          recovered = recover(plc, domain);
        } catch (const InputError&) {
          refused = std::current_exception();
        }
      },
      [&] { looks = look_at(plc, *first, a); });
  if (domain != first) looks = look_at(plc, *domain, a);
  seconds.set("recovery", clock.seconds() - recovery_at);
  describe(*domain, *looks, a.quiet, d);
  if (D == 3) report.set("precision", domain->precision());
  report.set("merge_points", plc.merge_within);
  report.set("diagnosis", d);
  if (!a.quiet && !refused) note_precision(plc, domain->precision());
  if (!a.quiet) note_merge(plc, a.reading);
  give(looks->precision_hint, a.quiet, report);
  give(looks->merge_hint, !a.quiet, report);
  seconds.set("total", clock.seconds());
  report.set("seconds", seconds);
  if (refused) std::rethrow_exception(refused);

  d.set("accepted", true);
  report.set("diagnosis", d);
  report.set("warnings", to_json(recovered->warnings));
  repairs.insert(repairs.end(), recovered->repairs.begin(), recovered->repairs.end());
  report.set("repairs", to_json(repairs));
  if (!a.quiet) {
    print_warnings(recovered->warnings);
    if (!repairs.empty()) print_row("repaired", count(repairs.size(), "defect", "defects"));
    print_row("verdict", "pgdr mesh takes it");
  }
  return exit_done;
}

template <int D>
int info_of_mesh(const InfoArguments& a, Report& report) {
  const OutputMesh<D> mesh = read_mesh<D>(a.file);
  const QualitySummary q = summarize_quality(mesh);
  report.set("kind", "mesh");
  report.set("vertices", mesh.points.size());
  report.set("cells", mesh.cells.size());
  report.set("subsegments", mesh.subsegments.size());
  if (D == 3) report.set("subfacets", mesh.subfacets.size());
  std::vector<double> regions = mesh.regions;
  std::sort(regions.begin(), regions.end());
  regions.erase(std::unique(regions.begin(), regions.end()), regions.end());
  report.set("regions", std::max<std::size_t>(1, regions.size()));
  report.set("quality", to_json(q));
  if (a.quiet) return exit_done;

  print_row("mesh", format("%s (%dD)", a.file.c_str(), D));
  std::string counts = count(mesh.points.size(), "vertex", "vertices") + ", " +
                       count_cells<D>(mesh.cells.size()) + ", " +
                       count(mesh.subsegments.size(), "subsegment", "subsegments");
  if (D == 3) counts += ", " + count(mesh.subfacets.size(), "subfacet", "subfacets");
  print_row("counts", counts);
  print_row("quality", format("radius-edge up to %.4f, %s %.2f to %.2f degrees", q.max_radius_edge,
                              D == 3 ? "dihedral angles" : "angles", q.min_angle_deg, q.max_angle_deg));
  const std::uint64_t most = *std::max_element(q.histogram.begin(), q.histogram.end());
  for (std::size_t i = 0; i < q.histogram.size(); ++i) {
    const auto bar = most ? static_cast<std::size_t>(50 * q.histogram[i] / most) : 0;
    print_row("", format("%3zu-%3zu %12llu", 10 * i, 10 * i + 10, static_cast<unsigned long long>(q.histogram[i])) +
                      (bar ? ' ' + std::string(bar, '#') : ""));
  }
  return exit_done;
}

}  // namespace

int info(const InfoArguments& arguments, Report& report) {
  report.set("input", arguments.file);
  const int dimension = file_dimension(arguments.file);
  report.set("dimension", dimension);
  if (holds_cells(arguments.file))
    return dimension == 2 ? info_of_mesh<2>(arguments, report) : info_of_mesh<3>(arguments, report);
  return dimension == 2 ? info_of_input<2>(arguments, report) : info_of_input<3>(arguments, report);
}

}  // namespace pgdr::tool
