// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "cures.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <limits>
#include <optional>
#include <utility>

#include "ailments.hpp"
#include "deadline.hpp"
#include "proposal.hpp"
#include "text.hpp"

namespace pgdr::tool {
namespace {

std::string words(const std::array<double, 3>& p) { return "(" + digits(p[0]) + ", " + digits(p[1]) + ", " + digits(p[2]) + ")"; }

/// Does the diagnosis accept the input, and are its bodies told, with this done to it as the command does it?
template <int D>
bool is_accepted(Plc<D> plc, const Treatment& how, const std::stop_token& stop) {
  if (stop.stop_requested()) return false;
  try {
    std::vector<Diagnostic> ignored;
    plc = treated<D>(std::move(plc), how, ignored, stop);
    if constexpr (D == 3)
      if (how.bodies)
        plc = with_bodies(plc, *how.bodies, {how.resolve_crossings, how.markers.value_or(SharedMarker::smallest), stop}).plc;
    return diagnose(plc, {.most_listed = 0, .errors_only = true, .stop = stop}).error_count() == 0;
  } catch (const std::exception&) {
    return false;
  }
}

template <int D>
class CureSearch {
 public:
  CureSearch(const Plc<D>& given, const Treatment& done, const Diagnosis<D>& diagnosis, std::stop_token stop)
      : given_(given), done_(done), diagnosis_(diagnosis), stop_(std::move(stop)) {}

  std::vector<Cure> run() {
    try {
      if constexpr (D == 2)
        try_flags_of_plane();
      else
        try_flags_of_space();
      for (const bool coarse : {false, true})
        if (diagnosis_[Finding::open_boundary].count > 0) try_to_weld(coarse);
      if (const auto tolerance = are_found_ ? std::nullopt : tolerance_for_refused(given_, done_, stop_))
        add({"rounded to its last digit", "--tolerance " + digits(*tolerance),
             "--tolerance " + digits(*tolerance) + std::string(what_tolerance_does)});
    } catch (const std::exception&) {  // the refusal says enough
    }
    return std::move(cures_);
  }

 private:
  bool is_valid(const Treatment& how, std::optional<double> tolerance = {}, bool is_coarse = false) const {
    Plc<D> plc = given_;
    if (tolerance) plc.tolerance = tolerance;
    plc.is_coarse = plc.is_coarse || is_coarse;
    return is_accepted<D>(std::move(plc), how, stop_);
  }

  void add(Cure cure) { cures_.push_back(std::move(cure)); }

  Treatment with(bool close, bool resolve) const {
    Treatment how = done_;
    how.close_openings = how.close_openings || close;
    how.resolve_crossings = how.resolve_crossings || resolve;
    return how;
  }

  /// Of points alone, in space.
  void try_hull() requires(D == 3) {
    Treatment hull = done_;
    hull.convex_hull = true;
    if (is_valid(hull))
      add({"points alone", "--convex-hull", "--convex-hull makes it valid: the convex hull of all points is meshed then"});
  }

  void try_flags_of_plane() {
    const bool crosses = diagnosis_[Finding::segments_cross].count > 0 && !done_.resolve_crossings;
    const bool is_open = diagnosis_[Finding::encloses_nothing].count > 0;
    Treatment hull = done_, both = with(false, true);
    hull.convex_hull = both.convex_hull = true;
    const std::string cross = count(diagnosis_[Finding::segments_cross].count, "pair of segments crosses",
                                    "pairs of segments cross");
    if (is_open && is_valid(hull))
      return add({"open", "--convex-hull", "--convex-hull makes it valid: the convex hull of all points is meshed then"});
    if (crosses && is_valid(with(false, true)))
      return add({cross, "--resolve-crossings", "--resolve-crossings makes it valid: segments are split then where they cross"});
    if (crosses && is_valid(both))
      add({cross + ", and it is open", "--resolve-crossings --convex-hull",
           "--resolve-crossings with --convex-hull makes it valid: segments are split where they cross, and the convex hull of "
           "all "
           "points is meshed"});
  }

  /// Is anything wrong that cutting could cure?
  bool is_crossed() const {
    std::uint64_t crossings = 0;
    for (const Finding kind : {Finding::facets_cross, Finding::facets_overlap, Finding::segment_crosses_facet,
                               Finding::segments_cross, Finding::point_on_facet, Finding::point_on_segment})
      crossings += diagnosis_[kind].count;
    return crossings + diagnosis_[Finding::invalid_entity].count > 0;
  }
  /// And anything that it could not?
  bool has_other_than_crossings() const {
    return std::ranges::any_of(diagnosis_[Finding::invalid_entity].listed, [](const FindingList::Item& item) {
      return item.what.code != Errc::entities_intersect && item.what.code != Errc::facets_overlap;
    });
  }

  void try_flags_of_space() requires(D == 3) {
    if (has_other_than_crossings()) return;
    const bool is_crossed = this->is_crossed(), cuts = is_crossed && !done_.resolve_crossings, closes = !done_.close_openings;
    const bool is_open = diagnosis_[Finding::open_boundary].count + diagnosis_[Finding::encloses_nothing].count > 0;
    if (given_.facets.empty()) return try_hull();
    if (cuts && is_valid(with(false, true))) add_cutting();
    if (is_crossed) try_points();
    if (is_open) try_to_weld(false);
    if (are_found_ || !is_open || !closes) return;
    if (!is_crossed && is_valid(with(true, false))) add_closing({}, {});
    if (cuts && is_valid(with(true, true))) add_closing(words_of_meetings(diagnosis_) + ", and it is ", " --resolve-crossings");
  }

  void add_cutting() requires(D == 3) {
    Cure cure{words_of_meetings(diagnosis_), "--resolve-crossings",
              "--resolve-crossings makes it valid: facets are cut along each other then where they cross"};
    std::vector<Diagnostic> ignored;
    const auto bodies = done_.bodies ? std::nullopt
                                     : overlapping_bodies(treated<3>(given_, done_, ignored, stop_), diagnosis_, stop_);
    if (bodies) {
      Treatment united = with(false, true);
      united.bodies = BodyMode::united;
      cure.ailment = std::to_string(bodies->count) + " closed bodies that overlap";
      if (is_valid(united)) {
        cure.flags += " --regions union";
        cure.words += "; with --regions union the bodies are one solid, with --regions fragments each cell says whose it is";
      }
    }
    add(std::move(cure));
  }

  void add_closing(const std::string& before, const std::string& flags) requires(D == 3) {
    std::vector<Diagnostic> closed;
    treated<3>(given_, with(true, !flags.empty()), closed, stop_);
    std::uint64_t loops = 0;
    for (const Diagnostic& d : closed) loops += d.code == Errc::open_boundary;
    are_found_ = true;
    add({before + "open, with " + count(loops, "opening that lies in a plane", "openings that lie in planes"),
         "--close-planar-openings" + flags,
         "--close-planar-openings" + (flags.empty() ? "" : " with" + flags) +
             " makes it valid: openings whose loops lie in a plane are closed then, by facets with markers of their own"});
  }

  /// A point of the file that lies on edges becomes one of all of them.
  void try_points() requires(D == 3) {
    constexpr std::size_t most_said = 5, all_of_them = std::numeric_limits<std::size_t>::max();
    const Diagnosis<3> all = diagnose(given_, {.most_listed = all_of_them, .errors_only = true, .stop = stop_});
    Plc<3> other = given_;
    const auto places = places_where_edges_cross(all, tolerance_of(given_));
    if (places.empty()) return;
    for (const auto& [x, y, z] : places) other.points.push_back({x, y, z});
    if (!other.point_markers.empty()) other.point_markers.resize(other.points.size());
    other.point_attributes.clear();
    if (!is_accepted<3>(other, done_, stop_)) return;
    std::string where;
    std::size_t said = 0;
    for (const auto& p : places)
      if (said++ < most_said) where += (said > 1 ? ", " : "") + words(p);
    if (said > most_said) where += " and " + std::to_string(said - most_said) + " more places";
    are_found_ = true;
    add({"edges cross where neither has a point", "",
         "edges cross where neither has a point: to add " + std::string(said == 1 ? "a point" : "points") + " at " + where +
             " to the input makes it valid"});
  }

  /// Corners that were meant to be one are much nearer to each other than others are: a tolerance between the two joins them.
  /// What crosses besides is cut.
  void try_to_weld(bool coarse) {
    constexpr double jump = 4;
    constexpr std::array<double, 3> factors{1.5, 3, 6};  // corners of one place are farther from each other than from the nearest
    if (given_.tolerance || are_found_ || std::exchange(has_welded_[coarse ? 1 : 0], true)) return;
    std::vector<double> gaps = gaps_of_open_boundaries(given_, stop_);
    if (!coarse && !gaps.empty()) gaps.push_back(std::numeric_limits<double>::infinity());  // all of them may be seams
    for (std::size_t i = gaps.size(), tried = 0; i-- > 1 && tried < 3;) {
      if (!(gaps[i] > jump * gaps[i - 1])) continue;
      ++tried;
      for (const double factor : factors) {
        const double rough = factor * gaps[i - 1], power = std::pow(10.0, std::floor(std::log10(rough)));
        const double tolerance = std::ceil(rough / power) * power;
        for (const bool cuts : {false, true})
          if ((!cuts || (D == 3 && !done_.resolve_crossings)) && is_valid(with(false, cuts), tolerance, coarse))
            return add_weld(gaps[i - 1], tolerance, coarse, cuts);
      }
    }
  }
  void add_weld(double gap, double tolerance, bool coarse, bool cuts) {
    const std::string flag = "--tolerance " + format("%.2g", tolerance) + (coarse ? " --yes-coarse" : "");
    are_found_ = true;
    add({"not welded, gaps up to " + format("%.2g", gap), flag + (cuts ? " --resolve-crossings" : ""),
         "the surface is not welded: corners that were meant to be one are up to " + format("%.2g", gap) + " apart; " + flag +
             " joins them, and makes it valid" + (cuts ? ", with --resolve-crossings" : "")});
  }

  const Plc<D>& given_;
  const Treatment& done_;
  const Diagnosis<D>& diagnosis_;
  std::stop_token stop_;
  std::vector<Cure> cures_;
  bool are_found_ = false;
  std::array<bool, 2> has_welded_{};  // tried
};

}  // namespace

template <int D>
std::string words_of_bodies(const Plc<D>& plc, const Diagnosis<D>& diagnosis, const std::stop_token& stop) {
  if constexpr (D == 3) {
    try {
      if (const auto bodies = overlapping_bodies(plc, diagnosis, stop))
        return std::to_string(bodies->count) + " closed bodies that overlap: " +
               count(bodies->crossings, "pair of their facets intersects", "pairs of their facets intersect") +
               ", the first: " + bodies->first;
    } catch (const CancelledError&) {  // the pairs say it one by one
    }
  }
  return {};
}

template <int D>
std::vector<Cure> cures_of(const Plc<D>& given, const Treatment& done, const Diagnosis<D>& diagnosis,
                           const std::stop_token& stop) {
  const Deadline deadline(longest_search, stop);
  return CureSearch<D>(given, done, diagnosis, deadline.token()).run();
}

std::optional<Cure> cure_of_bodies(const Plc<3>& given, const Treatment& done, Errc code, const std::stop_token& stop) {
  const Deadline deadline(longest_search, stop);
  Treatment other = done;
  if (code == Errc::bodies_overlap) {
    other.bodies = BodyMode::fragments;
    if (is_accepted<3>(given, other, deadline.token()))
      return Cure{
          "bodies that overlap", "--regions fragments",
          "--regions fragments gives what several bodies have in common a label of its own, --regions priority gives it to the "
          "first of them, --regions union makes one solid of them"};
  }
  other.bodies = std::nullopt;
  if (code == Errc::not_orientable && is_accepted<3>(given, other, deadline.token()))
    return Cure{"a body whose facets have no two sides", "--regions all",
                "--regions all takes every enclosed volume for a region, whatever the facets mean"};
  return std::nullopt;
}

#define PGDR_INSTANTIATE(D)                                                                            \
  template std::string words_of_bodies<D>(const Plc<D>&, const Diagnosis<D>&, const std::stop_token&); \
  template std::vector<Cure> cures_of<D>(const Plc<D>&, const Treatment&, const Diagnosis<D>&, const std::stop_token&);
PGDR_INSTANTIATE(2)
PGDR_INSTANTIATE(3)
#undef PGDR_INSTANTIATE

}  // namespace pgdr::tool
