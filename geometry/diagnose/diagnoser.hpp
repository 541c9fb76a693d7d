// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The maker of a Diagnosis of a Domain: what meets where it should not (pairs.cpp), how facets hang together (topology.cpp),
// small angles (angles.cpp), points that may be meant to be one (near_points.cpp). Used by one thread, once; long loops run in
// its task arena, too.
#pragma once

#include <algorithm>
#include <array>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "pgdr/diagnosis.hpp"
#include "space/bulk.hpp"
#include "space/contact.hpp"
#include "space/stop_check.hpp"

namespace pgdr::detail {

/// The `most` least of what is added, ascending.
template <class Entry>
class Least {
 public:
  explicit Least(std::size_t most) : most_(most) {}
  void add(const Entry& e) {
    ++count_;
    if (kept_.size() == most_) {
      if (most_ == 0 || !(e < kept_.back())) return;
      kept_.pop_back();
    }
    kept_.insert(std::upper_bound(kept_.begin(), kept_.end(), e), e);
  }
  /// The least of both.
  void add(const Least& other) {
    count_ += other.count_ - other.kept_.size();
    for (const Entry& e : other.kept_) add(e);
  }
  std::uint64_t count() const { return count_; }
  const std::vector<Entry>& kept() const { return kept_; }

 private:
  std::size_t most_;
  std::uint64_t count_ = 0;
  std::vector<Entry> kept_;
};

template <int D>
class Diagnoser {
 public:
  Diagnoser(const Domain<D>& domain, const DiagnosisOptions& options, Diagnosis<D>& out)
      : domain_(domain),
        options_(options),
        bulk_(options.parallel, options.stop),
        stop_check_(options.stop),
        out_(out),
        p_(domain.points()) {}
  void run();

 private:
  using Ids = std::vector<std::int64_t>;
  using Edge = std::array<std::uint32_t, 2>;

  struct Triangle {
    std::array<std::uint32_t, 3> corners;
    EntityId facet;
    TriangleOrigin origin;
  };
  /// A use of an edge by a triangle; sorted, the uses of an edge stand together.
  struct EdgeUse {
    std::uint64_t key;  // smaller point in the upper half
    std::uint32_t triangle;
    Edge edge() const { return {static_cast<std::uint32_t>(key >> 32), static_cast<std::uint32_t>(key)}; }
    friend auto operator<=>(const EdgeUse&, const EdgeUse&) = default;
  };
  /// Two pieces that meet, by the input entities that they belong to.
  struct Meeting {
    std::uint32_t first, second;  // input facet, domain segment
    std::array<std::uint32_t, 2> pieces;
    bool overlap;
    friend auto operator<=>(const Meeting&, const Meeting&) = default;
  };
  /// A point on an edge, or (second no_entity) on an input facet.
  struct Resting {
    std::uint32_t point, first, second;
    friend auto operator<=>(const Resting&, const Resting&) = default;
  };
  /// What a part of the search found.
  struct Meetings {
    std::vector<Meeting> facet_facet, segment_facet, segment_segment;
    std::vector<Resting> resting;
  };
  /// An angle: the square of its sine, then what makes its order definite: points and triangles.
  struct Angle {
    double sine2;
    std::array<std::uint32_t, 4> at;
    friend bool operator<(const Angle& a, const Angle& b) { return a.sine2 != b.sine2 ? a.sine2 < b.sine2 : a.at < b.at; }
  };
  struct Angles {
    explicit Angles(std::size_t most) : below_60(most), segment_facet_90(most), facets_90(most) {}
    Least<Angle> below_60, segment_facet_90, facets_90;
  };

  // diagnosis.cpp
  static std::uint64_t key(std::uint32_t a, std::uint32_t b) {
    return static_cast<std::uint64_t>(std::min(a, b)) << 32 | std::max(a, b);
  }
  std::int64_t number(std::size_t i) const { return static_cast<std::int64_t>(i) + domain_.first_index(); }
  std::int64_t point_number(std::uint32_t v) const { return number(domain_.input_of_point()[v]); }
  std::string point_words(std::uint32_t v) const;  ///< its number and coordinates
  std::string facet_words(std::uint32_t f) const { return std::to_string(number(f)); }
  std::string edge_words(const Edge& e) const { return "from point " + point_words(e[0]) + " to " + point_words(e[1]); }
  std::string segment_words(EntityId s) const;
  PlcSource::Place segment_place(EntityId s) const;
  PlcSource::Place facet_place(std::uint32_t f) const { return domain_.source().place(SourceItem::facet, f); }
  PlcSource::Place point_place(std::uint32_t v) const {
    return domain_.source().place(SourceItem::point, domain_.input_of_point()[v]);
  }
  bool wants_more(Finding kind) const { return out_[kind].listed.size() < options_.most_listed; }
  void list(Finding kind, Errc code, std::string message, PlcSource::Place place, Ids ids, const std::vector<Point<D>>& where,
            double measure = 0);
  std::vector<Point<D>> points_of(std::span<const std::uint32_t> vertices) const;
  void collect_triangles();
  std::span<const EdgeUse> uses_at(std::size_t begin) const;

  // pairs.cpp
  void find_meetings();
  void note(std::uint32_t i, std::uint32_t j, Meetings& found) const;
  std::uint32_t owner(std::uint32_t piece) const;
  Resting resting(const Contact::Corner& corner, std::uint32_t on_piece) const;
  void report_meetings(std::vector<Meeting> meetings, std::size_t first_corners, std::size_t second_corners);
  void list_meeting(std::span<const Meeting> same, std::size_t first_corners, std::size_t second_corners, Finding kind);
  void report_resting(std::vector<Resting> resting);
  void list_resting(const Resting& r);

  // topology.cpp
  void find_repairs();
  void find_unreferenced();
  void find_open_boundary();
  void find_open_loops() requires(D == 3);
  void list_open_loop(const std::vector<std::uint32_t>& loop);
  void find_non_manifold_edges() requires(D == 3);
  void find_non_manifold_points() requires(D == 3);
  void find_orientation() requires(D == 3);
  void find_encloses_nothing();
  bool all_collapses() const;

  // near_points.cpp
  std::vector<std::uint32_t> open_points() const;
  void find_near_points();

  // angles.cpp
  void find_angles();
  void segments_at_points();
  void corners_at_points() requires(D == 3);
  void facets_at_segments(Angles& found) const requires(D == 3);
  void note_segment_angles(std::uint32_t v, Angles& found) const;
  void note_facet_angles(std::uint32_t v, Angles& found) const requires(D == 3);
  void report_angles(const Angles& found);

  const Domain<D>& domain_;
  const DiagnosisOptions& options_;
  const Bulk bulk_;
  const StopCheck stop_check_;
  Diagnosis<D>& out_;
  std::span<const Point<D>> p_;
  std::vector<Triangle> triangles_;  // all facets'
  std::vector<EdgeUse> uses_;
  std::vector<Piece> pieces_;                                // the triangles, then segments of no facet, then points of neither
  std::vector<std::uint32_t> segment_begin_, corner_begin_;  // by point
  std::vector<std::uint32_t> corner_at_;                     // 3 * triangle + corner
  std::vector<EntityId> segment_at_;
};

}  // namespace pgdr::detail
