// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The independent checker: decides from the input and the finished mesh alone whether the mesh is sound, Delaunay,
// conforming and within its bounds. It shares nothing with the refiner but the predicates and the bound tests.
// Any thread; no state. Exact arithmetic wherever a verdict depends on a sign.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "pgdr/domain.hpp"
#include "pgdr/output_mesh.hpp"
#include "pgdr/sizing.hpp"

namespace pgdr {

/// Why a cell stayed over a bound; one entry of the report's `bounds.reasons`.
struct PoorReason {
  enum class Code { small_angle, rounding, beyond_theory };
  std::uint32_t cell = 0;  ///< index into OutputMesh::cells
  Code code = Code::small_angle;
  std::array<EntityRef, 2> entities;  ///< input entities (of the Domain) that meet at the angle
  double angle = 0;                   ///< degrees
};

template <int D>
struct CheckOptions {
  const Domain<D>* domain = nullptr;  ///< null: no conformity, no regions
  double radius_edge_bound = std::numeric_limits<double>::infinity();
  SizingField<D> size;                ///< circumradius (3D) or area (2D) bound at the centroid
  double max_measure = std::numeric_limits<double>::infinity();  ///< volume (3D) bound of all cells
  const std::vector<PoorReason>* reasons = nullptr;
  /// Widest distance, in ulps of the entity's largest coordinate, of a vertex from the line or plane it is on.
  int conformity_ulps = 2;
  std::size_t max_listed = 20;        ///< at most so many findings of one kind in words; all are counted
};

struct CheckFinding {
  enum class Kind {
    bad_index, repeated_vertex, duplicate_point, unreferenced_point, inverted_cell, bad_link, overlapping, not_delaunay,
    missing_input_point, segment_not_conforming, facet_not_conforming, wrong_marker, stray_constraint,
    wrong_region, wrong_volume, hole_filled, over_radius_edge, over_size, bad_reason,
  };
  Kind kind;
  std::string message;
  std::vector<std::int64_t> ids;
};
std::string_view name(CheckFinding::Kind kind);

struct CheckReport {
  std::uint64_t not_delaunay_rounding = 0;  ///< local violations that moving slanted points by conformity_ulps cancels
  std::uint64_t not_delaunay_refused = 0;   ///< other violations, beside an entity whose split was refused (in reasons)
  std::uint64_t over_radius_edge = 0, over_size = 0;  ///< cells over a bound
  std::uint64_t explained = 0;                        ///< of these, cells with a reason that holds
  std::vector<CheckFinding> findings;                 ///< what makes the check fail, at most max_listed a kind
  std::uint64_t finding_count = 0;                    ///< all of them
  /// 0: everything holds; 1: sound and conforming, over a bound only where the reasons explain it; 6: anything else.
  int exit_code() const;
};

/// Runs all checks for which `options` has the data.
template <int D>
CheckReport check(const OutputMesh<D>& mesh, const CheckOptions<D>& options);

}  // namespace pgdr
