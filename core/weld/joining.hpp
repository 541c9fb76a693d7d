// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// What the stages of a join hand on, and what they find wrong. One thread.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "numbers/corners.hpp"
#include "pgdr/mesh_join.hpp"
#include "space/stop_check.hpp"

namespace pgdr::detail {

/// Errors, the first twenty of each kind in words.
class Refusals {
 public:
  bool empty() const { return count_ == 0; }
  /// Are there so many that more would help nobody?
  bool are_plenty() const { return count_ >= plenty; }
  /// `diagnostic` is called only if the error is listed.
  template <class Make>
  void add(Errc code, const Make& diagnostic) {
    ++count_;
    if (count_of_[code]++ < most_listed) listed_.push_back(diagnostic());
  }
  /// Throws the first as an InputError that has all, and these behind them, if there is any.
  void throw_any(const std::vector<Diagnostic>& behind = {}) const;

 private:
  static constexpr std::uint64_t most_listed = 20, plenty = 10000;
  std::uint64_t count_ = 0;
  std::map<Errc, std::uint64_t> count_of_;
  std::vector<Diagnostic> listed_;
};

/// A face (2D: edge) of one mesh with one cell of it alone.
template <int D>
struct OuterFace {
  std::array<std::uint32_t, D> vertices;  ///< of the joined mesh, sorted
  std::uint64_t place;                    ///< the number of its cell times D + 1, and the corner that it is opposite of
  std::uint32_t mesh;
  bool is_shared;  ///< another mesh has it, on its other side
  std::uint32_t cell() const { return static_cast<std::uint32_t>(place / (D + 1)); }
};

template <int D>
struct Joining {
  std::span<const OutputMesh<D>* const> meshes;
  const JoinOptions* options;
  StopCheck heed_stop;
  JoinedMesh<D> out;
  Refusals refusals;
  std::vector<OuterFace<D>> outer{};  ///< by their vertices, then by their cells

  std::uint32_t mesh_of(std::uint32_t cell) const {
    return static_cast<std::uint32_t>(std::ranges::upper_bound(out.first_cell, cell) - out.first_cell.begin() - 1);
  }
  std::string name(std::uint32_t mesh) const {
    return options->names.empty() ? "mesh " + std::to_string(mesh) : options->names[mesh];
  }
  /// The number that a vertex of the joined mesh has in one that has it. Linear time: for messages.
  std::uint32_t number_in(std::uint32_t mesh, std::uint32_t vertex) const {
    return static_cast<std::uint32_t>(std::ranges::find(out.vertices[mesh], vertex) - out.vertices[mesh].begin());
  }
  double label(std::uint32_t mesh, std::size_t cell) const {
    return meshes[mesh]->regions.empty() ? 0 : meshes[mesh]->regions[cell];
  }
};

/// The vertices of a face of a cell; seen from outside of the cell they run counterclockwise (2D: the cell is to the left).
template <int D>
std::array<std::uint32_t, D> outward_face(const std::array<std::uint32_t, D + 1>& cell, std::size_t corner) {
  std::array<std::uint32_t, D> face;
  for (std::size_t i = 0; i < D; ++i) face[i] = cell[face_corners<D>[corner][i]];
  if (D == 3) std::swap(face[0], face[1]);
  return face;
}

/// Numbers the points, and puts the cells into one array. @throws InputError: a mesh that is not sound
template <int D>
void join_cells(Joining<D>& joining);
/// Finds the outer faces, and those with cells on the same side.
template <int D>
void join_faces(Joining<D>& joining);
/// Do boundaries that meet match, and is nothing of one mesh inside of another?
template <int D>
void compare_boundaries(Joining<D>& joining);
/// Vertices of boundaries that may be meant to be one, as warnings.
template <int D>
void find_near_points(Joining<D>& joining);
/// Subfacets and subsegments.
template <int D>
void join_constraints(Joining<D>& joining);
/// Labels, markers and attributes of points, and names.
template <int D>
void join_data(Joining<D>& joining);

}  // namespace pgdr::detail
