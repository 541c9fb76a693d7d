// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// A memo of the splits that a visit was refused. Beside a small angle hundreds of poor elements, one after the other, are blocked
// by the same subsegment, most of them by way of one of a few subfacets, and a vertex there is too near for each. One look at the
// cell where that vertex was found tells whether it still is. One thread at a time.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <unordered_map>

#include "mesh/ids.hpp"
#include "refine/work_list.hpp"

namespace pgdr {

/// The refused splits of one visit.
template <int D>
class RefusalMemo {
 public:
  /// A cell in the cavity of a subsegment's point, with a corner near the point.
  struct Near {
    CellId cell;          ///< its slot
    std::uint16_t birth;  ///< of that cell
    Point<D> x;           ///< the point
    double distance;      ///< of its nearest corner from the point
    EntityRef home;       ///< of that corner
  };

  /// Forgets everything, at no cost where there is nothing.
  void clear() {
    if (!near_.empty()) near_ = {};
    if (!passed_on_.empty()) passed_on_ = {};
  }
  /// Notes it for the subsegment ab.
  void note_near(VertexId a, VertexId b, const Near& near) { near_.insert_or_assign(key(a, b), near); }
  /// The cell that was noted last, if it is still there and has a corner nearer than this.
  std::optional<Near> nearer_than(const Mesh<D>& mesh, VertexId a, VertexId b, double distance) const {
    const auto at = near_.find(key(a, b));
    if (at == near_.end() || !(at->second.distance < distance) || mesh.birth(at->second.cell) != at->second.birth) return {};
    return at->second;
  }
  /// Notes that the subsegment was to be split in the place of the subfacet.
  void note_passed_on(const Entry<D>& face, const Entry<D>& edge) { passed_on_.insert_or_assign(key(face), edge); }
  bool knows_faces() const { return !passed_on_.empty(); }  ///< has note_passed_on() been called?
  /// The subsegment noted for the subfacet, if the cell that it was noted with is still there.
  std::optional<Entry<D>> passed_on(const Mesh<D>& mesh, const Entry<D>& face) const {
    const auto at = passed_on_.find(key(face));
    if (at == passed_on_.end() || !at->second.alive(mesh)) return {};
    return at->second;
  }

 private:
  static std::uint64_t key(VertexId a, VertexId b) {
    return std::uint64_t{std::max(index(a), index(b))} << 32 | std::min(index(a), index(b));
  }
  static std::uint64_t key(const Entry<D>& face) {
    return std::uint64_t{index(face.cell)} << 32 | std::uint64_t{face.birth} << 4 | static_cast<unsigned>(face.which());
  }

  std::unordered_map<std::uint64_t, Near> near_;
  std::unordered_map<std::uint64_t, Entry<D>> passed_on_;
};

}  // namespace pgdr
