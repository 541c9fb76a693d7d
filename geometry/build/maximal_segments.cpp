// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "build/maximal_segments.hpp"

#include <algorithm>
#include <string>
#include <utility>

namespace pgdr::detail {
namespace {

/// Reports a segment that repeats an earlier one. One that is a facet of the input goes by the facet's number.
template <int D>
void report_repeated(const ExplicitSegments<D>& segments, std::uint32_t s, std::uint32_t first, BuildReport<D>& report) {
  const auto number = [&](std::uint32_t t) { return report.number(segments.item_of(t)); };
  const auto name = [&](std::uint32_t t) { return (segments.is_in_plc(t) ? "" : "facet ") + std::to_string(number(t)); };
  const std::string words = name(s) + " = " + name(first);
  const std::initializer_list<std::int64_t> ids{number(s), number(first)};
  report.repairs.repeated_segments.add([&] { return words; }, ids);
  if (segments.marker_of(s) != segments.marker_of(first))
    report.warn(Errc::degenerate_segment, "segments " + words + ", but their markers differ; that of the latter is kept",
                segments.is_in_plc(s) ? SourceItem::segment : SourceItem::facet, segments.item_of(s), ids);
}

template <int D>
DomainSegment segment_of(const BuildInput<D>& in, std::span<const EdgeUse> uses, const ExplicitSegments<D>& segments,
                         BuildReport<D>& report) {
  auto [a, b] = edge_of(uses[0].key);
  if (lex_less(in.points[b], in.points[a])) std::swap(a, b);
  DomainSegment segment{{a, b}, 0, false};
  std::uint32_t first = 0;
  for (const EdgeUse& use : uses) {
    if (use.kind != EdgeUse::Kind::explicit_segment) continue;
    if (segment.explicit_in_input) {
      report_repeated(segments, use.owner, first, report);
      continue;
    }
    first = use.owner;
    segment.explicit_in_input = true;
    segment.marker = segments.marker_of(first);
    (segments.is_in_plc(first) ? segment.input : segment.input_facet) = segments.item_of(first);
  }
  return segment;
}

/// Adds what of the input the uses of one segment are: Plc::segments come first, as their numbers do.
template <int D>
void add_origins(std::span<const EdgeUse> uses, const ExplicitSegments<D>& segments, MaximalSegments& out) {
  const auto first = static_cast<std::ptrdiff_t>(out.origins.size());
  for (const EdgeUse& use : uses)
    if (use.kind == EdgeUse::Kind::explicit_segment)
      out.origins.push_back({segments.item_of(use.owner), !segments.is_in_plc(use.owner)});
  out.origins.erase(std::unique(out.origins.begin() + first, out.origins.end()), out.origins.end());
  out.origins_begin.push_back(static_cast<std::uint32_t>(out.origins.size()));
}

}  // namespace

template <int D>
MaximalSegments make_maximal_segments(const BuildInput<D>& in, const EdgeUses& all, const std::vector<bool>& soft,
                                      const ExplicitSegments<D>& segments, std::span<const EntityId> group_of,
                                      std::span<DomainFacet> facets, BuildReport<D>& report) {
  MaximalSegments out;
  out.origins_begin.push_back(0);
  std::vector<std::pair<EntityId, EntityId>> pairs;  // facet, segment
  all.each_edge([&](std::size_t begin, std::span<const EdgeUse> uses) {
    if (soft[begin]) return;
    const auto id = static_cast<EntityId>(out.segments.size());
    for (const EdgeUse& use : uses)
      if (use.is_triangle()) pairs.emplace_back(group_of[use.owner], id);
    out.segments.push_back(segment_of(in, uses, segments, report));
    add_origins(uses, segments, out);
  });
  in.stop.sort(in.bulk, pairs);
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  for (const auto& [f, s] : pairs) {
    DomainFacet& facet = facets[f];
    if (facet.segment_count++ == 0) facet.first_segment = static_cast<std::uint32_t>(out.of_facets.size());
    out.of_facets.push_back(s);
  }
  out.facets_begin.assign(out.segments.size() + 1, 0);
  for (const auto& [f, s] : pairs) ++out.facets_begin[s + 1];
  for (std::size_t s = 1; s < out.facets_begin.size(); ++s) out.facets_begin[s] += out.facets_begin[s - 1];
  std::vector<std::uint32_t> next(out.facets_begin);
  out.facets.resize(pairs.size());
  for (const auto& [f, s] : pairs) out.facets[next[s]++] = f;
  return out;
}

#define PGDR_INSTANTIATE(D)                                                                                          \
  template MaximalSegments make_maximal_segments<D>(const BuildInput<D>&, const EdgeUses&, const std::vector<bool>&, \
                                                    const ExplicitSegments<D>&, std::span<const EntityId>,           \
                                                    std::span<DomainFacet>, BuildReport<D>&);
PGDR_INSTANTIATE(2)
PGDR_INSTANTIATE(3)
#undef PGDR_INSTANTIATE

}  // namespace pgdr::detail
