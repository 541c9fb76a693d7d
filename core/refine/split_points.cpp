// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "refine/split_points.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "input/entities.hpp"
#include "pgdr/predicates.hpp"

namespace pgdr {

template <int D>
std::array<double, 2> parameters_of(const RefineContext<D>& context, EntityId s, VertexId a, VertexId b) {
  const auto parameter = [&](VertexId v) {
    const Home home = context.mesh.vertex(v).home;
    if (home.kind() != EntityKind::vertex) return segment_parameter<D>(context.domain, s, context.mesh.point(v));
    return home.id() == context.domain.segments()[s].points[0] ? 0.0 : 1.0;
  };
  const double ta = parameter(a), tb = parameter(b);
  return {std::min(ta, tb), std::max(ta, tb)};
}

template <int D>
Point<D> split_point(const RefineContext<D>& context, EntityId s, VertexId a, VertexId b) {
  const auto [t0, t1] = parameters_of(context, s, a, b);
  return point_on_segment<D>(context.domain, s, context.shells.split_parameter(s, t0, t1));
}

namespace {

/// x, a rounded point of the segment pq, or, where it lies to the right of that, a next double to it on the left: along the axis
/// across which that goes farthest. (Half an ulp an axis is less than that, so that once is enough but for a rounding of 2^-104.)
Point2 rounded_to_the_left(const Point2& p, const Point2& q, Point2 x) {
  const std::array<double, 2> to_the_left{p[1] - q[1], q[0] - p[0]};
  while (orient2d(p, q, x) == Sign::negative) {
    std::array<double, 2> next, gain;
    for (int i = 0; i < 2; ++i) {
      next[i] = std::nextafter(x[i], std::copysign(std::numeric_limits<double>::infinity(), to_the_left[i]));
      gain[i] = (next[i] - x[i]) * to_the_left[i];
    }
    const int axis = gain[0] > gain[1] ? 0 : 1;
    x[axis] = next[axis];
  }
  return x;
}

/// 2D: where the subsegment opposite the corner of the cell is split. At the rim of the mesh the point is rounded inwards:
/// whatever lies beyond, a point of the input or another part of the rim, is never reached, however near it is. (Pieces of the
/// segment then are on the one side of it, between its ends, and nothing of the mesh has been between them and the segment.)
Point2 split_point_within(const RefineContext<2>& context, CellId c, int face) {
  const auto& k = context.mesh.cell(c).vertices;
  const VertexId a = k[(face + 1) % 3], b = k[(face + 2) % 3];
  const EntityId s = context.mesh.constraints(c)->face_entity[face];
  const Point2 x = split_point(context, s, a, b);
  if (context.mesh.cell(c).links[face]) return x;
  const auto& ends = context.domain.segments()[s].points;
  Point2 p = context.domain.points()[ends[0]], q = context.domain.points()[ends[1]];
  const int axis = std::fabs(q[0] - p[0]) >= std::fabs(q[1] - p[1]) ? 0 : 1;
  if ((p[axis] < q[axis]) != (context.mesh.point(a)[axis] < context.mesh.point(b)[axis])) std::swap(p, q);
  return rounded_to_the_left(p, q, x);
}

}  // namespace

template <int D>
Point<D> split_point_of_face(const RefineContext<D>& context, CellId c, int face) {
  if constexpr (D == 2) {
    return split_point_within(context, c, face);
  } else {
    const Mesh<D>& mesh = context.mesh;
    const auto& k = mesh.cell(c).vertices;
    const EntityId id = mesh.constraints(c)->face_entity[face];
    const Ball<3> ball = equatorial_ball(mesh.point(k[(face + 1) & 3]), mesh.point(k[(face + 2) & 3]),
                                         mesh.point(k[(face + 3) & 3]));
    return point_on_facet(context.domain, id, ball.center);
  }
}

template std::array<double, 2> parameters_of(const RefineContext<2>&, EntityId, VertexId, VertexId);
template std::array<double, 2> parameters_of(const RefineContext<3>&, EntityId, VertexId, VertexId);
template Point<2> split_point(const RefineContext<2>&, EntityId, VertexId, VertexId);
template Point<3> split_point(const RefineContext<3>&, EntityId, VertexId, VertexId);
template Point<2> split_point_of_face(const RefineContext<2>&, CellId, int);
template Point<3> split_point_of_face(const RefineContext<3>&, CellId, int);

}  // namespace pgdr
