// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The encroachment tests: which subsegments and subfacets have a vertex, or a point that is to go in, in their diametral
// (equatorial) balls (theory: sections 2.1 and 2.2). Queries without memory; any thread that may read the cells.
#pragma once

#include <optional>
#include <vector>

#include "cavity/cavity.hpp"
#include "pgdr/refine_options.hpp"
#include "refine/work_list.hpp"

namespace pgdr {

/// How a point encroaches upon a constrained face: not at all; from beside it; projecting into it (Projection Lemma 2.6).
enum class Encroachment { none, beside, before };

/// Does x encroach upon the constrained face, and does it project into it?
template <int D>
Encroachment encroachment(const Mesh<D>& mesh, CellId c, int face, const Point<D>& x);

/// Does the vertex encroach upon the constrained face? Vertices of the entity itself never do, though rounding may put them some
/// ulps inside a ball. In 2D a vertex of the boundary does only if the triangle with the subsegment has an angle below the bound
/// on its account, that at v above 180 degrees less twice the bound (diametral lenses, Chew 1993, Shewchuk 1997): what is no
/// obstacle to a good triangle is none, and if the triangle is poor for another reason, that splits the subsegment. (Vertices of
/// the volume are never inserted inside a diametral ball. So no such split has one near, and none has to be deleted.)
/// `radius_edge_bound`: of the run.
template <int D>
bool is_face_encroached_by(const Mesh<D>& mesh, const Domain<D>& domain, CellId c, int face, VertexId v,
                           double radius_edge_bound);

/// Of the smallest sphere through the corners of the face, or the ends of the edge.
template <int D>
double squared_radius_of_face(const Mesh<D>& mesh, CellId c, int face);
double squared_radius_of_edge(const Mesh<3>& mesh, CellId c, int edge);

/// 3D: do any vertices of the cell encroach upon its constrained edge?
bool is_edge_encroached(const Mesh<3>& mesh, const Domain<3>& domain, CellId c, int edge);

/// 3D: the subsegments on cells of the collected cavity in whose diametral balls x lies, each once, in the order of the cells.
template <int D>
std::vector<Entry<D>> encroached_edges(const Mesh<D>& mesh, const Cavity<D>& cavity, const Point<D>& x);

/// An entity that the collected point x of a poor element encroaches upon: a subsegment, or else a constrained face of the
/// cavity's boundary, one that x projects into, if there is one. Where the boundary is kept (2D): a subsegment with which x would
/// make a triangle so flat that it has an angle below the bound, whatever comes after; a point that merely encroaches upon it
/// does more good than harm.
template <int D>
std::optional<Entry<D>> encroached_entity(const Mesh<D>& mesh, const Cavity<D>& cavity, const RefineOptions<D>& options,
                                          const Point<D>& x);

/// 2D: that subsegment where the boundary is kept.
template <int D>
std::optional<Entry<D>> flattened_face(const Mesh<D>& mesh, const Cavity<D>& cavity, const RefineOptions<D>& options,
                                       const Point<D>& x);

}  // namespace pgdr
