// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "run/leaf_work.hpp"

#include <algorithm>

namespace pgdr::detail {

template <int D>
void LeafWorks<D>::pass_up_changes() {
  for (Node n = static_cast<Node>(works_.size()); --n > Orthtree<D>::root;) {  // children have larger numbers
    std::uint64_t& above = works_[tree_->parent(n)]->changed;
    above = std::max(above, works_[n]->changed);
  }
}

template <int D>
void LeafWorks<D>::hand_down(const RefineContext<D>& context, Node parent, std::uint64_t generation) {
  const Mesh<D>& mesh = context.mesh;
  LeafWork<D>& from = *works_[parent];
  auto pass_on = [&](const Entry<D>& e) {
    if (!e.alive(mesh)) return;
    // To a child of this parent, though an entity that was set aside may be on a cell with its centre elsewhere.
    LeafWork<D>& to = *works_[tree_->child_at(parent, context.place_of(e.cell))];
    to.list.push(e);
    to.since = generation;
  };
  for (Node child = 0; child < Orthtree<D>::children; ++child) works_[tree_->first_child(parent) + child]->changed = from.changed;
  from.open_inbox();
  from.list.drain(pass_on, [&mesh](const Entry<D>& e) { mesh.prefetch(e.cell); });
  for (auto& entries : from.set_aside) {
    for (const Entry<D>& e : entries) pass_on(e);
    std::vector<Entry<D>>().swap(entries);
  }
}

template class LeafWorks<2>;
template class LeafWorks<3>;

}  // namespace pgdr::detail
