// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// What is done to an input on request, before anything else: what flags ask for, and what is tried on one that is refused. Prints
// nothing.
#pragma once

#include <optional>
#include <stop_token>
#include <vector>

#include "pgdr/bodies.hpp"
#include "pgdr/error.hpp"
#include "pgdr/plc.hpp"

namespace pgdr::tool {

struct Treatment {
  bool convex_hull = false;
  bool close_openings = false;  ///< 3D
  bool resolve_crossings = false;
  std::optional<SharedMarker> markers = {};  ///< 3D, with resolve_crossings
  std::optional<BodyMode> bodies = {};       ///< 3D

  bool is_any() const { return convex_hull || close_openings || resolve_crossings || bodies; }  ///< is anything to be done?
};

/// The input with its hull, its planar openings closed, its crossings resolved; the latter not where bodies are asked for, with
/// which they are.
/// @param repairs gets what was done. @throws InputError where crossings have no end; CancelledError (3D)
template <int D>
Plc<D> treated(Plc<D> plc, const Treatment& how, std::vector<Diagnostic>& repairs, const std::stop_token& stop = {});

/// One sentence of the openings that were closed, for the warnings; none if none was.
std::optional<Diagnostic> warning_of_openings(const std::vector<Diagnostic>& repairs);

}  // namespace pgdr::tool
