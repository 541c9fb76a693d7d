// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The volumes that the pieces of an arrangement separate, and how often each body goes round each of them. Immutable once made,
// any thread.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "bodies/body_chains.hpp"
#include "numbers/exact_sum.hpp"
#include "numbers/vectors.hpp"
#include "pgdr/bodies.hpp"
#include "space/stop_check.hpp"
#include "volumes/wall_volumes.hpp"

namespace pgdr::detail {

/// A winding number that is not 0.
struct Winding {
  std::uint32_t body;
  int times;
  friend bool operator==(const Winding&, const Winding&) = default;
};

/// A volume that no point of doubles is inside of: it counts to the one beside it, and the piece between them does not.
struct ThinVolume {
  std::uint32_t volume, piece, beside;
};

class BodyVolumes {
 public:
  /// Both must outlive this. @throws InputError not_orientable, ambiguous; CancelledError
  BodyVolumes(const Plc<3>& plc, const Arrangement& pieces, const Bulk& bulk, const StopCheck& stop_check);

  const WallVolumes<3>& walls() const { return walls_; }  ///< the pieces
  std::uint32_t count() const { return walls_.count(); }  ///< of volumes; 0 is the outside
  std::uint32_t bodies() const { return body_count_; }
  std::uint32_t body_of_facet(std::uint32_t facet) const { return chains_.body_of_facet[facet]; }  ///< no_entity: it has no area
  std::span<const Winding> windings(std::uint32_t volume) const { return windings_[volume]; }      ///< by body
  /// The sum of all of these.
  int total(std::uint32_t volume) const;
  /// Six times the volume's measure; of the outside less what it lacks.
  const ExactSum& measure(std::uint32_t volume) const { return measures_[volume]; }
  /// A point strictly inside; none of the outside, and of thin volumes.
  const std::optional<Point<3>>& inside(std::uint32_t volume) const { return insides_[volume]; }
  /// Each behind the one beside it, if that is thin, too.
  std::span<const ThinVolume> thin() const { return thin_; }
  const std::vector<Diagnostic>& warnings() const { return warnings_; }

 private:
  /// A point, where a wall is nearest to it, and how far that is, squared.
  struct Deep {
    Point<3> x, wall;
    double square;
  };

  std::vector<char> separating() const;
  void require_known() const;
  void wind_closed();
  void add_closed(std::uint32_t volume, std::uint32_t piece, bool to_negative);
  void require_consistent() const;
  void measure_volumes();
  void list_sides();
  void join_cavities();
  std::optional<std::uint32_t> host_of(std::uint32_t body, std::span<const PieceOfBody> its_pieces,
                                       std::span<const ExactSum> measures) const;
  void renumber(std::span<const std::uint32_t> new_body);
  void wind_open(const Bulk& bulk);
  void warn_of_turned();
  std::span<const PieceOfBody> at_piece(std::uint32_t piece) const;
  bool is_closed(std::uint32_t body) const { return chains_.is_closed[body] != 0; }
  std::vector<std::uint32_t> largest_sides(std::uint32_t volume) const;
  std::optional<Point<3>> find_inside(std::uint32_t volume) const;
  void join_thin();
  double extent_of(std::uint32_t volume) const;
  Deep depth_at(const Point<3>& x) const;
  std::optional<Deep> deepest_towards(std::uint32_t volume, const Point<3>& from, const Vector<3>& way, double reach) const;

  const Plc<3>& plc_;
  const Arrangement& pieces_;
  const WallVolumes<3> walls_;
  BodyChains chains_;
  std::uint32_t body_count_ = 0;
  std::vector<std::vector<Winding>> windings_;      ///< of volumes
  std::vector<ExactSum> measures_;                  ///< of volumes
  std::vector<std::uint32_t> sides_begin_, sides_;  ///< of volumes, as WallVolumes numbers them
  std::vector<std::optional<Point<3>>> insides_;    ///< of volumes
  std::vector<ThinVolume> thin_;
  std::vector<Diagnostic> warnings_;
};

}  // namespace pgdr::detail
