// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The insertion rule: when a Steiner point x may be inserted, so that every run ends, whatever the input angles.
//
// Each vertex p has a home, the input vertex, segment or facet that it lies on, or the volume. It has a relaxed insertion radius
// R(p), which is infinite for input vertices. The insertion radius r(x) is the distance from x to the nearest vertex of its
// cavity (1). x is inserted only if r(x) >= d, and gets R(x) = max(r(x), h). Let c = 1/2. The demand (d, h) depends on what x is
// for:
//
//   cause                                                    | 2D: d      h      | 3D: d      h
//   ---------------------------------------------------------+-------------------+------------------------------
//   a poor element (2), or an entity that blocks its point   | c l        l      | l          0        (3) (4) (9)
//   an entity encroached upon by q (5), where                |                   |
//     q is an input vertex, or their entities do not touch   | 0          0      | 0          0        (6)
//     they meet at less than 60 degrees                      | c R(q)     R(q)   | R(q)       R(q)     (7)
//     otherwise                                              | c R(q)     R(q)   | c R(q)     R(q)
//   a point of a subsegment on a shell (8)                   | 0          R(q)   | as without shells
//   a missing subsegment or subfacet of the recovery         | 0          0      | 0          0
//
// l is the least relaxed length of the element's edges. The relaxed length of an edge uv is max(|uv|, min(R(u), R(v))). It is
// |uv| between two input vertices, and between vertices of entities that do not touch: such an edge is no child of a small angle,
// though both ends may have inherited a large R from one. (Asked for more, the cells of a thin wall would stay poor without a
// small angle anywhere near.)
//
// (1) Of a subsegment that is split for something else, in 3D: of all cells in conflict with x, cut back or not. A point of a
//     subsegment with twins, on other segments as far from a common end (twins.hpp), has the distance from the nearest other
//     vertex.
// (2) Of an element that is only too big, l is at most half its circumradius.
// (3) c l and l, if an entity is split for an element of poor shape, and the radius-edge bound is below the smallest proved one.
// (4) c l and l in the last resort, when nothing else waits and no optimiser follows. Elements at angles below 20 degrees, and
//     at input vertices without an angle below 60 degrees, still demand l: they have a reason to stay poor.
// (5) q is the nearest vertex of the cavity that is none of the entity's. If a subsegment cuts the point of a subfacet off, q is
//     the nearer one of the two vertices beyond the subfacet that encroach upon it.
// (6) r(x) is then at least the least distance of disjoint entities. If the split is passed on from a facet to a segment, d is
//     half the distance from x to q.
// (7) That d is not c R(q) in 3D is for the size of the meshes, not for the proof (bench/notebook/small_angles.md).
// (8) The first shell at its end, or one no nearer to it than q is on another segment there (shells.hpp). h is at least R(q).
// (9) Of a subsegment in 2D, if r(x) is less and q is no vertex of the volume: what an entity encroached upon by q demands. It
//     may be that, and was not split for it at once (encroachment.hpp).
//
// Proof. R is inherited along a chain of small angles, so that the factor c is paid once, not once a link. Let lambda be the
// least of: half the least distance of disjoint entities, the shortest edge of the recovered mesh, half the least size, the least
// first shell. Relaxed lengths are at least lambda as long as R is. By induction over the insertions every Steiner point of the
// refinement has R >= lambda and r >= c lambda. On shells r >= c lambda min(1, 2 sin(a / 2)), where a is the least angle between
// segments: the distance from their end does not shrink from one shell to the other, nor from one twin to the other. So mutually
// visible vertices are c lambda apart (on shells, that much less). The domain is bounded: there are finitely many insertions.
// In doubles lambda could be less than their rounding, if the least distance of disjoint entities is. In 2D r >= 8 ulps of the
// largest coordinate, too (RefineContext::least_apart); what that refuses stays poor by rounding.
// Without inheritance c would have to be 1. Gift wrapping and flips insert nothing. The optimiser, which comes after all this in
// 3D, does not ask the rule; what ends it is another argument (optimize/judge.hpp).
//
// Pure functions; any thread.
#pragma once

#include <array>
#include <optional>

#include "mesh/entity_pair.hpp"
#include "mesh/mesh.hpp"

namespace pgdr {

inline constexpr double inherited_fraction = 0.5;  ///< c of the table above
inline constexpr double small_angle = 60;          ///< degrees; 3D: entities that meet at less are split less often

/// The demand of what a point is inserted for: r(x) >= d, and R(x) is at least h.
struct Demand {
  double d = 0;  ///< least insertion radius
  double h = 0;  ///< least relaxed insertion radius
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
