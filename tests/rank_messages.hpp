// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Everything that ranks send each other, by kind: a message of each, and its reader, which gets any bytes.
#pragma once

#include <algorithm>
#include <cmath>
#include <span>
#include <stdexcept>
#include <vector>

#include "cut_meshes.hpp"
#include "ranks/cell_message.hpp"
#include "ranks/late_work.hpp"
#include "ranks/rank_outbox.hpp"
#include "ranks/sent_entry.hpp"
#include "ranks/values.hpp"
#include "ranks/visit_changes.hpp"
#include "transport/shared_error.hpp"

namespace pgdr::test {

enum class MessageKind : unsigned { cells, late_constraints, letters, late_work, plc, piece, result, error };
inline constexpr unsigned message_kinds = 8;

/// Two ranks have a mesh. The first reads what the second would send of what both have.
template <int D>
class RankMessages {
 public:
  RankMessages() { reader_.held.find_all(); }

  /// A message of this kind.
  Bytes sample(MessageKind kind) {
    using namespace detail;
    MessageWriter message;
    switch (kind) {
      case MessageKind::cells: some_cells().put(message); break;
      case MessageKind::late_constraints:
        message.put(std::uint64_t{1});
        some_cells().put(message);
        break;
      case MessageKind::letters: put_letters(message); break;
      case MessageKind::late_work: put_late_work(message); break;
      case MessageKind::plc: put_plc<D>(message, box_with_pairs<D>(2, 0.1, 1)); break;
      case MessageKind::piece: put_piece<D>(message, some_piece()); break;
      case MessageKind::result: put_result<D>(message, some_result()); break;
      case MessageKind::error:
        put_error(message, std::make_exception_ptr(InputError({Errc::not_finite, "no number", "a.poly", 3, {1, 2}, {}})), 1);
        break;
    }
    return message.take();
  }

  /// Reads the bytes as a message of this kind, to its end. What was read is looked at. @throws std::logic_error if it is not
  /// what the reader promises; what the reader throws; of kind error what travelled
  void read(MessageKind kind, std::span<const std::byte> bytes) {
    using namespace detail;
    MessageReader message(bytes);
    switch (kind) {
      case MessageKind::cells: look_at(SentCells<D>::get(message)); break;
      case MessageKind::late_constraints: {
        CutMesh<D> again(owned_, 0, pairs, 1);  // the constraints stay in it
        LateConstraints<D>::apply(message, again.held);
        break;
      }
      case MessageKind::letters:
        RankOutbox<D>(owned_.tree, reader_.territory, reader_.part.mesh).get(message, reader_.held);
        break;
      case MessageKind::late_work: LateWork<D>().get(message, owned_.tree, reader_.part.mesh, reader_.held); break;
      case MessageKind::plc: get_plc<D>(message); break;
      case MessageKind::piece: get_piece<D>(message); break;
      case MessageKind::result: get_result<D>(message); break;
      case MessageKind::error: throw_error(message);
    }
    message.require_end();
  }

 private:
  static constexpr int pairs = D == 2 ? 4 : 2;

  /// Some are gone, some made, with and without constraints, some get others.
  detail::SentCells<D> some_cells() {
    const Mesh<D>& mesh = reader_.part.mesh;
    const std::vector<CellId> cells = cells_of(mesh);
    detail::CellWriter<D> writer(mesh, cells.size());
    writer.add_gone(mesh.cell(cells[0]).vertices);
    for (std::size_t i = 1; i < std::min<std::size_t>(cells.size(), 6); ++i) writer.add_made(cells[i]);
    const auto constrained = std::find_if(cells.begin(), cells.end(), [&](CellId c) { return mesh.constraints(c) != nullptr; });
    writer.add_changed(*constrained);
    return writer.take();
  }
  std::vector<Entry<D>> some_entries(std::size_t most) {
    std::vector<Entry<D>> entries;
    for (const CellId c : cells_of(reader_.part.mesh))
      if (entries.size() < most) entries.emplace_back(c, reader_.part.mesh.birth(c), EntryKind::face, D, 0, 7);
    entries.emplace_back(entries[0].cell, entries[0].birth, EntryKind::cell, Entry<D>::over_radius_edge, 200, 1);
    return entries;
  }
  void put_letters(detail::MessageWriter& message) {
    const auto own = std::find(owned_.owners.begin(), owned_.owners.end(), 0) - owned_.owners.begin();
    message.put(std::uint64_t{2});
    for (const std::uint64_t visit : {5, 4}) {
      message.put(visit);
      message.put(owned_.nodes[static_cast<std::size_t>(own)]);
      std::vector<detail::SentEntry<D>> sent;
      for (const Entry<D>& e : some_entries(3)) sent.push_back(detail::SentEntry<D>::of(reader_.part.mesh, e));
      message.put(sent);
    }
  }
  void put_late_work(detail::MessageWriter& message) {
    using Late = detail::LateWork<D>;
    const Mesh<D>& mesh = reader_.part.mesh;
    Late late;
    for (const Entry<D>& e : some_entries(1)) {
      late.add_entry({1, 2, 3}, Late::Kind::found, 0, 1, e);
      late.add_entry({1, 2, 4}, Late::Kind::set_aside, 1, 2, e);
      Refusal<D> refusal{e, EntityPair{{EntityRef{EntityKind::vertex, 1}, EntityRef{EntityKind::segment, 2}}}, 1, {}, 1, false, 0,
                         0};
      refusal.seen.push_back({e.cell, e.birth});
      refusal.surroundings = surroundings_of<D>(mesh, refusal.seen, refusal.owned).value_or(0);
      late.add({{2, 0, 0}, Late::Kind::refused, 0, 1, refusal});
    }
    late.put(message, mesh);
  }
  static MeshPiece<D> some_piece() {
    MeshPiece<D> piece;
    piece.mesh.points.resize(D + 1);
    piece.mesh.cells.resize(2);
    piece.mesh.regions = {1, 2};
    piece.mesh.subsegments.push_back({{0, 1}, 5});
    piece.point_numbers.assign(D + 1, 7);
    return piece;
  }
  static RefineResult<D> some_result() {
    RefineResult<D> result;
    result.reasons.resize(2);
    result.regions.resize(2);
    result.warnings.push_back({Errc::not_finite, "words", "a.poly", 1, {4}, {{{1, 2, 3}}}});
    return result;
  }

  /// All numbers are in range: parts of it can be taken, and it is written as it was.
  static void look_at(const detail::SentCells<D>& cells) {
    using Writer = detail::CellWriter<D>;
    detail::MessageWriter first, second;
    cells.put(first);
    const Bytes bytes = first.take();
    detail::MessageReader reader(bytes);
    detail::SentCells<D>::get(reader).put(second);
    if (bytes != second.take()) throw std::logic_error("cells that were read and written again are others");
    const auto all = Writer::part(cells, [](std::uint32_t) { return true; });
    const auto some = Writer::part(cells, [](std::uint32_t v) { return v % 2 == 0; });
    if (all.made.size() != cells.made.size() || all.gone.size() != cells.gone.size() || some.made.size() > all.made.size())
      throw std::logic_error("a part has other cells");
    for (const auto& v : all.vertices)
      for (const double x : v.point)
        if (!std::isfinite(x)) throw std::logic_error("a point is no point");
  }

  OwnedTree<D> owned_{2, 2, 1};
  CutMesh<D> reader_{owned_, 0, pairs, 1};
};

/// The kind and the dimension by the first byte, the message after it.
inline void read_any_message(std::span<const std::byte> bytes) {
  static RankMessages<2> planar;
  static RankMessages<3> solid;
  if (bytes.empty()) return;
  const auto first = static_cast<unsigned>(bytes[0]);
  const auto kind = static_cast<MessageKind>(first / 2 % message_kinds);
  if (first % 2 == 0)
    planar.read(kind, bytes.subspan(1));
  else
    solid.read(kind, bytes.subspan(1));
}

}  // namespace pgdr::test
