// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The invariants of a mesh, which hold between any two insertions; for assertions. Any thread, while nobody writes.
#pragma once

#include "mesh/mesh.hpp"

namespace pgdr::detail {

/// Are links symmetric and do linked cells share their face's vertices; are all cells positively oriented; do both sides of
/// a face agree on its constraint and on its edges'; is every open face constrained; and is no trace of a cavity left?
/// @pre the exterior is carved away: no ghosts.
template <int D>
bool is_whole(const Mesh<D>& mesh);

extern template bool is_whole<2>(const Mesh<2>&);
extern template bool is_whole<3>(const Mesh<3>&);

}  // namespace pgdr::detail
