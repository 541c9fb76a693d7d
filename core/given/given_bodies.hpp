// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The bodies of an input as given, and how often they go round a point: by exact rays through the given triangles, which may
// cross each other. Immutable once made.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "given/given_input.hpp"
#include "space/box_tree.hpp"

namespace pgdr::checking {

class GivenBodies {
 public:
  /// The input must outlive this.
  explicit GivenBodies(const GivenInput<3>& input);

  /// Why nothing can be said of them; empty: all are closed, and look one way.
  const std::string& unfit() const { return unfit_; }
  std::uint32_t count() const { return static_cast<std::uint32_t>(volumes_.size()); }
  double volume(std::uint32_t body) const { return volumes_[body]; }
  /// By how much the volume may change if all of its facets move by so much.
  double slack(std::uint32_t body, double reach) const { return areas_[body] * reach + perimeters_[body] * reach * reach; }
  const Point<3>& least_point(std::uint32_t body) const { return least_points_[body]; }
  /// Of the bodies that go round x how often; none if x is on a facet.
  std::optional<std::map<std::uint32_t, int>> windings(const Point<3>& x) const;

 private:
  void find_bodies();
  void require_closed();
  void measure();
  void join_cavities();
  bool turns_over(std::uint32_t triangle) const;
  std::optional<std::map<std::uint32_t, int>> cross(const Point<3>& x, const Point<3>& to, std::uint32_t without) const;
  std::optional<std::map<std::uint32_t, int>> windings(const Point<3>& x, std::uint32_t without) const;

  const GivenInput<3>& input_;
  std::string unfit_;
  std::vector<std::array<Point<3>, 3>> triangles_;  ///< as their facets run
  std::vector<std::array<std::uint32_t, 3>> places_;
  std::vector<std::uint32_t> body_of_;  ///< of triangles
  std::vector<double> volumes_, areas_, perimeters_;
  std::vector<Point<3>> least_points_;
  std::vector<int> signs_;  ///< of bodies: -1 where their file is inside out
  double span_ = 0;
  std::optional<detail::BoxTree<3>> tree_;
};

}  // namespace pgdr::checking
