// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "pgdr/voronoi.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <ostream>
#include <string>

#include "input/words.hpp"
#include "output/simplices.hpp"
#include "pgdr/circumsphere.hpp"
#include "pgdr/error.hpp"
#include "pgdr/mesh_maps.hpp"
#include "pgdr/predicates.hpp"

namespace pgdr {
namespace {

constexpr double rounding_of_cosine = 1e-9;  // vertices on slanted segments are off these by rounding
constexpr std::uint32_t nobody_there = 0xffffffffu;

[[noreturn]] void refuse_mesh(const std::string& what) { throw UsageError({Errc::bad_option, what, {}, 0, {}, {}}); }

double distance(const Point2& a, const Point2& b) { return std::hypot(a[0] - b[0], a[1] - b[1]); }
double product(const Point2& o, const Point2& a, const Point2& b) {
  return (a[0] - o[0]) * (b[0] - o[0]) + (a[1] - o[1]) * (b[1] - o[1]);
}
double doubled_area(const Point2& o, const Point2& a, const Point2& b) {
  return (a[0] - o[0]) * (b[1] - o[1]) - (a[1] - o[1]) * (b[0] - o[0]);
}

/// Makes the cells. A corner of a triangle is 3 times that plus its number in it, 0, 1 or 2; so is the edge opposite.
class CellMaker {
 public:
  explicit CellMaker(const OutputMesh<2>& mesh) : mesh_(mesh), neighbors_(neighbors_of_cells(mesh)) {
    made_.sites = mesh.points;
    find_beyond();
    require_centers_inside();
    make_points();
  }

  VoronoiCells made() {
    gather_corners();
    made_.offsets.push_back(0);
    made_.areas.assign(made_.sites.size(), 0);
    for (std::uint32_t v = 0; v < made_.sites.size(); ++v) {
      put_cell(v);
      made_.offsets.push_back(made_.corners.size());
      made_.areas[v] = area(v);
    }
    link();
    return std::move(made_);
  }

 private:
  std::uint32_t vertex(std::uint32_t corner) const { return mesh_.cells[corner / 3][corner % 3]; }
  /// The corner that follows in its triangle, counterclockwise, and the one before.
  static std::uint32_t next(std::uint32_t corner) { return corner % 3 == 2 ? corner - 2 : corner + 1; }
  static std::uint32_t last(std::uint32_t corner) { return corner % 3 == 0 ? corner + 2 : corner - 1; }
  const Point2& at(std::uint32_t corner) const { return mesh_.points[vertex(corner)]; }

  /// Of each edge the same edge in the triangle beyond, or nobody_there.
  void find_beyond() {
    beyond_.assign(3 * mesh_.cells.size(), nobody_there);
    for (std::uint32_t edge = 0; edge < beyond_.size(); ++edge) {
      const std::uint32_t other = neighbors_[edge / 3][edge % 3];
      if (other == no_cell_beyond) continue;
      std::uint32_t k = 3 * other;
      while (vertex(next(k)) != vertex(last(edge)) && k < 3 * other + 2) ++k;
      if (vertex(next(k)) != vertex(last(edge)) || vertex(last(k)) != vertex(next(edge)))
        refuse_mesh("the mesh has a clockwise triangle beside one that is not");
      beyond_[edge] = k;
    }
  }

  double cosine(std::uint32_t corner) const {
    const Point2 &o = at(corner), &a = at(next(corner)), &b = at(last(corner));
    return product(o, a, b) / (distance(o, a) * distance(o, b));
  }

  /// The circumcentres on both sides of an edge are in the order of the triangles where the angles opposite are at most 180
  /// degrees together; that of a triangle at the boundary is in the domain where the angle is at most 90 degrees.
  void require_centers_inside() const {
    std::size_t wrong = 0;
    for (std::uint32_t edge = 0; edge < beyond_.size(); ++edge) {
      const double opposite = beyond_[edge] == nobody_there ? 0 : cosine(beyond_[edge]);
      if (!(cosine(edge) + opposite >= -rounding_of_cosine)) ++wrong;
    }
    if (wrong > 0)
      refuse_mesh("at " + std::to_string(wrong) +
                  " sides of triangles the circumcentres are not in the domain, or in the wrong order: make the mesh "
                  "with conforming_delaunay");
  }

  void make_points() {
    auto& points = made_.points;
    for (std::size_t c = 0; c < mesh_.cells.size(); ++c) points.push_back(circumsphere<2>(corners_of(mesh_, c)).center);
    own_.assign(mesh_.points.size(), nobody_there);
    middle_.assign(beyond_.size(), nobody_there);
    for (std::uint32_t edge = 0; edge < beyond_.size(); ++edge) {
      if (beyond_[edge] != nobody_there) continue;
      const Point2 &a = at(next(edge)), &b = at(last(edge));
      middle_[edge] = static_cast<std::uint32_t>(points.size());
      points.push_back({a[0] / 2 + b[0] / 2, a[1] / 2 + b[1] / 2});
      own_[vertex(next(edge))] = own_[vertex(last(edge))] = 0;
    }
    for (std::uint32_t v = 0; v < own_.size(); ++v)
      if (own_[v] != nobody_there) {
        own_[v] = static_cast<std::uint32_t>(points.size());
        points.push_back(mesh_.points[v]);
      }
  }

  /// The corners of triangles by their vertices.
  void gather_corners() {
    begin_.assign(mesh_.points.size() + 1, 0);
    for (std::uint32_t c = 0; c < beyond_.size(); ++c) ++begin_[vertex(c) + 1];
    std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
    std::vector<std::size_t> free(begin_.begin(), begin_.end() - 1);
    about_.resize(beyond_.size());
    for (std::uint32_t c = 0; c < beyond_.size(); ++c) about_[free[vertex(c)]++] = c;
  }

  /// About a vertex inside its triangles are a ring; about one of the boundary they are fans, each from an edge with nobody_there
  /// before.
  void put_cell(std::uint32_t v) {
    const auto begin = about_.begin() + static_cast<std::ptrdiff_t>(begin_[v]),
               end = about_.begin() + static_cast<std::ptrdiff_t>(begin_[v + 1]);
    if (begin == end) return;
    if (own_[v] == nobody_there) return put_fan(*begin);
    std::vector<std::uint32_t> starts;
    std::copy_if(begin, end, std::back_inserter(starts), [&](std::uint32_t c) { return beyond_[last(c)] == nobody_there; });
    const Point2 &o = mesh_.points[v], &first = at(next(starts.front()));
    const auto beyond_half = [&](const Point2& x) { return orient2d(o, first, x) == Sign::negative; };
    std::sort(starts.begin() + 1, starts.end(), [&](std::uint32_t a, std::uint32_t b) {
      const Point2 &p = at(next(a)), &q = at(next(b));
      return beyond_half(p) != beyond_half(q) ? beyond_half(q) : orient2d(o, p, q) == Sign::positive;
    });
    for (const std::uint32_t start : starts) put_fan(start);
  }

  /// The triangles about a vertex counterclockwise, from one of its corners to the boundary, or to where it began.
  void put_fan(std::uint32_t start) {
    auto& out = made_.corners;
    if (beyond_[last(start)] == nobody_there) {
      out.push_back(own_[vertex(start)]);
      out.push_back(middle_[last(start)]);
    }
    for (std::uint32_t corner = start;;) {
      out.push_back(corner / 3);
      const std::uint32_t edge = next(corner), across = beyond_[edge];
      if (across == nobody_there) return out.push_back(middle_[edge]);
      corner = next(across);
      if (corner == start) return;
    }
  }

  /// By triangles with the site, so that nobody_there cancels far from the origin.
  double area(std::uint32_t v) const {
    const std::size_t begin = made_.offsets[v], end = made_.offsets[v + 1];
    double sum = 0;
    for (std::size_t i = begin; i < end; ++i)
      sum += doubled_area(made_.sites[v], made_.points[made_.corners[i]],
                          made_.points[made_.corners[i + 1 < end ? i + 1 : begin]]);
    return sum / 2;
  }

  /// Each edge once.
  void link() {
    std::vector<std::uint32_t> edges;
    for (std::uint32_t e = 0; e < beyond_.size(); ++e)
      if (beyond_[e] == nobody_there || e < beyond_[e]) edges.push_back(e);
    const auto ends = [this](std::uint32_t e) {
      return std::array{std::min(vertex(next(e)), vertex(last(e))), std::max(vertex(next(e)), vertex(last(e)))};
    };
    std::sort(edges.begin(), edges.end(), [&](std::uint32_t a, std::uint32_t b) { return ends(a) < ends(b); });
    for (const std::uint32_t e : edges) {
      made_.links.push_back(ends(e));
      made_.widths.push_back(
          distance(made_.points[e / 3], made_.points[beyond_[e] == nobody_there ? middle_[e] : beyond_[e] / 3]));
      made_.lengths.push_back(distance(at(next(e)), at(last(e))));
    }
  }

  const OutputMesh<2>& mesh_;
  std::vector<std::array<std::uint32_t, 3>> neighbors_;
  std::vector<std::uint32_t> beyond_;
  std::vector<std::uint32_t> own_;     ///< of each vertex of the boundary its row in `points`; else nobody_there
  std::vector<std::uint32_t> middle_;  ///< of each edge of the boundary that of its middle
  std::vector<std::size_t> begin_;
  std::vector<std::uint32_t> about_;  ///< corners by vertices: those of vertex v from begin_[v]
  VoronoiCells made_;
};

}  // namespace

VoronoiCells voronoi_cells(const OutputMesh<2>& mesh) { return CellMaker(mesh).made(); }

void write_voronoi(std::ostream& out, const VoronoiCells& cells) {
  using detail::to_text;
  out << "# pgdr voronoi 1\n" << cells.points.size() << ' ' << cells.sites.size() << '\n';
  for (const Point2& p : cells.points) out << to_text(p[0]) << ' ' << to_text(p[1]) << '\n';
  for (std::size_t i = 0; i < cells.sites.size(); ++i) {
    const std::size_t begin = cells.offsets[i], end = cells.offsets[i + 1];
    out << to_text(cells.sites[i][0]) << ' ' << to_text(cells.sites[i][1]) << ' ' << end - begin;
    for (std::size_t k = begin; k < end; ++k) out << ' ' << cells.corners[k];
    out << '\n';
  }
}

}  // namespace pgdr
