// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "refine/split_points.hpp"

#include <algorithm>

#include "input/entities.hpp"

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

template <int D>
Point<D> split_point_of_face(const RefineContext<D>& context, CellId c, int face) {
  const Mesh<D>& mesh = context.mesh;
  const auto& k = mesh.cell(c).vertices;
  const EntityId id = mesh.constraints(c)->face_entity[face];
  if constexpr (D == 2) {
    return split_point(context, id, k[(face + 1) % 3], k[(face + 2) % 3]);
  } else {
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
