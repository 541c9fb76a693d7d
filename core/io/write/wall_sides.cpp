// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "io/write/wall_sides.hpp"

#include <algorithm>
#include <compare>
#include <utility>

namespace pgdr::detail {
namespace {

bool comes_before(double a, double b) { return std::strong_order(a, b) < 0; }

}  // namespace

template <int D>
std::vector<std::array<CellFace, 2>> sides_of_walls(const OutputMesh<D>& mesh) {
  using Face = std::array<std::uint32_t, D>;
  const auto& walls = walls_of<D>(mesh);
  std::vector<std::pair<Face, std::uint32_t>> by_vertices;
  std::vector<std::uint8_t> on_wall(mesh.points.size(), 0);
  for (std::uint32_t w = 0; w < walls.size(); ++w) {
    by_vertices.emplace_back(walls[w].vertices, w);
    std::sort(by_vertices.back().first.begin(), by_vertices.back().first.end());
    for (const std::uint32_t v : walls[w].vertices) on_wall[v] = 1;
  }
  std::sort(by_vertices.begin(), by_vertices.end());
  std::vector<std::array<CellFace, 2>> sides(walls.size());
  for (std::uint32_t c = 0; c < mesh.cells.size(); ++c)
    for (std::uint32_t corner = 0; corner <= D; ++corner) {
      Face face;
      bool may_be = true;
      for (std::uint32_t k = 0, n = 0; k <= D; ++k) {
        if (k == corner) continue;
        face[n++] = mesh.cells[c][k];
        may_be = may_be && on_wall[mesh.cells[c][k]] != 0;
      }
      if (!may_be) continue;
      std::sort(face.begin(), face.end());
      auto it = std::lower_bound(by_vertices.begin(), by_vertices.end(), std::pair(face, std::uint32_t{0}));
      for (; it != by_vertices.end() && it->first == face; ++it) {
        auto& [first, second] = sides[it->second];
        (first.cell == no_cell ? first : second) = {c, corner};
      }
    }
  return sides;
}

bool is_positive_number(double label) {
  return label >= 1 && label <= 2147483647.0 && label == static_cast<double>(static_cast<int>(label));
}

std::vector<int> positive_numbers(const std::vector<double>& labels) {
  std::vector<int> taken, numbers;
  for (const double label : labels)
    if (is_positive_number(label)) taken.push_back(static_cast<int>(label));
  int next = 1;
  auto used = taken.begin();
  for (const double label : labels) {
    if (is_positive_number(label)) {
      numbers.push_back(static_cast<int>(label));
      continue;
    }
    for (; used != taken.end() && *used == next; ++used) ++next;
    numbers.push_back(next++);
  }
  return numbers;
}

std::vector<double> distinct_labels(std::vector<double> labels) {
  std::sort(labels.begin(), labels.end(), comes_before);
  const auto same = [](double a, double b) { return std::strong_order(a, b) == 0; };
  labels.erase(std::unique(labels.begin(), labels.end(), same), labels.end());
  return labels;
}

template std::vector<std::array<CellFace, 2>> sides_of_walls<2>(const OutputMesh<2>&);
template std::vector<std::array<CellFace, 2>> sides_of_walls<3>(const OutputMesh<3>&);

}  // namespace pgdr::detail
