// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Whether the reasons given for cells over a bound hold: the angle is measured again, and the cell must be near it.
//
// What excuses a cell depends on what is asked for. Refinement alone ends by a proof that any two segments below 60 degrees, and
// any other entities below 90, may keep it from splitting a cell near them: there such an angle is the excuse. A mesh that is
// held to a bound on dihedral angles was optimised, and optimising is not kept from anything by angles at which cells can meet
// the bounds. There only angles are an excuse at which the bounds cannot be met, of the input: dihedral angles below the bound on
// these, and planar angles below arcsin(1 / (2 B)), B the bound on the ratio (input/sharp_angles.hpp). For a ratio or a size they
// may be near the cell, as they always might. For a dihedral angle they have to be at the cell itself: the wedge of the walls at
// one of its edges, which the cell fills or shares, a sharp corner at one of its vertices, or a gap there between entities that
// share that vertex alone; or a part of the boundary that was kept, on which the cell has an edge, or that blocks the points
// which would take it away for its ratio (select/blocked_places.hpp). A reason that is true but no excuse leaves the cell
// unexplained.
#pragma once

#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "given/entity_angles.hpp"
#include "given/links.hpp"

namespace pgdr::checking {

template <int D>
class Reasons {
 public:
  using Entity = NamedEntity<D>;

  /// Reasons for cells that do not exist are findings. @param named null if there is no input.
  Reasons(const OutputMesh<D>& mesh, const CheckOptions<D>& options, const Links<D>& links, NamedEntities<D>* named,
          Findings& findings);

  /// What the reasons of a cell are: none at all, an excuse, true without being one, or false.
  enum class Verdict { absent, holds, admitted, fails };
  /// Of a cell over a bound of shape or size. @param why set to a clause that says why the (last) reason fails.
  Verdict judge(std::uint32_t cell, std::string& why);
  /// Is a reason of the cell, given for whatever bound, an excuse for a dihedral angle below the bound?
  bool excuses_dihedral(std::uint32_t cell);

  /// Has a cell that needs no excuse of shape or size a reason whose entities do not meet at the small angle that it states? Such
  /// reasons stand for faces that are not locally Delaunay, and for dihedral angles. @param why as of judge()
  bool misstates_angle(std::uint32_t cell, std::string& why);

  /// Of each vertex: it lies on an entity of a small angle that some reason names; empty if there are no reasons.
  std::vector<std::uint8_t> vertices_at_refused();

 private:
  /// The two entities of a reason; null where it names none that exist.
  struct Pair {
    const Entity *a, *b;
    bool exists() const { return a && b; }
  };
  Pair pair_of(const PoorReason& reason);
  std::span<const std::uint32_t> of_cell(std::uint32_t cell) const;
  bool asks_for_dihedral() const { return D == 3 && options_.largest_cosine < 1; }
  AngleBounds angle_bounds() const { return {options_.radius_edge_bound, options_.largest_cosine}; }
  Verdict judge(const PoorReason& reason, std::string& why);
  Verdict judge_angle(const PoorReason& reason, std::string& why);
  bool is_true(const PoorReason& reason, std::string& why);
  bool is_at_corner(const PoorReason& reason);
  bool is_facet_between(std::uint32_t v, const Entity& a, const Entity& b);
  bool is_in_gap(const PoorReason& reason);
  bool reaches(std::uint32_t cell, std::uint32_t v, const Pair& pair, const Point3& middle) const;
  Verdict in_wedge(const PoorReason& reason, std::string& why);
  bool beside_kept(const PoorReason& reason, std::string& why);
  template <class OnTriangle, class OnSegment>
  void each_kept_piece(const GivenEntity& name, const Entity& e, OnTriangle on_triangle, OnSegment on_segment);
  bool is_behind_kept(const PoorReason& reason);
  bool has_edge_on(const PoorReason& reason);
  bool is_side(const GivenEntity& name) const;
  bool is_subfacet(std::array<std::uint32_t, 3> corners);
  const EntityMeeting& meeting(const Pair& pair);
  bool near(std::uint32_t cell, const Entity& entity) const;
  bool meets_piece(std::uint32_t cell, const Entity& entity) const;

  const OutputMesh<D>& mesh_;
  const CheckOptions<D>& options_;
  const Links<D>& links_;
  NamedEntities<D>* named_;
  std::vector<std::uint32_t> by_cell_;  ///< indices of reasons, sorted by cell
  std::map<std::array<const Entity*, 2>, EntityMeeting> meetings_;
  std::vector<typename Entity::AtEdge> subfacets_;              ///< 3D: by their edges, sorted; made when they are asked for
  std::vector<detail::PlanarEdge> subsegments_;                 ///< 3D: likewise
  std::vector<std::array<std::uint32_t, 3>> sorted_subfacets_;  ///< by corners; made when they are asked for
  double largest_ = 0;                                          ///< coordinate of the mesh
};

}  // namespace pgdr::checking
