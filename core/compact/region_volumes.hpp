// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The volumes of regions (2D: areas), as meshed and as given, both by the divergence theorem and exactly: over the subfacets
// between two labels, and over those triangles of the input's facets in whose place these are.
#pragma once

#include <span>
#include <vector>

#include "mesh/mesh.hpp"
#include "pgdr/region_volume.hpp"
#include "space/pieces.hpp"

namespace pgdr {

/// One entry a label that cells have, ascending. Needs a time in proportion to the subfacets, and a look at every cell's tag.
/// @param pieces  the threads
/// @param region_attributes  the attribute of each region number; empty: cells get no labels
/// @pre the exterior has been carved away
template <int D>
std::vector<RegionVolume> region_volumes(const Mesh<D>& mesh, const Domain<D>& domain, std::span<const double> region_attributes,
                                         const detail::Pieces& pieces);

}  // namespace pgdr
