// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The last visits of a run, in 3D: Steiner vertices are taken out where that leaves less excess (refiner_improvement.cpp says
// what that is, why this ends, and what may be new). Between segments at a small angle every vertex makes short edges, to
// those on the other segment, and poor elements at these; what needed it when it was inserted may be gone by now.
#include <algorithm>
#include <array>

#include "pgdr/improvement.hpp"
#include "pgdr/refiner.hpp"

namespace pgdr {
namespace {

constexpr std::size_t most_cells = 100;  // at a vertex
constexpr double least_gain = -1e-9;  // none, but for rounding

}  // namespace

/// The excess of the cells collected for a contraction.
template <int D>
double Refiner<D>::excess_about_vertex() const {
  double sum = 0;
  for (const CellId c : contraction_.cells())
    if (context_->bounds.test(*mesh_, c)) sum += context_->bounds.excess(mesh_->simplex(c), mesh_->region(c));
  return sum;
}

/// By how much the contraction makes it less, if that is more than `least`, no new cell too large, and no edge too short.
template <int D>
std::optional<double> Refiner<D>::gain_of_contraction(double excess, double least) const {
  const double shortest = options_->min_edge * options_->min_edge;
  for (std::size_t i = 0; i < contraction_.turned().size(); ++i) {
    const Simplex<D> s = contraction_.prospect(i);
    const int region = mesh_->region(contraction_.turned()[i].cell);
    excess -= context_->bounds.excess(s, region);
    if (!(excess > least) || shortest_edge_squared<D>(s) < shortest || !context_->bounds.within_size(s, region)) return {};
  }
  return excess > least ? std::optional(excess) : std::nullopt;
}

/// Of the corners of the i-th new cell.
template <int D>
std::vector<Home> Refiner<D>::homes_of_turned(std::size_t i) const {
  const auto [c, corner] = contraction_.turned()[i];
  std::vector<Home> homes;
  for (int k = 0; k <= D; ++k)
    homes.push_back(mesh_->vertex(k == corner ? contraction_.target() : mesh_->cell(c).vertices[k]).home);
  return homes;
}

/// Would small angles at their own corners explain all new elements that are poor, and all faces that are not locally
/// Delaunay? `any`: are there such faces?
template <int D>
bool Refiner<D>::contraction_is_explained(bool& any) const {
  const PoorReasons<D>& reasons = context_->improvement->reasons;
  const auto ball = [](const Simplex<D>& s) {
    const auto sphere = circumsphere<D>(s);
    return Ball<D>{sphere.center, sphere.squared_radius};
  };
  for (std::size_t i = 0; i < contraction_.turned().size(); ++i) {
    const Simplex<D> s = contraction_.prospect(i);
    if (!(context_->bounds.excess(s, mesh_->region(contraction_.turned()[i].cell)) > 0)) continue;
    if (!reasons.has_reason(homes_of_turned(i), ball(s))) return false;
  }
  for (const auto& [i, beyond] : contraction_.open_faces()) {
    const Simplex<D> s = contraction_.prospect(i);
    if (in_sphere<D>(s, mesh_->point(beyond)) != Sign::positive) continue;
    any = true;
    std::vector<Home> homes = homes_of_turned(i);
    homes.push_back(mesh_->vertex(beyond).home);
    if (!reasons.has_reason(homes, ball(s))) return false;
  }
  return true;
}

/// Takes out the vertex of the element for which that makes the excess less by most, the first of those that do.
template <int D>
auto Refiner<D>::take_out(const Item& e) -> Outcome {
  struct Best {
    VertexId v, u;
    bool violates;
  };
  std::optional<Best> best;
  double most = least_gain;
  const auto& kept = context_->improvement->kept;
  const auto is_kept = [&kept](CellId c) { return index(c) < kept.size() && kept[index(c)]; };
  for (const VertexId v : mesh_->cell(e.cell).vertices) {
    const auto status = contraction_.collect(v, e.cell, most_cells);
    const auto& cells = contraction_.cells();
    seen_.insert(seen_.end(), cells.begin(), cells.end());
    if (status == Contraction::Status::not_owned) return Outcome::not_owned;
    if (status != Contraction::Status::ok || std::any_of(cells.begin(), cells.end(), is_kept)) continue;
    std::vector<CellId> about(cells);
    std::sort(about.begin(), about.end());
    const std::uint64_t surroundings = surroundings_of<D>(*mesh_, about).value_or(0);
    if (const auto before = rooted_.find(index(v)); before != rooted_.end() && before->second == surroundings) continue;
    const double excess = excess_about_vertex();
    const bool others = best.has_value();
    for (const VertexId u : contraction_.targets()) {
      if (!(excess > most) || !contraction_.aim(u)) continue;
      const auto gain = gain_of_contraction(excess, most);
      bool violates = false;
      if (!gain || !contraction_is_explained(violates)) continue;
      most = *gain;
      best = {v, u, violates};
    }
    if (!others && !best) rooted_[index(v)] = surroundings;
  }
  if (!best) return Outcome::refused;
  contraction_.collect(best->v, e.cell, most_cells);
  contraction_.aim(best->u);
  contraction_.commit(pools_);
  ++visit_->counts.taken_out;
  visit_->changed_mesh = true;
  visit_->violations_seen = visit_->violations_seen || best->violates;
  for (const CellId c : contraction_.new_cells()) list_if_poor(c, context_->bounds.test(*mesh_, c));
  return Outcome::committed;
}

template class Refiner<3>;  // nothing of this in 2D

}  // namespace pgdr
