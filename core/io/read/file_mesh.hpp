// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// What a .mesh or .msh file holds, before it is known what it is wanted for: as an input its surface counts (3D; its
// edges in 2D), as a mesh its cells. Coordinates are three, and the dimension follows from the content where the format
// or the program that wrote the file does not tell it.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "pgdr/output_mesh.hpp"
#include "pgdr/periodic.hpp"
#include "pgdr/plc.hpp"

namespace pgdr::detail {

struct FileMesh {
  /// Labels are doubles, so that markers and region attributes are both what they were.
  template <std::size_t N>
  struct Element {
    std::array<std::uint32_t, N> corners;
    double label = 0;
  };

  std::string file;
  int dimension = 3;               ///< as stated: 2 or 3; where it is 3, flat files are 2D all the same
  bool dimension_certain = false;  ///< the statement holds for flat files, too
  std::uint64_t dimension_line = 0;

  std::vector<Point3> points;
  std::vector<int> point_markers;       ///< one a point
  std::vector<std::uint8_t> required;   ///< one a point, or empty: points that are kept although no surface has them
  std::vector<std::uint8_t> mid_sides;  ///< one a point, or empty: elements of second order have it in the middle of an edge
  std::vector<std::uint32_t> point_lines;
  std::size_t input_points = 0;
  std::uint32_t first_index = 1;

  std::vector<Element<2>> edges;
  std::vector<Element<3>> triangles;
  std::vector<Element<4>> quadrilaterals;
  std::vector<Element<4>> tetrahedra;
  Names names;  ///< of labels, whatever has them
  /// Names of the labels of elements of one dimension: by dimension and label.
  std::map<std::pair<int, double>, std::string> group_names;
  std::vector<std::uint32_t> edge_lines, triangle_lines, quadrilateral_lines;

  /// Two sides of which the file says that they correspond, by their labels, with a motion of 4 x 4 numbers, or none.
  struct PeriodicLink {
    int dimension;
    double from, to;
    std::vector<double> affine;
    std::vector<std::array<std::uint32_t, 2>> points;  ///< of the one, and of the other
  };
  std::vector<PeriodicLink> periodic_links;

  /// Hexahedra, prisms and pyramids: what they are called, the line of the first, all their corners.
  std::string other_cells;
  std::uint64_t other_line = 0;
  std::vector<std::uint32_t> other_corners;
};

/// 2 if that is stated, or if all points have z = 0 and there are no cells of volume; else 3.
int dimension_of(const FileMesh& mesh);
/// Whether there are cells: of volume in 3D, triangles and quadrilaterals in 2D.
bool has_cells(const FileMesh& mesh);

/// Which points elements have in the middles of edges, and nothing has as a corner; empty: none.
std::vector<std::uint8_t> dropped_mid_sides(const FileMesh& mesh);
/// Takes these out. @returns how many they are
std::size_t drop_mid_sides(FileMesh& mesh);

/// Leaves the rows, of so many items each, that are not dropped.
template <class Item>
void keep_rows(std::vector<Item>& items, std::size_t width, const std::vector<std::uint8_t>& dropped) {
  if (items.empty() || dropped.empty()) return;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < dropped.size(); ++i)
    for (std::size_t k = 0; k < width && !dropped[i]; ++k) items[kept++] = items[i * width + k];
  items.resize(kept);
}

/// The surface and the edges. In 2D a quadrilateral is two triangles. Cells add what of their boundary, and of the faces between
/// different labels, the surface lacks; a region seed for each label, in each part that facets enclose; a hole in each void; and
/// are dropped, with the points of them alone.
/// @throws InputError syntax (another dimension), unknown_format (cells that are no simplices, and no surface),
///   self_crossing_facet (2D: a quadrilateral that is no two triangles)
template <int D>
Plc<D> to_plc(FileMesh&& mesh);

/// @throws InputError syntax (another dimension; labels that are no markers), unknown_format (cells that are no simplices)
template <int D>
OutputMesh<D> to_output_mesh(FileMesh&& mesh);

/// What the links say, without their elements. @throws InputError syntax (another dimension; labels that are no markers)
template <int D>
StatedPeriods to_periods(const FileMesh& mesh);

}  // namespace pgdr::detail
