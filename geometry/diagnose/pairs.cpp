// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Diagnosis: facets, segments of no facet, and points that meet where they have no corner in common. A box tree finds the
// pairs to look at; pairs of triangles are told as pairs of input facets, touching ones by the point that lies on the
// other alone.
#include <algorithm>

#include "diagnose/diagnoser.hpp"
#include "diagnose/near_pieces.hpp"
#include "input/words.hpp"
#include "space/make_set.hpp"
#include "space/piece_pairs.hpp"

namespace pgdr::detail {

template <int D>
void Diagnoser<D>::find_meetings() {
  if (domain_.nothing_meets()) return;
  auto parts = look_at_pairs<Meetings, D>(pieces_, p_, 0, bulk_, stop_check_,
                                          [this](std::uint32_t i, std::uint32_t j, Meetings& found) { note(i, j, found); });
  report_meetings(joined(parts, &Meetings::facet_facet), 3, 3);
  report_meetings(joined(parts, &Meetings::segment_facet), 2, 3);
  report_meetings(joined(parts, &Meetings::segment_segment), 2, 2);
  report_resting(joined(parts, &Meetings::resting));
}

/// Input facet of a triangle, domain segment of a segment.
template <int D>
std::uint32_t Diagnoser<D>::owner(std::uint32_t piece) const {
  return piece < triangles_.size() ? triangles_[piece].origin.facet : pieces_[piece].owner;
}

template <int D>
void Diagnoser<D>::note(std::uint32_t i, std::uint32_t j, Meetings& found) const {
  bool same_plane = false;
  if (j < triangles_.size()) {
    const Triangle &s = triangles_[i], &t = triangles_[j];
    if (s.origin.facet == t.origin.facet && !s.origin.mixed) return;  // of one planar triangulation
    same_plane = s.facet == t.facet && domain_.facets()[s.facet].planar;
  }
  const Contact c = contact<D>(p_, pieces_[i], pieces_[j], same_plane);
  if (c.kind == Contact::Kind::none) return;
  for (const Contact::Corner& corner : c.corners) found.resting.push_back(resting(corner, corner.of_second ? i : j));
  if (c.kind == Contact::Kind::touch) return;
  std::uint32_t a = i, b = j;  // triangles come first; segments are named before facets
  if (pieces_[a].count > pieces_[b].count) std::swap(a, b);
  if (pieces_[a].count == pieces_[b].count && owner(a) > owner(b)) std::swap(a, b);
  auto& meetings = pieces_[a].count == 3   ? found.facet_facet
                   : pieces_[b].count == 3 ? found.segment_facet
                                           : found.segment_segment;
  meetings.push_back({owner(a), owner(b), {a, b}, c.kind == Contact::Kind::overlap});
}

// On an edge: unless it is a diagonal inside of one input facet, which the input does not have.
template <int D>
auto Diagnoser<D>::resting(const Contact::Corner& corner, std::uint32_t on_piece) const -> Resting {
  bool on_edge = corner.edge[0] != no_entity;
  if (on_edge && on_piece < triangles_.size() && segment_between(domain_, corner.edge[0], corner.edge[1]) == no_entity) {
    const EdgeUse wanted{key(corner.edge[0], corner.edge[1]), 0};
    const auto at = std::lower_bound(uses_.begin(), uses_.end(), wanted);
    const auto uses = uses_at(static_cast<std::size_t>(at - uses_.begin()));
    on_edge = std::any_of(uses.begin(), uses.end(),
                          [&](const EdgeUse& u) { return triangles_[u.triangle].origin.facet != owner(on_piece); });
  }
  if (!on_edge) return {corner.point, owner(on_piece), no_entity};
  return {corner.point, std::min(corner.edge[0], corner.edge[1]), std::max(corner.edge[0], corner.edge[1])};
}

template <int D>
void Diagnoser<D>::report_meetings(std::vector<Meeting> meetings, std::size_t first_corners, std::size_t second_corners) {
  std::sort(meetings.begin(), meetings.end());
  for (std::size_t begin = 0, end; begin < meetings.size(); begin = end) {
    bool overlap = false;
    for (end = begin;
         end < meetings.size() && meetings[end].first == meetings[begin].first && meetings[end].second == meetings[begin].second;
         ++end)
      overlap = overlap || meetings[end].overlap;
    const Finding kind = overlap               ? Finding::facets_overlap
                         : first_corners == 3  ? Finding::facets_cross
                         : second_corners == 3 ? Finding::segment_crosses_facet
                                               : Finding::segments_cross;
    ++out_[kind].count;
    if (wants_more(kind)) list_meeting(std::span(meetings).subspan(begin, end - begin), first_corners, second_corners, kind);
  }
}

template <int D>
void Diagnoser<D>::list_meeting(std::span<const Meeting> same, std::size_t first_corners, std::size_t second_corners,
                                Finding kind) {
  std::vector<Point<D>> where;
  for (const Meeting& m : same) {
    const auto more = contact_points<D>(p_, contact<D>(p_, pieces_[m.pieces[0]], pieces_[m.pieces[1]]));
    where.insert(where.end(), more.begin(), more.end());
  }
  std::sort(where.begin(), where.end(), lex_less<D>);
  where.erase(std::unique(where.begin(), where.end()), where.end());
  // Points of one line: in lexicographic order the first and the last are its ends.
  if (kind != Finding::facets_overlap && where.size() > 2) where = {where.front(), where.back()};
  if (where.size() > max_listed) where.resize(max_listed);

  const std::uint32_t a = same[0].first, b = same[0].second;
  const auto name_of = [&](std::uint32_t e, std::size_t corners) {
    return corners == 3 ? "facet " + facet_words(e) : segment_words(e);
  };
  std::string message = first_corners == 3 ? "facets " + facet_words(a) + " and " + facet_words(b)
                                           : name_of(a, 2) + " and " + name_of(b, second_corners);
  message += kind == Finding::facets_overlap ? " lie in one plane and overlap" : first_corners == 3 ? " intersect" : " cross";
  if (where.size() == 1) message += " at " + to_text(where[0]);
  if (where.size() > 1)
    message += (where.size() == 2 ? " from " : ", between ") + to_text(where.front()) + (where.size() == 2 ? " to " : " and ") +
               to_text(where.back());
  Ids ids;
  for (const auto& [e, corners] : {std::pair{a, first_corners}, {b, second_corners}}) {
    if (corners == 3)
      ids.push_back(number(e));
    else
      for (const std::uint32_t v : domain_.segments()[e].points) ids.push_back(point_number(v));
  }
  list(kind, kind == Finding::facets_overlap ? Errc::facets_overlap : Errc::entities_intersect, std::move(message),
       first_corners == 3 ? facet_place(a) : segment_place(a), std::move(ids), where);
}

template <int D>
void Diagnoser<D>::report_resting(std::vector<Resting> resting) {
  make_set(resting);
  for (const Resting& r : resting) {
    const Finding kind = r.second == no_entity ? Finding::point_on_facet : Finding::point_on_segment;
    ++out_[kind].count;
    if (wants_more(kind)) list_resting(r);
  }
}

template <int D>
void Diagnoser<D>::list_resting(const Resting& r) {
  const std::string words = "point " + point_words(r.point) + " lies inside ";
  if (r.second == no_entity)
    list(Finding::point_on_facet, Errc::point_on_facet, words + "facet " + facet_words(r.first), point_place(r.point),
         {point_number(r.point), number(r.first)}, {p_[r.point]});
  else
    list(Finding::point_on_segment, Errc::point_on_segment, words + "the edge " + edge_words({r.first, r.second}),
         point_place(r.point), {point_number(r.point), point_number(r.first), point_number(r.second)}, {p_[r.point]});
}

template void Diagnoser<2>::find_meetings();
template void Diagnoser<3>::find_meetings();

}  // namespace pgdr::detail
