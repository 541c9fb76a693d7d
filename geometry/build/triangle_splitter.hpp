// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>

#include "build/contact_resolver.hpp"

namespace pgdr::detail {

/// Splits the triangles of facets at points on their edges and (pairs of triangle and point, sorted) inside them.
void split_triangles(const BuildInput<3>& in, const PointsOnEdges<3>& on_edges, std::span<const PointOn> inside,
                     FacetTriangles& faces, BuildReport<3>& report);

}  // namespace pgdr::detail
