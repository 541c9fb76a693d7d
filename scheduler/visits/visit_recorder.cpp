// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "visits/visit_recorder.hpp"

#include <algorithm>

namespace pgdr::detail {

template <int D>
double VisitRecorder::record(const VisitRequest& request, const NodeVisit<D>& visit, const Watch& watch) {
  const auto end = Clock::now();
  const double seconds = std::chrono::duration<double>(end - watch.start).count();
  const std::lock_guard lock(mutex_);
  ++statistics_.visits;
  if (!numbers_.at_home()) predicates_elsewhere_ += predicate_counts() - watch.predicates;
  const std::uint32_t thread = numbers_.of_this_one();
  std::vector<double>& busy = statistics_.busy_seconds;
  if (thread == busy.size()) busy.push_back(0);
  busy[thread] += seconds;
  if (!keeps_trace_) return seconds;
  const auto since_origin = [this](Clock::time_point t) { return std::chrono::duration<double>(t - origin_).count(); };
  trace_.push_back({thread, since_origin(watch.start), since_origin(end), request.node, visit.level, request.order,
                    visit.generation, visit.counts.committed, visit.set_aside.size()});
  return seconds;
}

void VisitRecorder::count_concurrent(std::uint32_t visits) {
  statistics_.max_concurrent = std::max(statistics_.max_concurrent, visits);
}

template double VisitRecorder::record(const VisitRequest&, const NodeVisit<2>&, const Watch&);
template double VisitRecorder::record(const VisitRequest&, const NodeVisit<3>&, const Watch&);

}  // namespace pgdr::detail
