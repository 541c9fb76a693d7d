// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// When a Steiner point may be inserted, so that every run ends, whatever the input angles.
//
// Each vertex p has a home (the input vertex, segment or facet it lies on, or the volume) and a relaxed insertion radius
// R(p): infinity for input vertices. The relaxed length of an edge uv is |uv| between input vertices and between vertices
// of entities that do not touch, else max(|uv|, min(R(u), R(v))). (Between entities that do not touch an edge is no child
// of a small angle, though both ends may have inherited a large R from one: asked for more, the cells of a thin wall
// would stay poor without a small angle anywhere near.) Let r(x) be the distance from a new point x to the nearest vertex
// of its cavity (of a subsegment that is split for something else, in 3D: of all cells in conflict with it, cut back or not). x is inserted only if r(x) >= d, and gets R(x) = max(r(x), h), where
//   * for a poor element, or an entity that it encroaches upon or that hides its point: d is the least relaxed length
//     of the element's edges (of an element only too big, at most half its circumradius); h = 0. In 2D c times that
//     length is d, and that length is h; in 3D so for an entity that is split for an element of poor shape, where the
//     radius-edge bound is below the smallest proved one, and for what is poor once all else is done, but for elements
//     at angles below 20 degrees, or at input vertices without one below 60, that have a reason; whether a point goes in at the
//     circumcentre, inside of the element, or on an entity;
//   * for an entity encroached upon by q, the cavity's nearest vertex that is none of the entity's: if q is an input
//     vertex or the entities of q and x do not touch, d = h = 0 (r(x) is then at least the least distance of disjoint
//     entities; passed on from a facet to a segment, d = |xq| / 2); else d = c R(q), h = R(q); in 3D d = R(q) where the
//     two meet at less than 60 degrees;
//   * for a missing subsegment or subfacet of the boundary recovery: d = h = 0;
//   * 3D: for a point of a subsegment with twins, on other segments as far from a common end (twins.hpp), r(x) here is the
//     distance from the nearest other vertex; likewise in the recovery;
//   * 2D: for a point of a subsegment on a shell (shells.hpp), the first at its end or no nearer to it than q, on another
//     segment there, d = 0 in any case, and h is at least R(q).
// c = 1/2. Since R is inherited along a chain of small angles the factor c is paid once, not once a link: with lambda =
// min(half the least distance of disjoint entities, the shortest edge of the recovered mesh, half the least size, the least
// first shell) relaxed lengths are at least lambda as long as R is, and every Steiner point of the refinement has R >=
// lambda and r >= c lambda, by induction over the insertions (on shells: r >= c lambda min(1, 2 sin(a / 2)), a the least
// angle between segments, as distances from their end do not shrink from one shell to the other, nor, of twins, from one to
// the other). Mutually visible vertices are thus c lambda apart, and the domain is bounded: finitely many insertions.
// Vertices of the volume that are taken out again (change/rewrap.hpp) are finitely many, too. Without inheritance c would
// have to be 1. (That it is 1 at small angles in 3D is for the size of the meshes, not for the proof: docs/performance.md.)
// What ends a run in 3D follows rules of its own (improve/improve.cpp). Pure functions; any thread.
#pragma once

#include <array>
#include <optional>

#include "mesh/entity_pair.hpp"
#include "mesh/mesh.hpp"

namespace pgdr {

inline constexpr double inherited_fraction = 0.5;  ///< c
inline constexpr double small_angle = 60;  ///< degrees; 3D: entities that meet at less are split less often
inline constexpr double sharp_angle = 20;  ///< degrees; 3D: there nothing asks for less in the end

/// What an insertion asks for: r(x) >= d, and R(x) is at least h.
struct Demand {
  double d = 0;  ///< least distance from the cavity's vertices
  double h = 0;  ///< least relaxed radius
};

/// Does a vertex with this home lie on the entity (a segment or facet)?
template <int D>
bool lies_on(const Domain<D>& domain, Home home, EntityRef entity);

/// The relaxed length of the edge between two vertices.
template <int D>
double relaxed_length(const Domain<D>& domain, const VertexRecord<D>& u, const VertexRecord<D>& v);

/// 2D: the two segments between which the shortest edge of a triangle of these corners lies, if they meet at an angle below
/// the bound and its ends are equally far from there (by a thousandth). Such a triangle is not split for its shape (after
/// Shewchuk 1997): its neighbours along the segments would have to be as small, up to where they meet. `bound`: on
/// circumradius over shortest edge.
std::optional<EntityPair> small_angle_across(const Domain<2>& domain, const std::array<const VertexRecord<2>*, 3>& corners,
                                             double bound);

/// The demand of an entity encroached upon by q.
template <int D>
Demand encroachment_demand(const Domain<D>& domain, EntityRef entity, const VertexRecord<D>& q);

}  // namespace pgdr
