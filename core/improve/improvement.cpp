// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "improve/improvement.hpp"

#include "improve/change_judge.hpp"
#include "improve/flip_changes.hpp"
#include "improve/point_changes.hpp"
#include "improve/vertex_changes.hpp"
#include "mesh/surroundings.hpp"

namespace pgdr {
namespace {

/// Does something for an element that stays poor, if there is anything to be done.
class Improver final : public ElementTreatment<3> {
 public:
  Improver(Workspace<3>& workspace, WorkLister<3>& lister, DelaunayRepair<3>& repair, const PoorReasons<3>& reasons,
           const Improvement& stage)
      : w_(&workspace),
        stage_(&stage),
        judge_(workspace, reasons),
        flips_(workspace, lister, repair.flips(), judge_),
        vertices_(workspace, judge_, flips_),
        points_(workspace, judge_, flips_) {}

  void begin_visit() override {
    w_->cavity.set_most_cells(most_cells_changed);
    vertices_.begin_visit();
  }
  Outcome treat(const Entry<3>& e) override {
    Outcome outcome = vertices_.change(e, VertexChanges::Kind::collapse);
    if (!stage_->collapses_only) {
      if (outcome == Outcome::refused) outcome = flips_.flip_to_improve(e);
      if (outcome == Outcome::refused) outcome = vertices_.change(e, VertexChanges::Kind::move);
      if (outcome == Outcome::refused) outcome = points_.insert_to_improve(e);
    }
    w_->visit->counts.refused += outcome == Outcome::refused;
    return outcome;
  }
  std::uint64_t version(CellId c) const override { return stage_->version(c); }

 private:
  Workspace<3>* w_;
  const Improvement* stage_;
  ChangeJudge judge_;
  FlipChanges flips_;
  VertexChanges vertices_;
  PointChanges points_;
};

}  // namespace

std::unique_ptr<ElementTreatment<3>> Improvement::treatment(Workspace<3>& workspace, WorkLister<3>& lister,
                                                            DelaunayRepair<3>& repair) const {
  return std::make_unique<Improver>(workspace, lister, repair, *reasons_, *this);
}

std::uint64_t Improvement::version(CellId c) const { return versions_about(*mesh_, c); }

}  // namespace pgdr
