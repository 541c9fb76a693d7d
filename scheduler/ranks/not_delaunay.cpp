// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Faces that are not locally Delaunay, in a mesh of which each rank has a piece. A rank gets the cells of higher ranks beside its
// own, so that the rank of its first cell decides each face; the counts are added.
#include "check/not_delaunay.hpp"

#include <algorithm>
#include <array>
#include <span>
#include <unordered_map>
#include <vector>

#include "check/bounds.hpp"
#include "numbers/rounding.hpp"
#include "pgdr/ranks.hpp"
#include "ranks/exchange.hpp"
#include "transport/collectives.hpp"

namespace pgdr {
namespace {

using detail::Collectives;

/// slack_of_vertices() of the whole mesh, of the points of the piece.
template <int D>
std::vector<double> slack_of_points(Collectives& ranks, const DistributedResult<D>& result) {
  const int ulps = CheckOptions<D>{}.conformity_ulps;
  const SharingRanks& sharing = result.sharing;
  std::vector<double> slack = ranks.together([&] { return checking::slack_of_vertices(result.piece.mesh, ulps); });
  const auto each_shared = [&](auto f) {  // of two ranks in the same order: that of the points' numbers
    for (std::size_t v = 0; v < slack.size(); ++v)
      for (std::uint64_t i = sharing.begin[v]; i < sharing.begin[v + 1]; ++i)
        f(slack[v], static_cast<std::size_t>(sharing.ranks[i]));
  };
  const auto of_each = detail::exchange_lists(ranks, ranks.together([&] {
    std::vector<std::vector<double>> to_each(static_cast<std::size_t>(ranks.size()));
    each_shared([&](double own, std::size_t rank) { to_each[rank].push_back(own); });
    return to_each;
  }));
  const double own = checking::largest_coordinate(result.piece.mesh);
  const double width = ulps * rounding::ulp * ranks.max(std::span(&own, 1)).front();
  ranks.together([&] {
    std::vector<std::size_t> next(of_each.size());
    each_shared([&](double& of_point, std::size_t rank) { of_point = std::max(of_point, of_each[rank].at(next[rank]++)); });
    for (double& of_point : slack) of_point = of_point > 0 ? width : 0;
  });
  return slack;
}

/// A point on its way.
template <int D>
struct SentPoint {
  std::uint64_t number;
  Point<D> point;
  double slack;
};
template <int D, std::size_t N>
using SentRows = std::vector<std::array<SentPoint<D>, N>>;

/// Of these rows, which have N points each, those for each of the ranks below `end` that has D of the points.
template <std::size_t N, int D, class Rows, class Vertices>
std::vector<SentRows<D, N>> rows_for_ranks(const DistributedResult<D>& result, const std::vector<double>& slack, const Rows& rows,
                                           const Vertices& vertices_of, int ranks, int end) {
  const SharingRanks& sharing = result.sharing;
  const MeshPiece<D>& piece = result.piece;
  std::vector<SentRows<D, N>> to_each(static_cast<std::size_t>(ranks));
  std::vector<int> having;  // ranks, as often as they have points of the row
  for (const auto& row : rows) {
    having.clear();
    std::array<SentPoint<D>, N> sent;
    for (std::size_t i = 0; i < N; ++i) {
      const std::uint32_t v = vertices_of(row)[i];
      sent[i] = {piece.point_numbers[v], piece.mesh.points[v], slack[v]};
      for (std::uint64_t k = sharing.begin[v]; k < sharing.begin[v + 1]; ++k)
        if (sharing.ranks[k] < end) having.push_back(sharing.ranks[k]);
    }
    std::sort(having.begin(), having.end());
    for (auto first = having.begin(), last = first; first != having.end(); first = last) {
      last = std::upper_bound(first, having.end(), *first);
      if (last - first >= D) to_each[static_cast<std::size_t>(*first)].push_back(sent);
    }
  }
  return to_each;
}

/// A piece, and what is beside it.
template <int D>
struct WithNeighbours {
  OutputMesh<D> mesh;
  std::vector<double> slack;
  std::unordered_map<std::uint64_t, std::uint32_t> place;  ///< of points by their numbers

  WithNeighbours(const MeshPiece<D>& piece, const std::vector<double>& of_points) : mesh(piece.mesh), slack(of_points) {
    for (std::uint32_t v = 0; v < piece.point_numbers.size(); ++v) place.emplace(piece.point_numbers[v], v);
  }
  template <std::size_t N>
  std::array<std::uint32_t, N> places_of(const std::array<SentPoint<D>, N>& row) {
    std::array<std::uint32_t, N> places;
    for (std::size_t i = 0; i < N; ++i) {
      const auto [at, is_new] = place.emplace(row[i].number, static_cast<std::uint32_t>(mesh.points.size()));
      places[i] = at->second;
      if (!is_new) continue;
      mesh.points.push_back(row[i].point);
      slack.push_back(row[i].slack);
    }
    return places;
  }
};

template <int D>
auto& walls_of(OutputMesh<D>& mesh) {
  if constexpr (D == 3)
    return mesh.subfacets;
  else
    return mesh.subsegments;
}

template <int D>
NotDelaunay count_own(Collectives& ranks, const DistributedResult<D>& result) {
  const std::vector<double> slack = slack_of_points(ranks, result);
  WithNeighbours<D> part = ranks.together([&] { return WithNeighbours<D>(result.piece, slack); });
  const auto of_cell = [](const auto& cell) -> auto& { return cell; };
  const auto of_wall = [](const auto& wall) -> auto& { return wall.vertices; };
  const auto cells = detail::exchange_lists(ranks, ranks.together([&] {
    return rows_for_ranks<D + 1>(result, slack, part.mesh.cells, of_cell, ranks.size(), ranks.rank());
  }));
  const auto walls = detail::exchange_lists(ranks, ranks.together([&] {
    return rows_for_ranks<D>(result, slack, walls_of(part.mesh), of_wall, ranks.size(), ranks.size());
  }));
  return ranks.together([&] {
    for (const auto& of_rank : cells)
      for (const auto& row : of_rank) part.mesh.cells.push_back(part.places_of(row));
    for (const auto& of_rank : walls)
      for (const auto& row : of_rank) walls_of(part.mesh).push_back({part.places_of(row), 0, 0});
    return checking::count_among<D>(part.mesh, part.slack, result.run.violations_seen, result.piece.mesh.cells.size());
  });
}

}  // namespace

template <int D>
NotDelaunay count_not_delaunay(Transport& transport, const DistributedResult<D>& result) {
  Collectives ranks(transport);
  if (ranks.size() == 1) return count_not_delaunay(result.piece.mesh, result.run.violations_seen);
  const NotDelaunay own = count_own(ranks, result);
  const std::vector<std::uint64_t> counts = ranks.sum(std::array<std::uint64_t, 2>{own.rounding, own.other});
  return {counts[0], counts[1]};
}

template PGDR_API NotDelaunay count_not_delaunay<2>(Transport&, const DistributedResult<2>&);
template PGDR_API NotDelaunay count_not_delaunay<3>(Transport&, const DistributedResult<3>&);

}  // namespace pgdr
