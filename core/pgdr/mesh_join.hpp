// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// One conforming mesh of several whose boundaries match. A pure function; any thread.
//
// Vertices are one where their coordinates are equal (-0 is 0), faces (2D: edges) where their vertices are. Nothing is moved, and
// nothing has a tolerance. What must hold for that, and is decided exactly:
//
// * A face has at most two cells, on its two sides.
// * A face of one cell alone meets the faces, and the cells, of other meshes in common vertices, edges and faces only.
//
// Then the cells of all are one mesh, if those of each alone are. Count at each place the cells that hold it. The count changes
// at faces of one cell alone, by one, and beside these it is 0 and 1, since no cell of another mesh reaches into them; far away
// it is 0. So it is 0 or 1 everywhere: no cells overlap, of two meshes or of more. And cells that do not overlap meet in common
// vertices, edges and faces: around a place that is on no face of one cell alone, the cells that have what lies there as an edge,
// say, leave no room for others that do not; at a place on such a face what others have there was compared with it.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <stop_token>
#include <string>
#include <vector>

#include "pgdr/error.hpp"
#include "pgdr/export.hpp"
#include "pgdr/output_mesh.hpp"

namespace pgdr PGDR_API {

/// How meshes are joined.
struct JoinOptions {
  /// Labels of different meshes become different ones: 1, 2, ... in the order of the meshes, and of the labels of each.
  /// DEFAULT: equal labels stay one label.
  bool relabel = false;
  /// What each mesh is called in messages, as its file. DEFAULT: "mesh 0", "mesh 1", ...
  std::vector<std::string> names;
  /// Ends it by a CancelledError, from any thread. DEFAULT: nothing can.
  std::stop_token stop = {};
};

/// Faces, or edges of segments, that two meshes have in common, of equal markers each.
struct SharedConstraints {
  std::array<std::uint32_t, 2> meshes{};  ///< the first one, whose marker stands, and a later one; they count from 0
  std::array<int, 2> markers{};           ///< what the two of them say; 0 where one lists none
  std::uint64_t count = 0;                ///< so many
  friend bool operator==(const SharedConstraints&, const SharedConstraints&) = default;  ///< the same
};

/// A label of one mesh, and what has become of it.
struct JoinedLabel {
  std::uint32_t mesh = 0;                                                    ///< which counts from 0
  double given = 0;                                                          ///< what its cells had
  double label = 0;                                                          ///< what they have
  friend bool operator==(const JoinedLabel&, const JoinedLabel&) = default;  ///< the same
};

/// The mesh, and what is what of those that were given.
template <int D>
struct JoinedMesh {
  /// First the input points of all, mesh by mesh, if each says which they are, then the others; cells mesh by mesh, in their
  /// order. A face (2D: edge) of one cell alone, of two labels, or of two meshes is a subfacet (subsegment) even if no mesh lists
  /// it: then its marker is 0. Where several meshes have something, what the first one says of it stands.
  OutputMesh<D> mesh;
  std::vector<std::vector<std::uint32_t>> vertices;  ///< of each mesh, the vertex of `mesh` that each of its points has become
  std::vector<std::uint64_t> first_cell;             ///< of each mesh; and behind them how many cells there are
  std::uint64_t shared_points = 0;                   ///< vertices of several meshes
  std::vector<SharedConstraints> interfaces;         ///< faces (2D: edges) with a cell of one mesh and one of another; sorted
  std::vector<SharedConstraints> shared_segments;    ///< 3D: subsegments that several meshes list; sorted
  std::vector<JoinedLabel> labels;                   ///< all labels of all meshes; sorted
  std::uint64_t added_walls = 0;                     ///< subfacets (2D: subsegments) that no mesh lists
  std::vector<std::string> dropped;                  ///< what of the meshes does not come along, and why, a sentence each
  /// Vertices of boundaries that may be meant to be one (near_points), within two ulps of a float of the largest coordinate.
  std::vector<Diagnostic> warnings;
};

/// The one mesh of several. Markers of points come along if all meshes have them, attributes if all have equally many; at common
/// vertices those of the first mesh stand, and `dropped` says where others are unlike. Names likewise.
///
/// n log n, and linear in the pairs of boxes, of faces of one cell alone and of faces and cells of other meshes, that meet. On
/// the calling thread. The order of the meshes decides numbers, and whose word stands, and nothing else.
/// @param meshes  one or more, each sound in itself, as check() decides it without an input: here it is only seen whether indices
///   and arrays fit, coordinates are finite, points are distinct, cells positively oriented, and two at a face on its two sides
/// @param options  names for messages, and whether labels stay apart
/// @throws UsageError bad_option: no mesh, or another number of names; InputError index_out_of_range, not_finite,
/// duplicate_point,
///   inconsistent_orientation: a mesh that is not sound; point_on_facet, point_on_segment, facets_overlap, entities_intersect:
///   the boundaries meet, and do not match; bodies_overlap: insides overlap, of meshes whose boundaries match. What is wrong is
///   in InputError::diagnostics(), the first twenty of each kind, with the vertices in the numbers of their own meshes, from 0,
///   and where they are; ResourceError ids_exhausted; CancelledError
template <int D>
JoinedMesh<D> join_meshes(std::span<const OutputMesh<D>* const> meshes, const JoinOptions& options = {});

}  // namespace pgdr
