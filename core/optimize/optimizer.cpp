// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "optimize/optimizer.hpp"

#include "optimize/numbers.hpp"
#include "optimize/order_by_level.hpp"

#include <algorithm>
#include <array>
#include <vector>

#include "mesh/surroundings.hpp"
#include "optimize/flips.hpp"
#include "optimize/insertions.hpp"
#include "optimize/polyhedron_growth.hpp"
#include "optimize/surgery.hpp"
#include "optimize/vertex_changes.hpp"

namespace pgdr {
namespace {

/// Treats poor cells. Part of a worker: one thread at a time.
class Optimizer final : public ElementTreatment<3> {
 public:
  Optimizer(Workspace<3>& workspace, WorkLister<3>& lister, const OptimizerStage& stage)
      : s_(workspace, stage.min_dihedral()),
        lister_(&lister),
        stage_(&stage),
        flip_(s_),
        vertices_(s_),
        reconnect_(s_),
        insertions_(s_) {}

  void begin_visit() override { s_.replacer.set_area(s_.area()); }
  Outcome treat(const Entry<3>& e) override;
  std::uint64_t version(CellId c) const override { return stage_->version(c); }

 private:
  /// Is nothing more to be tried for the element?
  bool is_spent() const { return s_.judge.asked() - evaluated_before_ > stage_->most_a_cell; }
  void ask_about(CellId c);
  bool change(CellId c);
  bool change_cheaply(CellId c, Judge::Rule rule);
  bool open_cheaply(CellId c) { return change_cheaply(c, Judge::Rule::better); }
  bool open_by_reconnection(CellId c) { return reconnect_.make(c, Judge::Rule::better); }
  bool open_by_digging(CellId c) { return insertions_.dig(c, Judge::Rule::better); }
  bool open_by_contraction(CellId c) { return vertices_.contract(c, Judge::Rule::better); }
  bool make_detour(CellId c);
  bool split_an_edge(CellId c);
  bool end_compound(bool begun);
  void list_made(const std::vector<CellId>& made);

  Surgery s_;
  WorkLister<3>* lister_;
  const OptimizerStage* stage_;
  BestFlip flip_;
  VertexChanges vertices_;
  PolyhedronGrowth reconnect_;
  Insertions insertions_;
  std::uint64_t evaluated_before_ = 0;  ///< the element that is treated
  RefineCounts counts_before_;          ///< a compound
  std::vector<CellId> about_;           ///< scratch of ask_about()
};

/// Asks for the sizes at the cells that have a vertex of this one, in one block: nearly all cells that a change of it looks at.
void Optimizer::ask_about(CellId c) {
  Mesh<3>& mesh = *s_.mesh;
  const auto vertices = mesh.cell(c).vertices;
  const auto touches = [&](CellId x) {
    return std::any_of(vertices.begin(), vertices.end(), [&](VertexId v) { return has_corner(mesh.cell(x).vertices, v); });
  };
  about_.assign(1, c);
  mesh.mark(c);
  for (std::size_t i = 0; i < about_.size() && about_.size() < Judge::most_known / 2; ++i)
    for (const Link next : mesh.cell(about_[i]).links) {
      if (!next || mesh.marked(next.cell()) || !s_.owns(next.cell()) || !touches(next.cell())) continue;
      mesh.mark(next.cell());
      about_.push_back(next.cell());
    }
  for (const CellId x : about_) mesh.unmark(x);
  s_.judge.ask(about_);
}

bool Optimizer::change_cheaply(CellId c, Judge::Rule rule) {
  if (flip_.make(c, rule)) {
    ++s_.w->visit->counts.edge_removals;
    return true;
  }
  return vertices_.move(c, rule);
}

/// Ends a transaction: mends the poor cells that it has made, and keeps all if they are better than what was there, together.
bool Optimizer::end_compound(bool begun) {
  const int rounds = stage_->phase == OptimizerStage::Phase::rest ? numbers::rounds_in_rest : numbers::rounds_of_compound;
  for (int round = 0; begun && round < rounds && !is_spent(); ++round) {
    bool any = false;
    const std::vector<CellId> made = s_.transaction.made();
    s_.judge.ask(made);
    for (const CellId c : made) {
      const auto& now = s_.transaction.made();
      if (is_spent() || std::find(now.begin(), now.end(), c) == now.end() || s_.judge.of(c) >= 1) continue;
      any = change_cheaply(c, Judge::Rule::better) || any;
    }
    if (!any) break;
  }
  const bool kept = begun && s_.judge.accepts(s_.transaction.made(), s_.judge.standing_of(s_.transaction.removed()),
                                              Judge::Rule::no_more_poor);
  if (kept) {
    const std::vector<CellId> made = s_.transaction.made();
    s_.transaction.keep(s_.w->pools);
    list_made(made);
  } else {
    s_.transaction.undo(s_.w->pools);
    s_.w->visit->counts = counts_before_;
  }
  return kept;
}

/// Begins with changes that make the worst better, whatever else gets poor.
bool Optimizer::make_detour(CellId c) {
  using Opening = bool (Optimizer::*)(CellId);
  static constexpr std::array<Opening, 4> openings{&Optimizer::open_cheaply, &Optimizer::open_by_reconnection,
                                                   &Optimizer::open_by_digging, &Optimizer::open_by_contraction};
  const std::size_t count = stage_->phase == OptimizerStage::Phase::rest ? openings.size() : 1;
  for (std::size_t i = 0; i < count && !is_spent(); ++i) {
    counts_before_ = s_.w->visit->counts;
    s_.transaction.begin();
    if (end_compound((this->*openings[i])(c))) return true;
  }
  return false;
}

/// The longest first.
bool Optimizer::split_an_edge(CellId c) {
  const Simplex<3> s = s_.mesh->simplex(c);
  std::array<int, 6> edges{0, 1, 2, 3, 4, 5};
  const auto length2 = [&](int e) { return squared_distance(s[edge_ends[e][0]], s[edge_ends[e][1]]); };
  std::stable_sort(edges.begin(), edges.end(), [&](int a, int b) { return length2(a) > length2(b); });
  for (const int edge : edges) {
    if (is_spent()) return false;
    counts_before_ = s_.w->visit->counts;
    s_.transaction.begin();
    if (end_compound(insertions_.split_edge(c, edge))) return true;
  }
  return false;
}

bool Optimizer::change(CellId c) {
  const bool strong = stage_->phase != OptimizerStage::Phase::cheap;
  const auto list = [this](bool changed) {
    if (changed) list_made(s_.replacer.new_cells());
    return changed;
  };
  const bool has_short_edge = s_.w->context.bounds.over_radius_edge(*s_.mesh, c);
  if (list(change_cheaply(c, Judge::Rule::no_more_poor) || (has_short_edge && vertices_.contract(c, Judge::Rule::no_more_poor))))
    return true;
  if (!strong) return false;
  if (list(reconnect_.make(c, Judge::Rule::no_more_poor) || insertions_.dig(c, Judge::Rule::no_more_poor))) return true;
  if (make_detour(c) || split_an_edge(c)) return true;
  return !is_spent() && !has_short_edge && list(vertices_.contract(c, Judge::Rule::no_more_poor));
}

void Optimizer::list_made(const std::vector<CellId>& made) {
  for (const CellId c : made)
    if (const int level = CellQuality::level(s_.judge.of(c)); level < 0)
      lister_->list_element(c, order_by_level(*s_.mesh, c, level));
}

Outcome Optimizer::treat(const Entry<3>& e) {
  s_.out_of_reach = false;
  if (s_.w->context.bounds.sizes_vary()) ask_about(e.cell);
  evaluated_before_ = s_.judge.asked();
  const bool changed = change(e.cell);
  s_.w->visit->counts.evaluated += s_.judge.asked() - evaluated_before_;
  if (changed && s_.w->alive(e)) list_made({e.cell});  // a contraction beside it
  if (changed) return Outcome::committed;
  return s_.out_of_reach ? Outcome::not_owned : Outcome::refused;
}

}  // namespace

std::unique_ptr<ElementTreatment<3>> OptimizerStage::treatment(Workspace<3>& workspace, WorkLister<3>& lister,
                                                               DelaunayRepair<3>&) const {
  return std::make_unique<Optimizer>(workspace, lister, *this);
}

std::uint64_t OptimizerStage::version(CellId c) const { return versions_at(*mesh_, c); }

}  // namespace pgdr
