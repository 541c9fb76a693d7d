// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Which body each facet is of, which way it looks, and how often the facets of a body cover each piece of an arrangement: a chain
// of triangles, in the words of topology, which is closed where its edges cancel.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "pgdr/arrangement.hpp"
#include "pgdr/error.hpp"
#include "pgdr/plc.hpp"
#include "space/bulk.hpp"

namespace pgdr::detail {

/// How often a body's facets cover a piece: of those that run as its corners do, less the others.
struct PieceOfBody {
  std::uint32_t piece, body;
  int times;
  friend auto operator<=>(const PieceOfBody&, const PieceOfBody&) = default;
};

/// How often a body's facets run from a to b, less how often back.
struct EdgeOfBody {
  std::uint32_t a, b;  ///< a < b: points of the arrangement
  std::uint32_t body;
  int times;
  friend auto operator<=>(const EdgeOfBody&, const EdgeOfBody&) = default;
};

struct BodyChains {
  std::uint32_t count = 0;                   ///< of bodies
  std::vector<std::uint32_t> body_of_facet;  ///< no_entity: fewer than three corners
  std::vector<PieceOfBody> pieces;           ///< sorted; none with `times` 0
  std::vector<EdgeOfBody> open_edges;        ///< by body, then by points; none with `times` 0
  std::vector<char> is_closed;               ///< of bodies: it has no open edge
  std::vector<std::uint32_t> turned_over;    ///< facets, ascending, before bodies are reversed as a whole
};

/// What a body is called in messages: by its name, or its number.
std::string body_name(const Plc<3>& plc, std::uint32_t body);

/// @param separates  of each piece: are there different volumes on its sides? Others do not count in chains.
/// @throws InputError not_orientable
BodyChains make_chains(const Plc<3>& plc, const Arrangement& pieces, std::span<const char> separates, const Bulk& bulk);

}  // namespace pgdr::detail
