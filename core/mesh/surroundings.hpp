// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Numbers that change when the surroundings of cells do: whoever keeps one can tell whether a decision still holds.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "mesh/mesh.hpp"

namespace pgdr {

/// A hash of which cells are in these slots and, unless `alone`, beside them: it changes, but for a chance of 2^-64, once any of
/// them is another cell. Nothing if one of the slots is empty. @pre no other thread writes to these cells
template <int D>
std::optional<std::uint64_t> surroundings_of(const Mesh<D>& mesh, std::span<const CellId> slots, bool alone = false);

/// 3D: a hash of how often the cells at the corners of this one have changed (VertexNote::version). Not at those of its
/// neighbours, which another visit may own. @pre this visit owns the cell, or none runs
template <int D>
std::uint64_t versions_at(const Mesh<D>& mesh, CellId c);

}  // namespace pgdr
