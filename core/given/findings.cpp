// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The words of the checker: names of the kinds of findings (stable, they stand in reports), vertices and cells in
// messages, and the verdict as an exit code.
#include "given/findings.hpp"

#include <charconv>

namespace pgdr {

std::string_view name(CheckFinding::Kind kind) {
  static constexpr std::string_view names[] = {"not_finite",
                                               "bad_index",
                                               "repeated_vertex",
                                               "duplicate_point",
                                               "unreferenced_point",
                                               "inverted_cell",
                                               "bad_link",
                                               "overlapping",
                                               "not_delaunay",
                                               "missing_input_point",
                                               "segment_not_conforming",
                                               "facet_not_conforming",
                                               "wrong_marker",
                                               "wrong_name",
                                               "stray_constraint",
                                               "wrong_region",
                                               "wrong_volume",
                                               "hole_filled",
                                               "over_radius_edge",
                                               "over_size",
                                               "bad_reason",
                                               "off_surface",
                                               "surface_not_covered",
                                               "other_topology",
                                               "boundary_not_kept"};
  static_assert(std::size(names) == CheckFinding::kinds);
  return names[static_cast<std::size_t>(kind)];
}

int CheckReport::exit_code() const {
  if (finding_count > 0) return 6;
  return explained + unexplained + not_delaunay_unexplained > 0 ? 1 : 0;
}

namespace checking {

std::string words(double x) {
  char buffer[32];
  const auto end = std::to_chars(buffer, buffer + sizeof buffer, x);
  return std::string(buffer, end.ptr);
}

template <int D>
std::string words(const Point<D>& p) {
  std::string text = "(";
  for (int i = 0; i < D; ++i) text += (i ? ", " : "") + words(p[i]);
  return text + ")";
}

template <int D>
std::string vertex_words(const OutputMesh<D>& mesh, std::uint32_t vertex) {
  return "vertex " + std::to_string(vertex) + " " + words(mesh.points[vertex]);
}

template <int D>
std::string cell_words(const OutputMesh<D>& mesh, std::uint32_t cell) {
  return "cell " + std::to_string(cell) + " (" + list_words(mesh.cells[cell]) + ")";
}

template std::string words(const Point<2>&);
template std::string words(const Point<3>&);
template std::string vertex_words(const OutputMesh<2>&, std::uint32_t);
template std::string vertex_words(const OutputMesh<3>&, std::uint32_t);
template std::string cell_words(const OutputMesh<2>&, std::uint32_t);
template std::string cell_words(const OutputMesh<3>&, std::uint32_t);

}  // namespace checking
}  // namespace pgdr
