// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The canonical numbering (compact/compact.hpp) of a mesh of which each rank has a part, in 64 bits. No rank gets more than its
// part of it.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "compact/point_data.hpp"
#include "mesh/mesh.hpp"
#include "pgdr/domain.hpp"
#include "pgdr/mesh_piece.hpp"
#include "ranks/own_cell.hpp"
#include "space/pieces.hpp"
#include "transport/collectives.hpp"

namespace pgdr::detail {

/// The piece of this rank of the finished mesh: that which piece_of() gives of the whole, without leaves. All ranks call it.
/// @param mesh  has the rank's own cells, whole with their constraints, and may have others. It is taken apart: its memory is
///   used for the piece, so that the rank needs little more than for the mesh
/// @param region_attributes  the attribute of each region number, on all ranks alike; empty: cells get no labels
/// @param pieces  the threads; the result does not depend on them
/// @param unused  gets the points of the Domain that no cell has, ascending, on all ranks
/// @param drop  the mesh is without these
/// @param most_narrow  if there are more points than that, their numbers take 64 bits in messages of cells, not 32: for tests
template <int D>
MeshPiece<D> number_on_ranks(Collectives& ranks, Mesh<D>& mesh, const IsOwnCell& is_own, const Domain<D>& domain,
                             std::span<const double> region_attributes, const PointData<D>& data, const Pieces& pieces,
                             std::vector<std::uint32_t>& unused, bool drop = false,
                             std::uint64_t most_narrow = std::numeric_limits<std::uint32_t>::max());

/// Which other ranks have each point of the pieces, of which each rank gives its own. All ranks call it.
template <int D>
SharingRanks sharing_of(Collectives& ranks, const MeshPiece<D>& piece);

}  // namespace pgdr::detail
