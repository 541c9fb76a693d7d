// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Ids of cells and vertices of the mesh under refinement.
#pragma once

#include <concepts>
#include <cstdint>

namespace pgdr {

/// The id of a vertex. It is converted explicitly where an array is indexed, nowhere else. (A finished mesh has plain indices,
/// see OutputMesh.)
enum class VertexId : std::uint32_t {};
/// The id of a cell: of its slot, which may hold another cell later (Mesh::birth).
enum class CellId : std::uint32_t {};
inline constexpr VertexId no_vertex{0xffffffffu};  ///< no vertex has this id
inline constexpr CellId no_cell{0xffffffffu};      ///< no cell has this id

/// A cell, and no other that the slot holds later.
struct CellName {
  CellId cell;          ///< its slot
  std::uint16_t birth;  ///< Mesh::birth
};

/// The id as an index of an array.
template <class Id>
requires std::same_as<Id, VertexId> || std::same_as<Id, CellId>
constexpr std::uint32_t index(Id id) { return static_cast<std::uint32_t>(id); }

}  // namespace pgdr
