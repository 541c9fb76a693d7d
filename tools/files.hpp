// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Questions about file names that are asked before any work is done.
#pragma once

#include <initializer_list>
#include <string>

#include "options.hpp"
#include "pgdr/io.hpp"

namespace pgdr::tool {

/// Upper or lower case.
bool has_extension(const std::string& file, std::initializer_list<const char*> extensions);
/// Files that are `-` get the names of standard streams (stream_name), with the format that --format says. A mesh that goes to
/// standard output is all that is printed there. @throws UsageError bad_option: there is none
void name_streams(MeshArguments& a);
void name_streams(CheckArguments& a);
void name_streams(InfoArguments& a);

/// What can be known of the files of a mesh without writing them is said before the work, not after it.
/// @throws UsageError unknown_format, FileError cannot_write
void require_mesh_writable(const std::string& output);

/// What only some formats can hold is refused for the others. @throws UsageError bad_option
void require_format(const MeshArguments& a);

/// How a mesh is written: numbered as the input is, if it is one of the formats that number at will.
WriteOptions write_options(const MeshArguments& a, std::uint32_t first_index_of_input);

/// Meshes in formats that are no inputs are refused with what can be done. @throws InputError unknown_format
void require_input_format(const std::string& file);

}  // namespace pgdr::tool
