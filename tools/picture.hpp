// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// A flat picture: polygons and lines in pixels, later ones over earlier ones; made of a mesh, written as .svg or .png.
#pragma once

#include <array>
#include <iosfwd>
#include <vector>

#include "options.hpp"
#include "pgdr/output_mesh.hpp"
#include "view/colors.hpp"

namespace pgdr::tool {

using Pixel = std::array<float, 2>;  ///< to the right, downwards

struct Picture {
  struct Triangle {
    std::array<Pixel, 3> corners;
    Color fill, edge;
  };
  int width = 0, height = 0;
  std::vector<Triangle> triangles;
  std::vector<std::array<Pixel, 2>> lines;  ///< over all triangles
};

inline constexpr double edge_width = 0.6, line_width = 1.4;  ///< in pixels

/// 2D: every cell and subsegment. 3D: the faces of the surface that `a` leaves in sight, a hidden one before what hides it.
/// @throws UsageError if the flags are of the other dimension or the cut leaves nothing; InputError if there is nothing to
///   draw
template <int D>
Picture draw(const OutputMesh<D>& mesh, const ViewArguments& a);

/// Whether this build has `write_png`.
bool has_png();
void write_svg(const Picture& picture, std::ostream& out);
/// @throws std::bad_alloc; what else fails leaves `out` in a failed state
void write_png(const Picture& picture, std::ostream& out);

}  // namespace pgdr::tool
