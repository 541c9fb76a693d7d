// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// A mesh that is the input: of `remesh`, and of `check` for what that has made.
#pragma once

#include <string>
#include <vector>

#include "options.hpp"
#include "pgdr/io.hpp"
#include "pgdr/mesh_fields.hpp"
#include "pgdr/remesh_input.hpp"
#include "report.hpp"

namespace pgdr::tool {

template <int D>
class OldMesh {
 public:
  /// Reads the mesh, and its fields. @throws what read_mesh and read_fields throw; UsageError bad_option: its sides do not
  /// correspond as the file says
  OldMesh(InputFile& file, bool with_fields);

  const OutputMesh<D>& mesh() const { return mesh_; }
  /// What the file says of sides that correspond, if it does; verified.
  const std::vector<PeriodicSides<D>>& sides() const { return sides_; }
  /// Of each vertex, whether it has one of these markers, which may be names; empty: none was asked for.
  /// @throws UsageError for what is neither, and for a marker that no vertex has
  std::vector<std::uint8_t> required(const std::vector<std::string>& markers) const;
  /// --size-field, in the unit of the flags; no bound if there is none. @throws UsageError for a field that is none
  SizingField<D> sizes(const BoundArguments& arguments) const;
  /// Bounds on the volume (area) of each cell in a .vol (.area) file; none if there is no file. @throws what read_cell_bounds
  /// throws
  SizingField<D> sizes_of_cells(const std::string& file) const;
  /// What remesh_input() gives; facets of poor cells are then named by renamed(). The boundary stays as it
  /// is where any of it is kept.
  Plc<D> input(const MeshArguments& arguments);
  /// Reasons that name facets of input() name those of the old mesh's boundary instead.
  void rename(std::vector<PoorReason>& reasons) const;
  /// Puts what lived on the old mesh on the new one: attributes into it, fields into what is returned, as far as the output has
  /// room for them; a warning says which have none.
  MeshFields transferred(const MeshArguments& arguments, OutputMesh<D>& to, std::vector<Diagnostic>& warnings) const;

 private:
  const MeshField& field(const std::string& name) const;

  OutputMesh<D> mesh_;
  MeshFields fields_;
  std::vector<PeriodicSides<D>> sides_;
  std::vector<std::uint32_t> facet_of_input_;
};

}  // namespace pgdr::tool
