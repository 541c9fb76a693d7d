// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// A page that shows a mesh in any browser: one file of HTML with the viewer (the .js beside this, and three.js) and the arrays in
// it. No network, no server.
//
// The arrays are base64 of little-endian numbers, each a <script type="text/plain" id="pgdr-NAME">; what they mean is the JSON of
// id "pgdr-data": `arrays` has the type, the components and the rows of each by NAME. Points are 32-bit floats p that stand for
// origin + scale * p, where scale is a power of two; -1 <= p <= 1.
#pragma once

#include <iosfwd>
#include <optional>
#include <string>
#include <vector>

#include "pgdr/io.hpp"
#include "pgdr/output_mesh.hpp"

namespace pgdr::tool {

/// The plane where coordinate `axis` has this value.
struct CutPlane {
  int axis;
  double value;
};

/// What a page shows first; all of it can be changed there.
struct PageStart {
  std::string title;
  std::string color = "quality";  ///< or dihedral, radius_edge, volume, region, marker, name, leaf, or the name of a field
  std::optional<CutPlane> cut;    ///< cells whose centroid is on the eye's side are left out
  std::optional<Point3> from;     ///< 3D: towards the eye; none: as usual
};

/// Whether this build has three.js, and `write_page`.
bool has_page();

/// @param fields  each with as many numbers as there are points, or cells, times its components
/// @throws UsageError bad_option: a colouring that there is not, or a build without three.js
template <int D>
void write_page(const OutputMesh<D>& mesh, std::vector<MeshField> fields, const PageStart& start, std::ostream& out);

}  // namespace pgdr::tool
