// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "join/build_input.hpp"
#include "join/build_report.hpp"
#include "join/facet_triangles.hpp"

namespace pgdr::detail {

/// Drops facets that have the same triangles as an earlier one.
void drop_repeated_facets(const BuildInput<3>& in, FacetTriangles& faces, BuildReport<3>& report);

}  // namespace pgdr::detail
