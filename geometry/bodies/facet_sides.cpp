// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "bodies/facet_sides.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "bodies/body_chains.hpp"
#include "input/words.hpp"
#include "pgdr/error.hpp"

namespace pgdr::detail {

void FacetSides::add(std::uint32_t piece, std::uint32_t facet, std::uint32_t body, bool reversed) {
  const auto& t = pieces_.triangles[piece];
  for (std::size_t k = 0; k < 3; ++k) {
    const std::uint32_t a = t[k], b = t[(k + 1) % 3];
    edges_.push_back({body, std::min(a, b), std::max(a, b), facet, (a < b) != reversed});
  }
}

std::uint32_t FacetSides::find(std::uint32_t facet, bool& differs) {
  std::uint32_t root = facet;
  differs = false;
  for (; links_[root].up != root; root = links_[root].up) differs ^= links_[root].differs;
  bool left = differs;
  while (facet != root) {
    Link& link = links_[facet];
    facet = std::exchange(link.up, root);
    left ^= std::exchange(link.differs, left);
  }
  return root;
}

void FacetSides::unite(const AtEdge& x, const AtEdge& y) {
  bool x_differs, y_differs;
  const std::uint32_t f = find(x.facet, x_differs), g = find(y.facet, y_differs);
  const bool differ = x.forward == y.forward;
  if (f != g)
    links_[std::max(f, g)] = {std::min(f, g), (x_differs != y_differs) != differ};
  else if ((x_differs != y_differs) != differ)
    fail(x, y);
}

void FacetSides::fail(const AtEdge& x, const AtEdge& y) const {
  const Point<3>&a = pieces_.points[x.a], &b = pieces_.points[x.b];
  const std::uint32_t first = plc_.first_index;
  Diagnostic what{
      Errc::not_orientable,
      "body " + body_name(plc_, x.body) +
          " has but one side, as a Moebius strip: going round it, one comes back to the other side of the edge from " +
          to_text<3>(a) + " to " + to_text<3>(b) +
          "; --regions all takes every volume that facets enclose, whatever bodies they are of",
      plc_.source.file,
      x.facet < plc_.source.facet_lines.size() ? plc_.source.facet_lines[x.facet] : 0,
      {x.facet + first, y.facet + first},
      {a.x, b.x}};
  throw InputError(std::move(what));
}

bool FacetSides::has_lesser_corners(std::uint32_t f, std::uint32_t g) const {
  const auto corners = [&](std::uint32_t i) {
    std::vector<std::array<double, 3>> points;
    for (const std::uint32_t v : plc_.facets[i].polygons[0]) points.push_back(plc_.points[v].x);
    std::ranges::sort(points);
    return points;
  };
  return corners(f) < corners(g);
}

std::vector<std::uint32_t> FacetSides::minority(const Bulk& bulk) {
  bulk.sort(edges_, std::less<>());
  links_.resize(plc_.facets.size());
  for (std::uint32_t f = 0; f < links_.size(); ++f) links_[f] = {f, false};
  for (std::size_t i = 0, j = 0; i < edges_.size(); i = j) {
    for (j = i + 1;
         j < edges_.size() && edges_[j].body == edges_[i].body && edges_[j].a == edges_[i].a && edges_[j].b == edges_[i].b;)
      ++j;
    if (j == i + 2 && edges_[i].facet != edges_[i + 1].facet) unite(edges_[i], edges_[i + 1]);
  }
  struct Group {
    std::uint32_t same = 0, other = 0, least = no_entity;
    bool least_differs = false;
    bool turns_other() const { return other < same || (other == same && !least_differs); }
  };
  std::vector<Group> groups(links_.size());
  bool differs;
  for (std::uint32_t f = 0; f < links_.size(); ++f) {
    Group& g = groups[find(f, differs)];
    ++(differs ? g.other : g.same);
  }
  for (std::uint32_t f = 0; f < links_.size(); ++f) {
    Group& g = groups[find(f, differs)];
    if (g.other != g.same || (g.least != no_entity && !has_lesser_corners(f, g.least))) continue;
    g.least = f;
    g.least_differs = differs;
  }
  std::vector<std::uint32_t> found;
  for (std::uint32_t f = 0; f < links_.size(); ++f) {
    const Group& g = groups[find(f, differs)];
    if (g.other > 0 && differs == g.turns_other()) found.push_back(f);
  }
  return found;
}

}  // namespace pgdr::detail
