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
// share that vertex alone. A reason that is true but no excuse
// leaves the cell unexplained.
#pragma once

#include <map>
#include <span>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "check/conformity.hpp"
#include "input/sharp_angles.hpp"

namespace pgdr::checking {

template <int D>
class Reasons {
 public:
  /// Reasons for cells that do not exist are findings. @param conformity null if there is no domain.
  Reasons(const OutputMesh<D>& mesh, const CheckOptions<D>& options, const Links<D>& links, const Conformity<D>* conformity,
          Findings& findings);

  /// What the reasons of a cell are: none at all, an excuse, true without being one, or false.
  enum class Verdict { absent, holds, admitted, fails };
  /// Of a cell over a bound of shape or size. @param why set to a clause that says why the (last) reason fails.
  Verdict judge(std::uint32_t cell, std::string& why);
  /// Is a reason of the cell, given for whatever bound, an excuse for a dihedral angle below the bound?
  bool excuses_dihedral(std::uint32_t cell);

  /// Of each vertex: it lies on an entity of a small angle that some reason names; empty if there are no reasons.
  std::vector<std::uint8_t> vertices_at_refused(const InputVolumes<D>& input);

 private:
  std::span<const std::uint32_t> of_cell(std::uint32_t cell) const;
  bool asks_for_dihedral() const { return D == 3 && options_.largest_cosine < 1; }
  AngleBounds angle_bounds() const { return {options_.radius_edge_bound, options_.largest_cosine}; }
  Verdict judge(const PoorReason& reason, std::string& why);
  bool is_at_corner(const PoorReason& reason) const;
  bool is_in_gap(const PoorReason& reason) const;
  bool reaches(std::uint32_t cell, std::uint32_t v, const std::array<EntityRef, 2>& pair, const Point3& middle) const;
  bool lies_on(std::uint32_t v, EntityRef entity) const;
  Verdict in_wedge(const PoorReason& reason, std::string& why);
  void list_subsegments();
  bool beside_kept(const PoorReason& reason, std::string& why) const;
  /// Of two entities: do they meet at a small angle; and at one at which the bounds cannot be met?
  struct Meeting {
    bool small, sharp;
  };
  Meeting meeting(EntityRef a, EntityRef b);
  bool measure_angle(EntityRef a, EntityRef b) const;
  bool small_at_point(std::uint32_t point, EntityRef b) const;
  bool exists(EntityRef entity) const;
  bool near(std::uint32_t cell, EntityRef entity) const;
  bool meets_piece(std::uint32_t cell, EntityRef entity);
  bool within(const Point<D>& x, double distance, EntityRef entity) const;

  const OutputMesh<D>& mesh_;
  const CheckOptions<D>& options_;
  const Links<D>& links_;
  const Conformity<D>* conformity_;
  std::vector<std::uint32_t> by_cell_;  ///< indices of reasons, sorted by cell
  std::map<std::array<std::uint64_t, 2>, Meeting> angles_;
  /// Edges of the mesh on segments, sorted, with the segment; made when the first is asked for.
  std::vector<std::pair<std::array<std::uint32_t, 2>, EntityId>> subsegments_;
  std::unordered_map<EntityId, std::vector<std::uint32_t>> pieces_;  ///< 2D: subsegments by segment; made when asked for
  double largest_ = 0;                                               ///< coordinate of the mesh
};

}  // namespace pgdr::checking
