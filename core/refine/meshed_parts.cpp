// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "refine/meshed_parts.hpp"

#include <algorithm>
#include <utility>

#include "input/domain_parts.hpp"
#include "numbers/corners.hpp"
#include "pgdr/predicates.hpp"

namespace pgdr {
namespace {

/// Marks the parts that a mesh has, by their first triangles. Every part has segments about it, so that some of its subfacets are
/// at subsegments.
class PartMarker {
 public:
  PartMarker(const Mesh<3>& mesh, const Domain<3>& domain, const detail::DomainParts& parts)
      : mesh_(&mesh), domain_(&domain), parts_(&parts), marked_(parts.triangles()) {}

  void look_at(CellId c) {
    const auto* constraints = mesh_->constraints(c);
    for (int face = 0; constraints && face < 4; ++face)
      if (constraints->has_face(face)) look_at_face(c, *constraints, face);
  }

  std::vector<std::uint8_t> marked() && { return std::move(marked_); }

 private:
  /// A subfacet whose turn in the projection rounding hides says that all of its facet may be there.
  void look_at_face(CellId c, const ConstraintRecord<3>& constraints, int face) {
    const EntityId f = constraints.face_entity[face];
    const DomainFacet& facet = domain_->facets()[f];
    if (facet.triangle_count == 1) return mark(facet.first_triangle);
    const auto& v = mesh_->cell(c).vertices;
    for (int opposite = 0; opposite < 4; ++opposite) {
      if (opposite == face) continue;
      const int edge = edge_without(face, opposite);
      if (!constraints.has_edge(edge)) continue;
      const auto ends = ends_of_edge(v, edge);
      const Point3 &a = mesh_->point(ends[0]), &b = mesh_->point(ends[1]);
      const Sign turn = orient_projected(a, b, mesh_->point(v[opposite]), facet.axis);
      if (turn == Sign::zero) {
        for (std::uint32_t t = 0; t < facet.triangle_count; ++t) mark(parts_->of(facet.first_triangle + t));
        return;
      }
      const EntityId s = constraints.edge_entity[edge];
      mark(parts_->at({f, s, detail::runs_along(*domain_, s, a, b) == (turn == Sign::positive)}));
    }
  }

  void mark(std::uint32_t part) {
    if (part != no_entity) marked_[part] = 1;
  }

  const Mesh<3>* mesh_;
  const Domain<3>* domain_;
  const detail::DomainParts* parts_;
  std::vector<std::uint8_t> marked_;
};

}  // namespace

template <>
std::vector<std::uint8_t> meshed_triangles<2>(const Mesh<2>&, const Domain<2>&) {
  return {};
}

template <>
std::vector<std::uint8_t> meshed_triangles<3>(const Mesh<3>& mesh, const Domain<3>& domain) {
  const detail::DomainParts parts(domain);
  PartMarker marker(mesh, domain, parts);
  for (std::uint32_t c = 0; c < mesh.cell_bound(); ++c)
    if (mesh.alive(CellId{c})) marker.look_at(CellId{c});
  std::vector<std::uint8_t> meshed = std::move(marker).marked();
  for (std::uint32_t t = 0; t < meshed.size(); ++t) meshed[t] = meshed[parts.of(t)];
  if (std::ranges::find(meshed, 0) == meshed.end()) meshed.clear();
  return meshed;
}

}  // namespace pgdr
