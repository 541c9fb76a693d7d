// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// pgdr info: what is in an input or a mesh, and whether pgdr mesh would take it.
#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <numeric>
#include <optional>

#include <tbb/parallel_invoke.h>

#include "bodies.hpp"
#include "command.hpp"
#include "console.hpp"
#include "diagnosis.hpp"
#include "estimate.hpp"
#include "files.hpp"
#include "input.hpp"
#include "pgdr/domain.hpp"
#include "pgdr/io.hpp"
#include "pgdr/refine.hpp"
#include "problems.hpp"
#include "proposal.hpp"
#include "surface_step.hpp"

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

template <class Label>
std::string words_of_names(const std::map<Label, std::string>& names) {
  constexpr std::size_t most = 20;
  std::string words;
  std::size_t n = 0;
  for (const auto& [label, name] : names)
    if (++n <= most) words += (n == 1 ? "" : ", ") + name + " (" + digits(static_cast<double>(label)) + ")";
  return n > most ? words + ", ..." : words;
}

void print_names(const Names& names) {
  if (!names.regions.empty()) print_row("regions", words_of_names(names.regions));
  if (!names.markers.empty()) print_row("markers", words_of_names(names.markers));
}

/// What takes time to find out of a Domain.
struct Looks {
  std::uint64_t open;
  std::optional<Proposal> proposal;
};

template <int D>
Looks look_at(const Plc<D>& plc, const Domain<D>& domain) {
  return {count_open(domain), find_proposal(plc, domain)};
}

/// What the input is without repetitions, its maximal entities, and how these meet.
template <int D>
void describe(const Domain<D>& domain, const Looks& looks, double smallest_angle, bool quiet, JsonObject& d) {
  const std::uint64_t open = looks.open;
  d.set("distinct_points", domain.points().size());
  d.set("maximal_segments", domain.segments().size());
  if (D == 3) d.set("maximal_facets", domain.facets().size());
  d.set("closed", open == 0);
  d.set("open", open);
  d.set("smallest_angle_deg", smallest_angle);
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
    if (open == 0)
      print_row("closed", "yes");
    else
      print_row("closed", "no: " + count(open, D == 3 ? "edge of one facet only" : "end of one segment only",
                                         D == 3 ? "edges of one facet only" : "ends of one segment only"));
    if (warped > 0) print_row("planar", count(warped, "facet is not", "facets are not") + format(", by up to %.3g", defect));
  }
}

/// Recovers the boundary, which decides the rest: seeds, and whether anything is enclosed.
template <int D>
RefineResult<D> recover(const Domain<D>& domain) {
  RefineOptions<D> options;
  options.refine = false;
  return refine(domain, options);
}

/// What `info` does with an input: read, diagnose, recover the boundary, print. Each step puts into the report what it knows.
template <int D>
class InputInfo {
 public:
  InputInfo(const InfoArguments& a, Inputs& file, Report& report) : a_(a), file_(file), report_(report) {}

  /// @returns the exit code
  int run() {
    try {
      read();
      return run_treated();
    } catch (const InputError& e) {
      say_cure<D>(refused(), e, !a_.quiet, report_);
      throw;
    }
  }

 private:
  Refused<D> refused() const { return {given_ ? *given_ : plc_, plc_, a_.reading}; }

  int run_treated() {
    if (a_.reading.resolve_crossings) bodies_ = label_bodies(plc_, a_.reading);
    std::optional<Domain<D>> prepared;
    const double diagnosis_at = clock_.seconds();
    const Diagnosis<D> diagnosis = diagnose(plc_, {}, prepared);
    recovery_at_ = clock_.seconds();
    seconds_.set("diagnosis", recovery_at_ - diagnosis_at);
    set_findings(findings_, diagnosis);
    report_.set("seconds", seconds_);
    report_.set("diagnosis", findings_);
    if (!a_.quiet) print_findings(diagnosis);
    if (!a_.problems.empty()) write_problems(problems_ = problems_in_full(plc_, diagnosis), a_.problems);
    if (diagnosis.error_count() > 0) return refuse(refused(), diagnosis, !a_.quiet, report_);
    if (!bodies_ && (bodies_ = label_bodies(plc_, a_.reading))) prepared.emplace(plc_);
    say_what_is_ahead(*prepared);
    const RefineResult<D> recovered = recover_and_describe(*prepared);
    accept(recovered);
    if constexpr (D == 3) try_surface();
    return exit_done;
  }

  void read() {
    plc_ = file_.read_given<D>(a_.reading);
    if (a_.reading.is_any()) plc_ = treated<D>(given_.emplace(plc_), a_.reading, repairs_);
    seconds_.set("read", clock_.seconds());
    report_.set("kind", "input");
    findings_.set("accepted", false);
    findings_.set("points", plc_.points.size());
    findings_.set("segments", plc_.segments.size());
    if (D == 3) findings_.set("facets", plc_.facets.size());
    findings_.set("holes", plc_.holes.size());
    findings_.set("regions", plc_.regions.size());
    report_.set("diagnosis", findings_);  // what is known so far, should the next step refuse the input
    set_names(report_, plc_.names);
    if (a_.quiet) return;
    print_row("input", format("%s (%dD)", file_.words().c_str(), D));
    std::string counts = count(plc_.points.size(), "point", "points") + ", " + count(plc_.segments.size(), "segment", "segments");
    if (D == 3) counts += ", " + count(plc_.facets.size(), "facet", "facets");
    print_row("file",
              counts + ", " + count(plc_.holes.size(), "hole", "holes") + ", " + count(plc_.regions.size(), "region", "regions"));
    print_names(plc_.names);
  }

  /// What `mesh` would say, with its default bounds: before the recovery, which may take long.
  void say_what_is_ahead(const Domain<D>& domain) {
    const Outlook<D> outlook = look_ahead<D>(domain, resolve<D>({}, smallest_proved_bound<D>()), true, a_.regions, {});
    set_outlook(report_, domain, outlook);
    if (outlook.estimate) estimated_ = outlook.estimate->cells;
    if (outlook.angle) smallest_angle_ = outlook.angle->degrees;
    if (!a_.quiet) print_outlook(domain, outlook);
    recovery_at_ = clock_.seconds();
  }

  /// Recovers the boundary, and looks at the Domain meanwhile; describes that. @throws InputError if the boundary is not
  /// recovered
  RefineResult<D> recover_and_describe(const Domain<D>& domain) {
    std::optional<RefineResult<D>> recovered;
    std::exception_ptr refused;
    Diagnostic problem;
    std::optional<Looks> looks;
    tbb::parallel_invoke(
        [&] {
          try {
            recovered = recover(domain);
          } catch (const InputError& e) {
            refused = std::current_exception();
            problem = e.diagnostic();
          }
        },
        [&] { looks = look_at(plc_, domain); });
    seconds_.set("recovery", clock_.seconds() - recovery_at_);
    describe(domain, *looks, smallest_angle_, a_.quiet, findings_);
    report_.set("tolerance", domain.tolerance());
    report_.set("largest_move", domain.largest_move());
    if constexpr (D == 3)
      report_.set("surface", JsonObject{{"given", to_json(surface_counts(plc_))}, {"meshed", to_json(surface_counts(domain))}});
    report_.set("diagnosis", findings_);
    give(looks->proposal, a_.quiet, report_);
    seconds_.set("total", clock_.seconds());
    report_.set("seconds", seconds_);
    if (!refused) return *std::move(recovered);
    add_problem(problems_, problem);
    if (!a_.problems.empty()) write_problems(problems_, a_.problems);
    std::rethrow_exception(refused);
  }

  /// Says what `mesh --surface-tolerance` would make of it, and how many cells of that.
  void try_surface() requires(D == 3) {
    if (!a_.surface.tolerance) return;
    const Bounds<3> bounds = resolve<3>({}, smallest_proved_bound<3>());
    const SurfaceStep step = replace_surface(plc_, a_.surface, a_.reading.tolerance, bounds, {}, {});
    set_surface(report_, step);
    if (!a_.quiet) print_surface(step);
    const Domain<3> domain(step.replaced.plc);
    const Outlook<3> outlook = look_ahead<3>(domain, bounds, true, a_.regions, {});
    JsonObject cells;
    if (outlook.estimate)
      cells = JsonObject{{"given", std::floor(estimated_)}, {"replaced", std::floor(outlook.estimate->cells)}};
    report_.set("surface_estimated_cells", cells);
    if (!a_.quiet && outlook.estimate)
      print_row("", "at least " + count_cells<3>(static_cast<std::uint64_t>(outlook.estimate->cells)) + " of it");
  }

  void accept(const RefineResult<D>& recovered) {
    findings_.set("accepted", true);
    report_.set("diagnosis", findings_);
    std::vector<Diagnostic> warnings = bodies_ ? bodies_->warnings : std::vector<Diagnostic>{};
    if (const auto closed = warning_of_openings(repairs_)) warnings.insert(warnings.begin(), *closed);
    if (bodies_) repairs_.insert(repairs_.end(), bodies_->repairs.begin(), bodies_->repairs.end());
    warnings.insert(warnings.end(), recovered.warnings.begin(), recovered.warnings.end());
    report_.set("warnings", to_json(warnings));
    repairs_.insert(repairs_.end(), recovered.repairs.begin(), recovered.repairs.end());
    report_.set("repairs", to_json(repairs_));
    report_.set("regions", to_json(recovered.regions));
    if (bodies_) set_regions(report_, recovered.regions, *bodies_);
    if (a_.quiet) return;
    if (bodies_) print_bodies(*bodies_);
    print_warnings(warnings);
    if (!repairs_.empty()) print_row("repaired", count(repairs_.size(), "defect", "defects"));
    print_row("verdict", "pgdr mesh takes it");
  }

  const InfoArguments& a_;
  Inputs& file_;
  Report& report_;
  const Stopwatch clock_;
  Plc<D> plc_;
  std::optional<Plc<D>> given_;  ///< as it was read, if anything was done to it
  Problems problems_;
  std::optional<BodyTable> bodies_;
  std::vector<Diagnostic> repairs_;
  JsonObject seconds_, findings_;
  double estimated_ = 0;  ///< cells
  double recovery_at_ = 0, smallest_angle_ = 180;
};

template <int D>
std::string angle_range(const QualityMeasures& q) {
  return format("%s %.2f to %.2f degrees", D == 3 ? "dihedral angles" : "angles", q.min_angle_deg, q.max_angle_deg);
}

std::string words(const MeasureSummary& m) {
  return format("from %.3f, 1 %% quantile %.3f, mean %.3f", m.least, m.one_percent, m.mean);
}

/// What is summed up of all cells, and in a line each of the first regions, if there are several.
template <int D>
void print_quality(const QualitySummary& q) {
  constexpr std::size_t most_regions = 20;
  print_row("quality", format("radius-edge up to %.4f, ", q.max_radius_edge) + angle_range<D>(q));
  const auto& [least, one, five] = q.smallest_angle_quantiles_deg;
  print_row("", format("smallest angle of a cell: 0.1, 1, 5 %% quantile %.2f, %.2f, %.2f degrees", least, one, five));
  print_row("", "radius ratio " + words(q.radius_ratio));
  print_row("", "scaled Jacobian " + words(q.scaled_jacobian));
  const std::uint64_t most = *std::max_element(q.histogram.begin(), q.histogram.end());
  for (std::size_t i = 0; i < q.histogram.size(); ++i) {
    const auto bar = most ? static_cast<std::size_t>(50 * q.histogram[i] / most) : 0;
    print_row("", format("%3zu-%3zu %12llu", 10 * i, 10 * i + 10, static_cast<unsigned long long>(q.histogram[i])) +
                      (bar ? ' ' + std::string(bar, '#') : ""));
  }
  if (q.regions.size() < 2) return;
  for (std::size_t r = 0; r < std::min(most_regions, q.regions.size()); ++r) {
    const RegionQuality& region = q.regions[r];
    const auto& cells = region.cells_by_smallest_angle;
    print_row("region " + digits(region.label), count_cells<D>(std::accumulate(cells.begin(), cells.end(), std::uint64_t{0})) +
                                                    ", " + angle_range<D>(region) +
                                                    format(", 1 %% quantile %.2f", region.smallest_angle_quantiles_deg[1]));
  }
  if (q.regions.size() > most_regions) print_row("", count(q.regions.size() - most_regions, "more region", "more regions"));
}

template <int D>
int info_of_mesh(const InfoArguments& a, InputFile& file, Report& report) {
  const OutputMesh<D> mesh = file.read_mesh<D>();
  report.set("warnings", to_json(file.warnings()));
  if (!a.quiet) print_warnings(file.warnings());
  const QualitySummary q = summarize_quality(mesh);
  report.set("kind", "mesh");
  report.set("vertices", mesh.points.size());
  report.set("cells", mesh.cells.size());
  report.set("subsegments", mesh.subsegments.size());
  if (D == 3) report.set("subfacets", mesh.subfacets.size());
  report.set("regions", to_json(measure_regions(mesh)));
  report.set("quality", to_json(q));
  set_names(report, mesh.names);
  if (a.quiet) return exit_done;

  print_row("mesh", format("%s (%dD)", a.files.front().c_str(), D));
  std::string counts = count(mesh.points.size(), "vertex", "vertices") + ", " + count_cells<D>(mesh.cells.size()) + ", " +
                       count(mesh.subsegments.size(), "subsegment", "subsegments");
  if (D == 3) counts += ", " + count(mesh.subfacets.size(), "subfacet", "subfacets");
  print_row("counts", counts);
  print_names(mesh.names);
  print_quality<D>(q);
  return exit_done;
}

}  // namespace

int info(const InfoArguments& arguments, Report& report) {
  if (!arguments.problems.empty()) require_problems_writable(arguments.problems);
  Inputs inputs(arguments.files);
  report.set("input", inputs.json());
  const int dimension = inputs.dimension();
  report.set("dimension", dimension);
  require_3d(arguments.surface, dimension);
  if (arguments.files.size() == 1 && inputs.only().holds_cells())
    return dimension == 2 ? info_of_mesh<2>(arguments, inputs.only(), report) : info_of_mesh<3>(arguments, inputs.only(), report);
  for (const std::string& file : arguments.files) require_input_format(file);
  return dimension == 2 ? InputInfo<2>(arguments, inputs, report).run() : InputInfo<3>(arguments, inputs, report).run();
}

}  // namespace pgdr::tool
