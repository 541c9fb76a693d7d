// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "ranks/outlook.hpp"

#include <algorithm>

#include "transport/message.hpp"

namespace pgdr::detail {

std::vector<std::uint64_t> Outlook::to_row() const {
  const RefineCounts& c = totals.counts;
  return {static_cast<std::uint64_t>(stop),
          first,
          visits,
          is_any_left ? 1u : 0u,
          c.committed,
          c.refused,
          c.selector_outside,
          c.removed,
          totals.vertices,
          totals.violations_seen ? 1u : 0u,
          totals.entities_refused ? 1u : 0u,
          totals.min_edge_hit ? 1u : 0u};
}

Outlook Outlook::of(const std::vector<std::uint64_t>& row) {
  if (row.size() != Outlook().to_row().size()) fail_message("a message of another rank is of another length");
  Outlook outlook;
  outlook.stop = static_cast<StopCause>(row[0]);
  outlook.first = row[1];
  outlook.visits = row[2];
  outlook.is_any_left = row[3] != 0;
  RefineCounts& c = outlook.totals.counts;
  c.committed = row[4];
  c.refused = row[5];
  c.selector_outside = row[6];
  c.removed = row[7];
  outlook.totals.vertices = row[8];
  outlook.totals.violations_seen = row[9] != 0;
  outlook.totals.entities_refused = row[10] != 0;
  outlook.totals.min_edge_hit = row[11] != 0;
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
  since.counts.removed -= then.counts.removed;
  since.vertices -= then.vertices;
  return since;
}

}  // namespace pgdr::detail
