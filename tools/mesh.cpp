// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// pgdr mesh: read, refine, write, report.
#include <algorithm>
#include <array>
#include <cstdio>
#include <optional>

#include <tbb/parallel_invoke.h>

#include "bodies.hpp"
#include "bounds.hpp"
#include "command.hpp"
#include "console.hpp"
#include "cures.hpp"
#include "deadline.hpp"
#include "diagnosis.hpp"
#include "estimate.hpp"
#include "files.hpp"
#include "input.hpp"
#include "mesh_options.hpp"
#include "mesh_report.hpp"
#include "old_mesh.hpp"
#include "periodic.hpp"
#include "pgdr/facet_places.hpp"
#include "pgdr/field_io.hpp"
#include "pgdr/io.hpp"
#include "pgdr/make_periodic.hpp"
#include "pgdr/output_files.hpp"
#include "pgdr/voronoi.hpp"
#include "proposal.hpp"
#include "ranks.hpp"
#include "signals.hpp"
#include "surface_step.hpp"
#include "threads.hpp"

namespace pgdr::tool {
namespace {

/// Of the time limit: to number a large mesh and to measure it takes up to a tenth of the time that it took to make.
constexpr double part_for_meshing = 0.95;

/// What needs several ranks, and what they cannot do.
void require_ranks(const MeshArguments& a, const Ranks& ranks) {
  if (a.rank_timeout && !ranks.transport())
    throw UsageError({.code = Errc::bad_option, .message = "--rank-timeout is for pgdr-mpi"});
  if (a.remesh && ranks.transport()) throw UsageError({.code = Errc::bad_option, .message = "remesh is not for pgdr-mpi"});
  if (!a.voronoi.empty() && ranks.transport())
    throw UsageError({.code = Errc::bad_option, .message = "--voronoi is for one process"});
}

/// One run: read, mesh, write, print. Each step puts into the report what it knows.
template <int D>
class MeshRun {
 public:
  MeshRun(const MeshArguments& a, Inputs& input, Report& report, const Ranks& ranks, const Stopwatch& total)
      : a_(a),
        input_(input),
        report_(report),
        ranks_(ranks),
        total_(total),
        bounds_(bounds_of<D>(a)),
        options_(make_options<D>(a, bounds_)),
        threads_(a.threads) {
    options_.stop = signals_.token();
  }

  /// @returns the exit code
  int run() {
    if (const std::optional<int> refused = unless_refused([this] { read(); })) return *refused;
    if (const std::optional<int> refused = unless_refused([this] { mesh(); })) return *refused;
    Transport* const transport = ranks_.transport();
    const Measured measured = transport ? measure(*transport, made_) : measure(result_);
    ranks_.on_first([&] {
      if (!surface_) report_.set("tolerance", result_.tolerance);  // else that of what was given, as `check` reads it
      report_.set("largest_move", result_.largest_move);
      fill(report_, a_, threads_, bounds_, result_, measured);
      if (surface_ && surface_->replaced.report.stopped) report_.set("reproducible", false);
      if (bodies_) set_regions(report_, result_.regions, *bodies_);
      if (result_.stop == StopCause::finished)
        for (const auto& sides : sides_) pairs_.push_back(periodic_pairs(result_.mesh, sides, 2 * result_.tolerance));
      if (!sides_.empty()) set_periodic(report_, pairs_);
    });
    const std::optional<Proposal> proposal = write(measured.cells > 0);
    if (!ranks_.is_first()) return exit_code();
    if constexpr (D == 2) write_cells();
    report_seconds();
    print(measured);
    give(proposal, a_.quiet, report_);
    if (!a_.trace.empty()) {
      std::string trace_file = a_.trace;
      signals_.hear(false);
      std::fflush(stdout);  // which the trace may go to, too
      write_trace(a_, result_, seconds_);
      report_.trace_file = std::move(trace_file);
    }
    return exit_code();
  }

 private:
  int exit_code() const {
    if (result_.stop != StopCause::finished) return exit_stopped;
    const bool holds = a_.no_refine || (result_.poor_left == 0 && result_.size_met);
    return holds && result_.statistics.boundary_points == 0 ? exit_done : exit_poor_left;
  }

  void read() {
    seconds_.read_at = total_.seconds();
    // Nobody looks at the stop token while the input is read, which may be a FIFO.
    ranks_.on_first([&] {
      plc_ = a_.remesh ? read_old_mesh() : input_.read_given<D>(a_.reading);
      is_read_ = true;
      if (a_.reading.is_any()) plc_ = treated<D>(given_.emplace(plc_), a_.reading, repairs_);
      bodies_ = label_bodies(plc_, a_.reading);
      if (bodies_) repairs_.insert(repairs_.end(), bodies_->repairs.begin(), bodies_->repairs.end());
    });
    if (ranks_.transport()) plc_ = broadcast(*ranks_.transport(), plc_);
    given_points_ = plc_.points.size();
    ranks_.together([&] { resolve_names(plc_.names, bounds_); });
    options_.region_sizes = bounds_.region_sizes;
    set_names(report_, plc_.names);
    if (!a_.reading.seeds.empty()) report_.set("seeds", a_.reading.seeds);
    if (!a_.reading.holes.empty()) report_.set("holes", a_.reading.holes);
    report_.set("tolerance", tolerance_of(plc_));
    report_.set("largest_move", 0.0);
    report_.set("resolve_crossings", a_.reading.resolve_crossings);
    report_.set("convex_hull", a_.reading.convex_hull);
    if constexpr (D == 3) {
      report_.set("close_planar_openings", a_.reading.close_openings);
      if (a_.reading.resolve_crossings) report_.set("markers", name(a_.reading.markers.value_or(SharedMarker::smallest)));
    } else {
      report_.set("region_areas", a_.reading.region_areas);
    }
    report_.set("region_mode", name(a_.regions, a_.reading.bodies));
    if (options_.conforming_delaunay) report_.set("conforming_delaunay", true);
    seconds_.mesh_at = total_.seconds();
    seconds_.read = seconds_.mesh_at - seconds_.read_at;
  }

  Plc<D> read_old_mesh() {
    old_.emplace(input_.only(), !a_.remesh->no_fields || !a_.bounds.size_field.empty());
    bounds_.size = smallest<D>({bounds_.size, old_->sizes(a_.bounds), old_->sizes_of_cells(a_.remesh->cell_bounds)});
    options_.size = bounds_.size;
    report_.set("remeshed", true);
    report_.set("required", a_.remesh->keep_vertices ? std::vector<std::string>{all_vertices} : a_.remesh->required);
    return Inputs::as_asked<D>(old_->input(a_), a_.reading);
  }

  /// The exit code if a diagnosis refuses the input.
  template <class Step>
  std::optional<int> unless_refused(Step step) {
    try {
      step();
      return std::nullopt;
    } catch (const InputError& e) {  // which names one culprit: find them all
      if (!ranks_.is_first() || !is_read_) throw;
      signals_.hear(true);
      const double left = a_.time_limit ? std::max(0.0, *a_.time_limit - total_.seconds()) : longest_search.count();
      const Deadline deadline(std::chrono::duration<double>(left), options_.stop);
      const Refused<D> refused{given_ ? *given_ : plc_, plc_, a_.reading, deadline.token()};
      if (say_cure(refused, e, false, report_)) throw;
      const Diagnosis<D> diagnosis = diagnose(plc_);
      JsonObject findings;
      set_findings(findings, diagnosis);
      report_.set("diagnosis", findings);
      if (diagnosis.error_count() > 0) return refuse(refused, diagnosis, false, report_);
      throw;
    }
  }

  void mesh() {
    signals_.hear(true);
    ProgressLine line(!a_.quiet);
    if (line.is_shown()) options_.progress = [&](const Progress& p) { line(p); };
    if (ranks_.is_first())
      options_.prepared = [&](const Domain<D>& domain) {
        line.clear();
        say_what_is_ahead(domain);
      };
    if constexpr (D == 3) make_surface();
    if (a_.time_limit)
      options_.time_limit = std::chrono::duration<double>(std::max(0.0, *a_.time_limit - total_.seconds()) * part_for_meshing);
    make_sides();
    refine_here();
    if constexpr (D == 3)
      if (periodic_) name_as_given(*periodic_, result_.mesh, result_.reasons);
    if constexpr (D == 3)
      if (surface_)  // the input does not have these facets
        name_facets_by_places(periodic_ ? surface_->replaced.plc : plc_, result_.reasons);
    if (old_) {
      old_->rename(result_.reasons);
      fields_ = old_->transferred(a_, result_.mesh, result_.warnings);
    }
    result_.repairs.insert(result_.repairs.begin(), repairs_.begin(), repairs_.end());
    const std::vector<Diagnostic> left_out = input_.warnings(), unfit = unfit_names(plc_.names, a_.output);
    result_.warnings.insert(result_.warnings.begin(), left_out.begin(), left_out.end());
    result_.warnings.insert(result_.warnings.end(), unfit.begin(), unfit.end());
    if (bodies_) result_.warnings.insert(result_.warnings.begin(), bodies_->warnings.begin(), bodies_->warnings.end());
    if (const auto closed = warning_of_openings(repairs_)) result_.warnings.insert(result_.warnings.begin(), *closed);
    if (!a_.quiet) print_warnings(result_.warnings);
  }

  bool has_sides_of_file() const { return a_.periodic.empty() && old_; }
  std::vector<PeriodicSides<D>> asked_sides() const {
    return has_sides_of_file() ? old_->sides() : periodic_sides<D>(a_.periodic, plc_.names);
  }

  /// Divides sides that are to correspond.
  void make_sides() {
    const std::vector<PeriodicSides<D>> sides = asked_sides();
    if (sides.empty()) return;
    const Stopwatch watch;
    if constexpr (D == 3) {  // facets have other numbers then
      if (options_.prepared) options_.prepared(Domain<3>(plc_, options_.stop));
      options_.prepared = {};
    }
    periodic_ = make_periodic(plc_, sides, options_);
    if constexpr (D == 3)
      if (surface_) surface_->replaced.plc = std::move(plc_);
    plc_ = periodic_->plc;
    sides_ = periodic_->sides;
    if (periodic_->keep_boundary) options_.kept_markers = periodic_->kept_markers;
    options_.keep_boundary = options_.keep_boundary || periodic_->keep_boundary;
    report_.set("periodic_sides", has_sides_of_file() ? flags_of(sides) : a_.periodic);
    report_.set("periodic_rounds", periodic_->rounds);
    if (a_.time_limit)
      options_.time_limit = std::chrono::duration<double>(std::max(0.0, options_.time_limit->count() - watch.seconds()));
  }

  /// Puts another surface in the place of the given one, where that is asked for.
  void make_surface() requires(D == 3) {
    if (!a_.surface.tolerance) return;
    SurfaceArguments arguments = a_.surface;
    if (!ranks_.is_first()) arguments.output.clear();
    // With a clock it has half of the time, so that a mesh can be made; where it ends early it has a valid surface.
    std::optional<Deadline> half;
    if (a_.time_limit)
      half.emplace(std::chrono::duration<double>(std::max(0.0, *a_.time_limit - total_.seconds()) / 2), options_.stop);
    std::vector<int> fixed;  // what one side became the other would have to become, too
    for (const PeriodicSides<3>& sides : asked_sides()) fixed.insert(fixed.end(), {sides.from, sides.to});
    surface_ = replace_surface(plc_, arguments, a_.reading.tolerance, bounds_, fixed, half ? half->token() : options_.stop);
    plc_ = std::move(surface_->replaced.plc);
    set_surface(report_, *surface_);
    if (!a_.quiet && ranks_.is_first()) print_surface(*surface_);
  }

  void refine_here() {
    if (Transport* const transport = ranks_.transport()) {
      made_ = refine(*transport, plc_, options_);
      report_.set("ranks", transport->size());
      report_.set("distributed", to_json(made_.distributed));
    } else {
      result_ = refine(plc_, options_);
    }
  }

  /// The estimate and the narrowest gap, before anything takes long. Refuses what memory does not hold, unless it is bounded.
  void say_what_is_ahead(const Domain<D>& domain) {
    const Outlook<D> outlook = look_ahead<D>(domain, bounds_, !a_.no_refine, a_.regions, options_.stop);
    set_outlook(report_, domain, outlook);
    if constexpr (D == 3)
      if (!surface_ && !domain.repairs().empty())
        report_.set("surface", JsonObject{{"given", to_json(surface_counts(plc_))}, {"meshed", to_json(surface_counts(domain))}});
    if (!a_.quiet) print_outlook(domain, outlook);
    const bool is_bounded = a_.max_vertices || a_.time_limit || a_.kept.any() || a_.min_edge > 0;
    if (!is_bounded && outlook.estimate) require_memory_for(domain, *outlook.estimate);
  }

  void require_memory_for(const Domain<D>& domain, const CellEstimate<D>& estimate) const {
    try {
      require_memory(domain, estimate);
    } catch (const ResourceError& e) {
      Diagnostic d = e.diagnostic();
      d.message += " (--max-vertices, --time-limit)";
      const auto is_cured = [this](const Domain<D>& other) {
        const Outlook<D> outlook = look_ahead<D>(other, bounds_, !a_.no_refine, a_.regions, options_.stop);
        return !outlook.estimate || has_memory_for(*outlook.estimate);
      };
      if (const auto tolerance = cure_of_gaps<D>(plc_, domain, is_cured))
        d.message += ". --tolerance " + digits(*tolerance) +
                     ", two units of the last digit of the coordinates, joins what is so near";
      throw ResourceError(std::move(d));
    }
  }

  /// Writes the mesh, if there is one. Where elements stay poor the first rank looks for a tolerance that may help: meanwhile, if
  /// it is alone, for else it has to talk to the others.
  std::optional<Proposal> write(bool has_mesh) {
    seconds_.write_at = total_.seconds();
    const std::vector<std::string> files = files_of_mesh(a_.output, write_options(a_, plc_.first_index));
    ranks_.on_first([&] {
      if (std::any_of(files.begin(), files.end(), is_written_to)) signals_.hear(false);  // who reads may never come
    });
    std::optional<Proposal> proposal;
    const auto write_mesh = [&] {
      if (has_mesh) write_as_asked();
      seconds_.write = total_.seconds() - seconds_.write_at;
    };
    const auto look_for_proposal = [&] {
      if (a_.no_refine || result_.poor_left == 0 || result_.stop != StopCause::finished) return;
      proposal = find_proposal(plc_, Domain<D>(plc_));
    };
    if (ranks_.transport()) {
      write_mesh();
      if (ranks_.is_first()) look_for_proposal();
    } else {
      tbb::parallel_invoke(write_mesh, look_for_proposal);
    }
    return proposal;
  }

  void write_as_asked() {
    Transport* const transport = ranks_.transport();
    WriteOptions how = write_options(a_, plc_.first_index);
    if (transport && how.pieces == 0) how.pieces = static_cast<std::uint32_t>(transport->size());
    std::vector<std::string> mesh_files = files_of_mesh(a_.output, how);
    how.periodic = pairs_;
    if (transport)
      pgdr::write_mesh(*transport, a_.output, made_, how);
    else
      pgdr::write_mesh(result_.mesh, fields_, a_.output, how);
    if (ranks_.is_first()) report_.mesh_files = std::move(mesh_files);
  }

  /// The Voronoi cells, where they are asked for. A mesh that is not finished does not have them.
  void write_cells() requires(D == 2) {
    if (a_.voronoi.empty() || result_.stop != StopCause::finished) return;
    const VoronoiCells cells = voronoi_cells(result_.mesh);
    write_file(a_.voronoi, [&](std::ostream& out) { write_voronoi(out, cells); });
    report_.mesh_files.push_back(a_.voronoi);
    report_.set("voronoi", JsonObject{{"cells", cells.sites.size()}, {"points", cells.points.size()}});
    seconds_.write = total_.seconds() - seconds_.write_at;
  }

  double seconds_of_surface() const { return surface_ ? surface_->replaced.report.seconds : 0; }

  void report_seconds() {
    const RefineStatistics& s = result_.statistics;
    seconds_.total = total_.seconds();
    report_.set("seconds", JsonObject{{"read", seconds_.read},
                                      {"mesh", s.seconds_mesh + seconds_of_surface()},
                                      {"initial", s.seconds_initial},
                                      {"refine", s.seconds_refine},
                                      {"optimize", s.seconds_optimize},
                                      {"write", seconds_.write},
                                      {"total", seconds_.total}});
    report_.set("peak_rss_bytes", peak_rss_bytes());
  }

  void print(const Measured& measured) {
    if (a_.quiet) return;
    print_summary(a_, input_.words(), given_points_, bounds_, result_, measured, seconds_, seconds_of_surface());
    if (bodies_) print_bodies(*bodies_);
    print_periodic(pairs_);
  }

  const MeshArguments& a_;
  Inputs& input_;
  Report& report_;
  const Ranks& ranks_;
  const Stopwatch& total_;
  Bounds<D> bounds_;
  RefineOptions<D> options_;
  StopOnSignal signals_;
  const Threads threads_;
  Seconds seconds_;
  std::optional<OldMesh<D>> old_;  ///< of `remesh`
  MeshFields fields_;
  std::vector<Diagnostic> repairs_;
  Plc<D> plc_;
  std::optional<Plc<D>> given_;  ///< as it was read, if anything was done to it
  bool is_read_ = false;
  std::size_t given_points_ = 0;
  std::optional<BodyTable> bodies_;
  std::optional<PeriodicInput<D>> periodic_;
  std::vector<PeriodicSides<D>> sides_;  ///< that correspond
  std::vector<PeriodicPairs> pairs_;
  std::optional<SurfaceStep> surface_;  ///< what was put in the place of the surface as given
  DistributedResult<D> made_;           ///< on ranks with a piece of the mesh each
  RefineResult<D>& result_ = made_.run;
};

template <int D>
int run(const MeshArguments& arguments, Inputs& input, Report& report, const Ranks& ranks, const Stopwatch& total) {
  std::optional<MeshRun<D>> run;
  ranks.together([&] { run.emplace(arguments, input, report, ranks, total); });
  return run->run();
}

}  // namespace

int mesh(const MeshArguments& arguments, Report& report, const Ranks& ranks) {
  const Stopwatch total;
  Inputs input(arguments.inputs);
  report.set("input", input.json());
  int dimension = 0;
  ranks.on_first([&] {
    if (!arguments.remesh)
      for (const std::string& file : arguments.inputs) require_input_format(file);
    require_mesh_writable(arguments.output);
    require_format(arguments);
    require_ranks(arguments, ranks);
    if (!arguments.trace.empty()) require_writable(arguments.trace);
    dimension = input.dimension();
  });
  dimension = ranks.largest(dimension);
  require_3d(arguments.surface, dimension);
  if (!arguments.periodic.empty() && ranks.transport())
    throw UsageError({.code = Errc::bad_option, .message = "--periodic is for one process"});
  report.set("dimension", dimension);
  return dimension == 2 ? run<2>(arguments, input, report, ranks, total) : run<3>(arguments, input, report, ranks, total);
}

}  // namespace pgdr::tool
