// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// One function a format and direction; io.cpp chooses by extension. All readers take the whole text of the file and
// its name (for messages, and for a file beside it); all throw what io.hpp says.
#pragma once

#include <filesystem>
#include <string_view>

#include "detail/file_output.hpp"
#include "pgdr/output_mesh.hpp"
#include "pgdr/plc.hpp"

namespace pgdr::detail {

template <int D>
Plc<D> read_poly(std::string_view text, const std::filesystem::path& file);
template <int D>
Plc<D> read_node(std::string_view text, const std::filesystem::path& file);
Plc<3> read_smesh(std::string_view text, const std::filesystem::path& file);
Plc<3> read_obj(std::string_view text, const std::filesystem::path& file);
Plc<3> read_off(std::string_view text, const std::filesystem::path& file);
Plc<3> read_stl(std::string_view text, const std::filesystem::path& file);

template <int D>
OutputMesh<D> read_medit(std::string_view text, const std::filesystem::path& file);
template <int D>
OutputMesh<D> read_vtu(std::string_view text, const std::filesystem::path& file);
template <int D>
void write_medit(const OutputMesh<D>& mesh, FileOutput& out);
template <int D>
void write_vtu(const OutputMesh<D>& mesh, FileOutput& out);

/// The dimension that the header states; anything but 2 and 3 is a syntax error.
int node_dimension(std::string_view text, const std::filesystem::path& file);  ///< .node, .poly
int medit_dimension(std::string_view text, const std::filesystem::path& file);
int vtu_dimension(std::string_view text, const std::filesystem::path& file);

}  // namespace pgdr::detail
