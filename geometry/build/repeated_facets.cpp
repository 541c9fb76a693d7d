// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "build/repeated_facets.hpp"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace pgdr::detail {
namespace {

PlanarTriangle sorted(PlanarTriangle t) {
  std::sort(t.begin(), t.end());
  return t;
}

std::vector<PlanarTriangle> sorted_triangles(const TriangulatedFacet& f, const FacetTriangles& faces) {
  std::vector<PlanarTriangle> out;
  for (const PlanarTriangle& t : faces.of(f)) out.push_back(sorted(t));
  std::sort(out.begin(), out.end());
  return out;
}

/// Of each facet an earlier one with the same triangles; no_entity: there is none. Those with an equal smallest triangle are
/// compared in full.
std::vector<std::uint32_t> find_repeated(const BuildInput<3>& in, const FacetTriangles& faces) {
  std::vector<std::pair<PlanarTriangle, std::uint32_t>> keys;
  for (std::uint32_t f = 0; f < faces.facets.size(); ++f) {
    const auto triangles = faces.of(faces.facets[f]);
    PlanarTriangle least = sorted(triangles[0]);
    for (const PlanarTriangle& t : triangles.subspan(1)) least = std::min(least, sorted(t));
    keys.emplace_back(least, f);
  }
  in.stop.sort(in.bulk, keys);
  std::vector<std::uint32_t> same(faces.facets.size(), no_entity);
  for (std::size_t k = 1; k < keys.size(); ++k)
    for (std::size_t j = k; j-- > 0 && keys[j].first == keys[k].first;) {
      const std::uint32_t f = keys[k].second, g = keys[j].second;
      if (same[g] != no_entity || faces.facets[f].count != faces.facets[g].count) continue;
      if (sorted_triangles(faces.facets[f], faces) == sorted_triangles(faces.facets[g], faces)) same[f] = g;
    }
  return same;
}

}  // namespace

void drop_repeated_facets(const BuildInput<3>& in, FacetTriangles& faces, BuildReport<3>& report) {
  const std::vector<std::uint32_t> same = find_repeated(in, faces);
  auto& facets = faces.facets;
  std::vector<std::uint32_t> new_index(facets.size());
  std::size_t kept = 0;
  std::uint32_t last = no_entity;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> repeated;
  for (std::uint32_t f = 0; f < facets.size(); ++f) {
    new_index[f] = static_cast<std::uint32_t>(kept);
    if (same[f] == no_entity) {
      facets[kept++] = facets[f];
      continue;
    }
    const std::uint32_t mine = facets[f].input, other = facets[new_index[same[f]]].input;
    new_index[f] = new_index[same[f]];
    repeated.emplace_back(new_index[f], mine);
    if (std::exchange(last, mine) == mine) continue;  // another part of it
    const std::int64_t number = report.number(mine), first = report.number(other);
    const std::string words = std::to_string(number) + " = " + std::to_string(first);
    report.repairs.repeated_facets.add([&] { return words; }, {number, first});
    if (in.plc.facets[mine].marker != in.plc.facets[other].marker)
      report.warn(Errc::degenerate_facet, "facets " + words + ", but their markers differ; that of the latter is kept",
                  SourceItem::facet, mine, {number, first});
  }
  std::erase_if(faces.polygon_edges, [&](const auto& e) { return same[e.owner] != no_entity; });
  for (auto& e : faces.polygon_edges) e.owner = new_index[e.owner];
  for (auto& e : faces.repeated) e.first = new_index[e.first];
  faces.repeated.insert(faces.repeated.end(), repeated.begin(), repeated.end());
  facets.resize(kept);
  std::uint32_t end = 0;
  for (TriangulatedFacet& f : facets) {
    std::copy_n(faces.triangles.begin() + f.first, f.count, faces.triangles.begin() + end);
    std::copy_n(faces.masks.begin() + f.first, f.count, faces.masks.begin() + end);
    f.first = std::exchange(end, end + f.count);
  }
  faces.resize(end);
}

}  // namespace pgdr::detail
