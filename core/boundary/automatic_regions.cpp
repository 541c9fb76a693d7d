// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "boundary/automatic_regions.hpp"

#include <algorithm>
#include <numeric>

#include "space/make_set.hpp"

namespace pgdr::detail {
namespace {

using Pair = std::array<std::uint32_t, 2>;

}  // namespace

template <int D>
std::vector<Pair> neighbouring_components(const Mesh<D>& mesh, std::span<const std::uint32_t> component, const Bulk& bulk) {
  std::vector<Pair> out = bulk.gather<Pair>(mesh.cell_bound(), [&](std::size_t i, std::vector<Pair>& found) {
    const CellId c{static_cast<std::uint32_t>(i)};
    if (!mesh.alive(c) || mesh.constraints(c) == nullptr) return;
    for (int f = 0; f <= D; ++f) {
      if (!mesh.constrained(c, f)) continue;
      const Pair both{component[i], component[index(mesh.cell(c).links[f].cell())]};
      if (both[0] < both[1] && (found.empty() || found.back() != both)) found.push_back(both);
    }
  });
  make_set(out, bulk);
  return out;
}

/// The place of each point in the order of coordinates.
template <int D>
std::vector<std::uint32_t> ranks_of(std::span<const Point<D>> points, const Bulk& bulk) {
  std::vector<std::uint32_t> by_place(points.size()), rank(points.size());
  bulk.each(points.size(), [&](std::size_t i) { by_place[i] = static_cast<std::uint32_t>(i); });
  bulk.sort(by_place, [&](std::uint32_t a, std::uint32_t b) { return lex_less(points[a], points[b]); });
  bulk.each(points.size(), [&](std::size_t i) { rank[by_place[i]] = static_cast<std::uint32_t>(i); });
  return rank;
}

template <int D>
std::vector<std::uint32_t> components_in_order(const Mesh<D>& mesh, const Domain<D>& domain,
                                               std::span<const std::uint32_t> component, std::uint32_t count, const Bulk& bulk) {
  const std::vector<std::uint32_t> rank = ranks_of<D>(domain.points(), bulk);
  using Key = std::pair<std::uint32_t, std::uint64_t>;  // of a component: one of its segments
  std::vector<Key> keys = bulk.gather<Key>(mesh.cell_bound(), [&](std::size_t i, std::vector<Key>& out) {
    const CellId c{static_cast<std::uint32_t>(i)};
    const auto* k = mesh.alive(c) ? mesh.constraints(c) : nullptr;
    if (k == nullptr) return;
    const auto add = [&](EntityId segment) {
      const auto& ends = domain.segments()[segment].points;  // the lesser first
      out.emplace_back(component[i], std::uint64_t{rank[ends[0]]} << 32 | rank[ends[1]]);
    };
    for (int f = 0; f <= D; ++f) {
      if (!k->has_face(f)) continue;
      if constexpr (D == 2) {
        add(k->face_entity[static_cast<std::size_t>(f)]);
      } else {
        for (int e = 0; e < 6; ++e)
          if (k->has_edge(e) && edge_ends[e][0] != f && edge_ends[e][1] != f) add(k->edge_entity[e]);
      }
    }
  });
  make_set(keys, bulk);
  std::vector<std::size_t> begin(count + 1, 0);
  for (std::uint32_t c = 0; c < count; ++c)
    begin[c + 1] = static_cast<std::size_t>(std::lower_bound(keys.begin(), keys.end(), Key(c + 1, 0)) - keys.begin());
  std::vector<std::uint32_t> order(count);
  std::iota(order.begin(), order.end(), 0u);
  const auto of = [&](std::uint32_t c) { return std::span(keys).subspan(begin[c], begin[c + 1] - begin[c]); };
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return std::ranges::lexicographical_compare(of(a), of(b), {}, &Key::second, &Key::second);
  });
  return order;
}

#define PGDR_INSTANTIATE(D)                                                                                                 \
  template std::vector<Pair> neighbouring_components(const Mesh<D>&, std::span<const std::uint32_t>, const Bulk&);          \
  template std::vector<std::uint32_t> components_in_order(const Mesh<D>&, const Domain<D>&, std::span<const std::uint32_t>, \
                                                          std::uint32_t, const Bulk&);
PGDR_INSTANTIATE(2)
PGDR_INSTANTIATE(3)
#undef PGDR_INSTANTIATE

}  // namespace pgdr::detail
