// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Judging a cavity by the cells that it would make: is it star-shaped about the point?
#include <algorithm>

#include "cavity/cavity.hpp"

namespace pgdr {

/// The cells that the boundary faces would make with the point, several side by side: whether they are positively oriented,
/// and the spheres and edges that a commit will ask for.
template <int D>
void Cavity<D>::look_at_shapes() {
  const std::size_t blocks = (boundary_.size() + shape_lanes - 1) / shape_lanes;
  if (blocks > shapes_.size()) {
    prospects_.resize(2 * blocks);
    shapes_.resize(2 * blocks);
  }
  const Mesh<D>& mesh = *mesh_;
  const Point<D> p = point_;
  for (std::size_t b = 0, i = 0; b < blocks; ++b) {
    SimplexBlock<D>& block = prospects_[b];
    for (std::size_t lane = 0; lane < shape_lanes; ++lane) {
      const BoundaryFace f = boundary_[i];
      const auto& vertices = mesh.cell(f.cell).vertices;
      for (int n = 0; n < D; ++n) {
        const VertexId v = vertices[face_corners<D>[f.face][n]];
        block.set(lane, n, v == infinite_vertex ? p : mesh.point(v));
      }
      if (i + 1 < boundary_.size()) ++i;  // the last lanes are copies
    }
    for (int k = 0; k < D; ++k) std::fill_n(block.corner[D][k], shape_lanes, p[k]);
  }
  simplex_shapes<D>({prospects_.data(), blocks}, {shapes_.data(), blocks});
  shapes_known_ = true;
}

template <int D>
bool Cavity<D>::surely_star_shaped() {
  if (!shapes_known_) look_at_shapes();
  for (std::size_t i = 0; i < boundary_.size(); ++i) {
    const ShapeBlock<D>& block = shapes_[i / shape_lanes];
    if (!(block.det[i % shape_lanes] > block.det_error[i % shape_lanes])) return false;
  }
  return true;
}

template <int D>
bool Cavity<D>::visible(std::size_t i) const {
  const ShapeBlock<D>& block = shapes_[i / shape_lanes];
  const std::size_t lane = i % shape_lanes;
  const double det = block.det[lane], error = block.det_error[lane];
  if (split_segment_ == no_entity) {
    if (det > error) [[likely]]
      return true;
    if (det < -error) return false;
  }
  return visible_exactly(boundary_[i]);
}

/// Does p see the inner side of the face? Ghosts' own faces at infinity are always seen.
template <int D>
bool Cavity<D>::visible_exactly(const BoundaryFace& f) const {
  const CellRecord<D>& k = mesh_->cell(f.cell);
  Simplex<D> s;
  for (int i = 0; i <= D; ++i) {
    if (i == f.face) {
      s[i] = point_;
    } else if (k.vertices[i] == infinite_vertex) {
      return true;
    } else {
      s[i] = mesh_->point(k.vertices[i]);
      if (s[i] == point_) return false;
    }
  }
  if (split_segment_ != no_entity)
    for (int i = 0; i <= D; ++i)
      for (int j = i + 1; j <= D; ++j)
        if (i != f.face && j != f.face && in_line(f.cell, i, j)) return false;
  return orient<D>(s) == Sign::positive;
}

template <int D>
auto Cavity<D>::make_star_shaped() -> Status {
  std::vector<CellId> doomed;
  while (!star_shaped_) {
    if (!shapes_known_) look_at_shapes();
    for (std::size_t i = 0; i < boundary_.size(); ++i)
      if (!visible(i)) doomed.push_back(boundary_[i].cell);
    if (doomed.empty())
      if (const Status s = find_broken_fans(doomed); s != Status::ok) return s;
    if (doomed.empty()) find_turned_over(doomed);
    star_shaped_ = doomed.empty();
    if (star_shaped_) break;
    if (const Status s = drop_cells(doomed); s != Status::ok) return s;
    doomed.clear();
  }
  return Status::ok;
}

/// The circumsphere of the i-th new cell, mostly from what look_at_shapes() found.
template <int D>
FilterSphere<D> Cavity<D>::computed_sphere(std::size_t i) const {
  const ShapeBlock<D>& block = shapes_[i / shape_lanes];
  const std::size_t lane = i % shape_lanes;
  if (!(block.center_error[lane] < std::numeric_limits<double>::infinity())) [[unlikely]]
    return FilterSphere<D>::of(circumsphere<D>(mesh_->simplex(new_cells_[i])));
  Point<D> center;
  for (int k = 0; k < D; ++k) center[k] = block.center[k][lane];
  return FilterSphere<D>::of(center, block.squared_radius[lane], block.power_error[lane]);
}

/// 3D: of the new cells.
template <int D>
void Cavity<D>::set_spheres() {
  if constexpr (D == 3) {
    for (std::size_t i = 0; i < new_cells_.size(); ++i) {
      const bool accurate = shapes_[i / shape_lanes].center_error[i % shape_lanes] < std::numeric_limits<double>::infinity();
      if (!accurate && mesh_->is_ghost(new_cells_[i])) [[unlikely]]
        mesh_->set_ghost_sphere(new_cells_[i]);
      else
        mesh_->set_sphere(new_cells_[i], computed_sphere(i));
    }
  }
}

// The members defined in this file.
template class Cavity<2>;
template class Cavity<3>;

}  // namespace pgdr
