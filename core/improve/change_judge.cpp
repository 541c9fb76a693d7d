// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "improve/change_judge.hpp"

namespace pgdr {

/// It is asked for the same cells again and again.
double ChangeJudge::excess_of(CellId c) {
  KnownExcess& known = excess_cache_[index(c) % excess_cache_.size()];
  if (known.cell != c || known.birth != w_->mesh.birth(c)) {
    const bool poor = static_cast<bool>(w_->context.bounds.test(w_->mesh, c));
    known = {c, w_->mesh.birth(c), poor ? w_->context.bounds.excess(w_->mesh.simplex(c), w_->mesh.region(c)) : 0};
  }
  return known.value;
}

double ChangeJudge::excess_of(const std::vector<CellId>& cells) {
  double sum = 0;
  for (const CellId c : cells) sum += excess_of(c);
  return sum;
}

bool ChangeJudge::is_explained(const std::vector<Home>& homes, const Simplex<3>& s) {
  const auto sphere = circumsphere<3>(s);
  return reasons_->has_reason(homes, {sphere.center, sphere.squared_radius},
                              [this](EntityRef a, EntityRef b) { return w_->angles.between(a, b); });
}

}  // namespace pgdr
