// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Which parts of facets are in the mesh. Of a facet that sticks out of the volumes, or into a void, what is not meshed makes no
// angle that a cell would have to live with: a reason may not name it.
#pragma once

#include <cstdint>
#include <vector>

#include "mesh/mesh.hpp"
#include "pgdr/domain.hpp"

namespace pgdr {

/// Of each triangle of all facets of the Domain: has the mesh the part that it is of? Empty if it has all, and in 2D. Near-linear
/// in triangles of facets and in cells. @pre the facets are in the mesh, and what is outside is not any more.
template <int D>
std::vector<std::uint8_t> meshed_triangles(const Mesh<D>& mesh, const Domain<D>& domain);

}  // namespace pgdr
