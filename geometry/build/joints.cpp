// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "build/joints.hpp"

#include "input/triangle_shapes.hpp"
#include "pgdr/predicates.hpp"
#include "space/triangle.hpp"

namespace pgdr::detail {

bool Joints::is_joint(std::span<const EdgeUse> uses) const {
  using Kind = EdgeUse::Kind;
  if (uses.size() < 2 || !uses[1].is_triangle()) return false;
  const EdgeUse &a = uses[0], &b = uses[1];
  const auto& facets = faces_.facets;
  // Both are planar parts of one bent polygon, of which an edge that is drawn inside of it is a segment.
  const bool within_facet = a.owner != b.owner && facets[a.owner].input == facets[b.owner].input;
  for (const EdgeUse& use : uses.subspan(2))
    if (use.kind != Kind::polygon || within_facet || (use.owner != a.owner && use.owner != b.owner && !facets[use.owner].mixed))
      return false;
  if (a.owner == b.owner) return a.kind == Kind::diagonal && b.kind == Kind::diagonal;
  return in_.plc.facets[facets[a.owner].input].marker == in_.plc.facets[facets[b.owner].input].marker;
}

bool Joints::opens(std::span<const EdgeUse> joint, int axis) const {
  const auto [p0, p1, c, d] = corners(joint);
  const Sign side = orient_projected(p0, p1, c, axis);
  return side != Sign::zero && side == -orient_projected(p0, p1, d, axis);
}

bool Joints::is_flat(std::span<const EdgeUse> joint) const {
  if (!faces_.facets[joint[0].owner].planar || !faces_.facets[joint[1].owner].planar) return false;
  const auto [p0, p1, c, d] = corners(joint);
  return orient3d(p0, p1, c, d) == Sign::zero;
}

std::array<Point3, 4> Joints::corners(std::span<const EdgeUse> joint) const {
  const auto [a, b] = edge_of(joint[0].key);
  const auto& p = in_.points;
  return {p[a], p[b], p[corner_beside(faces_.triangles[joint[0].triangle], a, b)],
          p[corner_beside(faces_.triangles[joint[1].triangle], a, b)]};
}

bool Joints::is_soft(std::span<const EdgeUse> uses, const PlaneWidth& width) const {
  if (!is_joint(uses)) return false;
  if (uses[0].owner == uses[1].owner) return true;
  if (!opens(uses, faces_.facets[uses[0].owner].axis)) return false;
  if (is_flat(uses)) return true;
  const auto [a, b, c, d] = corners(uses);
  const PlanarTriangle &s = faces_.triangles[uses[0].triangle], &t = faces_.triangles[uses[1].triangle];
  const double most = width.of(std::array{s[0], s[1], s[2], t[0], t[1], t[2]}) / in_.scale;
  return most > 0 && plane_distance(a, b, c, d) <= most && plane_distance(a, b, d, c) <= most;
}

}  // namespace pgdr::detail
