// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Cells in messages. A message has vertices with their coordinates, by which another rank knows them, and cells by the numbers of
// these. The order of the vertices of a cell is part of what a mesh is: refinement reads it.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "mesh/mesh.hpp"
#include "transport/message.hpp"

namespace pgdr::detail {

/// A vertex in a message.
template <int D>
struct SentVertex {
  std::array<double, D> point;
  std::uint32_t home;
  float relaxed_radius;
};

/// The vertices of a cell, by their numbers in the message.
template <int D>
using SentCorners = std::array<std::uint32_t, D + 1>;

/// A cell in a message.
template <int D>
struct SentCell {
  SentCorners<D> vertices;
  std::array<std::uint32_t, D + 1> links;  ///< cells of the message as Link has them, by their numbers; or nothing, or not_held
  std::uint16_t region;
  std::uint16_t has_constraints;  ///< 1: the next of the constraints is its
};

/// A cell that is there, and has other constraints.
template <int D>
struct SentConstraints {
  SentCorners<D> vertices;
  std::uint32_t hull_faces;  ///< bit i: nothing is beyond face i
  ConstraintRecord<D> constraints;
};

/// What one message says of cells.
template <int D>
struct SentCells {
  std::vector<SentVertex<D>> vertices;
  std::vector<SentCorners<D>> gone;
  std::vector<SentCell<D>> made;
  std::vector<ConstraintRecord<D>> constraints;  ///< of those made that have some
  std::vector<SentConstraints<D>> changed;       ///< that stay, with other constraints

  bool empty() const { return gone.empty() && made.empty() && changed.empty(); }
  void put(MessageWriter& message) const {
    message.put(vertices);
    message.put(gone);
    message.put(made);
    message.put(constraints);
    message.put(changed);
  }
  /// @throws ResourceError internal: no such message, numbers beyond what there is, points that are none, or a cell with a vertex
  ///   twice
  static SentCells get(MessageReader& message);
};

/// Makes messages of cells. One thread.
template <int D>
class CellWriter {
 public:
  using Vertices = std::array<VertexId, D + 1>;

  /// For so many cells at most.
  CellWriter(const Mesh<D>& mesh, std::size_t most);
  void add_gone(const Vertices& vertices) { all_.gone.push_back(corners(vertices)); }
  void add_made(CellId c);
  void add_changed(CellId c);
  /// All of them, with the links between those made.
  SentCells<D> take();

  /// The vertices of all cells added so far, by their numbers.
  const std::vector<VertexId>& vertices() const { return vertices_; }
  /// Those of the cells with a vertex, by its number, that is_in says. After take(), of what that returned.
  template <class IsIn>
  static SentCells<D> part(const SentCells<D>& all, IsIn is_in);

 private:
  static constexpr std::uint32_t none = 0xffffffffu;
  /// Numbers ids in the order in which they come.
  class Numbers {
   public:
    explicit Numbers(std::size_t most);
    /// The number of the id; `next` becomes its number if it has none.
    std::uint32_t number(std::uint32_t id, std::uint32_t next) {
      Slot& slot = slots_[place(id)];
      if (slot.number == none) slot = {id, next};
      return slot.number;
    }
    std::uint32_t find(std::uint32_t id) const { return slots_[place(id)].number; }  ///< its number; none

   private:
    struct Slot {
      std::uint32_t id = 0, number = none;
    };
    std::size_t place(std::uint32_t id) const {
      const std::size_t mask = slots_.size() - 1;
      std::size_t i = (std::uint64_t{id} * 0x9e3779b97f4a7c15u >> 32) & mask;
      while (slots_[i].number != none && slots_[i].id != id) i = (i + 1) & mask;
      return i;
    }
    std::vector<Slot> slots_;
  };
  SentCorners<D> corners(const Vertices& vertices);

  const Mesh<D>* mesh_;
  SentCells<D> all_;
  std::vector<CellId> made_;
  std::vector<VertexId> vertices_;
  Numbers vertex_numbers_, cell_numbers_;
};

template <int D>
template <class IsIn>
SentCells<D> CellWriter<D>::part(const SentCells<D>& all, IsIn is_in) {
  SentCells<D> part;
  std::vector<std::uint32_t> vertex_number(all.vertices.size(), none), cell_number(all.made.size(), none);
  const auto is_any_in = [&](const SentCorners<D>& corners) { return std::any_of(corners.begin(), corners.end(), is_in); };
  const auto renumbered = [&](SentCorners<D> corners) {
    for (std::uint32_t& v : corners) {
      std::uint32_t& number = vertex_number[v];
      if (number == none) {
        number = static_cast<std::uint32_t>(part.vertices.size());
        part.vertices.push_back(all.vertices[v]);
      }
      v = number;
    }
    return corners;
  };
  for (const SentCorners<D>& gone : all.gone)
    if (is_any_in(gone)) part.gone.push_back(renumbered(gone));
  auto constraints = all.constraints.begin();
  for (std::size_t i = 0; i < all.made.size(); ++i) {
    SentCell<D> cell = all.made[i];
    const ConstraintRecord<D>* own = cell.has_constraints != 0 ? &*constraints++ : nullptr;
    if (!is_any_in(cell.vertices)) continue;
    cell_number[i] = static_cast<std::uint32_t>(part.made.size());
    cell.vertices = renumbered(cell.vertices);
    part.made.push_back(cell);
    if (own) part.constraints.push_back(*own);
  }
  for (SentCell<D>& cell : part.made)
    for (std::uint32_t& code : cell.links)
      if (const Link link = Link::from_code(code); link) {
        const std::uint32_t number = cell_number[index(link.cell())];
        code = number == none ? Link::not_held().code : Link(CellId{number}, link.face()).code;
      }
  for (SentConstraints<D> changed : all.changed) {
    if (!is_any_in(changed.vertices)) continue;
    changed.vertices = renumbered(changed.vertices);
    part.changed.push_back(changed);
  }
  return part;
}

extern template struct SentCells<2>;
extern template struct SentCells<3>;
extern template class CellWriter<2>;
extern template class CellWriter<3>;

}  // namespace pgdr::detail
