// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Diagnosis: small angles of the input, counted exactly, ordered by the sine in doubles. Segments and facets at a point,
// facets at a segment. At a point where very many segments meet (fans of thousands) only the first are compared.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <mutex>
#include <numbers>

#include "diagnose/diagnoser.hpp"
#include "numbers/dihedral_sign.hpp"
#include "numbers/vectors.hpp"
#include "pgdr/predicates.hpp"
#include "space/sort_by_points.hpp"
#include "space/triangle.hpp"

namespace pgdr::detail {
namespace {

constexpr std::size_t most_at_a_point = 2000;

template <int D>
Vector<3> direction(const Point<D>& from, const Point<D>& to) {
  Vector<3> v{};
  for (std::size_t i = 0; i < D; ++i) v[i] = to.x[i] - from.x[i];
  return v;
}

double ratio(double a, double b) {
  const double q = a / b;
  return q >= 0 && q < 1 ? q : 1;  // also where products under- or overflow
}

double sine2(const Vector<3>& u, const Vector<3>& w) {
  const Vector<3> n = cross(u, w);
  return ratio(dot(n, n), dot(u, u) * dot(w, w));
}

// Between r and the nearest direction of the corner from b to c; `near_b`: r and b make less than a right angle.
double sine2_to_corner(const Vector<3>& r, const Vector<3>& b, const Vector<3>& c, bool near_b, bool near_c) {
  double least = 1;
  if (near_b) least = std::min(least, sine2(r, b));
  if (near_c) least = std::min(least, sine2(r, c));
  const Vector<3> n = cross(b, c);
  if (dot(cross(n, b), r) > 0 && dot(cross(c, n), r) > 0) {
    const double height = dot(n, r);
    least = std::min(least, ratio(height * height, dot(n, n) * dot(r, r)));
  }
  return least;
}

double degrees(double sine2) { return std::asin(std::sqrt(sine2)) * (180 / std::numbers::pi); }

std::string in_words(double angle) {
  char text[40];
  return {text, std::to_chars(text, text + sizeof text, angle, std::chars_format::general, 6).ptr};
}

}  // namespace

template <int D>
void Diagnoser<D>::find_angles() {
  segments_at_points();
  if constexpr (D == 3) corners_at_points();
  Angles all(options_.most_listed);
  std::mutex mutex;
  bulk_.blocks(p_.size(), [&](std::size_t first, std::size_t last) {
    Angles found(options_.most_listed);
    for (std::size_t v = first; v < last; ++v) {
      stop_check_();
      note_segment_angles(static_cast<std::uint32_t>(v), found);
      if constexpr (D == 3) note_facet_angles(static_cast<std::uint32_t>(v), found);
    }
    const std::lock_guard lock(mutex);  // in any order: the least of all are the least of all
    all.below_60.add(found.below_60);
    all.segment_facet_90.add(found.segment_facet_90);
  });
  stop_check_();
  if constexpr (D == 3) facets_at_segments(all);
  report_angles(all);
}

template <int D>
void Diagnoser<D>::segments_at_points() {
  const auto segments = domain_.segments();
  const auto ends = [&](std::uint32_t s) { return segments[s].points; };
  detail::sort_by_points(p_.size(), segments.size(), ends, segment_begin_, segment_at_);
}

template <int D>
void Diagnoser<D>::corners_at_points() requires(D == 3) {
  const auto corner = [&](std::uint32_t k) { return std::array{triangles_[k / 3].corners[k % 3]}; };
  detail::sort_by_points(p_.size(), 3 * triangles_.size(), corner, corner_begin_, corner_at_);
}

template <int D>
void Diagnoser<D>::note_segment_angles(std::uint32_t v, Angles& found) const {
  const auto here = std::span(segment_at_).subspan(segment_begin_[v], segment_begin_[v + 1] - segment_begin_[v]);
  const std::size_t n = std::min(here.size(), most_at_a_point);
  const auto far_end = [&](EntityId s) {
    const auto& ends = domain_.segments()[s].points;
    return ends[0] == v ? ends[1] : ends[0];
  };
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = i + 1; j < n; ++j) {
      const auto [a, b] = std::minmax({far_end(here[i]), far_end(here[j])});
      if (angle_below_60<D>(p_[v], p_[a], p_[b]))
        found.below_60.add({sine2(direction<D>(p_[v], p_[a]), direction<D>(p_[v], p_[b])), {v, a, b, 0}});
    }
}

// The corners at a point are in the order of their facets.
template <int D>
void Diagnoser<D>::note_facet_angles(std::uint32_t v, Angles& found) const requires(D == 3) {
  const auto segments = std::span(segment_at_).subspan(segment_begin_[v], segment_begin_[v + 1] - segment_begin_[v]);
  const auto corners = std::span(corner_at_).subspan(corner_begin_[v], corner_begin_[v + 1] - corner_begin_[v]);
  for (const EntityId s : segments.first(std::min(segments.size(), most_at_a_point))) {
    const auto& ends = domain_.segments()[s].points;
    const std::uint32_t end = ends[0] == v ? ends[1] : ends[0];
    const auto own = domain_.facets_of_segment(s);
    const Vector<3> r = direction<D>(p_[v], p_[end]);
    for (std::size_t k = 0, next; k < corners.size() && k < most_at_a_point; k = next) {
      const EntityId f = triangles_[corners[k] / 3].facet;
      Angle least{2, {v, end, 0, 0}};
      const bool part = std::find(own.begin(), own.end(), f) != own.end();
      for (next = k; next < corners.size() && triangles_[corners[next] / 3].facet == f; ++next) {
        if (part) continue;
        const Triangle& t = triangles_[corners[next] / 3];
        const std::uint32_t i = corners[next] % 3, b = t.corners[(i + 1) % 3], c = t.corners[(i + 2) % 3];
        const bool near_b = angle_below_90<D>(p_[v], p_[end], p_[b]), near_c = angle_below_90<D>(p_[v], p_[end], p_[c]);
        if (!near_b && !near_c) continue;
        const double sine2 = sine2_to_corner(r, direction<D>(p_[v], p_[b]), direction<D>(p_[v], p_[c]), near_b, near_c);
        if (sine2 < least.sine2) least = {sine2, {v, end, t.origin.facet, 0}};
      }
      if (least.sine2 <= 1) found.segment_facet_90.add(least);
    }
  }
}

template <int D>
void Diagnoser<D>::facets_at_segments(Angles& found) const requires(D == 3) {
  for (std::size_t begin = 0, n; begin < uses_.size(); begin += n) {
    const auto uses = uses_at(begin);
    n = uses.size();
    const auto [a, b] = uses[0].edge();
    const auto apex = [&, a = a, b = b](const EdgeUse& use) {
      const auto& t = triangles_[use.triangle].corners;
      return corner_beside(t, a, b);
    };
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = i + 1; j < n; ++j) {
        const Triangle &s = triangles_[uses[i].triangle], &t = triangles_[uses[j].triangle];
        if (s.facet == t.facet) continue;
        const std::uint32_t c = apex(uses[i]), d = apex(uses[j]);
        if (dihedral_sign(p_[a], p_[b], p_[c], p_[d]) != Sign::positive) continue;
        const Vector<3> e = direction<D>(p_[a], p_[b]);
        const Vector<3> u = cross(e, direction<D>(p_[a], p_[c])), w = cross(e, direction<D>(p_[a], p_[d]));
        const auto [f, g] = std::minmax(s.origin.facet, t.origin.facet);
        found.facets_90.add({sine2(u, w), {a, b, f, g}});
      }
  }
}

template <int D>
void Diagnoser<D>::report_angles(const Angles& found) {
  using At = std::array<std::uint32_t, 4>;
  struct Account {
    std::string words;
    PlcSource::Place place;
    Ids ids;
    std::vector<Point<D>> where;
  };
  const auto report = [this](Finding kind, const Least<Angle>& least, auto account) {
    out_[kind].count = least.count();
    for (const auto& [s2, at] : least.kept()) {
      const double angle = degrees(s2);
      Account a = account(at, in_words(angle) + " degrees");
      list(kind, Errc::small_angle, std::move(a.words), std::move(a.place), std::move(a.ids), a.where, angle);
    }
  };
  report(Finding::segments_below_60, found.below_60, [this](const At& at, const std::string& angle) -> Account {
    return {"the segments from point " + point_words(at[0]) + " to points " + point_words(at[1]) + " and " + point_words(at[2]) +
                " meet at " + angle,
            point_place(at[0]),
            {point_number(at[0]), point_number(at[1]), point_number(at[2])},
            {p_[at[0]]}};
  });
  report(Finding::segment_facet_below_90, found.segment_facet_90, [this](const At& at, const std::string& angle) -> Account {
    return {"the segment from point " + point_words(at[0]) + " to " + point_words(at[1]) + " meets facet " + facet_words(at[2]) +
                " at " + angle,
            facet_place(at[2]),
            {point_number(at[0]), point_number(at[1]), number(at[2])},
            {p_[at[0]]}};
  });
  report(Finding::facets_below_90, found.facets_90, [this](const At& at, const std::string& angle) -> Account {
    return {"facets " + facet_words(at[2]) + " and " + facet_words(at[3]) + " meet at " + angle + " at the edge " +
                edge_words({at[0], at[1]}),
            facet_place(at[2]),
            {number(at[2]), number(at[3]), point_number(at[0]), point_number(at[1])},
            {p_[at[0]], p_[at[1]]}};
  });
}

template void Diagnoser<2>::find_angles();
template void Diagnoser<3>::find_angles();

}  // namespace pgdr::detail
