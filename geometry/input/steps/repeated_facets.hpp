// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "input/steps/build_input.hpp"
#include "input/steps/build_report.hpp"
#include "input/steps/facet_triangles.hpp"

namespace pgdr::detail {

/// Drops facets that have the same triangles as an earlier one.
void drop_repeated_facets(const BuildInput<3>& in, FacetTriangles& faces, BuildReport<3>& report);

}  // namespace pgdr::detail
