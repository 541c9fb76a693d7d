// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Periodic sides of a planar input that hang together by pairs: the same places on each. One thread.
#pragma once

#include <array>
#include <cstdint>
#include <initializer_list>
#include <map>
#include <string>
#include <vector>

#include "pgdr/output_mesh.hpp"
#include "pgdr/periodic.hpp"
#include "pgdr/plc.hpp"

namespace pgdr::detail {

class SideChain {
 public:
  /// Gives the pairs that have none their motions. `plc` must outlive this.
  /// @throws UsageError: the sides do not match within the tolerance, or pairs contradict each other
  SideChain(const Plc<2>& plc, std::vector<PeriodicSides<2>>& pairs, double tolerance);

  bool has(int marker) const { return side_of_.contains(marker); }
  /// Halves the pieces that a mesh has divided. @returns whether there are any
  bool divide(const OutputMesh<2>& mesh);
  /// Appends points that are not of the given input, and the pieces as segments.
  void add_to(Plc<2>& plc) const;

 private:
  using Piece = std::array<std::uint32_t, 2>;  // places, the smaller first
  struct Side {
    int marker = 0;
    std::uint32_t parent = 0;              // where its places come from; of the first: itself
    Motion<2> motion{};                    // from the parent, or to it
    bool is_image = true;                  // the former
    std::vector<std::uint32_t> given{};    // points of the input on it
    std::vector<Point2> at{};              // of each place
    std::vector<std::uint32_t> point{};    // that of the input; no_entity: none
    std::vector<std::uint32_t> segment{};  // of the input, on which it lies
  };
  /// A subsegment of a mesh, from 0 to 1 along a piece.
  struct Part {
    double from, to, length;
  };

  void make_sides(const std::vector<PeriodicSides<2>>& pairs);
  void find_given_points();
  void find_motions(std::vector<PeriodicSides<2>>& pairs) const;
  void order_sides(const std::vector<PeriodicSides<2>>& pairs);
  void find_places();
  void require_consistent(const std::vector<PeriodicSides<2>>& pairs) const;
  void find_pieces();
  std::vector<Piece> pieces_on(const Side& side) const;
  std::uint32_t segment_at(int marker, const Point2& p) const;
  Point2 from_parent(const Side& side, const Point2& p) const;
  Point2 to_parent(const Side& side, const Point2& p) const;
  std::vector<std::vector<Part>> parts_of_pieces(const OutputMesh<2>& mesh) const;
  void halve(const Piece& ends, double from, double to, const std::vector<Part>& parts, const Piece& whole,
             std::vector<Piece>& made);
  std::uint32_t add_place(const Point2& on_first, std::uint32_t origin, int marker);
  std::vector<std::int64_t> numbers(std::initializer_list<std::uint32_t> points) const;
  [[noreturn]] void refuse_place(const Point2& p, int there, std::uint32_t origin, int marker) const;

  const Plc<2>& plc_;
  const double reach_;  // within which things meet
  std::vector<Side> sides_;
  std::vector<std::uint32_t> order_;  // of sides: parents first
  std::map<int, std::uint32_t> side_of_;
  std::vector<Piece> pieces_;
};

}  // namespace pgdr::detail
