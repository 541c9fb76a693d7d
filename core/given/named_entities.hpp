// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// What reasons name: segments and facets of the input as given, in what of them is in the mesh, and what was given. Nothing is
// told again of how the input was prepared. A segment is straight, from end to end, and subsegments, or given segments and edges
// of facets, have all of it. A facet is all that hangs together with the one that is named: given triangles of one marker across
// edges of two that may lie in one plane, and subfacets, likewise, and on each other.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "given/match.hpp"
#include "pgdr/poor_reason.hpp"
#include "space/box_tree.hpp"
#include "space/disjoint_sets.hpp"
#include "space/planar_cdt.hpp"

namespace pgdr::checking {

/// Points are numbers of NamedEntities::point.
template <int D>
struct NamedEntity {
  /// A triangle at an edge, by the corner opposite; a subsegment, by its number.
  struct AtEdge {
    detail::PlanarEdge ends;  ///< sorted
    std::uint32_t apex;
    friend auto operator<=>(const AtEdge&, const AtEdge&) = default;
  };
  EntityKind kind = EntityKind::volume;
  std::array<std::uint32_t, 2> ends{none, none};            ///< of a segment
  std::vector<std::uint32_t> parts;                         ///< of a facet: the sets that it is, sorted
  std::vector<std::array<std::uint32_t, 3>> triangles;      ///< of a facet
  std::vector<AtEdge> edges;                                ///< of these, or subsegments of a segment, sorted
  std::vector<std::pair<std::uint32_t, std::uint32_t>> at;  ///< a point, and a triangle with it, sorted
  std::vector<std::uint32_t> points;                        ///< all, sorted
  std::shared_ptr<const detail::BoxTree<D>> tree;           ///< of the triangles
  bool is_one_plane = true;                                 ///< all of a facet is within the tolerance of one plane
  /// Of a facet that is not in one plane, or loose: what was given of it by itself, with the subfacets that lie on that, and
  /// without. Needles may lie in the planes on both of their sides, so that nothing says which of these are one with it; and
  /// where a facet is loose, the corners of what was given are known all the same.
  std::vector<NamedEntity> alone;
  /// Of a facet: what subsegments divide it into. In one plane, too, that is as many facets for whoever keeps these segments,
  /// where others that met at them are not in the mesh, or where the tolerance may have joined two and has not.
  std::vector<const NamedEntity*> faces;
  double off = 0;         ///< how far points of a facet, that were not given, may be off it
  bool is_loose = false;  ///< so may be those that were given: they do not lie in one plane, or were moved

  bool has(std::uint32_t point) const { return std::binary_search(points.begin(), points.end(), point); }
};

/// Which subfacets are one facet, where the input is the surface that the mesh has, each subfacet a facet of the same number.
struct OwnFacets {
  detail::DisjointSets sets;
  std::vector<double> thickness;  ///< by the number that names a set: how thick the slab is that its points lie in
};

/// One thread, as it remembers what it was asked for.
template <int D>
class NamedEntities {
 public:
  /// All must outlive it. @param sorted the vertices by their coordinates
  /// @param own  if the input is the mesh's own surface. Then facets are where their subfacets are; but whoever named them may
  ///   have known them by other triangles, within their slabs.
  NamedEntities(const GivenTask<D>& task, const GivenMatch<D>& match, std::span<const std::uint32_t> sorted,
                std::optional<OwnFacets> own = std::nullopt);

  /// Null if the input has no such segment or facet. It lasts as long as this.
  const NamedEntity<D>* find(const GivenEntity& name);
  /// A vertex of the mesh; behind these, points that are none.
  const Point<D>& point(std::uint32_t i) const {
    return i < mesh_.points.size() ? mesh_.points[i] : further_points_[i - mesh_.points.size()];
  }
  /// How far the point may be off the entity, which has it.
  double slack(const NamedEntity<D>& entity, std::uint32_t point) const {
    return entity.is_loose || point >= is_given_.size() || !is_given_[point] ? entity.off : 0;
  }
  bool is_given(std::uint32_t point) const {
    return point >= is_given_.size() || is_given_[point];
  }  ///< or is it of the mesh alone?
  bool is_within(const Point<D>& x, double distance, const NamedEntity<D>& entity) const;
  bool are_own() const { return own_.has_value(); }  ///< facets of the mesh's own surface
  /// Are the two facets in one plane, exactly?
  bool are_in_one_plane(const NamedEntity<D>& facet, const NamedEntity<D>& other) const;

 private:
  std::uint32_t number_of(const Point<D>& x);
  std::uint32_t known_number(const Point<D>& x) const;  ///< none, if it has none yet
  void make_segment(std::array<std::array<double, 3>, 2> of, NamedEntity<D>& out);
  bool is_covered(const NamedEntity<D>& segment) const;
  const NamedEntity<D>* make_facet(std::uint32_t facet);
  const NamedEntity<D>& all_of(const std::vector<std::uint32_t>& parts);
  void fill_facet(std::span<const std::uint32_t> members, NamedEntity<D>& out) const;
  bool is_in_one_plane(const NamedEntity<D>& facet) const;
  std::array<Point<D>, 3> largest_triangle(const NamedEntity<D>& facet) const;
  bool lies_on(std::uint32_t subfacet, std::uint32_t given) const;
  std::vector<std::uint32_t> members_alone(std::uint32_t first, std::uint32_t last) const;
  void join_flat_parts();
  void join_faces(std::span<const typename NamedEntity<D>::AtEdge> edges);
  std::vector<const NamedEntity<D>*> faces_of(std::span<const std::uint32_t> members);
  void join_own_parts();
  void add_triangle(const std::array<std::uint32_t, 3>& triangle, NamedEntity<D>& out) const;

  const OutputMesh<D>& mesh_;
  const GivenInput<D>& input_;
  const GivenMatch<D>& match_;
  std::span<const std::uint32_t> sorted_;
  std::vector<std::uint8_t> is_given_;  ///< of vertices
  std::vector<Point<D>> further_points_;
  std::map<std::array<double, D>, std::uint32_t> further_numbers_;
  std::map<std::array<std::array<double, 3>, 2>, std::optional<NamedEntity<D>>> segments_;
  std::map<std::uint32_t, const NamedEntity<D>*> facets_;
  /// What hangs together, by its sets. Facets of it that are the same, by these and by the faces, are one entity.
  std::map<std::vector<std::uint32_t>, NamedEntity<D>> groups_;
  std::map<std::pair<std::vector<std::uint32_t>, std::vector<const NamedEntity<D>*>>, NamedEntity<D>> plates_;
  std::map<std::uint32_t, NamedEntity<D>> bent_;  ///< facets that are not in one plane, or loose: each by itself
  std::unique_ptr<detail::BoxTree<D>> subsegments_;
  std::optional<OwnFacets> own_;
  std::optional<detail::DisjointSets> flat_;                      ///< of given triangles, then of subfacets
  std::vector<std::pair<std::uint32_t, std::uint32_t>> by_flat_;  ///< set, member
  std::vector<std::uint32_t> face_of_;                            ///< of subfacets
  std::vector<std::pair<std::uint32_t, std::uint32_t>> by_face_;  ///< face, subfacet
  std::vector<double> off_of_face_;                               ///< how far its points may be off what was given
  std::map<std::uint32_t, NamedEntity<D>> faces_;
};

}  // namespace pgdr::checking
