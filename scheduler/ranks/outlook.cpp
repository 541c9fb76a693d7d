// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "ranks/outlook.hpp"

#include <algorithm>
#include <type_traits>

#include "transport/message.hpp"

namespace pgdr::detail {

namespace {

template <class AnyOutlook, class F>
void each_field(AnyOutlook& o, const F& f) {
  auto& t = o.totals;
  const auto all = [&](auto&... values) { (f(values), ...); };
  all(o.stop, o.first, o.visits, o.is_any_left, t.counts.committed, t.counts.refused, t.counts.selector_outside,
      t.counts.selector_further, t.counts.selector_dropped, t.counts.removed, t.vertices, t.violations_seen, t.entities_refused,
      t.min_edge_hit);
}

}  // namespace

std::vector<std::uint64_t> Outlook::to_row() const {
  std::vector<std::uint64_t> row;
  each_field(*this, [&](const auto& value) { row.push_back(static_cast<std::uint64_t>(value)); });
  return row;
}

Outlook Outlook::of(const std::vector<std::uint64_t>& row) {
  Outlook outlook;
  if (row.size() != outlook.to_row().size()) fail_message("a message of another rank is of another length");
  std::size_t i = 0;
  each_field(outlook, [&](auto& value) { value = static_cast<std::remove_reference_t<decltype(value)>>(row[i++]); });
  return outlook;
}

Outlook Outlook::of_all(const std::vector<std::vector<std::uint64_t>>& rows, int rank, const RunTotals& before) {
  Outlook all;
  all.totals = before;
  for (int r = 0; r < static_cast<int>(rows.size()); ++r) {
    const Outlook one = of(rows[static_cast<std::size_t>(r)]);
    all.stop = std::max(all.stop, one.stop);
    all.is_any_left = all.is_any_left || one.is_any_left;
    if (one.first < all.first) {
      all.first = one.first;
      all.visits = all.visits_before = 0;
    }
    if (one.first == all.first) {
      if (r < rank) all.visits_before += one.visits;
      all.visits += one.visits;
    }
    all.totals.counts += one.totals.counts;
    all.totals.vertices += one.totals.vertices;
    all.totals.violations_seen = all.totals.violations_seen || one.totals.violations_seen;
    all.totals.entities_refused = all.totals.entities_refused || one.totals.entities_refused;
    all.totals.min_edge_hit = all.totals.min_edge_hit || one.totals.min_edge_hit;
  }
  return all;
}

RunTotals operator-(const RunTotals& now, const RunTotals& then) {
  RunTotals since = now;
  since.counts.committed -= then.counts.committed;
  since.counts.refused -= then.counts.refused;
  since.counts.selector_outside -= then.counts.selector_outside;
  since.counts.selector_further -= then.counts.selector_further;
  since.counts.selector_dropped -= then.counts.selector_dropped;
  since.counts.removed -= then.counts.removed;
  since.vertices -= then.vertices;
  return since;
}

}  // namespace pgdr::detail
