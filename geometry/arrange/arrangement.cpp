// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The rounds of an arrangement. Each makes a Domain of what the last one left, which joins what is within the tolerance and
// subdivides what overlaps in a plane, and cuts what crosses then. A Domain in which nothing crosses is the end.
#include "pgdr/arrangement.hpp"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include "arrange/cut_plc.hpp"
#include "arrange/grid.hpp"
#include "arrange/near_passes.hpp"
#include "diagnose/near_pieces.hpp"
#include "input/words.hpp"

namespace pgdr {
namespace {

using detail::Piece;

/// Real files take one round, or two; some ten where sheets are ulps apart.
constexpr int most_rounds = 20;
/// Where rounds make ever more crossings, or points, than they began with they do not end; few pairs say nothing.
constexpr std::size_t most_growth = 4, few_pairs = 64;
/// Rounds with points on a grid: each moves points first, and then cuts.
constexpr int most_rounds_on_grid = 12;
/// Points between edges that pass each other: what is not joined after so many rounds in a row is left until all else is cut.
constexpr int most_near_rounds = 2;

/// What is done where rounds do not end, one after the other, each from the beginning. What is within a tolerance that was given
/// stays joined.
enum class Rung : std::uint8_t {
  as_given,
  doubles,  ///< the tolerance is the rounding of doubles, as new points have it, and not of floats
  grid,     ///< the points of what crosses go to a grid
};

/// What crossed in the input, in the words and numbers of the report.
struct CrossingLists {
  detail::RepairList facets, segments_and_facets, segments;
};

class Arranger {
 public:
  Arranger(const Plc<3>& plc, const ArrangementOptions& options)
      : input_(plc), options_(options), bulk_(true, options.stop), stop_(options.stop), state_(plc) {}

  /// False if a Domain refuses the input for another reason than crossings.
  bool run() {
    do {
      stop_();
      refused_.clear();
      domain_.emplace(Domain<3>::without_invalid(state_.plc, refused_, options_.stop));
      if (domain_->points().empty() || (rounds_ == 0 && is_refused_otherwise())) return false;
    } while (cut_once());
    return true;
  }

  bool changed() const { return rounds_ > 0; }
  Plc<3> plc() const { return state_.with_markers_of(input_); }
  Arrangement arrangement() const;
  void report(std::vector<Diagnostic>& repairs);
  [[noreturn]] void refuse() const { throw InputError(refused_.front(), refused_); }

 private:
  /// What a Domain says of crossings is for the rounds.
  bool is_refused_otherwise() const {
    return std::ranges::any_of(
        refused_, [](const Diagnostic& d) { return d.code != Errc::entities_intersect && d.code != Errc::facets_overlap; });
  }

  bool cut_once();
  bool is_endless(std::size_t pairs);
  void climb(std::span<const Piece> pieces);
  std::string words_of_rung() const;
  bool snap(std::span<const Piece> pieces);
  void add_points(std::span<const Point3> points);
  void note_pairs(std::span<const Piece> pieces);
  std::uint32_t input_of(const Piece& piece, std::uint32_t i) const;
  [[noreturn]] void fail(std::span<const Piece> pieces) const;
  std::int64_t number(std::size_t i) const { return static_cast<std::int64_t>(i) + input_.first_index; }

  const Plc<3>& input_;
  const ArrangementOptions& options_;
  const detail::Bulk bulk_;
  const detail::StopCheck stop_;
  detail::CutPlc state_;
  std::optional<Domain<3>> domain_;
  std::vector<Diagnostic> refused_;
  detail::Crossings crossings_;
  CrossingLists lists_;
  std::optional<detail::Grid> grid_;
  Rung rung_ = Rung::as_given;
  int rounds_ = 0;       ///< all of them
  int rounds_here_ = 0;  ///< since the last step
  int near_rounds_ = 0;  ///< the last ones in a row
  std::size_t first_pairs_ = 0, first_points_ = 0;
  double farthest_ = 0;
};

/// One round: where edges pass each other within the tolerance they get a point; else what crosses is cut. False if there is
/// nothing to be done any more.
bool Arranger::cut_once() {
  const auto near = detail::points_at_near_passes(refused_);
  const auto pieces = detail::pieces_of(*domain_, bulk_);
  crossings_ = {};
  if (!domain_->nothing_meets()) crossings_ = detail::find_crossings(*domain_, pieces, bulk_, stop_);
  const std::size_t left = crossings_.pairs.size() + refused_.size();
  if (left == 0) {
    const bool changed = detail::replace_cut(state_, *domain_, {}, options_.markers);
    rounds_ += changed ? 1 : 0;
    return changed;
  }
  note_pairs(pieces);
  ++rounds_;
  ++rounds_here_;
  near_rounds_ = near.empty() ? 0 : near_rounds_ + 1;
  if (is_endless(left)) {
    climb(pieces);
    return true;
  }
  if (grid_ && snap(pieces)) return true;
  if (!near.empty() && near_rounds_ <= most_near_rounds) {
    add_points(near);
    return true;
  }
  near_rounds_ = 0;
  auto cut = detail::cut_triangles(*domain_, pieces, crossings_, bulk_, stop_);
  farthest_ += cut.farthest;
  if (grid_)
    for (Point3& p : cut.added) p = grid_->nearest(p);
  if (!detail::replace_cut(state_, *domain_, cut, options_.markers)) climb(pieces);
  return true;
}

/// Asked once a round.
bool Arranger::is_endless(std::size_t pairs) {
  if (rounds_here_ == 1) first_pairs_ = std::max(pairs, few_pairs);
  if (rounds_here_ == 2) first_points_ = state_.plc.points.size();
  return rounds_here_ > (grid_ ? most_rounds_on_grid : most_rounds) || pairs > most_growth * first_pairs_ ||
         (rounds_here_ > 2 && state_.plc.points.size() > most_growth * first_points_);
}

/// The next way to go, from the beginning. @throws InputError if there is none
void Arranger::climb(std::span<const Piece> pieces) {
  if (rung_ == Rung::grid) fail(pieces);
  const double before = tolerance_of(state_.plc);
  state_ = detail::CutPlc(input_);
  do {
    rung_ = input_.tolerance ? Rung::grid : static_cast<Rung>(static_cast<int>(rung_) + 1);
    if (!input_.tolerance) state_.plc.are_floats = false;
  } while (rung_ != Rung::grid && tolerance_of(state_.plc) == before);
  if (rung_ == Rung::grid) grid_.emplace(input_);
  rounds_here_ = near_rounds_ = 0;
  farthest_ = 0;
}

/// The corners of what still meets.
bool Arranger::snap(std::span<const Piece> pieces) {
  std::vector<Point3> places;
  for (const auto& pair : crossings_.pairs)
    for (const std::uint32_t i : pair)
      for (const std::uint32_t v : pieces[i].points()) places.push_back(domain_->points()[v]);
  for (const Diagnostic& d : refused_)
    for (const auto& p : d.points) places.push_back({p});
  return grid_->snap(state_.plc, places);
}

/// Points of no facet: the next Domain joins them with what is near.
void Arranger::add_points(std::span<const Point3> points) {
  Plc<3>& plc = state_.plc;
  const std::size_t columns = plc.points.empty() ? 0 : plc.point_attributes.size() / plc.points.size();
  plc.points.insert(plc.points.end(), points.begin(), points.end());
  plc.point_attributes.resize(plc.points.size() * columns, 0);
  if (!plc.point_markers.empty()) plc.point_markers.resize(plc.points.size(), 0);
}

/// The facet, or the segment, of the input that a piece is of; no_entity: a point, or an edge drawn inside a facet.
std::uint32_t Arranger::input_of(const Piece& piece, std::uint32_t i) const {
  if (piece.count == 3) {
    const std::uint32_t k = i - domain_->facets()[piece.owner].first_triangle;
    return state_.origins_of(domain_->triangle_origins(piece.owner)[k].facet)[0].facet;
  }
  if (piece.count == 1 || domain_->segment_origins(piece.owner).empty()) return no_entity;
  const SegmentOrigin origin = domain_->segment_origins(piece.owner)[0];
  return origin.is_facet ? state_.origins_of(origin.index)[0].facet : state_.segments[origin.index];
}

/// Of the first round that finds any: what meets later does so by rounding.
void Arranger::note_pairs(std::span<const Piece> pieces) {
  if (lists_.facets.count + lists_.segments_and_facets.count + lists_.segments.count > 0) return;
  std::vector<std::array<std::uint32_t, 3>> noted;  // how many are facets, the lesser first
  for (const auto& [i, j] : crossings_.pairs) {
    const std::uint32_t a = input_of(pieces[j], j), b = input_of(pieces[i], i);  // triangles come first
    if (a == no_entity || b == no_entity) continue;
    const auto facets = static_cast<std::uint32_t>((pieces[i].count == 3) + (pieces[j].count == 3));
    noted.push_back(facets == 1 ? std::array{facets, a, b} : std::array{facets, std::min(a, b), std::max(a, b)});
  }
  std::ranges::sort(noted);
  noted.erase(std::unique(noted.begin(), noted.end()), noted.end());
  for (const auto& [facets, a, b] : noted) {
    detail::RepairList& list = facets == 2 ? lists_.facets : facets == 1 ? lists_.segments_and_facets : lists_.segments;
    const std::string words = std::to_string(number(a)) + (facets == 1 ? " through " : " and ") + std::to_string(number(b));
    list.add([&] { return words; }, {number(a), number(b)});
  }
}

/// One of these, with the first points that are new in its place.
void Arranger::report(std::vector<Diagnostic>& repairs) {
  const std::size_t before = repairs.size();
  const std::string how = ", now cut there (" + std::to_string(rounds_) + (rounds_ == 1 ? " round" : " rounds") +
                          ", points rounded by up to " + detail::to_text(farthest_) + ")";
  const std::string& file = input_.source.file;
  lists_.facets.report(Errc::entities_intersect, "facets that cross" + how, file, repairs);
  lists_.segments_and_facets.report(Errc::entities_intersect, "segments through facets" + how, file, repairs);
  lists_.segments.report(Errc::entities_intersect, "segments that cross" + how, file, repairs);
  if (repairs.size() == before)
    repairs.push_back({Errc::entities_intersect, "edges that pass each other within the tolerance" + how, file, 0, {}, {}});
  for (std::size_t i = input_.points.size(); i < state_.plc.points.size(); ++i)
    repairs[before].points.push_back(state_.plc.points[i].x);
  if (rung_ != Rung::as_given) repairs.push_back({Errc::near_points, words_of_rung(), file, 0, {}, {}});
}

std::string Arranger::words_of_rung() const {
  if (grid_)
    return "rounds did not end: points of what still crossed were moved to a grid, by up to " +
           detail::to_text(grid_->farthest());
  return "rounds did not end with a tolerance of " + detail::to_text(tolerance_of(input_)) + ": it is " +
         detail::to_text(tolerance_of(state_.plc)) + " now";
}

/// With the pairs that are left, the first of them first.
void Arranger::fail(std::span<const Piece> pieces) const {
  std::vector<Diagnostic> all;
  const std::string left = std::to_string(crossings_.pairs.size() + refused_.size()) + " crossings are left after " +
                           std::to_string(rounds_) + " rounds of resolving them";
  for (const auto& [i, j] : crossings_.pairs) {
    if (all.size() == detail::max_listed) break;
    Diagnostic d{Errc::entities_intersect, left, input_.source.file, 0, {}, {}};
    for (const std::uint32_t k : {i, j})
      if (const std::uint32_t f = input_of(pieces[k], k); f != no_entity) d.ids.push_back(number(f));
    for (const Point3& p :
         detail::contact_points<3>(domain_->points(), detail::contact<3>(domain_->points(), pieces[i], pieces[j])))
      d.points.push_back(p.x);
    if (d.ids.size() == 2 && pieces[i].count == 3 && pieces[j].count == 3)
      d.message += "; facets " + std::to_string(d.ids[0]) + " and " + std::to_string(d.ids[1]) + " are among them";
    all.push_back(std::move(d));
  }
  all.insert(all.end(), refused_.begin(), refused_.end());
  Diagnostic first = all.front();
  throw InputError(std::move(first), std::move(all));
}

Arrangement Arranger::arrangement() const {
  Arrangement out;
  const Domain<3>& domain = *domain_;
  out.tolerance = tolerance_of(state_.plc);
  out.segments = state_.plc.segments;
  out.segment_lines = state_.plc.source.segment_lines;
  out.points = state_.plc.points;
  for (std::size_t i = 0; i < out.points.size(); ++i) out.points[i] = domain.points()[domain.point_of_input()[i]];
  out.point_attributes = state_.plc.point_attributes;
  const std::size_t columns = domain.attributes_per_point();
  for (std::uint32_t v = 0; v < domain.points().size(); ++v) {
    if (domain.input_of_point()[v] < state_.plc.points.size()) continue;
    out.points.push_back(domain.points()[v]);
    const auto row = domain.point_attributes().subspan(v * columns, columns);
    out.point_attributes.insert(out.point_attributes.end(), row.begin(), row.end());
  }
  const detail::PieceOrigins origins(state_, domain, options_.markers);
  out.origins_begin.push_back(0);
  const auto name = [&](std::uint32_t v) { return domain.input_of_point()[v]; };
  for (EntityId f = 0; f < domain.facets().size(); ++f)
    for (std::uint32_t k = 0; k < domain.facets()[f].triangle_count; ++k) {
      const auto& t = domain.triangles(f)[k];
      out.triangles.push_back({name(t[0]), name(t[1]), name(t[2])});
      const auto of = origins.of(f, k);
      out.origins.insert(out.origins.end(), of.begin(), of.end());
      out.origins_begin.push_back(static_cast<std::uint32_t>(out.origins.size()));
    }
  return out;
}

}  // namespace

Arrangement arrange(const Plc<3>& plc, std::vector<Diagnostic>& repairs, const ArrangementOptions& options) {
  Arranger arranger(plc, options);
  if (!arranger.run()) arranger.refuse();
  if (arranger.changed()) arranger.report(repairs);
  return arranger.arrangement();
}

Plc<3> resolve_crossings(const Plc<3>& plc, std::vector<Diagnostic>& repairs, const ArrangementOptions& options) {
  Arranger arranger(plc, options);
  if (!arranger.run() || !arranger.changed()) return plc;
  arranger.report(repairs);
  return arranger.plc();
}

}  // namespace pgdr
