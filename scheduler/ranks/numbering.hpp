// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The canonical numbering (compact/compact.hpp) of a mesh of which each rank has a part, in 64 bits. No rank gets more than its
// part of it.
#pragma once

#include <span>

#include "compact/point_data.hpp"
#include "mesh/mesh.hpp"
#include "pgdr/domain.hpp"
#include "pgdr/mesh_piece.hpp"
#include "space/pieces.hpp"
#include "transport/collectives.hpp"

namespace pgdr::detail {

/// The piece of this rank of the finished mesh: that which piece_of() gives of the whole, without leaves. All ranks call it.
/// @param mesh  has the rank's own cells, whole with their constraints, and may have others
/// @param own  the rank's own cells. Each cell of the whole mesh is one of exactly one rank
/// @param region_attributes  the attribute of each region number, on all ranks alike; empty: cells get no labels
/// @param pieces  the threads; the result does not depend on them
template <int D>
MeshPiece<D> number_on_ranks(Collectives& ranks, const Mesh<D>& mesh, std::span<const CellId> own, const Domain<D>& domain,
                             std::span<const double> region_attributes, const PointData<D>& data, const Pieces& pieces);

/// Which other ranks have each point of the pieces, of which each rank gives its own. All ranks call it.
template <int D>
SharingRanks sharing_of(Collectives& ranks, const MeshPiece<D>& piece);

}  // namespace pgdr::detail
