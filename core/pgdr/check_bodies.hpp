// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The checker's own look at bodies: how often the facets, as they were given, go round the cells. It shares nothing with what
// gave the mesh its seeds (bodies.hpp) but the meaning of BodyMode. Any thread; no state.
#pragma once

#include <optional>
#include <stop_token>
#include <string>

#include "pgdr/bodies.hpp"
#include "pgdr/check.hpp"
#include "pgdr/export.hpp"

namespace pgdr PGDR_API {

/// What check_bodies could verify.
struct BodyCheck {
  bool done = false;     ///< all of it
  std::string left_out;  ///< else why not, in words
};

/// Verifies that a mesh of with_bodies has the right cells in the right regions. In each part of the mesh that walls bound, exact
/// rays from the middle of its largest cell count how often they cross each body's facets one way, less the other way:
///
/// * `united`: the sum is positive; and the least point of each body is in the mesh.
/// * others: equal labels have equal sets of bodies (`priority`: first bodies), and no others have; none is empty.
/// * `fragments`, `disjoint`: each body's volume, the exact sum over its facets, is that of the parts in it, as often as it goes
///   round them, up to (area of its facets) (T + u) + (their perimeter) (T + u)^2, with T and u as in check.hpp.
///
/// Bodies have to be closed and to look one way as they are given, edge by edge of the same coordinates; what is open is left
/// out, and so is an input with seeds, since these win. About 5 microseconds a cell and a facet, on the calling thread.
/// @param mesh with labels
/// @param given what with_bodies was given, not what it made
/// @param mode that of with_bodies
/// @param tolerance CheckOptions::tolerance
/// @param report of check() for the same mesh: gets findings (wrong_region, wrong_volume) if it has none
/// @param stop ends it, from any thread, by a CancelledError
/// @throws what check() throws
BodyCheck check_bodies(const OutputMesh<3>& mesh, const Plc<3>& given, BodyMode mode, std::optional<double> tolerance,
                       CheckReport& report, const std::stop_token& stop = {});

}  // namespace pgdr
