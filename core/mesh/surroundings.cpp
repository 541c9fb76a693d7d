// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "mesh/surroundings.hpp"

#include <bit>

namespace pgdr {
namespace {

/// A hash of two multiplications, each a bijection of its operand: the same in another order makes another number.
std::uint64_t mixed(std::uint64_t sum, std::uint64_t more) {
  return (std::rotl(sum, 25) ^ more * 0x9e3779b97f4a7c15u) * 0xbf58476d1ce4e5b9u;
}

template <int D>
std::uint64_t mixed(std::uint64_t sum, const Point<D>& p) {
  for (int k = 0; k < D; ++k) sum = mixed(sum, std::bit_cast<std::uint64_t>(p[k] + 0.0));  // -0 becomes 0
  return sum;
}

}  // namespace

template <int D>
std::optional<std::uint64_t> surroundings_of(const Mesh<D>& mesh, std::span<const CellName> cells, std::size_t with_neighbours) {
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const CellName& c = cells[i];
    if (mesh.birth(c.cell) != c.birth) return std::nullopt;
    if (i >= with_neighbours) continue;
    for (const Link next : mesh.cell(c.cell).links)
      sum = next ? mixed<D>(sum, mesh.point(mesh.cell(next.cell()).vertices[next.face()])) : mixed(sum, 1);
  }
  return sum;
}

template <int D>
std::uint64_t place_hash(const Mesh<D>& mesh, CellId c) {
  std::uint64_t sum = 0;
  for (const VertexId v : mesh.cell(c).vertices) sum = mixed<D>(sum, mesh.point(v));
  return sum;
}

template <int D>
std::uint64_t versions_at(const Mesh<D>& mesh, CellId c) {
  std::uint64_t sum = 0;
  for (const VertexId v : mesh.cell(c).vertices) sum = mixed(sum, std::uint64_t{mesh.note(v).version});
  return sum;
}

template std::optional<std::uint64_t> surroundings_of<2>(const Mesh<2>&, std::span<const CellName>, std::size_t);
template std::optional<std::uint64_t> surroundings_of<3>(const Mesh<3>&, std::span<const CellName>, std::size_t);
template std::uint64_t place_hash<2>(const Mesh<2>&, CellId);
template std::uint64_t place_hash<3>(const Mesh<3>&, CellId);
template std::uint64_t versions_at<2>(const Mesh<2>&, CellId);
template std::uint64_t versions_at<3>(const Mesh<3>&, CellId);

}  // namespace pgdr
