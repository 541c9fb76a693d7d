// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// 2D: the Voronoi cells of the vertices of a finished mesh, clipped to its domain, for finite volumes. Pure functions, any
// thread.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <iosfwd>
#include <vector>

#include "pgdr/export.hpp"
#include "pgdr/output_mesh.hpp"
#include "pgdr/types.hpp"

namespace pgdr PGDR_API {

/// Cells about the n vertices of a mesh, in the order of these, and links between them. Lengths in units of the input.
struct VoronoiCells {
  std::vector<Point2> sites;  ///< n: the vertices of the mesh
  /// Corners of cells: the circumcentre of each triangle; the middles of boundary edges, by triangle and the corner that they are
  /// opposite of; the vertices of the boundary, ascending.
  std::vector<Point2> points;
  /// n + 1: cell i has corners[offsets[i]] to before corners[offsets[i + 1]]; none: a vertex without triangles.
  std::vector<std::size_t> offsets;
  /// Into `points`, counterclockwise. A vertex of the boundary is a corner of its own cell, once for each fan of triangles about
  /// it. Where vertices lie on one circle, corners that follow each other are one place.
  std::vector<std::uint32_t> corners;
  std::vector<double> areas;                        ///< n: of the cells; together that of the domain
  std::vector<std::array<std::uint32_t, 2>> links;  ///< cells with a common side, the smaller first, sorted: the mesh's edges
  std::vector<double> widths;                       ///< of each link: how long that side is, which is at right angles to it
  std::vector<double> lengths;                      ///< of each link: from site to site
};

/// The cells of a mesh that is conforming Delaunay (RefineOptions::conforming_delaunay), in n log n.
/// @param mesh  its triangles counterclockwise, as all of this library
/// @throws UsageError bad_option: a mesh with circumcentres beyond the boundary, or in the wrong order, by more than rounding: an
///   angle opposite an edge of the boundary above 90 degrees, two opposite another edge above 180 together; an edge with more
///   than two triangles; a triangle that is clockwise beside one that is not. InputError index_out_of_range: a vertex that does
///   not exist
VoronoiCells voronoi_cells(const OutputMesh<2>& mesh);

/// Writes cells as a text, .voronoi: a line `# pgdr voronoi 1`; the numbers of points and cells; the points; of each cell its
/// site, how many corners it has, and their rows, from 0. Numbers as short as they are read back exactly. Needs `sites`,
/// `points`, `offsets` and `corners` alone. What becomes of the stream is for its owner to see (output_files.hpp: write_file).
void write_voronoi(std::ostream& out, const VoronoiCells& cells);

}  // namespace pgdr
