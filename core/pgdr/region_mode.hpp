// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Which of the volumes (2D: areas) that the facets (segments) of an input separate are meshed, and their labels.
//
// `seeds`: all but the outside and those of hole seeds; those of region seeds have the seed's attribute, others 0.
//
// `automatic`: solids are told from voids by nesting. Two volumes are neighbours if a facet lies between them. Whoever
// walks from the outside through facets passes from void to solid and from solid to void in turn, wherever that is
// consistent: so of closed surfaces, one in the other or touching at points and edges, every second bounds a void. It
// is not consistent where an odd number of facets leads back to where one was (a wall inside of a body, bodies with a
// common facet): then all volumes of that group (a biconnected component of the graph of neighbours) are solid where
// the volume is void through which the group is entered, and void where it is solid. Facets with the same volume on both
// sides do not matter. Seeds win: a hole seed makes its volume void, a region seed solid, with the seed's attribute; they
// do not change what other volumes are. Solids without seed get the labels 1, 2, 3, ... that no seed has, in the order
// of their least segments: segments are compared by the coordinates of their lesser end, then of the other, and of two
// volumes that have the least one both, the next decides, as words are ordered by their letters.
//
// `all`: all but the outside and those of hole seeds, as with `seeds`; each without a region seed is numbered, in the same
// order and likewise without the labels that seeds have. So it is a region of its own wherever facets enclose it.
#pragma once

namespace pgdr {

/// How regions are found and labelled.
enum class RegionMode { seeds, automatic, all };

/// Does each kept volume without a region seed get a number for its label?
constexpr bool numbers_volumes(RegionMode mode) { return mode != RegionMode::seeds; }

}  // namespace pgdr
