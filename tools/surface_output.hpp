// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "pgdr/plc.hpp"

namespace pgdr::tool {

/// @throws UsageError bad_option if no surface is written in a file of that name; FileError cannot_write if it cannot be
void require_surface_writable(const std::string& file);

/// Writes facets as polygons, segments, holes and regions (.poly), or the triangles of the facets (.off, .obj, .ply, .stl).
/// @throws FileError cannot_write
void write_surface(const std::string& file, const Plc<3>& plc);

}  // namespace pgdr::tool
