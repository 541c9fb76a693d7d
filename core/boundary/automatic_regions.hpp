// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// RegionMode::automatic and the order of numbers (region_mode.hpp), on the components of a mesh whose boundary is recovered.
// Serial.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "mesh/mesh.hpp"
#include "pgdr/domain.hpp"
#include "space/bulk.hpp"

namespace pgdr::detail {

/// Whether each volume is solid, from the pairs of neighbours (of different volumes, in any order, any number of times).
/// Volume 0 is the outside. Linear time.
/// @pre all volumes can be reached from the outside
std::vector<bool> solid_by_nesting(std::uint32_t volumes, std::vector<std::array<std::uint32_t, 2>> neighbours);

/// Pairs of components with a constrained face between them, each once. `component` by slot of cells; ghosts have
/// components, too.
template <int D>
std::vector<std::array<std::uint32_t, 2>> neighbouring_components(const Mesh<D>& mesh, std::span<const std::uint32_t> component,
                                                                  const Bulk& bulk);

/// Components 0 <= c < count in the order of their least segments.
template <int D>
std::vector<std::uint32_t> components_in_order(const Mesh<D>& mesh, const Domain<D>& domain,
                                               std::span<const std::uint32_t> component, std::uint32_t count, const Bulk& bulk);

}  // namespace pgdr::detail
