// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "pgdr/make_periodic.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "input/usable_plc.hpp"
#include "pgdr/domain.hpp"
#include "pgdr/refine.hpp"
#include "run/periodic_sides.hpp"
#include "space/point_places.hpp"

namespace pgdr {
namespace {

using detail::Cuts;
using detail::SideChain;
using detail::SideInput;
using PlanarChain = SideChain<2>;

class PeriodicMaker {
 public:
  PeriodicMaker(const Plc<2>& plc, std::span<const PeriodicSides<2>> sides)
      : given_(plc), input_(detail::side_input(plc, detail::markers_of(sides))), points_(plc.points, input_.reach) {
    for (const Point2& p : plc.points) points_.add(p);
    out_.sides = detail::make_chains(input_, points_, sides, chains_);
    for (PlanarChain& chain : chains_) chain.find_pieces();
  }

  PeriodicInput<2> run(RefineOptions<2> options, std::uint32_t most_rounds) {
    options.progress = {};
    options.prepared = {};
    rebuild();
    if (options.keep_boundary || !options.refine) return finished(options.keep_boundary, options.kept_markers);
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
    detail::PieceCuts cuts;
    for (const PlanarChain& chain : chains_) cuts.push_back(cuts_of_pieces(chain, mesh));
    return detail::cut_pieces<2>(chains_, cuts);
  }

  /// Vertices of the mesh on pieces, side by side.
  std::vector<std::vector<Cuts>> cuts_of_pieces(const PlanarChain& chain, const OutputMesh<2>& mesh) const {
    std::vector<std::vector<Cuts>> cuts(chain.pieces().size());
    for (const auto& side : chain.sides()) {
      std::vector<detail::Box<2>> boxes;
      for (const auto& [a, b] : chain.pieces())
        boxes.push_back(detail::box_of_edge<2>(chain.point(side, a), chain.point(side, b), input_.reach));
      const detail::BoxTree<2> tree(boxes);
      std::map<std::uint32_t, std::set<double>> cut;  // by piece
      for (const auto& s : mesh.subsegments) {
        if (s.marker != side.marker) continue;
        const Point2 &p = mesh.points[s.vertices[0]], &q = mesh.points[s.vertices[1]];
        tree.meeting(detail::box_of_edge<2>(p, q, 0), [&](std::uint32_t k) {
          const Point2 &a = chain.point(side, chain.pieces()[k][0]), &b = chain.point(side, chain.pieces()[k][1]);
          const auto t = detail::part_near<2>(p, a, b, input_.reach), u = detail::part_near<2>(q, a, b, input_.reach);
          if (!t || !u || *t == *u) return;
          if (*t > 0 && *t < 1) cut[k].insert(detail::place_of_cut<2>(p, a, b));
          if (*u > 0 && *u < 1) cut[k].insert(detail::place_of_cut<2>(q, a, b));
        });
      }
      for (const auto& [k, places] : cut) cuts[k].emplace_back(places.begin(), places.end());
    }
    return cuts;
  }

  bool is_periodic(int marker) const {
    return std::ranges::any_of(chains_, [marker](const PlanarChain& chain) { return chain.has(marker); });
  }

  /// The given input with the pieces of its periodic sides.
  void rebuild() {
    Plc<2> plc = given_;
    std::erase_if(plc.segments, [&](const auto& s) { return is_periodic(s.marker); });
    for (const PlanarChain& chain : chains_) add_sides(chain, plc);
    plc.source.segment_lines.clear();
    if (!plc.source.point_lines.empty()) plc.source.point_lines.resize(plc.points.size(), 0);
    out_.plc = std::move(plc);
  }

  /// Appends points that are not of the given input, and the pieces as segments.
  void add_sides(const PlanarChain& chain, Plc<2>& plc) const {
    const std::size_t given = given_.points.size(), columns = given == 0 ? 0 : given_.point_attributes.size() / given;
    for (const std::uint32_t s : chain.order()) {
      const PlanarChain::Side& side = chain.sides()[s];
      std::vector<std::uint32_t> number(side.at);
      for (std::uint32_t k = 0; k < number.size(); ++k) {
        if (number[k] < given) continue;
        number[k] = static_cast<std::uint32_t>(plc.points.size());
        plc.points.push_back(chain.point(side, k));
        if (!given_.point_markers.empty()) plc.point_markers.push_back(side.marker);
        const auto [a, b] = input_.walls[side.wall[k]].points;
        const double t = detail::part_near<2>(chain.point(side, k), given_.points[a], given_.points[b], input_.reach).value_or(0);
        for (std::size_t i = 0; i < columns; ++i)
          plc.point_attributes.push_back((1 - t) * given_.point_attributes[a * columns + i] +
                                         t * given_.point_attributes[b * columns + i]);
      }
      for (const auto& [a, b] : chain.pieces()) plc.segments.push_back({{number[a], number[b]}, side.marker});
    }
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

  PeriodicInput<2> finished(bool keep_boundary, std::vector<int> kept_markers = {}) {
    out_.keep_boundary = keep_boundary;
    out_.kept_markers = std::move(kept_markers);
    out_.added_points = out_.plc.points.size() - given_.points.size();
    return std::move(out_);
  }

  const Plc<2>& given_;
  const SideInput<2> input_;
  detail::NearPoints<2> points_;
  std::vector<PlanarChain> chains_;
  PeriodicInput<2> out_;
};

}  // namespace

PeriodicInput<2> make_periodic(const Plc<2>& plc, std::span<const PeriodicSides<2>> sides, const RefineOptions<2>& options,
                               std::uint32_t most_rounds) {
  if (!detail::is_usable(plc)) Domain<2>{plc};  // which throws what is wrong
  return PeriodicMaker(plc, sides).run(options, most_rounds);
}

}  // namespace pgdr
