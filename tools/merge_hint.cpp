// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "merge_hint.hpp"

#include <algorithm>
#include <cstdio>
#include <exception>
#include <stop_token>
#include <vector>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "console.hpp"

namespace pgdr::tool {
namespace {

constexpr double of_rounding = 1e-14;  // what rotations and shifts do to doubles
constexpr double of_floats = 1e-7, of_six_digits = 1e-6;

/// Of some that are tried, the least Plc::merge_within with which nothing is refused; 0 if there is none.
double sufficient_merge(const Plc<3>& plc, const FindingList& near) {
  std::vector<double> tried{of_rounding, of_floats, of_six_digits};
  if (!near.listed.empty()) tried.push_back(1.1 * near.listed[0].measure);
  std::sort(tried.begin(), tried.end());
  std::vector<std::stop_source> needed(tried.size());  // until a smaller one will do
  std::vector<char> is_valid(tried.size());
  tbb::parallel_for(
      tbb::blocked_range<std::size_t>(0, tried.size(), 1),
      [&](const tbb::blocked_range<std::size_t>& range) {
        for (std::size_t i = range.begin(); i < range.end(); ++i) {
          Plc<3> merged = plc;
          merged.merge_within = tried[i];
          try {
            is_valid[i] =
                diagnose(merged, {.most_listed = 0, .errors_only = true, .stop = needed[i].get_token()}).error_count() == 0;
          } catch (const CancelledError&) {
          }
          if (is_valid[i])
            for (std::size_t k = i + 1; k < tried.size(); ++k) needed[k].request_stop();
        }
      },
      tbb::simple_partitioner());
  const auto least = std::find(is_valid.begin(), is_valid.end(), 1);
  return least == is_valid.end() ? 0 : tried[static_cast<std::size_t>(least - is_valid.begin())];
}

/// Points that were merged, or are on what they did not belong to.
std::size_t joined_points(const Domain<3>& domain) {
  std::size_t joined = 0;
  for (const Diagnostic& repair : domain.repairs()) {
    if (repair.code == Errc::point_on_segment) joined += repair.ids.size() / 3;
    if (repair.code == Errc::near_points || repair.code == Errc::point_on_facet) joined += repair.ids.size() / 2;
  }
  return joined;
}

}  // namespace

template <int D>
void hint_at_merge_of_refused(const Plc<D>& plc, const FindingList& near) {
  double within = 0;
  if constexpr (D == 3) within = plc.merge_within == 0 ? sufficient_merge(plc, near) : 0;
  if (within > 0) {
    std::fprintf(stderr, "pgdr: --merge-points %.1e makes it valid: what is apart, or crosses, by no more than that then meets\n",
                 within);
  } else if (!near.listed.empty()) {
    std::fprintf(stderr, "pgdr: %s; --merge-points %.1e makes %s one\n",
                 count(near.count, "pair of points of open boundaries nearly coincides",
                       "pairs of points of open boundaries nearly coincide")
                     .c_str(),
                 1.1 * near.listed[0].measure, near.count == 1 ? "it" : "each");
  }
}

template <int D>
std::optional<MergeHint> find_merge_hint(const Plc<D>& plc, const Domain<D>* domain) {
  if constexpr (D == 3) {
    if (plc.merge_within > 0) return std::nullopt;
    try {
      std::optional<Domain<3>> made;
      if (domain == nullptr) domain = &made.emplace(plc);
      if (!may_join(*domain, of_rounding)) return std::nullopt;
      Plc<3> merged = plc;
      merged.merge_within = of_rounding;
      const std::size_t before = joined_points(*domain), joined = joined_points(Domain<3>(merged));
      if (joined > before) return MergeHint{of_rounding, joined - before};
    } catch (const std::exception&) {
    }
  }
  return std::nullopt;
}

template <int D>
void note_merge(const Plc<D>& plc, const InputArguments& reading) {
  if (plc.merge_within > 0 && !reading.merge_points)
    print_row("merged", format("--merge-points %.0e: points that are apart by what floats keep of zeros (0 keeps them so)",
                               plc.merge_within));
}

void give(const std::optional<MergeHint>& hint, bool shown, Report& report) {
  if (!hint) return;
  report.set("merge_hint", JsonObject{{"merge_points", hint->merge_points}, {"points", hint->points}});
  if (shown)
    print_row("hint", format("--merge-points %.0e joins ", hint->merge_points) +
                          count(hint->points, "point to a point, an edge or a facet that it misses",
                                "points to points, edges or facets that they miss") +
                          " by rounding");
}

template void note_merge<2>(const Plc<2>&, const InputArguments&);
template void note_merge<3>(const Plc<3>&, const InputArguments&);
template void hint_at_merge_of_refused<2>(const Plc<2>&, const FindingList&);
template void hint_at_merge_of_refused<3>(const Plc<3>&, const FindingList&);
template std::optional<MergeHint> find_merge_hint<2>(const Plc<2>&, const Domain<2>*);
template std::optional<MergeHint> find_merge_hint<3>(const Plc<3>&, const Domain<3>*);

}  // namespace pgdr::tool
