// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Flat groups become polygons. Triangles that a tolerance would have to join are no way: a smooth surface is a chain of pairs
// that are almost flat. A polygon is one facet whatever the tolerance.
#include "replace/to_plc.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "replace/outlines.hpp"

namespace pgdr::detail {
namespace {

using Facet = Plc<3>::Facet;

/// Faces of one group that hang together across plain edges; faces of no group one by one.
std::vector<std::vector<std::uint32_t>> parts_of(const SurfaceComplex& s) {
  std::vector<std::vector<std::uint32_t>> parts;
  std::vector<bool> done(s.faces.size());
  for (std::uint32_t f = 0; f < s.faces.size(); ++f) {
    if (!s.faces[f].alive || done[f]) continue;
    std::vector<std::uint32_t> part{f};
    done[f] = true;
    const std::uint32_t group = s.faces[f].group;
    for (std::size_t next = 0; next < part.size() && group != no_index; ++next) {
      const auto& c = s.faces[part[next]].corners;
      for (std::size_t i = 0; i < 3; ++i) {
        const std::uint32_t a = c[i], b = c[(i + 1) % 3];
        if (s.is_kept(a, b)) continue;
        const std::uint32_t g = s.beyond(part[next], a, b);
        if (g == no_index || done[g] || s.faces[g].group != group) continue;
        done[g] = true;
        part.push_back(g);
      }
    }
    parts.push_back(std::move(part));
  }
  return parts;
}

/// Vertices in the order of their coordinates, those that are left.
std::vector<std::uint32_t> vertices_of(const SurfaceComplex& s, const LoosePieces& loose) {
  std::vector<std::uint32_t> out(loose.points);
  for (std::uint32_t v = 0; v < s.points.size(); ++v)
    if (!s.faces_at[v].empty() || !s.kept_at[v].empty()) out.push_back(v);
  std::sort(out.begin(), out.end(), [&](std::uint32_t a, std::uint32_t b) { return lex_less(s.at(a), s.at(b)); });
  return out;
}

/// The polygon as it is from its least point on, by the way that leads to the lesser one of the two beside it: whichever way
/// round a facet was given, it has its place.
std::vector<std::uint32_t> either_way_round(std::vector<std::uint32_t> polygon) {
  if (polygon.size() > 2 && polygon.back() < polygon[1]) std::reverse(polygon.begin() + 1, polygon.end());
  return polygon;
}

/// By numbers of points in the order of coordinates; each polygon begins with its least point.
void renumber(Facet& facet, const std::vector<std::uint32_t>& number) {
  for (auto& polygon : facet.polygons) {
    for (std::uint32_t& v : polygon) v = number[v];
    std::rotate(polygon.begin(), std::min_element(polygon.begin(), polygon.end()), polygon.end());
  }
  // The seeds of holes stand in the order of their polygons.
  std::vector<std::pair<std::vector<std::uint32_t>, Point3>> holes;
  for (std::size_t k = 0; k < facet.holes.size(); ++k) holes.emplace_back(std::move(facet.polygons[k + 1]), facet.holes[k]);
  std::ranges::sort(holes, {}, [](const auto& hole) { return either_way_round(hole.first); });
  for (std::size_t k = 0; k < holes.size(); ++k) {
    facet.polygons[k + 1] = std::move(holes[k].first);
    facet.holes[k] = holes[k].second;
  }
  std::sort(facet.polygons.begin() + 1 + static_cast<std::ptrdiff_t>(holes.size()), facet.polygons.end(),
            [](const auto& a, const auto& b) { return either_way_round(a) < either_way_round(b); });
}

void add_facets(const SurfaceComplex& s, const std::vector<std::uint32_t>& number, SurfacePlc& out) {
  struct Made {
    std::vector<std::vector<std::uint32_t>> place;
    Facet facet;
    std::uint32_t face;  // one of its faces
  };
  std::vector<Made> facets;
  const auto add = [&](Facet facet, std::uint32_t face) {
    facet.marker = s.classes[s.faces[face].klass].marker;
    renumber(facet, number);
    std::vector<std::vector<std::uint32_t>> place;
    for (const auto& polygon : facet.polygons) place.push_back(either_way_round(polygon));
    facets.push_back({std::move(place), std::move(facet), face});
  };
  for (const auto& part : parts_of(s)) {
    std::optional<Facet> polygon;
    if (part.size() > 1) polygon = polygon_of(s, part);
    if (polygon) {
      add(std::move(*polygon), part[0]);
      continue;
    }
    for (const std::uint32_t f : part) {
      const auto& c = s.faces[f].corners;
      add(Facet{.polygons = {{c[0], c[1], c[2]}}, .holes = {}, .marker = 0}, f);
    }
  }
  std::ranges::sort(facets, {}, &Made::place);
  for (Made& made : facets) {
    out.plc.facets.push_back(std::move(made.facet));
    out.face_of_facet.push_back(made.face);
  }
}

/// Creases, so that they are subsegments also where the surface has become flat there, and what the input has as segments.
void add_segments(const SurfaceComplex& s, const std::vector<std::uint32_t>& number, Plc<3>& plc) {
  for (std::uint32_t v = 0; v < s.points.size(); ++v)
    for (const KeptEdge& e : s.kept_at[v]) {
      const SurfaceCurve& curve = s.curves[e.curve];
      if (number[v] < number[e.other] && (curve.is_explicit || curve.is_crease))
        plc.segments.push_back({{number[v], number[e.other]}, curve.marker});
    }
  std::sort(plc.segments.begin(), plc.segments.end(), [](const auto& a, const auto& b) { return a.points < b.points; });
}

/// Leaves out the points inside of polygons: beside one, by what it is bent, they were points of their own.
void drop_points_inside(const LoosePieces& loose, SurfacePlc& out) {
  constexpr std::uint32_t unused = no_index;
  std::vector<std::uint32_t> number(out.plc.points.size(), unused);
  const auto each_corner = [&out](const auto& f) {
    for (auto& facet : out.plc.facets)
      for (auto& polygon : facet.polygons)
        for (std::uint32_t& v : polygon) f(v);
    for (auto& segment : out.plc.segments)
      for (std::uint32_t& v : segment.points) f(v);
  };
  each_corner([&](std::uint32_t v) { number[v] = 0; });
  std::vector<std::uint32_t> alone(loose.points);
  std::sort(alone.begin(), alone.end());
  std::uint32_t count = 0;
  for (std::uint32_t i = 0; i < number.size(); ++i) {
    if (number[i] == unused && !std::ranges::binary_search(alone, out.vertex_of_point[i])) continue;
    number[i] = count;
    out.plc.points[count] = out.plc.points[i];
    out.vertex_of_point[count++] = out.vertex_of_point[i];
  }
  out.plc.points.resize(count);
  out.vertex_of_point.resize(count);
  each_corner([&](std::uint32_t& v) { v = number[v]; });
}

}  // namespace

SurfacePlc to_plc(const SurfaceComplex& surface, const LoosePieces& loose) {
  SurfacePlc out;
  out.vertex_of_point = vertices_of(surface, loose);
  std::vector<std::uint32_t> number(surface.points.size(), no_index);
  for (std::uint32_t i = 0; i < out.vertex_of_point.size(); ++i) {
    number[out.vertex_of_point[i]] = i;
    out.plc.points.push_back(surface.at(out.vertex_of_point[i]));
  }
  add_facets(surface, number, out);
  add_segments(surface, number, out.plc);
  drop_points_inside(loose, out);
  return out;
}

}  // namespace pgdr::detail
