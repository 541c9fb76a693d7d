// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Splits of poor elements. A candidate, the element's circumcentre or the point of the caller's selector, is inserted if nothing
// blocks it and the insertion rule allows. An entity that blocks it is split in its place:
//
//   candidate -> blocked by? -> judged -> committed -> listed      (ElementSplitter::insert, Inserter::commit)
//
// A selector may want further points in the same element (further_points.hpp), which go in behind the candidate.
#pragma once

#include <optional>

#include "refine/entity_splitter.hpp"
#include "refine/inserter.hpp"
#include "refine/selector_view.hpp"
#include "refine/workspace.hpp"
#include "rule/cell_bounds.hpp"
#include "rule/insertion_rule.hpp"

namespace pgdr {

/// A point that is to go in for a poor element.
template <int D>
struct Candidate {
  Entry<D> entry;               ///< the element
  CellVerdict verdict;          ///< the bounds that it is over
  FilterSphere<D> sphere;       ///< its circumsphere
  Point<D> x;                   ///< the point
  bool at_center = true;        ///< is x the circumcentre, where there is no selector?
  bool is_beside_kept = false;  ///< what is kept blocks the circumcentre
  bool leads = false;           ///< do further points of the selector follow it?
};

/// Splits poor elements. Part of a worker: one thread at a time.
template <int D>
class ElementSplitter {
 public:
  /// All five must outlive it.
  ElementSplitter(Workspace<D>& workspace, WorkLister<D>& lister, Inserter<D>& inserter, DelaunayRepair<D>& repair,
                  EntitySplitter<D>& entities)
      : w_(&workspace),
        mesh_(&workspace.mesh),
        cavity_(&workspace.cavity),
        lister_(&lister),
        inserter_(&inserter),
        repair_(&repair),
        entities_(&entities),
        further_(workspace, inserter) {}

  /// Must be called before the visit does anything.
  void begin_visit() { answers_.begin_visit(); }
  /// Splits the element of an entry of kind cell. @throws what a callback throws
  Outcome split(const Entry<D>& e);

 private:
  using Status = typename Cavity<D>::Status;
  class RefusedFace;
  /// What is in the way of a candidate: an entity, or what ends the attempt; `committed` if the way is free.
  struct Obstacle {
    std::optional<Entry<D>> entity;
    Outcome outcome = Outcome::committed;
  };
  /// May the collected candidate go in (`committed`), and what is its relaxed insertion radius then?
  struct Judgement {
    Outcome outcome;
    double relaxed_radius = 0;
  };

  CellVerdict verdict_of(const Entry<D>& e, const FilterSphere<D>& sphere) const;
  Outcome insert(const Candidate<D>& c);
  Obstacle find_obstacle(const Candidate<D>& c);
  bool is_forced(const Candidate<D>& c);
  Judgement judge(const Candidate<D>& c);
  Outcome commit(const Candidate<D>& c);
  Outcome pass_by(const Entry<D>& entity, const Candidate<D>& c);
  std::optional<Point<D>> place_inside(const Entry<D>& entity, const Candidate<D>& c) const;
  Outcome insert_inside(const Entry<D>& entity, Candidate<D> c);
  Outcome split_instead(const Entry<D>& entity, const Candidate<D>& c);
  Demand demand_of(const Candidate<D>& c);
  Demand demand_on_entity(const Candidate<D>& c);
  bool may_halve_demand(CellId c);

  Workspace<D>* w_;
  Mesh<D>* mesh_;
  Cavity<D>* cavity_;
  WorkLister<D>* lister_;
  Inserter<D>* inserter_;
  DelaunayRepair<D>* repair_;
  EntitySplitter<D>* entities_;
  SelectorAnswers<D> answers_;  ///< in the visit
  FurtherPoints<D> further_;    ///< of the element that is split
};

extern template class ElementSplitter<2>;
extern template class ElementSplitter<3>;

}  // namespace pgdr
