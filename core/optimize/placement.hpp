// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// A better place for a vertex: the worst cell at it gets as good as an ascent makes it. The quality of the worst cell is not
// smooth where several are as bad. So the direction is a least vector of the convex hull of the gradients of the cells that are
// about as bad as the worst (Freitag, Ollivier-Gooch 1997): a gradient whose cell is better than the worst counts the less, the
// shorter the step is to be. A step that does not make the worst better is halved, and the cell that stopped it is looked at,
// too. Points and numbers alone; no mesh. One thread at a time.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "optimize/cell_quality.hpp"
#include "pgdr/types.hpp"

namespace pgdr {

/// The cells at a vertex, and where it may go.
struct Star {
  /// A cell without the vertex.
  struct Cell {
    std::array<Point3, 3> base;  ///< (base[0], base[1], base[2], vertex) is positively oriented
    int region;                  ///< of the cell
  };
  std::vector<Cell> cells;       ///< all at the vertex
  Point3 vertex;                 ///< where it is
  int freedom = 3;               ///< 3: anywhere; 2: in the plane of `axis`; 1: along `axis`
  std::array<double, 3> axis{};  ///< the normal, or the direction; a unit vector but for rounding
  /// Brings a point onto the entity that the vertex lies on; empty where it is free. It must return a point near its argument.
  std::function<Point3(const Point3&)> onto_entity;
};

/// Finds places.
class Placement {
 public:
  /// The best place found, if the worst cell is better there than where the vertex is, by more than a part of 10^-4. Ends as soon
  /// as all cells have the quality 1. It also gets cells off 0 that are flat or turned over, where there is a place for that. The
  /// cells are positive there as far as doubles tell. Another order of the cells, or of their corners, may give another rounding.
  std::optional<Point3> find(const Star& star, const CellQuality& quality);
  double least_quality() const { return least_; }  ///< of the cells at the place found

 private:
  using Direction = std::array<double, 3>;
  using Term = CellQuality::Term;
  /// A cell of the star, and what it is at the best place so far.
  struct Rated {
    double value;        ///< the quality, or the height over the base
    std::uint32_t cell;  ///< number in the star
  };
  static bool worse(const Rated& a, const Rated& b) { return a.value < b.value || (a.value == b.value && a.cell < b.cell); }

  void measure(bool heights);
  bool ascend(bool heights);
  bool try_steps(bool heights, double& trust);
  void model(std::size_t i, bool heights);
  Direction step(double trust);
  bool try_place(const Point3& x, bool heights, std::size_t& stopped_by);
  std::size_t first_turned_over(const Point3& x) const;
  double value_at(const Rated& r, const Point3& x, bool heights, double enough) const;

  const Star* star_ = nullptr;
  const CellQuality* quality_ = nullptr;
  Point3 x_;                             ///< the best place so far
  double least_ = 0;                     ///< the value of the worst cell there
  std::vector<Rated> rated_, at_trial_;  ///< the cells, the worst first
  std::size_t modelled_ = 0;             ///< so many of the first have their terms in terms_
  std::vector<Term> terms_;
  double gain_ = 0;  ///< what the last step would gain if the terms were linear
};

}  // namespace pgdr
