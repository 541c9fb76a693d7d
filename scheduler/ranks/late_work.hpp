// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Work that is kept for the end of a run on several ranks: entries for nodes that no rank visits, and what was refused. An entry
// is kept by a rank that holds its cell, and has the place in line that it would have in one process. One thread.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <iterator>
#include <span>
#include <tuple>
#include <vector>

#include "ranks/sent_entry.hpp"
#include "visits/waiting_work.hpp"

namespace pgdr::detail {

/// See above.
template <int D>
class LateWork {
 public:
  using Node = typename Orthtree<D>::Node;

  /// Where an entry is in line: the phase in which it came, the visit by its Morton number, and its place among those of this.
  struct Place {
    std::uint64_t phase = 0, visit = 0, number = 0;
    friend auto operator<=>(const Place&, const Place&) = default;
  };
  /// What is to be done with an entry.
  enum class Kind : std::uint32_t { set_aside, found, refused };
  struct Item {
    Place place;
    Kind kind;
    Node node;            ///< whose it is
    std::uint32_t order;  ///< of the claim that it was set aside for
    Refusal<D> refusal;   ///< with the entry; the rest is of those refused alone
  };

  bool empty() const { return items_.empty(); }
  void add(const Item& item) { items_.push_back(item); }
  void add_entry(const Place& place, Kind kind, Node node, std::uint32_t order, const Entry<D>& e) {
    items_.push_back({place, kind, node, order, {e, {}, 1, {}, 0, false, 0, 0}});
  }

  /// Takes the items out of whose entries `is` holds. @returns these
  template <class Is>
  LateWork take_if(Is is) {
    LateWork taken;
    const auto first = std::stable_partition(items_.begin(), items_.end(), [&](const Item& i) { return !is(i.refusal.entry); });
    taken.items_.assign(std::make_move_iterator(first), std::make_move_iterator(items_.end()));
    items_.erase(first, items_.end());
    return taken;
  }
  /// Writes all, with cells by the coordinates of their vertices, and takes it out.
  void put(MessageWriter& message, const Mesh<D>& mesh);
  /// Adds what another rank wrote. `held`: this rank holds the cells.
  /// @throws ResourceError internal: there is no such work, node or cell
  void get(MessageReader& message, const Orthtree<D>& tree, const Mesh<D>& mesh, const HeldMesh<D>& held);
  /// Puts all where it belongs, in line, and takes it out.
  void deliver(WaitingWork<D>& waiting);

 private:
  struct Sent {
    Place place;
    std::uint64_t surroundings, owned;
    SentEntry<D> entry;
    std::array<std::uint32_t, 4> pair;  ///< kinds and ids of the entities
    std::uint32_t kind, node, order, claim_order, has_pair, again;
  };

  std::vector<Item> items_;
};

extern template class LateWork<2>;
extern template class LateWork<3>;

}  // namespace pgdr::detail
