// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Numbers that change when the surroundings of cells do: whoever keeps one can tell whether a decision still holds. They are of
// coordinates: numbers of slots and vertices, which depend on timing, have no part in them.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "mesh/mesh.hpp"

namespace pgdr {

/// A hash of where the vertices are that lie opposite the first `with_neighbours` of these cells, across their faces: it changes,
/// but for a chance of 2^-64, once another cell with another such vertex is beside one of them. Nothing if one of all the cells
/// is gone.
/// @pre no other thread writes to these cells and those beside them
template <int D>
std::optional<std::uint64_t> surroundings_of(const Mesh<D>& mesh, std::span<const CellName> cells, std::size_t with_neighbours);

/// A hash of where the vertices of the cell are, in its order. No two cells have one, but for a chance of 2^-64. @pre as above
template <int D>
std::uint64_t place_hash(const Mesh<D>& mesh, CellId c);

/// 3D: a hash of how often the cells at the corners of this one have changed (VertexNote::version). Not at those of its
/// neighbours, which another visit may own. @pre this visit owns the cell, or none runs
template <int D>
std::uint64_t versions_at(const Mesh<D>& mesh, CellId c);

}  // namespace pgdr
