// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The encroachment tests: which subsegments and subfacets have a vertex, or a point that is to go in, in their diametral
// (equatorial) balls (theory: sections 2.1 and 2.2). Queries without memory; any thread that may read the cells.
#pragma once

#include <optional>
#include <vector>

#include "cavity/cavity.hpp"
#include "refine/context.hpp"
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
/// the volume are never inserted inside a diametral ball. So no such split has one near, and none has to be deleted.) With
/// RefineOptions::conforming_delaunay it does whenever it is inside, and such a split is not refused by the insertion rule.
///
/// That still ends. Call what is split for a vertex of the boundary a closing split. Its piece, of length L, has a vertex of
/// another segment inside its diametral circle, which is nearer than L/2 to it. (a) Of segments that do not touch, L is more than
/// twice their distance. (b) Of segments that meet at an angle a (below 90 degrees, or none is inside), the piece being at least
/// rho away from there, their distance there is at least rho sin a, so L is more than twice that. (c) A piece that begins at a
/// common end v, with a vertex inside at distance s from there: at 60 degrees or more s is less than half of it, and its half is
/// no shorter than the neighbour's first piece. At less it is split on a shell about v (rule/shells.hpp). If it ended on one, it
/// is halved, and if s is a shell, too, its half is no shorter than s; that one of both does not end on a shell happens once. So
/// the shortest of the first pieces at v does not get shorter without end. So closing splits between two others are finitely
/// many, and they leave no piece shorter than a length that depends on the input and on these first pieces alone. The relaxed
/// insertion radius of a new vertex is at least that of q, as without, so that R >= lambda holds for all (insertion_rule.hpp),
/// and all other insertions have r >= c lambda: finitely many vertices of the volume, and finitely many other splits, since each
/// of these takes one from the sum over all pieces of L / (c lambda), rounded down, less one, which no closing split raises.
template <int D>
bool is_face_encroached_by(const Mesh<D>& mesh, const Domain<D>& domain, CellId c, int face, VertexId v,
                           const RefineOptions<D>& options);

/// Of the smallest sphere through the corners of the face, or the ends of the edge.
template <int D>
double squared_radius_of_face(const Mesh<D>& mesh, CellId c, int face);
double squared_radius_of_edge(const Mesh<3>& mesh, CellId c, int edge);

/// 3D: do any vertices of the cell encroach upon its constrained edge?
bool is_edge_encroached(const Mesh<3>& mesh, const Domain<3>& domain, CellId c, int edge);

/// 3D: the subsegments on cells of the collected cavity in whose diametral balls x lies, each once, in the order of the cells.
template <int D>
std::vector<Entry<D>> encroached_edges(const Mesh<D>& mesh, const Cavity<D>& cavity, const Point<D>& x);

/// An entity that the collected point x of a poor element encroaches upon: one that is kept, if there is any; a subsegment, or
/// else a constrained face of the cavity's boundary, one that x projects into, if there is one. Of what is kept in 2D: a
/// subsegment with which x would make a triangle so flat that it has an angle below the bound, whatever comes after; a point that
/// merely encroaches upon it does more good than harm.
template <int D>
std::optional<Entry<D>> encroached_entity(const RefineContext<D>& context, const Cavity<D>& cavity, const Point<D>& x);

/// 2D: that subsegment that is kept.
template <int D>
std::optional<Entry<D>> flattened_face(const RefineContext<D>& context, const Cavity<D>& cavity, const Point<D>& x);

/// The facet or segment that the constrained face or edge is part of.
template <int D>
EntityRef entity_of(const Mesh<D>& mesh, const Entry<D>& e) {
  if (e.kind() == EntryKind::face) return mesh.entity_of_face(e.cell, e.which());
  return {EntityKind::segment, mesh.constraints(e.cell)->edge_entity[e.which()]};
}

}  // namespace pgdr
