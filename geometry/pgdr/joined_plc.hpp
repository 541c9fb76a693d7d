// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Several inputs as one. A pure function; any thread.
#pragma once

#include <span>
#include <string>

#include "pgdr/export.hpp"
#include "pgdr/plc.hpp"

namespace pgdr PGDR_API {

/// One input that has everything of several, one after the other: points, segments, facets, holes, regions. Points at one place
/// stay apart here; they become one in the Domain, as in any input.
///
/// Each input is a body (`Plc::facet_bodies`), or has several of its own, and keeps what it has apart from the others: a marker
/// is that of one input alone. An input keeps its number unless it is 0, or an input before has it; then it gets the least
/// positive one that no input has and nobody got before, in the order of inputs and markers. Segments in 3D, and points, without
/// a marker stay so. Labels of regions are treated alike. Each marker of a facet (2D: segment) has a name then: its own, else
/// that of its input where it has one marker alone or this one is 0, else that with ":" and the number it had; where inputs have
/// the same name, those of each get that of their input and ":" before it, and what is the same even then gets ":2", ":3", ... A
/// body is called as its only marker is, where that had a name, else as its input.
///
/// The tolerance is the largest of those given; coordinates are floats if those of any input are; attributes that an input's
/// points lack are 0.
/// @param inputs  where there is one alone it comes back as it is
/// @param names  what each input is called; empty, or "" for one: as its file is, without folder and extension, else
///   "input1", ...
/// @throws UsageError bad_option: another number of names than of inputs, or no input; ResourceError ids_exhausted: more points
///   than can be numbered
template <int D>
Plc<D> joined(std::span<const Plc<D>> inputs, std::span<const std::string> names = {});

}  // namespace pgdr
