// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "boundary/named_points.hpp"

namespace pgdr::detail {

template <int D>
Diagnostic about_points(Errc code, const Domain<D>& domain, std::span<const std::uint32_t> points) {
  Diagnostic d;
  d.code = code;
  d.file = domain.source().file;
  for (const std::uint32_t p : points) {
    const std::uint32_t input = domain.input_of_point()[p];
    if (d.ids.empty()) {
      PlcSource::Place place = domain.source().place(SourceItem::point, input);
      d.file = std::move(place.file);
      d.line = place.line;
    }
    d.ids.push_back(std::int64_t{input} + domain.first_index());
    const Point<D>& x = domain.points()[p];
    if constexpr (D == 3)
      d.points.push_back(x.x);
    else
      d.points.push_back({x[0], x[1], 0});
  }
  return d;
}

std::string segment_words(const Diagnostic& about) {
  return "the segment between points " + std::to_string(about.ids[0]) + " and " + std::to_string(about.ids[1]);
}

std::string facet_words(const Diagnostic& about) {
  constexpr std::size_t most = 3;
  std::string words = "the facet through points ";
  for (std::size_t i = 0; i < about.ids.size() && i < most; ++i) words += (i == 0 ? "" : ", ") + std::to_string(about.ids[i]);
  return about.ids.size() > most ? words + ", ..." : words;
}

template Diagnostic about_points<2>(Errc, const Domain<2>&, std::span<const std::uint32_t>);
template Diagnostic about_points<3>(Errc, const Domain<3>&, std::span<const std::uint32_t>);

}  // namespace pgdr::detail
