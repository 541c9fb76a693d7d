// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// What a visit knows of splits that were refused. Beside a small angle hundreds of poor elements, one after the other, ask for a
// point on the same subsegment, most of them by way of one of a few subfacets, and a vertex there is too near for each. Whether
// it still is takes one look at the cell that it was found in. One thread at a time.
#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <unordered_map>

#include "mesh/ids.hpp"
#include "refine/work_list.hpp"

namespace pgdr {

/// What a visit knows of splits that were refused: see above.
template <int D>
class RefusalMemo {
 public:
  /// A cell of the cavity of a subsegment's point, and how near a corner of it is.
  struct Near {
    CellId cell;  ///< its slot
    std::uint16_t birth;  ///< of that cell
    Point<D> x;  ///< the point
    double distance;  ///< of its nearest corner from there
  };

  /// Forgets everything, at no cost where there is nothing.
  void clear() {
    if (!near_.empty()) near_ = {};
    if (!passed_on_.empty()) passed_on_ = {};
  }
  /// Of the subsegment ab.
  void note_near(VertexId a, VertexId b, const Near& near) { near_.insert_or_assign(key(a, b), near); }
  /// The cell that was noted last, if it is still there and has a corner nearer than this.
  std::optional<Near> nearer_than(const Mesh<D>& mesh, VertexId a, VertexId b, double distance) const {
    const auto at = near_.find(key(a, b));
    if (at == near_.end() || !(at->second.distance < distance) || mesh.birth(at->second.cell) != at->second.birth) return {};
    return at->second;
  }
  /// The point of the subfacet encroaches upon the subsegment.
  void note_passed_on(const Entry<D>& face, const Entry<D>& edge) { passed_on_.insert_or_assign(key(face), edge); }
  bool knows_faces() const { return !passed_on_.empty(); }  ///< has any been noted?
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
