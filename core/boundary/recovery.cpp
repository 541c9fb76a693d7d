// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "boundary/recovery.hpp"

#include <algorithm>
#include <limits>
#include <span>
#include <string>

#include "boundary/marking.hpp"
#include "boundary/named_points.hpp"
#include "boundary/numbers.hpp"
#include "boundary/segment_insertion.hpp"
#include "boundary/state.hpp"
#include "input/words.hpp"

namespace pgdr {
namespace {

/// The most points of missing pieces.
std::uint64_t most_points(std::uint64_t input_points) {
  return numbers::missing_points + numbers::missing_points_a_point * input_points +
         std::min(numbers::hump_points_a_point * input_points, numbers::most_hump_points);
}

/// The most points of pieces that went missing since triangles are split for their shape, which `improving` points were for.
std::uint64_t most_points_after(std::uint64_t input_points, std::uint64_t improving) {
  return numbers::early_missing_points + numbers::early_missing_points_a_point * input_points +
         numbers::early_missing_points_a_split * improving;
}

constexpr auto time_between_reports = std::chrono::milliseconds(200);
constexpr double infinity = std::numeric_limits<double>::infinity();

/// The least angle at which two facets of the segment meet, in degrees.
double least_angle_at(const Domain<3>& domain, EntityId segment) {
  const auto facets = domain.facets_of_segment(segment);
  double least = 180;
  for (std::size_t i = 0; i < facets.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      least = std::min(least, entity_angle<3>(domain, {EntityKind::facet, facets[i]}, {EntityKind::facet, facets[j]}));
  return least;
}

/// The error that ends a recovery: it names the segment or facet with the most points.
InputError not_recovered(const Domain<3>& domain, const detail::SegmentChains& chains, const detail::FacetPatches& patches,
                         std::uint64_t points) {
  EntityRef most;
  std::size_t on_it = 0;
  const auto look_at = [&](EntityRef e, std::size_t n) {
    if (n <= on_it) return;
    most = e;
    on_it = n;
  };
  for (EntityId s = 0; s < domain.segments().size(); ++s) look_at({EntityKind::segment, s}, chains.chain(s).size() - 2);
  for (EntityId f = 0; f < domain.facets().size(); ++f) look_at({EntityKind::facet, f}, patches.inner_points(f));
  const bool is_facet = most.kind == EntityKind::facet;
  const std::span<const std::uint32_t> ends = is_facet ? domain.facet_points(most.id) : domain.segments()[most.id].points;
  Diagnostic d = detail::about_points<3>(Errc::boundary_not_recovered, domain, ends);
  d.message = "the boundary is not recovered after " + std::to_string(points) +
              " Steiner points: facets meet at very small angles, or nearly touch. The most, " + std::to_string(on_it) +
              ", are on " + (is_facet ? detail::facet_words(d) : detail::segment_words(d));
  if (const double angle = is_facet ? 180 : least_angle_at(domain, most.id); angle < 180)
    d.message += ", where facets meet at " + detail::to_text(angle) + " degrees";
  return InputError(std::move(d));
}

/// What ends a recovery early: the caller, or the time.
template <int D>
class EarlyEnd {
 public:
  EarlyEnd(const RefineOptions<D>& options, std::chrono::steady_clock::time_point start) : options_(&options), start_(start) {}

  /// Asks the clock and the stop token.
  bool is_reached() {
    if (options_->stop.stop_requested()) cause_ = StopCause::cancelled;
    if (options_->time_limit && std::chrono::steady_clock::now() - start_ >= *options_->time_limit)
      cause_ = StopCause::time_limit;
    return cause_ != StopCause::finished;
  }
  void set(StopCause cause) { cause_ = cause; }  ///< for another reason
  StopCause cause() const { return cause_; }     ///< finished: it has not ended early

 private:
  const RefineOptions<D>* options_;
  std::chrono::steady_clock::time_point start_;
  StopCause cause_ = StopCause::finished;
};

/// The recovery in 3D: rounds that split what is missing, then rounds that split poor triangles and what goes missing by that.
class BoundaryRecovery {
 public:
  BoundaryRecovery(Mesh<3>& mesh, Delaunay<3>& delaunay, const Domain<3>& domain, const RefineOptions<3>& options,
                   std::chrono::steady_clock::time_point start, RecoveryCounts& counts, const detail::Pieces& pieces)
      : mesh_(&mesh),
        domain_(&domain),
        options_(&options),
        counts_(&counts),
        bulk_(pieces),
        squares_(mesh, delaunay, domain),
        chains_(mesh, delaunay, domain, squares_, bulk_),
        patches_(mesh, delaunay, domain, chains_, squares_, bulk_),
        end_(options, start),
        last_report_(start) {}

  StopCause run(Mesh<3>::Pools& pools) {
    if (recover()) mark(pools);
    counts_->segment_points = chains_.points();
    counts_->facet_points = patches_.points();
    return end_.cause();
  }

 private:
  bool recover();
  void mark(Mesh<3>::Pools& pools);
  bool improve();
  bool is_over();
  void check_budget() const;
  bool must_end();
  void report();
  std::uint64_t points() const { return chains_.points() + patches_.points(); }
  std::uint64_t vertices() const { return domain_->points().size() + points(); }

  Mesh<3>* mesh_;
  const Domain<3>* domain_;
  const RefineOptions<3>* options_;
  RecoveryCounts* counts_;
  const detail::Bulk bulk_;
  detail::SquareFlips squares_;
  detail::SegmentChains chains_;
  detail::FacetPatches patches_;
  EarlyEnd<3> end_;
  std::chrono::steady_clock::time_point last_report_;
  std::uint64_t needed_ = 0;  ///< points, before any was for the shape of a triangle
};

/// Is nothing missing in the end, and no triangle poor? False: it ended early. Where the boundary is kept, and points have to go
/// again, what flips can make gets none; when they are made, all that they have changed is looked at once more.
bool BoundaryRecovery::recover() {
  const auto stop = [this] { return is_over(); };
  if (options_->keep_boundary) squares_.take(chains_.missing_segments());
  while (true) {
    ++counts_->rounds;
    if (is_over() || !chains_.recover(stop)) return false;
    if (patches_.recover_once(stop) || improve()) continue;
    if (!squares_.any()) return true;
    if (squares_.flip()) squares_.clear();
  }
}

/// @throws InputError boundary_not_recovered: an edge or triangle would be a part of two entities
void BoundaryRecovery::mark(Mesh<3>::Pools& pools) {
  const detail::WantedFaces faces = patches_.wanted();
  patches_.require_distinct(faces);
  const detail::WantedEdges edges = chains_.wanted();
  chains_.require_distinct(edges);
  detail::mark_constraints(*mesh_, pools, faces, edges, bulk_);
  patches_.require_edges_inside_one();
}

/// Splits poor triangles, one round. False if there are none. Triangles up to twice the bound are left to the refinement, which
/// splits them in the order that makes few points; where the boundary is kept, no point may stay.
bool BoundaryRecovery::improve() {
  const double bound = options_->refine && !options_->keep_boundary
                           ? numbers::early_split_slack * std::max(options_->radius_edge_bound, smallest_proved_bound<3>())
                           : infinity;
  if (!(bound < infinity)) return false;
  const std::uint64_t before = points();
  if (counts_->improving == 0) needed_ = before;
  const bool any = patches_.split_poor_triangles(bound, options_->min_edge, [this] { return must_end(); });
  counts_->improving += points() - before;
  return any;
}

/// Must it end? @throws InputError boundary_not_recovered, past the budget of points
bool BoundaryRecovery::is_over() {
  check_budget();
  return must_end();
}

void BoundaryRecovery::check_budget() const {
  const std::uint64_t input_points = domain_->points().size();
  const std::uint64_t missing = points() - counts_->improving;
  const bool is_falling = patches_.trend().rounds() > 1 ? patches_.trend().is_falling() : chains_.trend().is_falling();
  const std::uint64_t more = is_falling && counts_->rounds < numbers::falling_rounds ? numbers::falling_points : 0;
  const bool too_many = missing > most_points(input_points) + more;
  const bool too_many_after = counts_->improving > 0 && missing - needed_ > most_points_after(input_points, counts_->improving);
  if (too_many || too_many_after) throw not_recovered(*domain_, chains_, patches_, missing);
}

/// Do the limits of the caller end it? Reports progress, too.
bool BoundaryRecovery::must_end() {
  report();
  if (vertices() >= options_->max_vertices) end_.set(StopCause::max_vertices);
  return end_.is_reached();
}

void BoundaryRecovery::report() {
  if (!options_->progress) return;
  const auto now = std::chrono::steady_clock::now();
  if (now - last_report_ < time_between_reports) return;
  last_report_ = now;
  options_->progress({vertices(), 0, "recover", std::nullopt});
}

/// The recovery in 2D, which needs no points.
StopCause insert_segments(Mesh<2>& mesh, Mesh<2>::Pools& pools, const Delaunay<2>& delaunay, const Domain<2>& domain,
                          EarlyEnd<2> end, const detail::Pieces& pieces) {
  const auto stop = [&end] { return end.is_reached(); };
  if (!stop()) detail::SegmentInsertion(mesh, pools, delaunay, domain, detail::Bulk(pieces)).run(stop);
  return end.cause();
}

}  // namespace

template <int D>
StopCause recover_boundary(Mesh<D>& mesh, typename Mesh<D>::Pools& pools, Delaunay<D>& delaunay, const Domain<D>& domain,
                           const RefineOptions<D>& options, std::chrono::steady_clock::time_point start, RecoveryCounts& counts,
                           const detail::Pieces& pieces) {
  if constexpr (D == 3) {
    return BoundaryRecovery(mesh, delaunay, domain, options, start, counts, pieces).run(pools);
  } else {
    counts.rounds = 1;
    return insert_segments(mesh, pools, delaunay, domain, {options, start}, pieces);
  }
}

template StopCause recover_boundary<2>(Mesh<2>&, Mesh<2>::Pools&, Delaunay<2>&, const Domain<2>&, const RefineOptions<2>&,
                                       std::chrono::steady_clock::time_point, RecoveryCounts&, const detail::Pieces&);
template StopCause recover_boundary<3>(Mesh<3>&, Mesh<3>::Pools&, Delaunay<3>&, const Domain<3>&, const RefineOptions<3>&,
                                       std::chrono::steady_clock::time_point, RecoveryCounts&, const detail::Pieces&);

}  // namespace pgdr
