// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "cavity/tile_plan.hpp"

#include <algorithm>
#include <array>
#include <bit>

namespace pgdr::detail {

template <int D>
TilePlan<D>::TilePlan(const Mesh<D>& mesh, std::span<const VertexId> waiting, std::uint32_t vertices, const Bulk& bulk)
    : waiting_(waiting) {
  if (waiting.size() < mesh.cell_bound() / slots_a_point) return;
  find_tiles(vertices);
  if (tiles_ < fewest_tiles) return;
  make_claims(find_pairs(mesh, bulk), bulk);
  drop_wide_ranges();
  make_batches();
}

/// Tiles are as large as makes the number of points that wait in one right on average.
template <int D>
void TilePlan<D>::find_tiles(std::uint32_t vertices) {
  const std::uint64_t size = std::max<std::uint64_t>(1, vertices * points_of_visit / std::max<std::size_t>(1, waiting_.size()));
  tile_shift_ = std::max(ranges_shift, static_cast<int>(std::bit_width(size)) - 1);
  tiles_ = (vertices >> tile_shift_) + 1;
  first_waiting_.assign(tiles_ + 1, 0);
  for (const VertexId v : waiting_) ++first_waiting_[(index(v) >> tile_shift_) + 1];
  for (std::uint32_t t = 0; t < tiles_; ++t) first_waiting_[t + 1] += first_waiting_[t];
}

/// Each pair at least once, in the order of the slots of cells.
template <int D>
auto TilePlan<D>::find_pairs(const Mesh<D>& mesh, const Bulk& bulk) const -> std::vector<std::vector<Pair>> {
  constexpr std::size_t block = 8192;  // slots
  std::vector<std::vector<Pair>> pairs((mesh.cell_bound() + block - 1) / block);
  bulk.parts(pairs.size(), [&](std::size_t part) {
    std::array<Pair, 2048> last;  // those met last, by their hashes
    last.fill(~Pair{0});
    const auto end = static_cast<std::uint32_t>(std::min<std::size_t>(mesh.cell_bound(), (part + 1) * block));
    for (auto i = static_cast<std::uint32_t>(part * block); i < end; ++i) {
      if (!mesh.alive(CellId{i})) continue;
      std::array<std::uint32_t, D + 1> range;
      int corners = 0;
      for (const VertexId v : mesh.cell(CellId{i}).vertices)
        if (v != infinite_vertex) range[corners++] = index(v) >> range_shift();
      for (int a = 0; a < corners; ++a) {
        const std::uint32_t tile = range[a] >> ranges_shift;
        for (int b = 0; b < corners; ++b) {
          if (range[b] >> ranges_shift == tile) continue;
          const Pair pair = Pair{tile} << 32 | range[b];
          Pair& seen = last[(pair * 0x9e3779b97f4a7c15u) >> 53];
          if (seen == pair) continue;
          seen = pair;
          pairs[part].push_back(pair);
        }
      }
    }
  });
  return pairs;
}

/// The claim of each tile: its own ranges, then the others by number.
template <int D>
void TilePlan<D>::make_claims(std::vector<std::vector<Pair>> pairs, const Bulk& bulk) {
  const auto tile_of = [](Pair p) { return static_cast<std::uint32_t>(p >> 32); };
  constexpr std::uint32_t own = 1u << ranges_shift;
  first_claimed_.assign(tiles_ + 1, 0);
  for (const auto& some : pairs)
    for (const Pair p : some) ++first_claimed_[tile_of(p) + 1];
  for (std::uint32_t t = 0; t < tiles_; ++t) first_claimed_[t + 1] += first_claimed_[t] + own;
  claims_.resize(first_claimed_[tiles_]);
  last_claimed_.assign(first_claimed_.begin(), first_claimed_.end() - 1);
  for (std::uint32_t t = 0; t < tiles_; ++t)
    for (std::uint32_t k = 0; k < own; ++k) claims_[last_claimed_[t]++] = (t << ranges_shift) + k;
  for (const auto& some : pairs)
    for (const Pair p : some) claims_[last_claimed_[tile_of(p)]++] = static_cast<std::uint32_t>(p);
  constexpr std::uint32_t block = 64;  // tiles
  bulk.parts((tiles_ + block - 1) / block, [&](std::size_t part) {
    const auto end = static_cast<std::uint32_t>(std::min<std::size_t>(tiles_, (part + 1) * block));
    for (auto t = static_cast<std::uint32_t>(part * block); t < end; ++t) {
      const auto first = claims_.begin() + first_claimed_[t] + own, last = claims_.begin() + last_claimed_[t];
      std::sort(first, last);
      last_claimed_[t] = static_cast<std::uint32_t>(std::unique(first, last) - claims_.begin());
    }
  });
}

template <int D>
void TilePlan<D>::drop_wide_ranges() {
  std::vector<std::uint32_t> claimants(ranges(), 0);
  for (std::uint32_t t = 0; t < tiles_; ++t)
    for (std::uint32_t i = first_claimed_[t]; i < last_claimed_[t]; ++i) ++claimants[claims_[i]];
  for (std::uint32_t t = 0; t < tiles_; ++t) {
    const auto first = claims_.begin() + first_claimed_[t] + (1 << ranges_shift), last = claims_.begin() + last_claimed_[t];
    const auto kept = std::remove_if(first, last, [&](std::uint32_t range) { return claimants[range] > most_claimants; });
    last_claimed_[t] = static_cast<std::uint32_t>(kept - claims_.begin());
  }
}

/// Each tile goes into the first batch that claims nothing of what it claims.
template <int D>
void TilePlan<D>::make_batches() {
  std::vector<std::array<std::uint64_t, most_batches / 64>> taken(ranges());  // by range, the batches that claim it
  for (std::uint32_t t = 0; t < tiles_; ++t) {
    if (first_waiting_[t] == first_waiting_[t + 1]) continue;
    std::array<std::uint64_t, most_batches / 64> any{};
    for (const std::uint32_t range : visit(t).claim)
      for (std::size_t w = 0; w < any.size(); ++w) any[w] |= taken[range][w];
    std::size_t batch = 0;
    for (const std::uint64_t word : any) {
      batch += static_cast<std::size_t>(std::countr_one(word));
      if (word != ~std::uint64_t{0}) break;
    }
    if (batch == most_batches) {
      unplanned_.push_back(t);
      continue;
    }
    for (const std::uint32_t range : visit(t).claim) taken[range][batch / 64] |= std::uint64_t{1} << batch % 64;
    if (batch >= batches_.size()) batches_.resize(batch + 1);
    batches_[batch].push_back(t);
  }
  // The last batches are of what had no place in those before.
  std::size_t tiles = 0;
  for (const auto& batch : batches_) tiles += batch.size();
  const std::size_t mean = batches_.empty() ? 0 : tiles / batches_.size();
  while (!batches_.empty() && batches_.back().size() < std::max(fewest_visits, mean / 2)) {
    unplanned_.insert(unplanned_.end(), batches_.back().begin(), batches_.back().end());
    batches_.pop_back();
  }
  std::sort(unplanned_.begin(), unplanned_.end());
}

template <int D>
auto TilePlan<D>::visit(std::uint32_t tile) const -> Visit {
  return {waiting_.subspan(first_waiting_[tile], first_waiting_[tile + 1] - first_waiting_[tile]),
          std::span(claims_).subspan(first_claimed_[tile], last_claimed_[tile] - first_claimed_[tile])};
}

template <int D>
std::vector<VertexId> TilePlan<D>::unplanned() const {
  if (batches_.empty()) return {waiting_.begin(), waiting_.end()};
  std::vector<VertexId> all;
  for (const std::uint32_t t : unplanned_) {
    const auto some = visit(t).waiting;
    all.insert(all.end(), some.begin(), some.end());
  }
  return all;
}

template class TilePlan<2>;
template class TilePlan<3>;

}  // namespace pgdr::detail
