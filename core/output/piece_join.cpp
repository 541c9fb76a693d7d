// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "output/piece_join.hpp"

#include <algorithm>
#include <bit>

#include "pgdr/error.hpp"

namespace pgdr::detail {
namespace {

using Number = std::uint64_t;

[[noreturn]] void fail(const std::string& file, const char* what, Number number, const char* why) {
  const std::string message = std::string(what) + " " + std::to_string(number) + " of the whole mesh " + why;
  throw InputError({Errc::syntax, message, file, 0, {static_cast<std::int64_t>(number)}, {}});
}

template <int D>
class PieceJoiner {
 public:
  PieceJoiner(std::span<const PieceView<D>> pieces, const std::string& whole) : pieces_(pieces), whole_(whole) {}

  OutputMesh<D> join() {
    if (pieces_.empty()) return {};
    check_totals();
    using Piece = MeshPiece<D>;
    check_rows("point", total_.points, [](const Piece& p) { return Rows{p.first_point, p.own_points}; });
    check_rows("cell", total_.cells, [](const Piece& p) { return Rows{p.first_cell, p.mesh.cells.size()}; });
    check_rows("subfacet", total_.subfacets, [](const Piece& p) { return Rows{p.first_subfacet, p.mesh.subfacets.size()}; });
    check_rows("subsegment", total_.subsegments, [](const Piece& p) {
      return Rows{p.first_subsegment, p.mesh.subsegments.size()};
    });
    constexpr Number most_ids = 0xfffffffe;
    if (total_.points > most_ids || total_.cells > most_ids)
      throw ResourceError(
          {Errc::ids_exhausted, "the whole mesh has more points or cells than can be numbered", whole_, 0, {}, {}});
    for (const auto& [piece, name] : pieces_) check_numbers(*piece, name);
    // No piece says that there is more than it has, so that all this is no more than there is already.
    out_.points.resize(total_.points);
    out_.input_points = total_.input_points;
    out_.names = pieces_.front().piece->mesh.names;
    if (total_.point_markers) out_.point_markers.resize(total_.points);
    out_.point_attributes.resize(total_.points * total_.attributes_per_point);
    out_.cells.resize(total_.cells);
    if (total_.regions) out_.regions.resize(total_.cells);
    if (total_.leaves) out_.leaves.resize(total_.cells);
    out_.subfacets.resize(total_.subfacets);
    out_.subsegments.resize(total_.subsegments);
    for (const auto& [piece, name] : pieces_) put_own_points(*piece);
    for (const auto& [piece, name] : pieces_) check_points(*piece, name);
    for (const auto& [piece, name] : pieces_) put_rows(*piece);
    return std::move(out_);
  }

 private:
  struct Rows {
    Number first, count;
  };

  void check_totals() {
    total_ = pieces_.front().piece->total;
    for (const auto& [piece, name] : pieces_)
      if (piece->total != total_ || piece->mesh.names != pieces_.front().piece->mesh.names)
        throw InputError({Errc::syntax, "this piece and " + pieces_.front().name + " are not of one mesh", name, 0, {}, {}});
    if (total_.input_points > total_.points) fail(whole_, "point", total_.points, "would be an input point, and is none of it");
  }

  /// The rows of all pieces must be all rows, each once.
  template <class RowsOf>
  void check_rows(const char* what, Number total, const RowsOf& rows_of) const {
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < pieces_.size(); ++i)
      if (rows_of(*pieces_[i].piece).count > 0) order.push_back(i);
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      return std::pair(rows_of(*pieces_[a].piece).first, a) < std::pair(rows_of(*pieces_[b].piece).first, b);
    });
    Number next = 0;
    for (const std::size_t i : order) {
      const Rows rows = rows_of(*pieces_[i].piece);
      if (rows.first > next) fail(whole_, what, next, "is in no piece");
      if (rows.first < next) fail(pieces_[i].name, what, rows.first, "is in another piece, too");
      if (rows.count > total - next) fail(pieces_[i].name, what, total, "is none of it");
      next += rows.count;
    }
    if (next < total) fail(whole_, what, next, "is in no piece");
  }

  void check_numbers(const MeshPiece<D>& piece, const std::string& name) const {
    const auto& numbers = piece.point_numbers;
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      if (numbers[i] >= total_.points) fail(name, "point", numbers[i], "is none of it");
      if (i > 0 && numbers[i] <= numbers[i - 1]) fail(name, "point", numbers[i], "is not behind those before it");
    }
    const auto at = [&](Number number) { return std::lower_bound(numbers.begin(), numbers.end(), number) - numbers.begin(); };
    if (piece.own_points > 0 &&
        (at(piece.first_point + piece.own_points) - at(piece.first_point)) != static_cast<std::ptrdiff_t>(piece.own_points))
      fail(name, "point", piece.first_point, "or one behind it is missing in its piece");
    if (at(total_.input_points) != static_cast<std::ptrdiff_t>(piece.mesh.input_points))
      fail(name, "point", total_.input_points, "is not the first that is no input point");
  }

  void put_own_points(const MeshPiece<D>& piece) {
    if (piece.own_points == 0) return;
    const auto& numbers = piece.point_numbers;
    const auto from = std::lower_bound(numbers.begin(), numbers.end(), piece.first_point) - numbers.begin();
    const auto count = static_cast<std::ptrdiff_t>(piece.own_points), to = static_cast<std::ptrdiff_t>(piece.first_point);
    const auto columns = static_cast<std::ptrdiff_t>(total_.attributes_per_point);
    std::copy_n(piece.mesh.points.begin() + from, count, out_.points.begin() + to);
    if (total_.point_markers) std::copy_n(piece.mesh.point_markers.begin() + from, count, out_.point_markers.begin() + to);
    std::copy_n(piece.mesh.point_attributes.begin() + columns * from, columns * count,
                out_.point_attributes.begin() + columns * to);
  }

  void check_points(const MeshPiece<D>& piece, const std::string& name) const {
    const auto same_bits = [](double a, double b) { return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b); };
    const std::size_t columns = static_cast<std::size_t>(total_.attributes_per_point);
    for (std::size_t i = 0; i < piece.point_numbers.size(); ++i) {
      const Number number = piece.point_numbers[i];
      bool same = !total_.point_markers || piece.mesh.point_markers[i] == out_.point_markers[number];
      for (int k = 0; k < D; ++k) same = same && same_bits(piece.mesh.points[i][k], out_.points[number][k]);
      for (std::size_t k = 0; k < columns; ++k)
        same = same && same_bits(piece.mesh.point_attributes[i * columns + k], out_.point_attributes[number * columns + k]);
      if (!same) fail(name, "point", number, "is not the same in all pieces");
    }
  }

  void put_rows(const MeshPiece<D>& piece) {
    const auto number = [&](std::uint32_t v) { return static_cast<std::uint32_t>(piece.point_numbers[v]); };
    const auto put = [](const auto& rows, auto& to, Number first) {
      std::copy(rows.begin(), rows.end(), to.begin() + static_cast<std::ptrdiff_t>(first));
    };
    for (std::size_t i = 0; i < piece.mesh.cells.size(); ++i)
      for (int j = 0; j <= D; ++j) out_.cells[piece.first_cell + i][j] = number(piece.mesh.cells[i][j]);
    if (!piece.mesh.cells.empty()) {
      put(piece.mesh.regions, out_.regions, piece.first_cell);
      put(piece.mesh.leaves, out_.leaves, piece.first_cell);
    }
    const auto put_constraints = [&](const auto& rows, auto& to, Number first) {
      for (std::size_t i = 0; i < rows.size(); ++i) {
        to[first + i] = rows[i];
        for (auto& v : to[first + i].vertices) v = number(v);
      }
    };
    put_constraints(piece.mesh.subfacets, out_.subfacets, piece.first_subfacet);
    put_constraints(piece.mesh.subsegments, out_.subsegments, piece.first_subsegment);
  }

  std::span<const PieceView<D>> pieces_;
  const std::string& whole_;
  typename MeshPiece<D>::Totals total_;
  OutputMesh<D> out_;
};

}  // namespace

template <int D>
OutputMesh<D> join_views(std::span<const PieceView<D>> pieces, const std::string& whole) {
  return PieceJoiner<D>(pieces, whole).join();
}

template OutputMesh<2> join_views<2>(std::span<const PieceView<2>>, const std::string&);
template OutputMesh<3> join_views<3>(std::span<const PieceView<3>>, const std::string&);

}  // namespace pgdr::detail
