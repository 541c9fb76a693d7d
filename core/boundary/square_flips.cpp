// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "boundary/square_flips.hpp"

#include <algorithm>
#include <utility>

#include "numbers/corners.hpp"
#include "pgdr/predicates.hpp"

namespace pgdr::detail {
namespace {

/// Joins face i of c with face k of d.
void join(Mesh<3>& mesh, CellId c, int i, CellId d, int k) {
  mesh.cell(c).links[i] = Link(d, k);
  mesh.cell(d).links[k] = Link(c, i);
}

}  // namespace

void SquareFlips::take(std::span<const EntityId> missing) {
  for (const EntityId s : missing) {
    const auto facets = domain_->facets_of_segment(s);
    if (facets.size() != 2) continue;
    const auto& ends = domain_->segments()[s].points;
    std::array<std::uint32_t, 2> apexes{};
    bool are_triangles = true;
    for (std::size_t i = 0; i < 2; ++i) {
      const auto triangles = domain_->triangles(facets[i]);
      are_triangles = are_triangles && triangles.size() == 1 && domain_->facet_points(facets[i]).size() == 3;
      for (const std::uint32_t p : triangles[0])
        if (p != ends[0] && p != ends[1]) apexes[i] = p;
    }
    if (!are_triangles) continue;
    const auto& points = domain_->points();
    if (orient3d(points[ends[0]], points[ends[1]], points[apexes[0]], points[apexes[1]]) != Sign::zero) continue;
    const auto& v = delaunay_->vertices();
    const Square square{{v[ends[0]], v[ends[1]]}, {v[apexes[0]], v[apexes[1]]}};
    if (std::array<Side, 2> sides; find_sides(square, sides) && is_flippable(square, sides)) squares_[s] = square;
  }
}

bool SquareFlips::has_facet(EntityId f) const {
  if (squares_.empty()) return false;
  const auto segments = domain_->facet_segments(f);
  return std::any_of(segments.begin(), segments.end(), [&](EntityId s) { return has_segment(s); });
}

void SquareFlips::drop_facet(EntityId f) {
  if (squares_.empty()) return;
  for (const EntityId s : domain_->facet_segments(f)) squares_.erase(s);
}

/// Are the other diagonal and its two triangles there, with two cells on each side?
bool SquareFlips::find_sides(const Square& square, std::array<Side, 2>& sides) {
  const auto [a, b] = square.wanted;
  const auto [c, d] = square.present;
  star_.assign(1, delaunay_->cell_at(c));
  mesh_->mark(star_[0]);
  std::size_t found = 0;
  bool fits = true;
  for (std::size_t i = 0; i < star_.size(); ++i) {
    const auto& cell = mesh_->cell(star_[i]);
    for (int k = 0; k < 4; ++k) {
      if (cell.vertices[k] == c || mesh_->marked(cell.links[k].cell())) continue;
      mesh_->mark(cell.links[k].cell());
      star_.push_back(cell.links[k].cell());
    }
    if (!has_corner(cell.vertices, d) || !has_corner(cell.vertices, a)) continue;
    const CellId beyond = cell.links[corner_of(cell.vertices, a)].cell();
    fits = fits && found < 2 && has_corner(mesh_->cell(beyond).vertices, b);
    if (found < 2) sides[found++] = {star_[i], beyond};
  }
  for (const CellId x : star_) mesh_->unmark(x);
  return fits && found == 2;
}

/// Do the four corners lie on one circle, the diagonals crossing each other?
bool SquareFlips::is_flippable(const Square& square, const std::array<Side, 2>& sides) const {
  return std::all_of(sides.begin(), sides.end(), [&](const Side& side) {
    const auto& v = mesh_->cell(side[0]).vertices;
    return has_corner(v, infinite_vertex) || in_sphere<3>(mesh_->simplex(side[0]), mesh_->point(square.wanted[1])) == Sign::zero;
  });
}

/// The cell with a and cd gets b for d, that with b and cd gets a for c. Each stays positive, as a and b are on both sides of cd
/// in its plane, c and d on both sides of ab.
void SquareFlips::flip(const Square& square, const std::array<Side, 2>& sides) {
  const auto [a, b] = square.wanted;
  const auto [c, d] = square.present;
  for (const Side& side : sides) {
    auto of_a = mesh_->cell(side[0]).vertices, of_b = mesh_->cell(side[1]).vertices;
    const int a_in_a = corner_of(of_a, a), c_in_a = corner_of(of_a, c), d_in_a = corner_of(of_a, d);
    const int b_in_b = corner_of(of_b, b), c_in_b = corner_of(of_b, c), d_in_b = corner_of(of_b, d);
    const Link beyond_a = mesh_->cell(side[0]).links[c_in_a], beyond_b = mesh_->cell(side[1]).links[d_in_b];
    of_a[d_in_a] = b;
    of_b[c_in_b] = a;
    mesh_->set_vertices(side[0], of_a);
    mesh_->set_vertices(side[1], of_b);
    join(*mesh_, side[0], a_in_a, beyond_b.cell(), beyond_b.face());
    join(*mesh_, side[1], b_in_b, beyond_a.cell(), beyond_a.face());
    join(*mesh_, side[0], c_in_a, side[1], d_in_b);
  }
  for (const Side& side : sides) {
    for (const CellId x : side) mesh_->is_ghost(x) ? mesh_->set_ghost_sphere(x) : mesh_->set_sphere(x);
    delaunay_->note_changed(side);
  }
}

bool SquareFlips::flip() {
  std::vector<EntityId> order;
  for (const auto& [s, square] : squares_) order.push_back(s);
  std::sort(order.begin(), order.end());
  std::vector<EntityId> impossible;
  std::vector<Square> flipped;
  for (const EntityId s : order) {
    const Square& square = squares_.at(s);
    if (std::array<Side, 2> sides; find_sides(square, sides) && is_flippable(square, sides)) {
      flip(square, sides);
      flipped.push_back(square);
    } else {
      impossible.push_back(s);
    }
  }
  if (impossible.empty()) return true;
  for (std::size_t i = flipped.size(); i-- > 0;) {
    const Square back{flipped[i].present, flipped[i].wanted};
    std::array<Side, 2> sides;
    find_sides(back, sides);
    flip(back, sides);
  }
  for (const EntityId s : impossible) squares_.erase(s);
  return false;
}

}  // namespace pgdr::detail
