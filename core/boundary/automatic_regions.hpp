// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// What RegionMode::automatic and the order of numbers (region_mode.hpp) ask of the components of a mesh whose boundary is
// recovered. Serial.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "mesh/mesh.hpp"
#include "pgdr/domain.hpp"
#include "space/bulk.hpp"

namespace pgdr::detail {

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
