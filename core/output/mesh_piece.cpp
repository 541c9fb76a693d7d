// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "pgdr/mesh_piece.hpp"

#include <algorithm>
#include <bit>
#include <numeric>
#include <utility>

#include "output/piece_join.hpp"
#include "output/simplices.hpp"
#include "pgdr/error.hpp"

namespace pgdr {
namespace {

/// A set of numbers below a bound, of which each knows how many smaller ones there are: a bit a number, counted by words.
class RankedSet {
 public:
  explicit RankedSet(std::size_t bound) : words_(bound / bits + 1, 0), before_(words_.size(), 0) {}

  void add(std::size_t number) { words_[number / bits] |= std::uint64_t{1} << number % bits; }
  /// To be called once, after the last add(). @returns how many numbers there are
  std::uint32_t count() {
    std::uint32_t all = 0;
    for (std::size_t i = 0; i < words_.size(); ++i) {
      before_[i] = all;
      all += static_cast<std::uint32_t>(std::popcount(words_[i]));
    }
    return all;
  }
  /// How many are smaller.
  std::uint32_t rank(std::size_t number) const {
    const std::uint64_t smaller = words_[number / bits] & ((std::uint64_t{1} << number % bits) - 1);
    return before_[number / bits] + static_cast<std::uint32_t>(std::popcount(smaller));
  }
  template <class F>
  void each(const F& f) const {
    for (std::size_t i = 0; i < words_.size(); ++i)
      for (std::uint64_t rest = words_[i]; rest != 0; rest &= rest - 1)
        f(i * bits + static_cast<std::size_t>(std::countr_zero(rest)));
  }

 private:
  static constexpr std::size_t bits = 64;
  std::vector<std::uint64_t> words_;
  std::vector<std::uint32_t> before_;
};

/// Rows [first, last) of the whole mesh that lie in a part of it, whose first is `begin`; nothing of what is not there.
template <class Row>
void take_rows(const std::vector<Row>& rows, std::uint64_t begin, std::uint64_t first, std::uint64_t last,
               std::vector<Row>& out) {
  if (rows.empty() || first >= last) return;
  out.assign(rows.begin() + static_cast<std::ptrdiff_t>(first - begin), rows.begin() + static_cast<std::ptrdiff_t>(last - begin));
}

/// Where part of a mesh lies in the whole: all of it, or the rows of a piece.
template <int D>
struct Source {
  const OutputMesh<D>& mesh;
  const std::vector<std::uint64_t>* numbers;  ///< of its points; null: they are all points
  std::uint64_t first_point, own_points, first_cell, first_subfacet, first_subsegment;

  std::uint64_t number(std::size_t p) const { return numbers ? (*numbers)[p] : p; }
  /// The place of a point that is one of its own rows.
  std::size_t place_of_own(std::uint64_t number) const {
    const std::size_t begin = numbers ? static_cast<std::size_t>(std::lower_bound(numbers->begin(), numbers->end(), first_point) -
                                                                 numbers->begin())
                                      : 0;
    return begin + static_cast<std::size_t>(number - first_point);
  }
};

/// The points of the piece, whose simplices have the places of the source, and are given those of the piece.
template <int D>
void take_points(const Source<D>& source, MeshPiece<D>& piece) {
  OutputMesh<D>& mesh = piece.mesh;
  const OutputMesh<D>& from = source.mesh;
  RankedSet used(from.points.size());
  each_simplex(mesh, [&](const auto& vertices) {
    for (const auto v : vertices) used.add(v);
  });
  if (piece.own_points > 0) {
    const std::size_t begin = source.place_of_own(piece.first_point);
    for (std::size_t i = 0; i < piece.own_points; ++i) used.add(begin + i);
  }
  const std::uint32_t count = used.count();
  const auto columns = static_cast<std::ptrdiff_t>(piece.total.attributes_per_point);
  piece.point_numbers.reserve(count);
  mesh.points.reserve(count);
  used.each([&](std::size_t p) {
    piece.point_numbers.push_back(source.number(p));
    mesh.points.push_back(from.points[p]);
    if (piece.total.point_markers) mesh.point_markers.push_back(from.point_markers[p]);
    const auto attributes = from.point_attributes.begin() + static_cast<std::ptrdiff_t>(p) * columns;
    mesh.point_attributes.insert(mesh.point_attributes.end(), attributes, attributes + columns);
  });
  mesh.input_points = static_cast<std::size_t>(
      std::lower_bound(piece.point_numbers.begin(), piece.point_numbers.end(), piece.total.input_points) -
      piece.point_numbers.begin());
  each_simplex(mesh, [&](auto& vertices) {
    for (auto& v : vertices) v = used.rank(v);
  });
}

/// What the source has of piece k of so many of the whole mesh.
template <int D>
MeshPiece<D> take_piece(const Source<D>& source, const typename MeshPiece<D>::Totals& total, std::uint64_t k,
                        std::uint64_t count) {
  MeshPiece<D> piece;
  piece.total = total;
  const OutputMesh<D>& from = source.mesh;
  piece.mesh.names = from.names;
  /// The first row that both have, and the first that not both have.
  const auto both = [&](std::uint64_t rows, std::uint64_t begin, std::uint64_t size) {
    const std::uint64_t first = first_row_of_part(rows, k, count), last = first_row_of_part(rows, k + 1, count);
    const std::uint64_t low = std::clamp(first, begin, begin + size);
    return std::pair(low, std::clamp(last, low, begin + size));
  };
  const auto points = both(total.points, source.first_point, source.own_points);
  piece.first_point = points.first;
  piece.own_points = points.second - points.first;
  const auto cells = both(total.cells, source.first_cell, from.cells.size());
  piece.first_cell = cells.first;
  take_rows(from.cells, source.first_cell, cells.first, cells.second, piece.mesh.cells);
  take_rows(from.regions, source.first_cell, cells.first, cells.second, piece.mesh.regions);
  take_rows(from.leaves, source.first_cell, cells.first, cells.second, piece.mesh.leaves);
  const auto subfacets = both(total.subfacets, source.first_subfacet, from.subfacets.size());
  piece.first_subfacet = subfacets.first;
  take_rows(from.subfacets, source.first_subfacet, subfacets.first, subfacets.second, piece.mesh.subfacets);
  const auto subsegments = both(total.subsegments, source.first_subsegment, from.subsegments.size());
  piece.first_subsegment = subsegments.first;
  take_rows(from.subsegments, source.first_subsegment, subsegments.first, subsegments.second, piece.mesh.subsegments);
  take_points(source, piece);
  return piece;
}

}  // namespace

template <int D>
typename MeshPiece<D>::Totals detail::totals_of(const OutputMesh<D>& mesh) {
  typename MeshPiece<D>::Totals total;
  total.points = mesh.points.size();
  total.input_points = mesh.input_points;
  total.cells = mesh.cells.size();
  total.subfacets = mesh.subfacets.size();
  total.subsegments = mesh.subsegments.size();
  total.attributes_per_point = mesh.points.empty() ? 0 : mesh.point_attributes.size() / mesh.points.size();
  total.point_markers = !mesh.point_markers.empty();
  total.regions = !mesh.regions.empty();
  total.leaves = !mesh.leaves.empty();
  return total;
}

template <int D>
MeshPiece<D> piece_of(const OutputMesh<D>& mesh, std::uint64_t k, std::uint64_t count) {
  if (count == 0 || count > 0xffffffffu || k >= count)
    throw UsageError({Errc::bad_option, "a mesh has from 1 to 2^32 - 1 pieces, numbered from 0", {}, 0, {}, {}});
  return take_piece<D>({mesh, nullptr, 0, mesh.points.size(), 0, 0, 0}, detail::totals_of<D>(mesh), k, count);
}

template <int D>
MeshPiece<D> detail::whole_piece(OutputMesh<D> mesh) {
  MeshPiece<D> piece;
  piece.total = totals_of(mesh);
  piece.own_points = piece.total.points;
  piece.point_numbers.resize(mesh.points.size());
  std::iota(piece.point_numbers.begin(), piece.point_numbers.end(), std::uint64_t{0});
  piece.mesh = std::move(mesh);
  return piece;
}

template <int D>
MeshPiece<D> detail::part_of_piece(const MeshPiece<D>& piece, std::uint64_t k, std::uint64_t count) {
  const Source<D> source{piece.mesh,       &piece.point_numbers, piece.first_point,     piece.own_points,
                         piece.first_cell, piece.first_subfacet, piece.first_subsegment};
  return take_piece<D>(source, piece.total, k, count);
}

template <int D>
MeshPiece<D> detail::joined_parts(std::span<const MeshPiece<D>> parts, std::uint64_t k, std::uint64_t count) {
  MeshPiece<D> out;
  const auto& total = out.total = parts.front().total;
  out.first_point = first_row_of_part(total.points, k, count);
  out.own_points = first_row_of_part(total.points, k + 1, count) - out.first_point;
  out.first_cell = first_row_of_part(total.cells, k, count);
  out.first_subfacet = first_row_of_part(total.subfacets, k, count);
  out.first_subsegment = first_row_of_part(total.subsegments, k, count);
  std::vector<std::uint64_t>& numbers = out.point_numbers;
  for (const MeshPiece<D>& part : parts) numbers.insert(numbers.end(), part.point_numbers.begin(), part.point_numbers.end());
  std::sort(numbers.begin(), numbers.end());
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
  const auto columns = static_cast<std::ptrdiff_t>(total.attributes_per_point);
  OutputMesh<D>& mesh = out.mesh;
  mesh.names = parts.front().mesh.names;
  mesh.points.resize(numbers.size());
  if (total.point_markers) mesh.point_markers.resize(numbers.size());
  mesh.point_attributes.resize(numbers.size() * static_cast<std::size_t>(columns));
  mesh.input_points = static_cast<std::size_t>(std::lower_bound(numbers.begin(), numbers.end(), total.input_points) -
                                               numbers.begin());
  for (const MeshPiece<D>& part : parts) {
    std::vector<std::uint32_t> place;
    for (const std::uint64_t number : part.point_numbers) {
      const auto i = place.size(),
                 to = static_cast<std::size_t>(std::lower_bound(numbers.begin(), numbers.end(), number) - numbers.begin());
      place.push_back(static_cast<std::uint32_t>(to));
      mesh.points[to] = part.mesh.points[i];
      if (total.point_markers) mesh.point_markers[to] = part.mesh.point_markers[i];
      std::copy_n(part.mesh.point_attributes.begin() + static_cast<std::ptrdiff_t>(i) * columns, columns,
                  mesh.point_attributes.begin() + static_cast<std::ptrdiff_t>(to) * columns);
    }
    const auto append = [&](const auto& rows, auto& to) { to.insert(to.end(), rows.begin(), rows.end()); };
    OutputMesh<D> moved;
    moved.cells = part.mesh.cells;
    moved.subfacets = part.mesh.subfacets;
    moved.subsegments = part.mesh.subsegments;
    each_simplex(moved, [&](auto& vertices) {
      for (auto& v : vertices) v = place[v];
    });
    append(moved.cells, mesh.cells);
    append(moved.subfacets, mesh.subfacets);
    append(moved.subsegments, mesh.subsegments);
    append(part.mesh.regions, mesh.regions);
    append(part.mesh.leaves, mesh.leaves);
  }
  return out;
}

template <int D>
OutputMesh<D> join_pieces(std::span<const MeshPiece<D>> pieces) {
  std::vector<detail::PieceView<D>> views;
  for (const MeshPiece<D>& piece : pieces) views.push_back({&piece, {}});
  return detail::join_views<D>(views, {});
}

template MeshPiece<2>::Totals detail::totals_of<2>(const OutputMesh<2>&);
template MeshPiece<3>::Totals detail::totals_of<3>(const OutputMesh<3>&);
template MeshPiece<2> detail::whole_piece<2>(OutputMesh<2>);
template MeshPiece<3> detail::whole_piece<3>(OutputMesh<3>);
template MeshPiece<2> detail::part_of_piece<2>(const MeshPiece<2>&, std::uint64_t, std::uint64_t);
template MeshPiece<3> detail::part_of_piece<3>(const MeshPiece<3>&, std::uint64_t, std::uint64_t);
template MeshPiece<2> detail::joined_parts<2>(std::span<const MeshPiece<2>>, std::uint64_t, std::uint64_t);
template MeshPiece<3> detail::joined_parts<3>(std::span<const MeshPiece<3>>, std::uint64_t, std::uint64_t);
template PGDR_API MeshPiece<2> piece_of<2>(const OutputMesh<2>&, std::uint64_t, std::uint64_t);
template PGDR_API MeshPiece<3> piece_of<3>(const OutputMesh<3>&, std::uint64_t, std::uint64_t);
template PGDR_API OutputMesh<2> join_pieces<2>(std::span<const MeshPiece<2>>);
template PGDR_API OutputMesh<3> join_pieces<3>(std::span<const MeshPiece<3>>);

}  // namespace pgdr
