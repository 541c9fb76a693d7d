// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// What the mesher alone asks of the entities of a Domain. Pure functions, any thread.
#pragma once

#include "pgdr/domain.hpp"

namespace pgdr {

/// The parameter t of a point on (near) segment s, in [0, 1].
template <int D>
double segment_parameter(const Domain<D>& domain, EntityId s, const Point<D>& p);

/// True iff both are segments or facets (or an input vertex of one) with a common input vertex.
template <int D>
bool entities_touch(const Domain<D>& domain, EntityRef a, EntityRef b);

}  // namespace pgdr
