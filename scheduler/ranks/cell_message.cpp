// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "ranks/cell_message.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

namespace pgdr::detail {

template <int D>
SentCells<D> SentCells<D>::get(MessageReader& message) {
  SentCells cells;
  cells.vertices = message.get_all<SentVertex<D>>();
  cells.gone = message.get_all<SentCorners<D>>();
  cells.made = message.get_all<SentCell<D>>();
  cells.constraints = message.get_all<ConstraintRecord<D>>();
  cells.changed = message.get_all<SentConstraints<D>>();
  for (const SentVertex<D>& v : cells.vertices)
    if (!std::all_of(v.point.begin(), v.point.end(), [](double x) { return std::isfinite(x); }))
      fail_message("a message of another rank has a vertex that is at no point");
  const auto check = [&](const SentCorners<D>& corners) {
    for (std::size_t i = 0; i < corners.size(); ++i) {
      if (corners[i] >= cells.vertices.size()) fail_message("a message of another rank has a cell of vertices that it lacks");
      if (std::find(corners.begin(), corners.begin() + i, corners[i]) != corners.begin() + i)
        fail_message("a message of another rank has a cell that has a vertex twice");
    }
  };
  for (const auto& corners : cells.gone) check(corners);
  for (const auto& changed : cells.changed) check(changed.vertices);
  std::size_t constrained = 0;
  for (const SentCell<D>& cell : cells.made) {
    check(cell.vertices);
    constrained += cell.has_constraints != 0 ? 1 : 0;
    for (const std::uint32_t code : cell.links) {
      const Link link = Link::from_code(code);
      if (link && (index(link.cell()) >= cells.made.size() || link.face() > D))
        fail_message("a message of another rank has a link to a cell that it lacks");
    }
  }
  if (constrained != cells.constraints.size()) fail_message("a message of another rank lacks constraints");
  return cells;
}

template <int D>
CellWriter<D>::Numbers::Numbers(std::size_t most) : slots_(std::bit_ceil(2 * most + 2)) {}

template <int D>
CellWriter<D>::CellWriter(const Mesh<D>& mesh, std::size_t most)
    : mesh_(&mesh), vertex_numbers_((D + 1) * most), cell_numbers_(most) {}

template <int D>
SentCorners<D> CellWriter<D>::corners(const Vertices& vertices) {
  SentCorners<D> corners;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const VertexId v = vertices[i];
    corners[i] = vertex_numbers_.number(index(v), static_cast<std::uint32_t>(vertices_.size()));
    if (corners[i] < vertices_.size()) continue;
    vertices_.push_back(v);
    const VertexRecord<D>& record = mesh_->vertex(v);
    SentVertex<D> sent{{}, record.home.code, record.relaxed_radius};
    for (int k = 0; k < D; ++k) sent.point[static_cast<std::size_t>(k)] = record.point[k];
    all_.vertices.push_back(sent);
  }
  return corners;
}

template <int D>
void CellWriter<D>::add_made(CellId c) {
  cell_numbers_.number(index(c), static_cast<std::uint32_t>(made_.size()));
  made_.push_back(c);
  const ConstraintRecord<D>* constraints = mesh_->constraints(c);
  all_.made.push_back(
      {corners(mesh_->cell(c).vertices), {}, mesh_->region(c), constraints ? std::uint16_t{1} : std::uint16_t{0}});
  if (constraints) all_.constraints.push_back(*constraints);
}

template <int D>
void CellWriter<D>::add_changed(CellId c) {
  std::uint32_t hull_faces = 0;
  for (std::uint32_t f = 0; f <= D; ++f) hull_faces |= mesh_->cell(c).links[f] == Link() ? 1u << f : 0u;
  all_.changed.push_back({corners(mesh_->cell(c).vertices), hull_faces, *mesh_->constraints(c)});
}

template <int D>
SentCells<D> CellWriter<D>::take() {
  for (std::size_t i = 0; i < made_.size(); ++i)
    for (std::size_t f = 0; f <= D; ++f) {
      const Link link = mesh_->cell(made_[i]).links[f];
      const std::uint32_t number = link ? cell_numbers_.find(index(link.cell())) : none;
      const Link sent = !link ? link : number == none ? Link::not_held() : Link(CellId{number}, link.face());
      all_.made[i].links[f] = sent.code;
    }
  return std::exchange(all_, {});
}

template struct SentCells<2>;
template struct SentCells<3>;
template class CellWriter<2>;
template class CellWriter<3>;

}  // namespace pgdr::detail
