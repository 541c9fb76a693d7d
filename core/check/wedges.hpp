// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Wedges: what two walls at an edge of the mesh leave to the cells between them. Decided on the walls of the mesh, which
// conformity holds to the input: whatever fills the wedge between these has dihedral angles that add up to the wedge's own.
#pragma once

#include <optional>

#include "given/links.hpp"

namespace pgdr::checking {

/// Two walls at an edge: its ends, and the corners opposite.
using Wedge = std::array<Point3, 4>;

/// The walls that the cell is between at its edge `edge`, if they make an angle below the one with this cosine on its side.
/// Exact.
std::optional<Wedge> wedge_below(const OutputMesh<3>& mesh, const Links<3>& links, std::uint32_t cell, int edge,
                                 double largest_cosine);

}  // namespace pgdr::checking
