// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Joins pieces to the mesh that they are of. Nothing about them is believed, since they may come from files, but that vertex
// indices are in range and labels as many as rows.
#pragma once

#include <span>
#include <string>

#include "pgdr/mesh_piece.hpp"

namespace pgdr::detail {

/// What a mesh has.
template <int D>
typename MeshPiece<D>::Totals totals_of(const OutputMesh<D>& mesh);
/// All of the mesh, as the only piece.
template <int D>
MeshPiece<D> whole_piece(OutputMesh<D> mesh);

/// What a piece has of piece k of `count` of the same mesh.
template <int D>
MeshPiece<D> part_of_piece(const MeshPiece<D>& piece, std::uint64_t k, std::uint64_t count);
/// Piece k of `count`: of what each of the pieces of another division has of it, in their order. @pre there are some
template <int D>
MeshPiece<D> joined_parts(std::span<const MeshPiece<D>> parts, std::uint64_t k, std::uint64_t count);

/// A piece, and what it is called in messages: its file, or nothing.
template <int D>
struct PieceView {
  const MeshPiece<D>* piece;
  std::string name;
};

/// As join_pieces(), with the file in what it throws. `whole` is what the mesh is called.
template <int D>
OutputMesh<D> join_views(std::span<const PieceView<D>> pieces, const std::string& whole);

}  // namespace pgdr::detail
