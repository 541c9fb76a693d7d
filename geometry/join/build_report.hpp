// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The report of a Domain in the making: what is refused, warned of and repaired, in the words and numbers of its input.
// Used by one thread.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "input/words.hpp"
#include "pgdr/error.hpp"
#include "pgdr/plc.hpp"

namespace pgdr::detail {

/// The lists of repairs, by kind.
struct Repairs {
  RepairList merged, merged_near, negative_zeros, dropped_edges, repeated_segments, repeated_facets, points_on_edges,
      points_in_facets, edges_in_facets, overlaps, hidden_markers, added_points, bent_facets, ambiguous_planes, dropped_flat,
      dropped_bare;
};

template <int D>
class BuildReport {
 public:
  /// `refused`: where to name what is invalid and go on without it; null: it is thrown.
  BuildReport(const Plc<D>& plc, std::vector<Diagnostic>* refused) : plc_(plc), refused_(refused) {}

  /// The distinct points that are spoken of from here on, and the first Plc point of each.
  void set_points(std::span<const Point<D>> points, std::span<const std::uint32_t> input_of_point) {
    points_ = points;
    input_of_point_ = input_of_point;
  }

  /// The number that the source of the input gives its item i.
  std::int64_t number(std::size_t i) const { return static_cast<std::int64_t>(i) + plc_.first_index; }
  /// The number of a distinct point.
  std::int64_t point_number(std::uint32_t v) const { return number(input_of_point_[v]); }
  /// Number and coordinates of a distinct point.
  std::string point_words(std::uint32_t v) const { return std::to_string(point_number(v)) + " " + to_text(points_[v]); }

  /// @throws InputError with what is said, and the file and line of item i of its kind
  [[noreturn]] void fail(Errc code, const std::string& message, SourceItem kind, std::size_t i,
                         const std::vector<std::int64_t>& ids, const std::vector<std::array<double, 3>>& where) const;
  /// Adds a warning with the same.
  void warn(Errc code, const std::string& message, SourceItem kind, std::size_t i, std::vector<std::int64_t> ids);
  /// Runs an action whose InputError, if the caller wants the refused things named, is named and not thrown.
  template <class Action>
  void attempt(Action&& action) const {
    if (refused_ == nullptr) return action();
    try {
      action();
    } catch (const InputError& e) {
      refused_->push_back(e.diagnostic());
    }
  }
  bool has_refused() const { return refused_ != nullptr && !refused_->empty(); }

  /// Is the point none of the input's, but one that a step has added behind them?
  bool is_added(std::uint32_t v) const { return input_of_point_[v] >= plc_.points.size(); }

  /// Notes that point v lies inside the edge ab, which is split there. Added points are listed on their own.
  void note_on_edge(std::uint32_t v, std::uint32_t a, std::uint32_t b) {
    if (is_added(v)) return;
    on_edges_.push_back({v, std::min(a, b), std::max(a, b)});
  }
  /// Notes that point v lies inside input facet f, and becomes one of its points.
  void note_in_facet(std::uint32_t v, std::uint32_t f) {
    if (!is_added(v)) in_facets_.emplace_back(v, f);
  }
  /// Counts the points noted so far among the repairs, each once.
  void list_points();

  /// What the triangulation of facets has added, to be taken back before it is done anew.
  struct Mark {
    RepairList dropped_edges;
    std::size_t refused, warnings;
  };
  Mark mark() const { return {repairs.dropped_edges, refused_ != nullptr ? refused_->size() : 0, warnings_.size()}; }
  void go_back_to(const Mark& mark);

  /// Appends what was mended and what was warned of.
  void write(std::vector<Diagnostic>& mended, std::vector<Diagnostic>& warnings);

  Repairs repairs;

 private:
  Diagnostic diagnostic(Errc code, const std::string& message, SourceItem kind, std::size_t i) const;

  const Plc<D>& plc_;
  std::vector<Diagnostic>* refused_;
  std::span<const Point<D>> points_;
  std::span<const std::uint32_t> input_of_point_;
  std::vector<Diagnostic> warnings_;
  std::vector<std::array<std::uint32_t, 3>> on_edges_;              // point, ends of the edge
  std::vector<std::pair<std::uint32_t, std::uint32_t>> in_facets_;  // point, facet
};

}  // namespace pgdr::detail
