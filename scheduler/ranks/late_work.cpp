// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "ranks/late_work.hpp"

#include <algorithm>

#include "mesh/surroundings.hpp"

namespace pgdr::detail {
namespace {

template <class E>
std::uint32_t code(E e) {
  return static_cast<std::uint32_t>(e);
}

}  // namespace

template <int D>
void LateWork<D>::put(MessageWriter& message, const Mesh<D>& mesh) {
  message.put(static_cast<std::uint64_t>(items_.size()));
  for (const Item& item : items_) {
    const Refusal<D>& r = item.refusal;
    Sent sent{};
    sent.place = item.place;
    sent.surroundings = r.surroundings;
    sent.entry = SentEntry<D>::of(mesh, r.entry);
    if (r.pair)
      sent.pair = {code(r.pair->entities[0].kind), r.pair->entities[0].id, code(r.pair->entities[1].kind),
                   r.pair->entities[1].id};
    sent.kind = code(item.kind);
    sent.node = item.node;
    sent.order = item.order;
    sent.claim_order = r.order;
    sent.has_pair = r.pair.has_value();
    sent.owned = r.owned;
    // What rested on cells that are gone is to be tried again.
    sent.again = r.again || (item.kind == Kind::refused && surroundings_of<D>(mesh, r.seen, r.owned) != r.surroundings);
    message.put(sent);
    std::vector<SentPoints<D>> seen;
    if (sent.again == 0)
      for (const CellName& c : r.seen) seen.push_back(points_of(mesh, c.cell));
    message.put(seen);
  }
  items_.clear();
}

template <int D>
void LateWork<D>::get(MessageReader& message, const Orthtree<D>& tree, const Mesh<D>& mesh, const HeldMesh<D>& held) {
  for (auto left = message.get<std::uint64_t>(); left > 0; --left) {
    const Sent sent = message.get<Sent>();
    const std::vector<SentPoints<D>> seen = message.get_all<SentPoints<D>>();
    if (sent.kind > code(Kind::refused) || sent.node >= tree.node_count() || (sent.again == 0 && sent.owned > seen.size()) ||
        std::max(sent.pair[0], sent.pair[2]) > code(EntityKind::volume))
      fail_message("another rank has late work that is none");
    const Entry<D> entry = sent.entry.entry(mesh, held);
    Refusal<D> refusal{entry, {}, sent.claim_order, {}, sent.owned, sent.again != 0, sent.surroundings, 0};
    if (sent.has_pair != 0)
      refusal.pair = EntityPair{{EntityRef{static_cast<EntityKind>(sent.pair[0]), sent.pair[1]},
                                 EntityRef{static_cast<EntityKind>(sent.pair[2]), sent.pair[3]}}};
    for (const SentPoints<D>& points : seen) {
      const CellId c = held.find(points);
      if (c == no_cell) fail_message("another rank has seen a cell that is not held");
      refusal.seen.push_back({c, mesh.birth(c)});
    }
    items_.push_back({sent.place, static_cast<Kind>(sent.kind), sent.node, sent.order, std::move(refusal)});
  }
}

template <int D>
void LateWork<D>::deliver(WaitingWork<D>& waiting) {
  std::stable_sort(items_.begin(), items_.end(), [](const Item& a, const Item& b) { return a.place < b.place; });
  for (Item& item : items_) {
    switch (item.kind) {
      case Kind::set_aside: waiting[item.node].add_set_aside(item.order, 0, item.refusal.entry); break;
      case Kind::found: waiting.post(item.node, {item.refusal.entry}); break;
      case Kind::refused: waiting[item.node].list.refused.push_back(std::move(item.refusal)); break;
    }
  }
  items_.clear();
}

template class LateWork<2>;
template class LateWork<3>;

}  // namespace pgdr::detail
