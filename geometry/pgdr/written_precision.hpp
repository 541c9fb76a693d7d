// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// How exact the coordinates of a file can be, by the digits that they have, or by how far faces that look planar are off.
// Programs print six digits, or store floats; a planar face that is slanted, and made of triangles, is then planar up to these
// digits only. Once it was turned, or converted to other units, its coordinates have all digits again. Pure functions; any
// thread.
#pragma once

#include <cstddef>
#include <span>

#include "pgdr/domain.hpp"
#include "pgdr/export.hpp"
#include "pgdr/types.hpp"

namespace pgdr PGDR_API {

/// A Plc::precision with which faces are planar that were so before their coordinates were rounded: 10^(1 - n) for coordinates
/// of at most n significant digits, n from 5 to 7 (no coordinate is off by more than half of that times its size); 2^-22 for
/// numbers of 8 or 9 digits, and for floats; else 2^-48, for rounding alone: coordinates of up to four digits count as exact.
/// What is scaled by a power of two or of ten has the digits that it had, although the latter rounds.
double written_precision(std::span<const Point3> points);

/// Plc::precision by that, for files whose numbers are floats (.stl, and .ply if it says so). Theirs are rounded by so much more
/// than doubles that a planar face of triangles is none any more once it is turned.
void set_precision_of_file(Plc<3>& plc);

/// Likewise for a file of other numbers, of six or seven digits or of floats, if many facets that are coplanar by these are
/// needles which rounding alone keeps apart: if a third of the elements that the facets take for their shapes are in such. Where
/// the numbers have all digits of a double, as such a file's have once it was turned, or are floats that may have been converted
/// before, by how far facets are off the planes of others, of faces alone that are planar within that as a whole: as
/// apparent_precision, of doubles with a third as many in the gap. Else facets are left as they are. Takes some microseconds a
/// triangle at most; the input need not be valid.
void set_precision_of_digits(Plc<3>& plc);

/// Plc::merge_within 1e-13 for a file of floats (Plc::precision_of_file) with points that miss each other by no more than that,
/// as what a program computed for zero does, if the input is valid then; else it stays 0, and walls that are as thin stay.
/// Takes a microsecond a point where there are such zeros, and a diagnosis where points miss each other; nothing to speak of
/// else.
void set_merge_of_file(Plc<3>& plc);

/// A Plc::precision with which faces are planar that look so: four times a distance d, of a facet from the plane of a larger one
/// that it meets at a segment (of the largest coordinate of both), where few or no distances lie between d and 10 d: of all
/// below, a twentieth at most. The largest such d up to 1e-5, if a twentieth of all segments are between facets that are less off
/// (but by more than rounding). Else 2^-48.
double apparent_precision(const Domain<3>& domain);

/// At most how many facets fewer there are with that Plc::precision: segments between facets that are so little off each other's
/// planes.
std::size_t most_facets_saved(const Domain<3>& domain, double precision);

/// By the digits, or where these tell nothing by the looks: what a Domain of it should be made with, if faces that look planar
/// are to be one facet each; no less than it has. 2^-48 where no Domain can be made.
double suggested_precision(const Plc<3>& plc);

}  // namespace pgdr
