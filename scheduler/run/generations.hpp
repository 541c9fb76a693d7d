// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The reproducible schedule. Work proceeds in generations; within one the tree, the claims and the order of the visits are
// frozen, and a visit waits for the earlier visits whose claims meet its own and for nothing else. A visit reads and
// writes its own claim alone, what waits in these leaves included, so that any execution that respects these edges gives the
// same mesh. What they find for other leaves or set aside, and splits, take effect at the end of the generation, in their order.
#pragma once

#include "claims/claim_registry.hpp"
#include "run/leaf_refinement.hpp"

namespace pgdr::detail {

template <int D>
class Generations final : public LeafRefinement<D> {
 public:
  using Base = LeafRefinement<D>;
  using typename Base::Node;

  Generations(RefineContext<D>& context, typename Mesh<D>::Pools pools, std::uint64_t vertices_so_far);

 private:
  using typename Base::Clock;
  using Base::seconds_since;
  struct Planned {
    RegionVisit<D> work;
    double seconds = 0;
  };

  StopCause drain() override;
  bool one_generation();
  void run_visit(const Visit<D>& visit, Planned& planned);
  void execute(const VisitGraph& graph, const VisitBody& body);
  void finish(Generation<D>& generation, std::vector<Planned>& planned);
  bool is_whole_if_small() const;
  void execute_pieces(std::size_t pieces, const VisitBody& piece);
  void renew_buffers(std::span<const VisitRequest> requests);
  void touch_memory(std::span<const VisitRequest> requests);
  void split_leaves(std::vector<Node> candidates);

  using Base::context_, Base::generation_, Base::options_, Base::random_, Base::statistics_, Base::tree_, Base::vertices_, Base::works_;
  ConflictManager<D> conflicts_;
  ClaimRegistry<D> registry_;
};

extern template class Generations<2>;
extern template class Generations<3>;

}  // namespace pgdr::detail
