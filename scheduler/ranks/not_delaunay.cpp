// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Faces that are not locally Delaunay, in a mesh of which each rank has a piece. Where the run saw none, rank 0 gets the cells
// beside slanted entities alone: as many as a surface has; else it gets all.
#include "check/not_delaunay.hpp"

#include <algorithm>
#include <array>
#include <span>

#include "check/bounds.hpp"
#include "numbers/rounding.hpp"
#include "pgdr/ranks.hpp"
#include "ranks/exchange.hpp"
#include "ranks/values.hpp"
#include "transport/collectives.hpp"

namespace pgdr {
namespace {

using detail::Collectives;
using Flags = std::vector<std::uint8_t>;  // one a point of the piece

/// Sets flags of points that are set on any rank that has the point.
template <int D>
void join_flags(Collectives& ranks, const DistributedResult<D>& result, Flags& flags) {
  const SharingRanks& sharing = result.sharing;
  const auto each_shared = [&](auto f) {  // of two ranks in the same order: that of the points' numbers
    for (std::size_t v = 0; v < flags.size(); ++v)
      for (std::uint64_t i = sharing.begin[v]; i < sharing.begin[v + 1]; ++i)
        f(flags[v], static_cast<std::size_t>(sharing.ranks[i]));
  };
  const auto to_each = ranks.together([&] {
    std::vector<Flags> lists(static_cast<std::size_t>(ranks.size()));
    each_shared([&](std::uint8_t flag, std::size_t rank) { lists[rank].push_back(flag); });
    return lists;
  });
  const std::vector<Flags> of_each = exchange_lists(ranks, to_each);
  ranks.together([&] {
    std::vector<std::size_t> next(of_each.size());
    each_shared([&](std::uint8_t& flag, std::size_t rank) { flag |= of_each[rank].at(next[rank]++); });
  });
}

/// The cells that are to be looked at, with all walls that may be among their faces. Of the points only what these have.
template <int D>
MeshPiece<D> part_to_look_at(const MeshPiece<D>& piece, const Flags& beside) {
  MeshPiece<D> part;
  std::vector<std::uint32_t> place(piece.mesh.points.size(), 0);
  const auto take = [&](const auto& rows, auto vertices_of, auto& into) {
    for (const auto& row : rows) {
      const auto& vertices = vertices_of(row);
      // Of a face of a cell that is looked at one point less need be beside.
      const auto count = std::count_if(vertices.begin(), vertices.end(), [&](std::uint32_t v) { return beside[v] != 0; });
      if (count + 1 < static_cast<std::ptrdiff_t>(vertices.size())) continue;
      into.push_back(row);
      for (const std::uint32_t v : vertices) place[v] = 1;
    }
  };
  const auto vertices_of_wall = [](auto& wall) -> auto& { return wall.vertices; };
  take(
      piece.mesh.cells, [](auto& cell) -> auto& { return cell; }, part.mesh.cells);
  take(piece.mesh.subsegments, vertices_of_wall, part.mesh.subsegments);
  take(piece.mesh.subfacets, vertices_of_wall, part.mesh.subfacets);
  for (std::size_t v = 0; v < place.size(); ++v) {
    if (place[v] == 0) continue;
    place[v] = static_cast<std::uint32_t>(part.point_numbers.size());
    part.point_numbers.push_back(piece.point_numbers[v]);
    part.mesh.points.push_back(piece.mesh.points[v]);
  }
  const auto renumber = [&](auto& vertices) {
    for (std::uint32_t& v : vertices) v = place[v];
  };
  for (auto& cell : part.mesh.cells) renumber(cell);
  for (auto& wall : part.mesh.subsegments) renumber(wall.vertices);
  for (auto& wall : part.mesh.subfacets) renumber(wall.vertices);
  return part;
}

/// A part of the mesh, as rank 0 puts it together: rows of all ranks, in their order.
template <int D>
struct Joined {
  OutputMesh<D> mesh;
  std::vector<std::uint64_t> numbers;  ///< of its points
  std::vector<double> slack;

  void find_numbers(const std::vector<MeshPiece<D>>& parts) {
    for (const MeshPiece<D>& part : parts) numbers.insert(numbers.end(), part.point_numbers.begin(), part.point_numbers.end());
    std::sort(numbers.begin(), numbers.end());
    numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
    mesh.points.resize(numbers.size());
    slack.resize(numbers.size());
  }
  void add(MeshPiece<D>& part, const Flags& slanted, double width) {
    std::vector<std::uint32_t> place;
    for (std::size_t v = 0; v < part.point_numbers.size(); ++v) {
      const auto found = std::lower_bound(numbers.begin(), numbers.end(), part.point_numbers[v]);
      place.push_back(static_cast<std::uint32_t>(found - numbers.begin()));
      mesh.points[place[v]] = part.mesh.points[v];
      if (slanted.at(v) != 0) slack[place[v]] = width;
    }
    const auto renumber = [&](auto& vertices) {
      for (std::uint32_t& v : vertices) v = place.at(v);
    };
    for (auto& cell : part.mesh.cells) renumber(mesh.cells.emplace_back(cell));
    for (auto& wall : part.mesh.subsegments) renumber(mesh.subsegments.emplace_back(wall).vertices);
    for (auto& wall : part.mesh.subfacets) renumber(mesh.subfacets.emplace_back(wall).vertices);
  }
};

/// What rank 0 has to get of this rank.
template <int D>
Bytes packed(const MeshPiece<D>& piece, const Flags& slanted, const Flags& beside) {
  const MeshPiece<D> part = part_to_look_at<D>(piece, beside);
  Flags of_part;
  std::size_t v = 0;
  for (const std::uint64_t number : part.point_numbers) {
    while (piece.point_numbers[v] != number) ++v;
    of_part.push_back(slanted[v]);
  }
  detail::MessageWriter message;
  detail::put_piece(message, part);
  message.put(of_part);
  return message.take();
}

template <int D>
NotDelaunay count_in(const std::vector<Bytes>& messages, double width) {
  std::vector<MeshPiece<D>> parts;
  std::vector<Flags> slanted;
  for (const Bytes& bytes : messages) {
    detail::MessageReader message(bytes);
    parts.push_back(detail::get_piece<D>(message));
    slanted.push_back(message.get_all<std::uint8_t>());
    message.require_end();
  }
  Joined<D> joined;
  joined.find_numbers(parts);
  for (std::size_t r = 0; r < parts.size(); ++r) joined.add(parts[r], slanted[r], width);
  if (joined.mesh.cells.empty()) return {};
  return checking::count_among<D>(joined.mesh, joined.slack);
}

/// As count_not_delaunay(mesh, false), on rank 0.
template <int D>
NotDelaunay count_beside_slanted_points(Collectives& ranks, const DistributedResult<D>& result) {
  const int ulps = CheckOptions<D>{}.conformity_ulps;
  const OutputMesh<D>& mesh = result.piece.mesh;
  Flags slanted = ranks.together([&] {
    Flags flags;
    for (const double s : checking::slack_of_vertices(mesh, ulps)) flags.push_back(s > 0);
    return flags;
  });
  join_flags(ranks, result, slanted);
  Flags beside = ranks.together([&] { return checking::points_beside(mesh, slanted); });
  join_flags(ranks, result, beside);
  const double own = checking::largest_coordinate(mesh);
  const double width = ulps * rounding::ulp * ranks.max(std::span(&own, 1)).front();
  const std::vector<Bytes> messages = ranks.gather(0, ranks.together([&] { return packed(result.piece, slanted, beside); }));
  return ranks.together([&] { return ranks.rank() == 0 ? count_in<D>(messages, width) : NotDelaunay{}; });
}

}  // namespace

template <int D>
NotDelaunay count_not_delaunay(Transport& transport, const DistributedResult<D>& result) {
  NotDelaunay count;
  if (result.run.violations_seen) {
    const OutputMesh<D> whole = gather(transport, result.piece);
    Collectives(transport).together([&] {
      if (transport.rank() == 0) count = count_not_delaunay(whole);
    });
  } else {
    Collectives ranks(transport);
    count = count_beside_slanted_points(ranks, result);
  }
  const std::vector<std::uint64_t> counts = Collectives(transport).sum(
      std::array<std::uint64_t, 2>{count.rounding, count.other});  // others have none
  return {counts[0], counts[1]};
}

template PGDR_API NotDelaunay count_not_delaunay<2>(Transport&, const DistributedResult<2>&);
template PGDR_API NotDelaunay count_not_delaunay<3>(Transport&, const DistributedResult<3>&);

}  // namespace pgdr
