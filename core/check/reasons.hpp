// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Whether the reasons given for cells over a bound hold: the angle is measured again, and the cell must be near it.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "check/conformity.hpp"

namespace pgdr::checking {

template <int D>
class Reasons {
 public:
  /// Reasons for cells that do not exist are findings. @param conformity null if there is no domain.
  Reasons(const OutputMesh<D>& mesh, const CheckOptions<D>& options, const Conformity<D>* conformity, Findings& findings);

  enum class Verdict { absent, holds, fails };
  /// @param why set to a clause that says why the (last) reason fails.
  Verdict judge(std::uint32_t cell, std::string& why);

  /// Of each vertex: it lies on an entity of a small angle that some reason names; empty if there are no reasons.
  std::vector<std::uint8_t> vertices_at_refused(const InputVolumes<D>& input);

 private:
  bool holds(const PoorReason& reason, std::string& why);
  bool beside_kept(const PoorReason& reason, std::string& why) const;
  bool small_angle(EntityRef a, EntityRef b);
  bool measure_angle(EntityRef a, EntityRef b) const;
  bool small_at_point(std::uint32_t point, EntityRef b) const;
  bool exists(EntityRef entity) const;
  bool near(std::uint32_t cell, EntityRef entity) const;
  bool within(const Point<D>& x, double distance, EntityRef entity) const;

  const OutputMesh<D>& mesh_;
  const CheckOptions<D>& options_;
  const Conformity<D>* conformity_;
  std::vector<std::uint32_t> by_cell_;  ///< indices of reasons, sorted by cell
  std::map<std::array<std::uint64_t, 2>, bool> angles_;
  double largest_ = 0;  ///< coordinate of the mesh
};

}  // namespace pgdr::checking
