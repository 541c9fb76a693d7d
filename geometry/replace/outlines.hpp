// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "pgdr/plc.hpp"
#include "replace/complex.hpp"

namespace pgdr::detail {

/// Faces of one flat group that hang together across plain edges, as one facet: its outer polygon, those of its holes with their
/// seeds, and kept edges inside of it. By numbers of the complex. None where its outline touches itself, or comes so near to
/// itself that it is none once points on its edges are rounded: then its triangles have to do.
std::optional<Plc<3>::Facet> polygon_of(const SurfaceComplex& surface, std::span<const std::uint32_t> faces);

}  // namespace pgdr::detail
