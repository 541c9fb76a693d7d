// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Bodies: what the facets of an input mean as solids, where these overlap, touch or lie in each other, and which volumes are
// meshed of it. Winding numbers say it: the winding number w of a volume for a body is how often the body's surface goes round
// it. Pure functions; any thread.
//
// A body is what Plc::facet_bodies says; without that, it is what hangs together by edges of facets, and what is open like that
// hangs together along its open edges, too. A closed body whose facets look inwards, in the inside of another one, is a cavity of
// that one and belongs to it. Facets that look outwards run counter-clockwise as seen from outside. If a file (without
// facet_bodies the whole input; else each body) has a negative volume it is reversed as a whole; nothing else is. Of bodies that
// are not closed as they are given, facets that look the other way than their neighbours are turned over first, as few as it
// takes; one whose facets have but one side, as a Moebius strip, is refused.
//
// Of a closed body w is a whole number, and exact; facets that have one and the same volume on both sides do not count. Of an
// open one it is the generalized winding number at a point of the volume (A. Jacobson, L. Kavan, O. Sorkine-Hornung: Robust
// inside-outside segmentation using generalized winding numbers, ACM Trans. Graph. 32(4), 2013; section 4), rounded; where it is
// farther than 1/4 from whole numbers a warning says so.
#pragma once

#include <cstdint>
#include <stop_token>
#include <string>
#include <vector>

#include "pgdr/arrangement.hpp"
#include "pgdr/error.hpp"
#include "pgdr/export.hpp"
#include "pgdr/plc.hpp"

namespace pgdr PGDR_API {

/// What is meshed of bodies, and how it is labelled.
enum class BodyMode {
  /// Solid is where the sum of all winding numbers is positive (if it is so nowhere: where it is not 0); a label each connected
  /// solid. Facets between solid and solid, and between void and void, are dropped.
  united,
  /// Solid is where the winding number of any body is not 0; a label each set of such bodies, connected or not. No facet is
  /// dropped.
  fragments,
  /// As `fragments`, but of the bodies of a volume the first one has it; a label each body. A facet that has the same body on
  /// both sides is dropped, unless it is that body's own; so is one with void on both sides.
  priority,
  /// As `fragments`, but a volume of two bodies is an error.
  disjoint,
};

/// What has one label.
struct BodyRegion {
  double label = 0;                   ///< of its cells
  double volume = 0;                  ///< an exact sum over the coordinates of what bounds it, rounded once
  std::vector<std::uint32_t> bodies;  ///< whose winding number is not 0 there (`priority`: the first of them), ascending
};

/// How bodies are told.
struct BodyOptions {
  bool resolve_crossings = false;                 ///< as the function of that name does; else facets must not cross
  SharedMarker markers = SharedMarker::smallest;  ///< with that, of pieces that several facets cover
  std::stop_token stop = {};                      ///< ends it, from any thread, by a CancelledError
};

/// An input whose seeds say which bodies are where.
struct WithBodies {
  /// For RegionMode::seeds. Facets that are left, as they were; of those that are left in part, the pieces. Seeds of the input,
  /// then one a region or void that has none. Points that only dropped facets had are dropped. A label without a name gets those
  /// of its bodies, with "+" between, if all have names.
  Plc<3> plc;
  std::vector<BodyRegion> regions;      ///< by label, ascending
  std::vector<std::string> body_names;  ///< of each body, in the order of their first facets: Plc::body_names, or ""
  std::vector<Diagnostic> repairs;      ///< as resolve_crossings says
  /// unsure_volume; inconsistent_orientation: what was turned over; ambiguous: volumes so thin that no point of doubles is
  /// inside, which count to those beside them, without the largest piece between them.
  std::vector<Diagnostic> warnings;
};

/// Seeds win, as with RegionMode::automatic: a region seed makes its solid or void a solid with the seed's label, a hole seed
/// makes it void. Other regions get the labels 1, 2, 3, ... that no seed has, in the order of their least points (compared by
/// coordinates, then the next ones); with `priority` in the order of the bodies. So what comes out depends on the order of bodies
/// with `priority` alone. About 10 microseconds a facet on the threads of the caller's tbb::task_arena, the same for any number
/// of them.
/// @param plc its facets may overlap in a plane, repeat, touch, or lie in each other
/// @param mode what is meshed, and how it is labelled
/// @param options whether facets may cross, too; what ends it
/// @throws DiagnosedError for facets that cross; InputError entities_intersect, if resolving crossings has no end,
/// not_orientable,
///   bodies_overlap (`disjoint`; one diagnostic a volume, `ids` are its bodies), ambiguous: a surface that no ray tells the place
///   of; what Domain throws; CancelledError
WithBodies with_bodies(const Plc<3>& plc, BodyMode mode, const BodyOptions& options = {});

}  // namespace pgdr
