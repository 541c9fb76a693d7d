// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The caller's point selector at work: what it is told, what it may ask, and what becomes of the point that it returns.
#pragma once

#include <cstdint>
#include <optional>
#include <unordered_map>
#include <vector>

#include "refine/further_points.hpp"
#include "refine/workspace.hpp"

namespace pgdr {

/// The answers of a selector that is asked by blocks, in one visit. An element is a function of its cell alone, so it may be
/// asked for at any time before its turn: with the one that is next all are asked for that wait behind it and may come to their
/// turns. The answers to those that do not are never used. One thread at a time.
template <int D>
class SelectorAnswers {
 public:
  /// As many as this are asked for at once.
  static constexpr std::size_t most = 8192;

  /// Must be called before a visit does anything.
  void begin_visit() {
    answers_.clear();
    is_first_ = true;
  }
  /// Where the selector puts the points of this element, which is that of the entry. @throws what the selector throws
  const SelectedPoints<D>& points_of(const Workspace<D>& w, const Entry<D>& e, const PoorElement<D>& element);

 private:
  struct Answer {
    std::uint16_t birth;
    SelectedPoints<D> points;
  };

  bool has(const Entry<D>& e) const {
    const auto found = answers_.find(index(e.cell));
    return found != answers_.end() && found->second.birth == e.birth;
  }
  void add(const Workspace<D>& w, const Entry<D>& e);
  void ask(const Workspace<D>& w, const Entry<D>& next, const PoorElement<D>& element);
  void drop_dead(const Mesh<D>& mesh);

  std::unordered_map<std::uint32_t, Answer> answers_;  ///< by the slot of the cell
  bool is_first_ = true;                               ///< was nothing asked for in this visit?
  std::vector<Entry<D>> entries_;                      // scratch of ask()
  std::vector<PoorElement<D>> elements_;
  std::vector<SelectedPoints<D>> points_;
};

/// Where the selector puts the (first) point of an entry's cell, which is over the radius-edge bound; nothing if the claim is too
/// small to tell. `center`: the cell's circumcentre. Gives the other points to `further`, if the first is in the disk: these go
/// by what the first needs. Uses the cavity, which must be empty.
/// @throws UsageError bad_option for a point outside the disk, if the caller wants that to be an error; what the selector throws
template <int D>
std::optional<Point<D>> selected_point(Workspace<D>& w, SelectorAnswers<D>& answers, const Entry<D>& e, const Point<D>& center,
                                       FurtherPoints<D>& further);

extern template class SelectorAnswers<2>;
extern template class SelectorAnswers<3>;

}  // namespace pgdr
