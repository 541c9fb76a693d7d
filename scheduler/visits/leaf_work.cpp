// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "visits/leaf_work.hpp"

#include <utility>

#include "claims/claim.hpp"

namespace pgdr::detail {

template <int D>
void LeafWorks<D>::hand_down(RefineContext<D>& context, Node parent, double most_radius, std::uint64_t generation) {
  const Mesh<D>& mesh = context.mesh;
  LeafWork<D>& from = *works_[parent];
  std::vector<Entry<D>> kept;
  auto pass_on = [&](const Entry<D>& e) {
    if (!e.alive(mesh)) return;
    if (context.radius_of(e) > most_radius) return kept.push_back(e);
    // To a child of this parent, though an entity that was set aside may be on a cell with its centre elsewhere.
    LeafWork<D>& to = *works_[tree_->child_at(parent, context.place_of(e.cell))];
    to.list.push(e);
    to.since = generation;
  };
  const auto ended = [&context] { return context.ended(); };
  from.open_inbox(ended);
  if (from.list.drain(
          pass_on, [&mesh](const Entry<D>& e) { mesh.prefetch(e.cell); }, ended)) {
    auto set_aside = std::exchange(from.set_aside, {});
    for (SetAside<D>& s : set_aside)
      for (const Entry<D>& e : s.entries) s.order == whole_tree ? from.add_set_aside(s.order, s.since, e) : pass_on(e);
  }
  for (const Entry<D>& e : kept) from.list.push(e);
}

template class LeafWorks<2>;
template class LeafWorks<3>;

}  // namespace pgdr::detail
