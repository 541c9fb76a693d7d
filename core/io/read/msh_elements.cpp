// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "io/read/msh_elements.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

namespace pgdr::detail {
namespace {

constexpr std::int32_t line = 1, triangle = 2, quadrilateral = 3, tetrahedron = 4, point = 15;
constexpr MshType types[] = {
    {line, line, 1, 2, 2, "Lines"},
    {triangle, triangle, 2, 3, 3, "Triangles"},
    {quadrilateral, quadrilateral, 2, 4, 4, "Quadrilaterals"},
    {tetrahedron, tetrahedron, 3, 4, 4, "Tetrahedra"},
    {5, 5, 3, 8, 8, "Hexahedra"},
    {6, 6, 3, 6, 6, "Prisms"},
    {7, 7, 3, 5, 5, "Pyramids"},
    {point, point, 0, 1, 1, "Points"},
    {8, line, 1, 2, 3, "Lines"},
    {9, triangle, 2, 3, 6, "Triangles"},
    {11, tetrahedron, 3, 4, 10, "Tetrahedra"},
};

}  // namespace

MshType MshElements::type_of(std::int32_t code) const {
  for (const MshType& type : types) {
    if (type.number == code) return type;
  }
  in_.fail(Errc::unknown_format,
           "elements of type " + std::to_string(code) +
               " are not read: only points, quadrilaterals and cells of first order, and lines, triangles and "
               "tetrahedra of first and second");
}

double MshElements::label_of_physical(int dimension, int physical) const {
  const auto it = names_.find({dimension, physical});
  return it == names_.end() ? physical : it->second;
}

double MshElements::label_of_entity(int dimension, std::int32_t entity) const {
  const auto it = physical_.find({dimension, entity});
  return it == physical_.end() ? 0 : label_of_physical(dimension, it->second);
}

void MshElements::set_nodes(std::vector<std::uint64_t> tags) {
  nodes_ = std::move(tags);
  dense_ = nodes_.empty() || nodes_.back() - nodes_.front() == nodes_.size() - 1;
  point_markers_.resize(nodes_.size());
}

std::optional<std::uint32_t> MshElements::find_node(std::uint64_t tag) const {
  if (dense_ && !nodes_.empty()) {
    const std::uint64_t at = tag - nodes_.front();
    return at < nodes_.size() ? std::optional(static_cast<std::uint32_t>(at)) : std::nullopt;
  }
  const auto it = std::lower_bound(nodes_.begin(), nodes_.end(), tag);
  if (it == nodes_.end() || *it != tag) return std::nullopt;
  return static_cast<std::uint32_t>(it - nodes_.begin());
}

std::uint32_t MshElements::node(std::uint64_t tag, std::uint64_t element) const {
  if (const auto found = find_node(tag)) return *found;
  const auto id = static_cast<std::int64_t>(tag);
  in_.fail(Errc::index_out_of_range,
           "element " + std::to_string(element) + " refers to node " + std::to_string(id) + ", which is not there",
           {static_cast<std::int64_t>(element), id});
}

void MshElements::add_point(std::uint32_t node, double label) {
  if (!(label >= -2147483648.0 && label <= 2147483647.0) || label != std::floor(label))
    in_.fail(Errc::syntax, "the label of a point is no integer");
  if (point_markers_[node] == 0) point_markers_[node] = static_cast<int>(label);
  required_.resize(nodes_.size());
  required_[node] = 1;
}

template <std::size_t N>
void MshElements::append(List<N>& list, std::uint64_t tag, const std::array<std::uint32_t, 8>& nodes, double label) {
  auto& element = list.elements.emplace_back();
  std::copy_n(nodes.begin(), N, element.corners.begin());
  element.label = label;
  list.tags.push_back(tag);
  if (with_lines_) list.lines.push_back(static_cast<std::uint32_t>(in_.line()));
}

void MshElements::add(const MshType& type, std::uint64_t tag, const MshNodes& tags, double label) {
  std::array<std::uint32_t, 8> nodes{};
  for (std::size_t k = 0; k < type.corners; ++k) nodes[k] = node(tags[k], tag);
  if (type.nodes > type.corners) mid_sides_.resize(nodes_.size());
  for (std::size_t k = type.corners; k < type.nodes; ++k) mid_sides_[node(tags[k], tag)] = 1;
  switch (type.code) {
    case point: return add_point(nodes[0], label);
    case line: return append(edges_, tag, nodes, label);
    case triangle: return append(triangles_, tag, nodes, label);
    case quadrilateral: return append(quadrilaterals_, tag, nodes, label);
    case tetrahedron: return append(tetrahedra_, tag, nodes, label);
    default: break;
  }
  if (other_cells_.empty()) {
    other_cells_ = type.name;
    other_line_ = in_.line();
  }
  other_corners_.insert(other_corners_.end(), nodes.begin(), nodes.begin() + static_cast<std::ptrdiff_t>(type.corners));
}

template <std::size_t N>
void MshElements::sort(List<N>& list) {
  if (std::is_sorted(list.tags.begin(), list.tags.end())) return;
  std::vector<std::size_t> order(list.tags.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&list](std::size_t a, std::size_t b) { return list.tags[a] < list.tags[b]; });
  list.elements = permuted(list.elements, order);
  if (!list.lines.empty()) list.lines = permuted(list.lines, order);
}

void MshElements::finish(FileMesh& mesh) {
  sort(edges_);
  sort(triangles_);
  sort(quadrilaterals_);
  sort(tetrahedra_);
  mesh.edges = std::move(edges_.elements);
  mesh.edge_lines = std::move(edges_.lines);
  mesh.triangles = std::move(triangles_.elements);
  mesh.triangle_lines = std::move(triangles_.lines);
  mesh.quadrilaterals = std::move(quadrilaterals_.elements);
  mesh.quadrilateral_lines = std::move(quadrilaterals_.lines);
  mesh.tetrahedra = std::move(tetrahedra_.elements);
  mesh.other_cells = other_cells_;
  mesh.other_line = other_line_;
  mesh.other_corners = std::move(other_corners_);
  mesh.point_markers = std::move(point_markers_);
  mesh.required = std::move(required_);
  mesh.mid_sides = std::move(mid_sides_);
}

}  // namespace pgdr::detail
