// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Faces of one cell alone against what other meshes have there. First against the faces of their boundaries, then, where all
// these match, against their cells: what a face then meets inside of a cell, and on faces of the cell inside of its mesh, lies
// inside of that mesh. For a place on the boundary of it was compared already, and has the same there of both.
#include <algorithm>
#include <set>
#include <utility>

#include "input/words.hpp"
#include "pgdr/predicates.hpp"
#include "space/box_tree.hpp"
#include "space/contact.hpp"
#include "weld/joining.hpp"

namespace pgdr::detail {
namespace {

template <int D>
class BoundaryComparer {
 public:
  explicit BoundaryComparer(Joining<D>& joining) : j_(joining), points_(joining.out.mesh.points), meshes_(boxes_of_meshes()) {}

  void run() {
    take_near_faces();
    if (near_.empty()) return;
    compare_faces();
    if (j_.refusals.empty()) compare_cells();
  }

 private:
  using Face = std::array<std::uint32_t, D>;

  std::vector<Box<D>> boxes_of_meshes() const {
    std::vector<Box<D>> boxes;
    for (const OutputMesh<D>* mesh : j_.meshes) boxes.push_back(Box<D>::of(mesh->points));
    return boxes;
  }
  template <class Vertices>
  Box<D> box_of(const Vertices& vertices) const {
    Box<D> box = Box<D>::empty();
    for (const std::uint32_t v : vertices) box.add(points_[v]);
    return box;
  }
  bool is_near_other(const Box<D>& box, std::uint32_t mesh) const {
    bool found = false;
    meshes_.meeting(box, [&](std::uint32_t m) { found = found || m != mesh; });
    return found;
  }

  void take_near_faces() {
    for (std::uint32_t f = 0; f < j_.outer.size(); ++f)
      if (is_near_other(box_of(j_.outer[f].vertices), j_.outer[f].mesh)) near_.push_back(f);
  }

  /// As contact() takes it. A face of a cell that is not flat is seen along some axis.
  Piece piece_of(const Face& face) const {
    Piece piece;
    piece.count = D;
    std::ranges::copy(face, piece.corners.begin());
    if constexpr (D == 3)
      for (int axis = 0; axis < 3; ++axis) {
        const Sign s = orient_projected(points_[face[0]], points_[face[1]], points_[face[2]], axis);
        if (s == Sign::zero) continue;
        piece.axis = static_cast<std::uint8_t>(axis);
        if (s == Sign::negative) std::swap(piece.corners[1], piece.corners[2]);
        break;
      }
    return piece;
  }

  /// Faces that two meshes share need not be compared with each other: where they met, so would others beside them.
  void compare_faces() {
    std::vector<Box<D>> boxes;
    for (const std::uint32_t f : near_) boxes.push_back(box_of(j_.outer[f].vertices));
    const BoxTree<D> tree(boxes);
    for (std::size_t i = 0; i < near_.size() && !j_.refusals.are_plenty(); ++i) {
      const OuterFace<D>& f = j_.outer[near_[i]];
      if (f.is_shared) continue;
      j_.heed_stop();
      std::vector<std::uint32_t> others;
      tree.meeting(boxes[i], [&](std::uint32_t k) {
        const OuterFace<D>& g = j_.outer[near_[k]];
        if (g.mesh != f.mesh && (g.is_shared || k > i)) others.push_back(k);
      });
      std::ranges::sort(others);
      for (const std::uint32_t k : others) compare(f, j_.outer[near_[k]]);
    }
  }

  /// The first mesh is named first.
  void compare(const OuterFace<D>& one, const OuterFace<D>& other) {
    const OuterFace<D>&f = other.mesh < one.mesh ? other : one, &g = other.mesh < one.mesh ? one : other;
    const Contact found = contact<D>(points_, piece_of(f.vertices), piece_of(g.vertices));
    if (found.kind == Contact::Kind::none) return;
    for (const Contact::Corner& corner : found.corners) refuse(corner, corner.of_second ? g : f, corner.of_second ? f : g);
    if (found.kind == Contact::Kind::touch) return;
    const bool overlap = found.kind == Contact::Kind::overlap;
    const Errc code = overlap ? Errc::facets_overlap : Errc::entities_intersect;
    j_.refusals.add(code, [&] {
      Diagnostic d{.code = code};
      d.message = "the " + words(f, d) + ' ' + (overlap ? "overlaps" : "crosses") + " the " + words(g, d);
      for (const Point<D>& p : contact_points<D>(points_, found)) d.points.push_back(in_space(p));
      if (!d.points.empty()) d.message += ", at " + place(d.points.front());
      return d;
    });
  }

  /// A corner of `of` on `on`. Found again with each face that has it, and told once.
  void refuse(const Contact::Corner& corner, const OuterFace<D>& of, const OuterFace<D>& on) {
    const bool is_on_edge = corner.edge[0] != no_entity;
    Face where = on.vertices;
    if (is_on_edge && D == 3) {
      where[0] = std::min(corner.edge[0], corner.edge[1]);
      where[1] = std::max(corner.edge[0], corner.edge[1]);
      where[D - 1] = no_entity;
    }
    if (!resting_.emplace(corner.point, where).second) return;
    const Errc code = is_on_edge ? Errc::point_on_segment : Errc::point_on_facet;
    j_.refusals.add(code, [&] {
      Diagnostic d{.code = code};
      const Point<D>& p = points_[corner.point];
      d.ids.push_back(j_.number_in(of.mesh, corner.point));
      d.message = "vertex " + std::to_string(d.ids[0]) + " of " + j_.name(of.mesh) + " lies inside the ";
      if (is_on_edge)
        d.message += "edge with the vertices " + list(corner.edge, on.mesh, d) + " of " + j_.name(on.mesh);
      else
        d.message += words(on, d);
      d.message += ", at " + to_text(p);
      d.points = {in_space(p)};
      return d;
    });
  }

  template <std::size_t N>
  std::string list(const std::array<std::uint32_t, N>& vertices, std::uint32_t mesh, Diagnostic& d) const {
    std::string text;
    for (const std::uint32_t v : vertices) {
      d.ids.push_back(j_.number_in(mesh, v));
      text += (text.empty() ? "" : ", ") + std::to_string(d.ids.back());
    }
    return text;
  }
  std::string words(const OuterFace<D>& f, Diagnostic& d) const {
    return std::string(D == 2 ? "edge" : "face") + " with the vertices " + list(f.vertices, f.mesh, d) + " of " + j_.name(f.mesh);
  }
  static std::string place(const std::array<double, 3>& p) {
    Point<D> at;
    std::copy_n(p.begin(), D, at.x.begin());
    return to_text(at);
  }

  void compare_cells() {
    const auto& cells = j_.out.mesh.cells;
    std::vector<std::uint32_t> near;
    std::vector<Box<D>> boxes;
    for (std::uint32_t c = 0; c < cells.size(); ++c)
      if (const Box<D> box = box_of(cells[c]); is_near_other(box, j_.mesh_of(c))) {
        near.push_back(c);
        boxes.push_back(box);
      }
    mark_outer();
    const BoxTree<D> tree(boxes);
    for (const std::uint32_t i : near_) {
      const OuterFace<D>& f = j_.outer[i];
      if (f.is_shared) continue;
      if (j_.refusals.are_plenty()) return;
      j_.heed_stop();
      std::uint32_t first = no_entity;
      tree.meeting(box_of(f.vertices), [&](std::uint32_t k) {
        if (near[k] < first && j_.mesh_of(near[k]) != f.mesh && reaches_into(f, near[k])) first = near[k];
      });
      if (first != no_entity) refuse(f, first);
    }
  }

  /// Bit i of a cell: its face i is outer.
  void mark_outer() {
    outer_bits_.assign(j_.out.mesh.cells.size(), 0);
    for (const OuterFace<D>& f : j_.outer) outer_bits_[f.cell()] |= static_cast<std::uint8_t>(1u << f.place % (D + 1));
  }

  /// A part of f is inside of the cell, or on faces of it inside of its mesh, and is not theirs in common.
  bool reaches_into(const OuterFace<D>& f, std::uint32_t c) const {
    const auto& cell = j_.out.mesh.cells[c];
    std::array<bool, D> inside;
    inside.fill(true);
    for (std::size_t i = 0; i <= D; ++i) {
      Simplex<D> s;
      for (std::size_t k = 0; k <= D; ++k) s[k] = points_[cell[k]];
      bool beyond = true;
      for (std::size_t k = 0; k < D; ++k) {
        s[i] = points_[f.vertices[k]];
        const Sign side = has_corner(cell, f.vertices[k]) && f.vertices[k] != cell[i] ? Sign::zero : orient<D>(s);
        inside[k] = inside[k] && side == Sign::positive;
        beyond = beyond && side == Sign::negative;
      }
      if (beyond) return false;
    }
    if (std::ranges::count(inside, true) > 0) return true;
    const Piece piece = piece_of(f.vertices);
    for (std::size_t i = 0; i <= D; ++i) {
      if ((outer_bits_[c] >> i & 1) != 0) continue;
      if (contact<D>(points_, piece, piece_of(outward_face<D>(cell, i))).kind != Contact::Kind::none) return true;
    }
    return false;
  }

  void refuse(const OuterFace<D>& f, std::uint32_t c) {
    j_.refusals.add(Errc::bodies_overlap, [&] {
      Diagnostic d{.code = Errc::bodies_overlap};
      const std::uint32_t m = j_.mesh_of(c);
      d.message = "the " + words(f, d);
      d.ids.push_back(static_cast<std::int64_t>(c - j_.out.first_cell[m]));
      d.message += " reaches into cell " + std::to_string(d.ids.back()) + " of " + j_.name(m) + ", at " +
                   to_text(points_[f.vertices[0]]);
      for (const std::uint32_t v : f.vertices) d.points.push_back(in_space(points_[v]));
      return d;
    });
  }

  Joining<D>& j_;
  const std::vector<Point<D>>& points_;
  const BoxTree<D> meshes_;          // by the boxes of the meshes
  std::vector<std::uint32_t> near_;  // of the outer faces, those in the box of another mesh
  std::set<std::pair<std::uint32_t, Face>> resting_;
  std::vector<std::uint8_t> outer_bits_;
};

}  // namespace

template <int D>
void compare_boundaries(Joining<D>& joining) {
  BoundaryComparer<D>(joining).run();
}

template void compare_boundaries<2>(Joining<2>&);
template void compare_boundaries<3>(Joining<3>&);

}  // namespace pgdr::detail
