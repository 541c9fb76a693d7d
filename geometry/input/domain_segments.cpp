// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Last step of a Domain: every edge that is not soft is a segment; which facets have it; both ways.
#include <algorithm>

#include "input/domain_builder.hpp"

namespace pgdr {
using detail::EdgeUse;

/// How many uses the edge at this position has.
template <int D>
std::size_t DomainBuilder<D>::uses_of(std::size_t begin) const {
  std::size_t end = begin + 1;
  while (end < uses_.size() && uses_[end].key == uses_[begin].key) ++end;
  return end - begin;
}

template <int D>
void DomainBuilder<D>::write_segment(std::size_t begin, std::size_t end) {
  const auto id = static_cast<EntityId>(out_.segments_.size());
  auto a = static_cast<std::uint32_t>(uses_[begin].key >> 32), b = static_cast<std::uint32_t>(uses_[begin].key);
  if (lex_less(out_.points_[b], out_.points_[a])) std::swap(a, b);
  DomainSegment segment{{a, b}, 0, false};
  std::uint32_t first = 0;
  for (std::size_t k = begin; k < end; ++k) {
    const EdgeUse& use = uses_[k];
    if (use.is_triangle()) facet_segment_.emplace_back(group_of_[use.owner], id);
    if (use.kind != EdgeUse::Kind::explicit_segment) continue;
    const int marker = marker_of(use.owner);
    if (!segment.explicit_in_input) {
      segment.explicit_in_input = true;
      segment.marker = marker;
      (is_in_plc(use.owner) ? segment.input : segment.input_facet) = item_of(use.owner);
      first = use.owner;
      continue;
    }
    note_repeated(use.owner, first);
  }
  out_.segments_.push_back(segment);
}

// A segment that is a facet of the input goes by the facet's number.
template <int D>
void DomainBuilder<D>::note_repeated(std::uint32_t segment, std::uint32_t first) {
  const auto name = [&](std::uint32_t s) { return (is_in_plc(s) ? "" : "facet ") + std::to_string(number(item_of(s))); };
  const std::string words = name(segment) + " = " + name(first);
  const std::initializer_list<std::int64_t> ids{number(item_of(segment)), number(item_of(first))};
  repeated_segments_.add([&] { return words; }, ids);
  if (marker_of(segment) != marker_of(first))
    warn(Errc::degenerate_segment, "segments " + words + ", but their markers differ; that of the latter is kept",
         is_in_plc(segment) ? plc_.source.segment_lines : plc_.source.facet_lines, item_of(segment), ids);
}

// An edge of a polygon that no triangle has (outside of its facet, or in a hole of it) is a segment, too.
template <int D>
void DomainBuilder<D>::write_segments() {
  for (std::size_t begin = 0, end; begin < uses_.size(); begin = end) {
    end = begin + uses_of(begin);
    if (!soft_[begin]) write_segment(begin, end);
  }
}

template <int D>
void DomainBuilder<D>::write_incidences() {
  auto& pairs = facet_segment_;
  stop_check_.sort(bulk_, pairs);
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  for (const auto& [f, s] : pairs) {
    DomainFacet& facet = out_.facets_[f];
    if (facet.segment_count++ == 0) facet.first_segment = static_cast<std::uint32_t>(out_.facet_segments_.size());
    out_.facet_segments_.push_back(s);
  }
  auto& begin = out_.facets_of_segment_begin_;
  begin.assign(out_.segments_.size() + 1, 0);
  for (const auto& [f, s] : pairs) ++begin[s + 1];
  for (std::size_t s = 1; s < begin.size(); ++s) begin[s] += begin[s - 1];
  std::vector<std::uint32_t> next(begin);
  out_.facets_of_segment_.resize(pairs.size());
  for (const auto& [f, s] : pairs) out_.facets_of_segment_[next[s]++] = f;
}

template std::size_t DomainBuilder<3>::uses_of(std::size_t) const;
template void DomainBuilder<2>::write_segments();
template void DomainBuilder<3>::write_segments();
template void DomainBuilder<2>::write_incidences();
template void DomainBuilder<3>::write_incidences();

}  // namespace pgdr
