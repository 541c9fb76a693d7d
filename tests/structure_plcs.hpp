// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Inputs that are no plain closed surface: nested and touching shells, walls and loose entities inside and outside.
// With what automatic regions make of them: labels at some points, 0 where there is no mesh.
#pragma once

#include <ostream>
#include <string>
#include <vector>

#include "model_plcs.hpp"

namespace pgdr::test {

struct Probe {
  Point3 at;
  double label;  ///< 0: outside or void
};

struct Structure {
  std::string name;
  Plc<3> plc;
  std::vector<Probe> probes;
  /// Its contacts are common points, so that it stays what it is under rotations that round.
  bool turns = true;
  /// Faces that are not locally Delaunay may be left (design.md, Known limits), with cells that stay poor beside them.
  bool mended = true;
};
inline void PrintTo(const Structure& s, std::ostream* out) { *out << s.name; }

inline Index add_point(Plc<3>& plc, const Point3& p) {
  plc.points.push_back(p);
  return static_cast<Index>(plc.points.size() - 1);
}

inline void add_facet(Plc<3>& plc, const std::vector<Point3>& polygon, int marker = 0) {
  std::vector<Index> ids;
  for (const Point3& p : polygon) ids.push_back(add_point(plc, p));  // what is there already is merged
  add_polygon(plc, ids, marker);
}

inline void add_segment(Plc<3>& plc, const Point3& a, const Point3& b, int marker = 0) {
  const Index i = add_point(plc, a);
  plc.segments.push_back({{i, add_point(plc, b)}, marker});
}

inline void append(Plc<3>& plc, const Plc<3>& other, double scale, const Point3& offset) {
  const Index base = static_cast<Index>(plc.points.size());
  for (const Point3& p : other.points)
    plc.points.push_back({{scale * p[0] + offset[0], scale * p[1] + offset[1], scale * p[2] + offset[2]}});
  for (auto f : other.facets) {
    for (auto& polygon : f.polygons)
      for (Index& v : polygon) v += base;
    plc.facets.push_back(f);
  }
}

inline Plc<3> boxes(const std::vector<std::pair<Point3, Point3>>& list) {
  Plc<3> plc;
  for (const auto& [low, high] : list) add_box(plc, low, high);
  return plc;
}

/// Rectangle with the two axes u < w at x_axis = at, as a polygon.
inline void add_rectangle(Plc<3>& plc, int axis, double at, Point2 low, Point2 high, int marker = 0) {
  const int u = axis == 0 ? 1 : 0, w = axis == 2 ? 1 : 2;
  std::vector<Point3> corners(4);
  for (int i = 0; i < 4; ++i) {
    corners[static_cast<std::size_t>(i)][axis] = at;
    corners[static_cast<std::size_t>(i)][u] = i == 1 || i == 2 ? high[0] : low[0];
    corners[static_cast<std::size_t>(i)][w] = i >= 2 ? high[1] : low[1];
  }
  add_facet(plc, corners, marker);
}

inline std::vector<Structure> nested_structures() {
  std::vector<Structure> out;
  {
    Structure s{"five_nested_spheres", {}, {}};
    for (const double r : {16.0, 8.0, 4.0, 2.0, 1.0}) append(s.plc, icosphere(1), r, {});
    s.probes = {{{{20, 0, 0}}, 0}, {{{0, 12, 0}}, 1}, {{{0, 6, 0}}, 0}, {{{0, 3, 0}}, 2}, {{{0, 0.1, 1.5}}, 0}, {{{0, 0, 0}}, 3}};
    out.push_back(s);
  }
  out.push_back({"boxes_side_by_side",
                 boxes({{{{4, 0, 0}}, {{5, 1, 1}}}, {{{0, 0, 0}}, {{1, 1, 1}}}}),
                 {{{{0.5, 0.5, 0.5}}, 1}, {{{4.5, 0.5, 0.5}}, 2}, {{{2, 0.5, 0.5}}, 0}}});
  out.push_back({"two_cavities",
                 boxes({{{{0, 0, 0}}, {{5, 2, 2}}}, {{{3, 0.5, 0.5}}, {{4, 1.5, 1.5}}}, {{{1, 0.5, 0.5}}, {{2, 1.5, 1.5}}}}),
                 {{{{0.5, 0.5, 0.5}}, 1}, {{{3.5, 1, 1}}, 0}, {{{1.5, 1, 1}}, 0}}});
  {
    // A body of two materials in a cavity is solid again; the wall between its halves makes it a group.
    Structure s{
        "divided_box_in_a_cavity",
        boxes({{{{0, 0, 0}}, {{6, 6, 6}}}, {{{1, 1, 1}}, {{5, 5, 5}}}, {{{2, 2, 2}}, {{3, 4, 4}}}, {{{3, 2, 2}}, {{4, 4, 4}}}}),
        {}};
    s.probes = {{{{0.5, 3, 3}}, 1}, {{{1.5, 3, 3}}, 0}, {{{2.5, 3, 3}}, 2}, {{{3.5, 3, 3}}, 3}};
    out.push_back(s);
  }
  out.push_back({"divided_void_in_a_box",
                 boxes({{{{0, 0, 0}}, {{6, 6, 6}}}, {{{2, 2, 2}}, {{3, 4, 4}}}, {{{3, 2, 2}}, {{4, 4, 4}}}}),
                 {{{{0.5, 3, 3}}, 1}, {{{2.5, 3, 3}}, 0}, {{{3.5, 3, 3}}, 0}},
                 true,
                 false});
  return out;
}

inline std::vector<Structure> touching_structures() {
  std::vector<Structure> out;
  const Point3 o{{0, 0, 0}}, e{{1, 1, 1}};
  out.push_back({"cubes_at_a_vertex",
                 boxes({{o, e}, {e, {{2, 2, 2}}}}),
                 {{{{0.5, 0.5, 0.5}}, 1}, {{{1.5, 1.5, 1.5}}, 2}, {{{0.5, 1.5, 0.5}}, 0}}});
  out.push_back({"cubes_at_an_edge",
                 boxes({{o, e}, {{{1, 1, 0}}, {{2, 2, 1}}}}),
                 {{{{0.5, 0.5, 0.5}}, 1}, {{{1.5, 1.5, 0.5}}, 2}, {{{0.5, 1.5, 0.5}}, 0}}});
  out.push_back(
      {"cubes_at_a_face", boxes({{o, e}, {{{1, 0, 0}}, {{2, 1, 1}}}}), {{{{0.5, 0.5, 0.5}}, 1}, {{{1.5, 0.5, 0.5}}, 2}}});
  {
    // Half a face in common: the common half is one facet, the other half another.
    Plc<3> plc;
    add_box(plc, o, e);
    plc.facets[1].polygons[0].clear();  // x high of the first box
    plc.facets.erase(plc.facets.begin() + 1);
    add_rectangle(plc, 0, 1, {{0, 0}}, {{1, 0.5}}, 2);
    add_rectangle(plc, 0, 1, {{0, 0.5}}, {{1, 1}}, 2);
    add_rectangle(plc, 0, 2, {{0, 0.5}}, {{1, 1.5}}, 3);
    add_rectangle(plc, 0, 1, {{0, 1}}, {{1, 1.5}}, 3);
    for (const double y : {0.0, 1.0}) add_rectangle(plc, 1, y, {{1, 0.5}}, {{2, 1.5}}, 4);
    for (const double z : {0.5, 1.5}) add_rectangle(plc, 2, z, {{1, 0}}, {{2, 1}}, 5);
    out.push_back({"cubes_at_half_a_face", plc, {{{{0.5, 0.5, 0.5}}, 1}, {{{1.5, 0.5, 1}}, 2}, {{{1.5, 0.5, 0.25}}, 0}}, false});
  }
  {
    // From within: at a vertex and at an edge a void, with a part of a facet in common a body of its own.
    Plc<3> plc = boxes({{o, {{4, 4, 4}}}});
    const std::vector<Point3> tip = {{{0, 0, 0}}, {{2, 1, 1}}, {{1, 2, 1}}, {{1, 1, 2}}};
    for (const auto& [a, b, c] : {std::array{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 2, 3}})
      add_facet(plc, {tip[a], tip[b], tip[c]}, 9);
    out.push_back({"void_at_a_vertex", plc, {{{{3, 3, 3}}, 1}, {{{1, 1, 1}}, 0}}});
  }
  {
    Plc<3> plc = boxes({{o, {{4, 4, 4}}}});
    const std::vector<Point3> wedge = {{{0, 0, 0}}, {{4, 0, 0}}, {{2, 2, 1}}, {{2, 1, 2}}};
    for (const auto& [a, b, c] : {std::array{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 2, 3}})
      add_facet(plc, {wedge[a], wedge[b], wedge[c]}, 9);
    out.push_back({"void_at_an_edge", plc, {{{{3.5, 3.5, 3.5}}, 1}, {{{2, 0.75, 0.75}}, 0}}});
  }
  {
    Plc<3> plc;
    add_box(plc, o, {{4, 4, 4}});
    plc.facets[4].polygons.push_back({});  // z low: with the floor of the inner box as a hole, and as a facet
    for (const Point3& p : {Point3{{1, 1, 0}}, {{2, 1, 0}}, {{2, 2, 0}}, {{1, 2, 0}}})
      plc.facets[4].polygons[1].push_back(add_point(plc, p));
    plc.facets[4].holes = {{{1.5, 1.5, 0}}};
    add_box(plc, {{1, 1, 0}}, {{2, 2, 1}}, 11);
    out.push_back({"body_on_a_floor", plc, {{{{3, 3, 3}}, 1}, {{{1.5, 1.5, 0.5}}, 2}}});
  }
  out.push_back({"spheres_at_a_vertex",
                 [] {
                   Plc<3> plc = icosphere(1);
                   Point3 most = plc.points[0];
                   for (const Point3& p : plc.points)
                     if (p[0] > most[0]) most = p;
                   Plc<3> mirrored = plc;
                   for (Point3& p : mirrored.points)
                     for (int i = 0; i < 3; ++i) p[i] = 2 * most[i] - p[i];
                   append(plc, mirrored, 1, {});
                   return plc;
                 }(),
                 {{{{0, 0, 0}}, 1}}});
  {
    // A ring of four boxes, each two with a common edge: what they enclose is void, and no seed says so.
    Plc<3> plc = boxes(
        {{{{0, 1, 0}}, {{1, 2, 1}}}, {{{1, 0, 0}}, {{2, 1, 1}}}, {{{2, 1, 0}}, {{3, 2, 1}}}, {{{1, 2, 0}}, {{2, 3, 1}}}});
    add_rectangle(plc, 2, 0, {{1, 1}}, {{2, 2}}, 9);
    add_rectangle(plc, 2, 1, {{1, 1}}, {{2, 2}}, 9);
    // Its lids lie between it and the outside: that it were void is not consistent. Five bodies.
    out.push_back({"ring_with_lids",
                   plc,
                   {{{{0.5, 1.5, 0.5}}, 1},
                    {{{1.5, 0.5, 0.5}}, 2},
                    {{{1.5, 1.5, 0.5}}, 3},
                    {{{1.5, 2.5, 0.5}}, 4},
                    {{{2.5, 1.5, 0.5}}, 5}}});
  }
  return out;
}

inline std::vector<Structure> inner_structures() {
  std::vector<Structure> out;
  const Point3 o{{0, 0, 0}}, e{{2, 2, 2}};
  {
    Plc<3> plc = boxes({{o, e}});
    add_rectangle(plc, 0, 1, {{0, 0}}, {{2, 2}}, 7);
    out.push_back({"wall", plc, {{{{0.5, 1, 1}}, 1}, {{{1.5, 1, 1}}, 2}}, false});
  }
  {
    // A wall, a void in one half, a fin on the wall in the other, and another on the void.
    Plc<3> plc = boxes({{o, {{8, 4, 4}}}, {{{1, 1, 1}}, {{3, 3, 3}}}});
    add_rectangle(plc, 0, 4, {{0, 0}}, {{4, 4}}, 7);
    add_rectangle(plc, 2, 2, {{4, 0}}, {{6, 4}}, 8);
    add_rectangle(plc, 1, 2, {{3, 1}}, {{3.5, 3}}, 8);
    out.push_back(
        {"wall_void_and_fins", plc, {{{{0.5, 0.5, 0.5}}, 1}, {{{5, 1, 1}}, 2}, {{{5, 1, 3}}, 2}, {{{2, 2, 2}}, 0}}, false});
  }
  {
    Plc<3> plc = boxes({{o, e}});
    add_rectangle(plc, 2, 1, {{0.5, 0.5}}, {{1.5, 1.5}}, 7);  // touches nothing
    out.push_back({"floating_facet", plc, {{{{0.25, 0.25, 0.25}}, 1}}});
    add_rectangle(plc, 1, 1, {{0.75, 0.25}}, {{1.25, 0.75}}, 8);
    out.push_back({"floating_facets", plc, {{{{0.25, 0.25, 0.25}}, 1}}});
  }
  {
    // Outside: a fin, a facet apart, a segment, a point; none of them is in the mesh.
    Plc<3> plc = boxes({{o, e}});
    add_facet(plc, {{{2, 0, 0}}, {{3, 0, 0}}, {{3, 0, 2}}, {{2, 0, 2}}}, 7);
    add_rectangle(plc, 2, 1, {{-3, -3}}, {{-2, -2}}, 8);
    add_segment(plc, e, {{3, 3, 3}}, 5);
    add_segment(plc, {{-1, -1, -1}}, {{-1, 1, -1}}, 5);
    add_point(plc, {{5, 0, 0}});
    out.push_back({"loose_outside", plc, {{{{1, 1, 1}}, 1}}});
  }
  {
    Plc<3> plc = boxes({{o, e}});
    add_segment(plc, {{0.5, 0.5, 0.5}}, {{1.5, 0.75, 1}}, 5);  // floats
    add_segment(plc, o, {{0.5, 1.5, 1.25}}, 6);                // from a corner
    add_segment(plc, {{1.5, 1.5, 0}}, {{1.5, 1.5, 0.5}}, 7);   // from the inside of a facet
    add_segment(plc, {{1, 0, 2}}, {{1, 0.75, 1.5}}, 8);        // from the inside of an edge
    add_point(plc, {{1, 1, 1.75}});
    add_point(plc, {{2, 1, 1}});
    add_point(plc, {{2, 2, 1}});
    out.push_back({"loose_inside", plc, {{{{1, 1, 1}}, 1}}, false});
  }
  {
    // One plane: a square with a hole, an island in it, segments and points on all of them.
    Plc<3> plc = boxes({{o, {{8, 8, 4}}}});
    auto& lid = plc.facets[5];
    const auto ring = [&](double low, double high, double z) {
      std::vector<Index> ids;
      for (const auto& [x, y] : {std::pair{low, low}, {high, low}, {high, high}, {low, high}})
        ids.push_back(add_point(plc, {{x, y, z}}));
      return ids;
    };
    lid.polygons.push_back(ring(1, 7, 4));
    lid.holes = {{{1.5, 1.5, 4}}};
    Plc<3>::Facet middle;  // closes the hole, but for its own, which the island closes
    middle.polygons = {ring(1, 7, 4), ring(2, 6, 4), {add_point(plc, {{1.5, 1.5, 4}}), add_point(plc, {{1.5, 5, 4}})}};
    middle.holes = {{{4, 4, 4}}};
    middle.marker = 21;
    Plc<3>::Facet island;
    island.polygons = {ring(2, 6, 4), {add_point(plc, {{3, 3, 4}}), add_point(plc, {{5, 5, 4}})}, {add_point(plc, {{5, 3, 4}})}};
    island.marker = 22;
    plc.facets.push_back(middle);
    plc.facets.push_back(island);
    out.push_back({"facets_in_facets", plc, {{{{4, 4, 2}}, 1}}});
  }
  {
    // Pages of a book in a box: facets that meet at one segment, and end inside.
    for (const int pages : {3, 7}) {
      Plc<3> plc = boxes({{{{-4, -4, 0}}, {{4, 4, 2}}}});
      const std::vector<std::pair<double, double>> ends{{3, 0}, {-2, 2}, {0, -3}, {2, 2}, {0, 3}, {-3, 0}, {-2, -2}};
      for (const auto& [x, y] : std::vector(ends.begin(), ends.begin() + pages))
        add_facet(plc, {{{0, 0, 0.5}}, {{x, y, 0.5}}, {{x, y, 1.5}}, {{0, 0, 1.5}}}, 7);
      out.push_back({"book_of_" + std::to_string(pages), plc, {{{{3.5, 3.5, 1}}, 1}}});
    }
  }
  {
    // Pages that reach the cover divide the box.
    Plc<3> plc;
    for (const auto& [a, b] :
         {std::pair{Point2{{-1, -1}}, Point2{{1, -1}}}, {{{1, -1}}, {{1, 1}}}, {{{1, 1}}, {{-1, 1}}}, {{{-1, 1}}, {{-1, -1}}}}) {
      add_facet(plc, {{{a[0], a[1], 0}}, {{b[0], b[1], 0}}, {{b[0], b[1], 1}}, {{a[0], a[1], 1}}}, 1);
      add_facet(plc, {{{0, 0, 0}}, {{a[0], a[1], 0}}, {{a[0], a[1], 1}}, {{0, 0, 1}}}, 2);
      for (const double z : {0.0, 1.0}) add_facet(plc, {{{0, 0, z}}, {{a[0], a[1], z}}, {{b[0], b[1], z}}}, 3);
    }
    out.push_back(
        {"divided_by_pages", plc, {{{{-0.5, 0, 0.5}}, 1}, {{{0, -0.5, 0.5}}, 2}, {{{0, 0.5, 0.5}}, 3}, {{{0.5, 0, 0.5}}, 4}}});
  }
  for (const int k : {5, 12}) {
    const double gap = std::ldexp(1.0, -k);
    out.push_back({"thin_walls_" + std::to_string(k),
                   boxes({{o, {{1, 1, 0.25}}}, {{{0, 0, 0.25 + gap}}, {{1, 1, 0.5}}}}),
                   {{{{0.5, 0.5, 0.125}}, 1}, {{{0.5, 0.5, 0.375}}, 2}, {{{0.5, 0.5, 0.25 + gap / 2}}, 0}}});
  }
  return out;
}

inline std::vector<Structure> all_structures() {
  std::vector<Structure> out = nested_structures();
  for (const auto& list : {touching_structures(), inner_structures()}) out.insert(out.end(), list.begin(), list.end());
  return out;
}

}  // namespace pgdr::test
