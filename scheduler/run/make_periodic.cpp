// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "pgdr/make_periodic.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "input/usable_plc.hpp"
#include "pgdr/domain.hpp"
#include "pgdr/refine.hpp"
#include "run/periodic_sides.hpp"
#include "space/disjoint_sets.hpp"
#include "space/point_places.hpp"

namespace pgdr {
namespace {

using detail::SideChain;

/// The pairs that hang together by common markers.
std::vector<std::vector<PeriodicSides<2>>> chains_of(std::span<const PeriodicSides<2>> sides) {
  std::map<int, std::uint32_t> number;
  for (const auto& pair : sides)
    for (const int marker : {pair.from, pair.to}) number.try_emplace(marker, static_cast<std::uint32_t>(number.size()));
  detail::DisjointSets sets(number.size());
  for (const auto& pair : sides) sets.unite(number[pair.from], number[pair.to]);
  std::map<std::uint32_t, std::vector<PeriodicSides<2>>> chains;
  for (const auto& pair : sides) chains[sets.find(number[pair.from])].push_back(pair);
  std::vector<std::vector<PeriodicSides<2>>> all;
  for (auto& [set, pairs] : chains) all.push_back(std::move(pairs));
  return all;
}

class PeriodicMaker {
 public:
  PeriodicMaker(const Plc<2>& plc, std::span<const PeriodicSides<2>> sides) : given_(plc) {
    for (std::vector<PeriodicSides<2>>& pairs : chains_of(sides)) {
      chains_.emplace_back(plc, pairs, tolerance_of(plc));
      out_.sides.insert(out_.sides.end(), pairs.begin(), pairs.end());
    }
  }

  PeriodicInput run(RefineOptions<2> options, std::uint32_t most_rounds) {
    options.progress = {};
    options.prepared = {};
    rebuild();
    if (options.keep_boundary || !options.refine) return finished(options.keep_boundary);
    for (;;) {
      const RefineResult<2> result = refine(out_.plc, options);
      ++out_.rounds;
      if (result.stop != StopCause::finished || !divide(result.mesh)) return finished(false);
      rebuild();
      if (out_.rounds < most_rounds) continue;
      keep(result.mesh);
      return finished(true);
    }
  }

 private:
  bool divide(const OutputMesh<2>& mesh) {
    bool any = false;
    for (SideChain& chain : chains_) any = chain.divide(mesh) || any;
    return any;
  }

  bool is_periodic(int marker) const {
    return std::ranges::any_of(chains_, [marker](const SideChain& chain) { return chain.has(marker); });
  }

  /// The given input with the pieces of its periodic sides.
  void rebuild() {
    Plc<2> plc = given_;
    std::erase_if(plc.segments, [&](const auto& s) { return is_periodic(s.marker); });
    for (const SideChain& chain : chains_) chain.add_to(plc);
    plc.source.segment_lines.clear();
    if (!plc.source.point_lines.empty()) plc.source.point_lines.resize(plc.points.size(), 0);
    out_.plc = std::move(plc);
  }

  /// The other segments as a mesh has divided them.
  void keep(const OutputMesh<2>& mesh) {
    Plc<2>& plc = out_.plc;
    std::erase_if(plc.segments, [&](const auto& s) { return !is_periodic(s.marker); });
    std::map<std::array<double, 2>, std::uint32_t> number;
    for (std::uint32_t v = 0; v < plc.points.size(); ++v) number.try_emplace(plc.points[v].x, v);
    const std::size_t columns = mesh.points.empty() ? 0 : mesh.point_attributes.size() / mesh.points.size();
    const auto point = [&](std::uint32_t v) {
      const auto [at, is_new] = number.try_emplace(mesh.points[v].x, static_cast<std::uint32_t>(plc.points.size()));
      if (is_new) {
        plc.points.push_back(mesh.points[v]);
        if (!plc.point_markers.empty()) plc.point_markers.push_back(mesh.point_markers[v]);
        const auto row = mesh.point_attributes.begin() + static_cast<std::ptrdiff_t>(v * columns);
        plc.point_attributes.insert(plc.point_attributes.end(), row, row + static_cast<std::ptrdiff_t>(columns));
      }
      return at->second;
    };
    for (const auto& s : mesh.subsegments)
      if (!is_periodic(s.marker)) plc.segments.push_back({{point(s.vertices[0]), point(s.vertices[1])}, s.marker});
    if (!plc.source.point_lines.empty()) plc.source.point_lines.resize(plc.points.size(), 0);
  }

  PeriodicInput finished(bool keep_boundary) {
    out_.keep_boundary = keep_boundary;
    out_.added_points = out_.plc.points.size() - given_.points.size();
    return std::move(out_);
  }

  const Plc<2>& given_;
  std::vector<SideChain> chains_;
  PeriodicInput out_;
};

}  // namespace

PeriodicInput make_periodic(const Plc<2>& plc, std::span<const PeriodicSides<2>> sides, const RefineOptions<2>& options,
                            std::uint32_t most_rounds) {
  if (!detail::is_usable(plc)) Domain<2>{plc};  // which throws what is wrong
  return PeriodicMaker(plc, sides).run(options, most_rounds);
}

}  // namespace pgdr
