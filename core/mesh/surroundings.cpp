// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "mesh/surroundings.hpp"

#include <bit>

namespace pgdr {

template <int D>
std::optional<std::uint64_t> surroundings_of(const Mesh<D>& mesh, std::span<const CellId> slots, bool alone) {
  std::uint64_t sum = 0;
  // A hash of two multiplications, each a bijection of its operand: cells in another order make another number.
  const auto add = [&](CellId c) {
    const std::uint64_t cell = std::uint64_t{index(c)} << 16 | mesh.birth(c);
    sum = (std::rotl(sum, 25) ^ cell * 0x9e3779b97f4a7c15u) * 0xbf58476d1ce4e5b9u;
  };
  for (const CellId c : slots) {
    if (!mesh.alive(c)) return std::nullopt;
    add(c);
    if (alone) continue;
    for (const Link next : mesh.cell(c).links)
      if (next) add(next.cell());
  }
  return sum;
}

template <int D>
std::uint64_t versions_at(const Mesh<D>& mesh, CellId c) {
  std::uint64_t sum = 0;
  for (const VertexId v : mesh.cell(c).vertices)
    sum = (std::rotl(sum, 25) ^ mesh.note(v).version * 0x9e3779b97f4a7c15u) * 0xbf58476d1ce4e5b9u;
  return sum;
}

template std::optional<std::uint64_t> surroundings_of<2>(const Mesh<2>&, std::span<const CellId>, bool);
template std::optional<std::uint64_t> surroundings_of<3>(const Mesh<3>&, std::span<const CellId>, bool);
template std::uint64_t versions_at<2>(const Mesh<2>&, CellId);
template std::uint64_t versions_at<3>(const Mesh<3>&, CellId);

}  // namespace pgdr
