// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The volumes of the input, in terms of the mesh: those that its walls separate, together with what was given and is not in
// the mesh. Once each wall is known to lie on something given, and the other way round, that is the input up to the reaches.
#pragma once

#include "given/match.hpp"
#include "given/regions.hpp"

namespace pgdr::checking {

/// The walls of the mesh, in their order; then what is left over, in simplices whose corners are those
/// of the mesh wherever they are within reach of these.
template <int D>
VolumeWalls<D> walls_of_mesh(const GivenTask<D>& task, const GivenMatch<D>& match);

/// No wall that is not in the mesh bounds a volume that is to be meshed.
template <int D>
void check_further_walls(const GivenTask<D>& task, const InputVolumes<D>& volumes);

/// Measures of volumes against those of the given facets (2D: segments) about them, where these close exactly: as many of
/// them run along each edge (2D: point) one way as the other. By how much they may differ: the area of the walls times the
/// reach, and their perimeter times its square.
template <int D>
void check_given_measures(const GivenTask<D>& task, const GivenMatch<D>& match, const InputVolumes<D>& volumes);

}  // namespace pgdr::checking
