// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Which cells of a finished mesh have which face (2D: edge): by buckets of the smallest vertices, each of which is sorted.
// Nothing is believed of the cells but their number. Pure functions, any thread.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "numbers/corners.hpp"
#include "pgdr/error.hpp"
#include "pgdr/output_mesh.hpp"

namespace pgdr::detail {

/// A face by its vertices other than the smallest, ascending, and where it is.
template <int D>
struct CellFace {
  std::array<std::uint32_t, D - 1> others;
  std::uint64_t place;  ///< the number of its cell times D + 1, and the corner that it is opposite of
  std::uint32_t cell() const { return static_cast<std::uint32_t>(place / (D + 1)); }
  std::size_t corner() const { return static_cast<std::size_t>(place % (D + 1)); }
};

/// Calls visit(face, place) for the faces of all cells, the vertices of each sorted.
template <int D, class Visit>
void each_face(const OutputMesh<D>& mesh, const Visit& visit) {
  for (std::size_t c = 0; c < mesh.cells.size(); ++c)
    for (int i = 0; i <= D; ++i) {
      auto face = face_without(mesh.cells[c], i);
      std::sort(face.begin(), face.end());
      visit(face, (D + 1) * std::uint64_t{c} + static_cast<std::uint64_t>(i));
    }
}

/// The faces of all cells, by their smallest vertices. `begin`: of those of each vertex, and the end.
/// @throws InputError index_out_of_range
template <int D>
std::vector<CellFace<D>> faces_by_vertex(const OutputMesh<D>& mesh, std::vector<std::size_t>& begin) {
  begin.assign(mesh.points.size() + 1, 0);
  each_face<D>(mesh, [&](const auto& face, std::uint64_t) {
    if (face.back() >= mesh.points.size())
      throw InputError({Errc::index_out_of_range, "a cell has a vertex that does not exist", {}, 0, {face.back()}, {}});
    ++begin[face[0] + 1];
  });
  for (std::size_t v = 1; v < begin.size(); ++v) begin[v] += begin[v - 1];
  std::vector<CellFace<D>> faces(begin.back());
  std::vector<std::size_t> next(begin.begin(), begin.end() - 1);
  each_face<D>(mesh, [&](const auto& face, std::uint64_t place) {
    CellFace<D>& f = faces[next[face[0]]++];
    std::copy(face.begin() + 1, face.end(), f.others.begin());
    f.place = place;
  });
  return faces;
}

/// Calls visit(v, group) for each face, of which v is the smallest vertex: the group has it as its cells do, in their order. By
/// ascending vertices. @throws InputError index_out_of_range
template <int D, class Visit>
void each_face_group(const OutputMesh<D>& mesh, const Visit& visit) {
  std::vector<std::size_t> begin;
  std::vector<CellFace<D>> faces = faces_by_vertex<D>(mesh, begin);
  for (std::uint32_t v = 0; v + 1 < begin.size(); ++v) {
    const auto bucket = std::span(faces).subspan(begin[v], begin[v + 1] - begin[v]);
    std::sort(bucket.begin(), bucket.end(), [](const CellFace<D>& a, const CellFace<D>& b) {
      return a.others != b.others ? a.others < b.others : a.place < b.place;
    });
    for (std::size_t i = 0, j; i < bucket.size(); i = j) {
      for (j = i + 1; j < bucket.size() && bucket[j].others == bucket[i].others;) ++j;
      visit(v, std::span<const CellFace<D>>(bucket.subspan(i, j - i)));
    }
  }
}

}  // namespace pgdr::detail
