// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The volumes of regions of a mesh of which each rank has a part. They are sums over the walls: one rank gets the cells at these,
// which are few beside all.
#pragma once

#include <span>
#include <vector>

#include "mesh/mesh.hpp"
#include "pgdr/domain.hpp"
#include "pgdr/region_volume.hpp"
#include "ranks/own_cell.hpp"
#include "space/pieces.hpp"
#include "transport/collectives.hpp"

namespace pgdr::detail {

/// region_volumes() of the whole mesh, on all ranks, which call it.
template <int D>
std::vector<RegionVolume> region_volumes_on_ranks(Collectives& ranks, const Mesh<D>& mesh, const IsOwnCell& is_own,
                                                  const Domain<D>& domain, std::span<const double> region_attributes,
                                                  const Pieces& pieces);

}  // namespace pgdr::detail
