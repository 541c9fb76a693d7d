// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Reconnection of a small polyhedron: of all ways to fill it with tetrahedra of its vertices, one whose worst cell is best, as
// far as a bounded search finds it (Liu, Chen, Sun, "Small polyhedron reconnection"; Marot, Remacle 2020). The search takes the
// open face with the fewest cells that may stand on it, tries each, and goes back where nothing better can come of it. Cells that
// are positive and whose oriented boundary is that of the polyhedron tile it, so that no test for intersections is needed; some
// are made, of cells against the given faces and edges, since they end vain searches early. Points and numbers alone; no mesh.
// One thread at a time.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "optimize/cell_quality.hpp"
#include "optimize/numbers.hpp"
#include "pgdr/types.hpp"

namespace pgdr {

/// A polyhedron to be filled.
struct Polyhedron {
  using Index = std::uint8_t;         ///< into the points
  using Face = std::array<Index, 3>;  ///< orient3d of the three and a point beside them in the polyhedron is positive
  using Cell = std::array<Index, 4>;  ///< positively oriented

  std::vector<Point3> points;  ///< at most PolyhedronFilling::most_points, pairwise distinct
  std::vector<Face> faces;     ///< a closed surface; one may occur twice, turned over, where the inside is on both sides of it
  /// Edges that the filling must have: subsegments.
  std::vector<std::array<Index, 2>> edges;
  std::vector<Index> kept;  ///< points that the filling must have: of the input, or on one of its entities
  /// Sets of points that lie in one facet each, one bit a point: a cell with all corners in one is flat but for rounding.
  std::vector<std::uint32_t> flat_sets;
  int region = 0;      ///< of all cells
  double volume6 = 0;  ///< six times its volume, rounded

  /// Forgets all but the memory.
  void clear();
};

/// Fills polyhedra.
class PolyhedronFilling {
 public:
  static constexpr std::size_t most_points = 32;                          ///< of a polyhedron, as a set of them is a word
  static constexpr std::size_t most_cells = numbers::most_filling_cells;  ///< that a polyhedron should be made of
  static constexpr std::size_t most_nodes = numbers::most_filling_nodes;  ///< that one search lays

  PolyhedronFilling();
  /// Looks for a filling with a least quality above `enough` and, of these, as good as it finds one. Signs of cells are exact.
  /// False if there is none, or none was found. `most_poor`: so many cells may have a quality below 1. What is found does not
  /// depend on the numbers of the points, nor on the order of faces. @throws UsageError bad_size as CellQuality::of
  bool find(const Polyhedron& polyhedron, const CellQuality& quality, double enough, std::size_t most_poor);
  /// The cells of the filling. Each is as it was measured: in this order of corners it has the same quality to the last bit.
  /// @pre find() was successful
  const std::vector<Polyhedron::Cell>& cells() const { return best_; }
  double least_quality() const { return least_; }     ///< of these
  std::uint64_t nodes() const { return all_nodes_; }  ///< cells laid by all searches

 private:
  using Index = Polyhedron::Index;
  using Set = std::uint32_t;         // of points, one bit each
  using FaceNumber = std::uint16_t;  // twice the number of its three corners, and 1 if it is seen from outside of their plane
  enum class Side : std::uint8_t { free, open, taken };
  struct Sides {
    Set above, below;  // points strictly on the two sides of a plane
  };
  struct OpenFace {
    FaceNumber face;
    Set apexes;  // that it may have
  };
  struct Candidate {
    double quality;
    int closes;  // faces
    Index apex;
  };
  struct Laid {
    Polyhedron::Cell corners;  // ascending
    bool turned;               // they are in negative order
  };
  struct Filling {
    double least = 1;  // quality
    std::size_t poor = 0;
    double volume6 = 0;
  };

  void prepare();
  bool open_given_faces();
  const Sides& sides(std::size_t triple);
  Set inner_side(FaceNumber f);
  Simplex<3> simplex(const Polyhedron::Cell& corners, bool turned) const;
  double quality_of(const Polyhedron::Cell& corners, bool turned);
  bool may_be(const Polyhedron::Cell& corners, bool turned);
  bool is_crossed(const Polyhedron::Cell& corners, bool turned);
  bool edge_is_crossed(Index p, Index q);
  bool face_is_crossed(std::size_t triple);
  bool crosses(Index p, Index q, std::size_t triple);
  Set apexes_of(FaceNumber f);
  Set apexes_left(FaceNumber f);
  bool search(std::size_t front, const Filling& so_far);
  std::size_t list_candidates(const OpenFace& on, std::array<Candidate, most_points>& list);
  bool lay(const Polyhedron::Cell& cell, bool turned, std::size_t front, std::size_t end);
  void take_back();
  bool accept(const Filling& filling);

  const Polyhedron* given_ = nullptr;
  const CellQuality* measure_ = nullptr;
  double bar_ = 0;  // what is not above it is no good
  double most_volume6_ = 0;
  std::size_t most_poor_ = 0, nodes_ = 0;
  std::uint64_t all_nodes_ = 0;

  // Points are numbered by their coordinates within, so that ties are broken by these.
  std::size_t count_ = 0;
  std::array<Index, most_points> number_{}, given_number_{};  // within, of given points; and the other way
  std::array<Point3, most_points> points_;
  std::vector<std::array<Index, 2>> edges_;
  std::vector<Set> flat_sets_;
  Set kept_ = 0;                            // corners of given faces as well
  std::array<Set, most_points> linked_{};   // to which points a given face or edge links each
  std::vector<std::size_t> walls_;          // the corners of given faces
  std::vector<Sides> sides_;                // by number of three points
  std::vector<std::uint8_t> face_crossed_;  // likewise: 2 unknown
  std::vector<std::uint8_t> edge_crossed_;  // by number of two points: 2 unknown
  std::vector<double> qualities_;           // by number of four points: negative unknown
  std::vector<std::uint8_t> possible_;      // likewise: 2 unknown
  std::vector<Set> apexes_;                 // by number of the face
  std::vector<Side> states_;                // likewise
  std::vector<OpenFace> fronts_;            // of all levels of the search, one behind the other
  std::vector<Laid> laid_;
  std::vector<Polyhedron::Cell> best_;
  double least_ = 0;
};

}  // namespace pgdr
