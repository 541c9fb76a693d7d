// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Periodic sides in 3D.
#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include "pgdr/domain.hpp"
#include "pgdr/error.hpp"
#include "pgdr/make_periodic.hpp"
#include "pgdr/refine.hpp"
#include "run/periodic_plc.hpp"
#include "run/side_surface.hpp"

namespace pgdr {
namespace {

using detail::SideInput;
using detail::SideSizes;
using detail::SideSurface;
using SurfaceChain = detail::SideChain<3>;

/// Are facets of any of these markers to stay as they are given?
bool keeps_any(const RefineOptions<3>& options, const detail::SideMarkers& markers) {
  return options.keep_boundary && (options.kept_markers.empty() || std::ranges::any_of(options.kept_markers, [&](int marker) {
                                     return markers.contains(marker);
                                   }));
}

class SurfaceMaker {
 public:
  SurfaceMaker(const Plc<3>& plc, std::span<const PeriodicSides<3>> sides, const RefineOptions<3>& options)
      : given_(plc),
        markers_(detail::markers_of(sides)),
        options_(options),
        domain_(plc, options.stop),
        input_(detail::side_input(domain_, markers_)),
        points_(domain_.points(), input_.reach) {
    options_.progress = {};
    options_.prepared = {};
    for (const Point3& p : domain_.points()) points_.add(p);
    out_.sides = detail::make_chains(input_, points_, sides, chains_);
    for (SurfaceChain& chain : chains_) chain.find_pieces();
  }

  PeriodicInput<3> run(std::uint32_t most_rounds) {
    out_.keep_boundary = true;
    out_.kept_markers = options_.kept_markers;
    if (keeps_any(options_, markers_)) {
      out_.plc = given_;
      return std::move(out_);
    }
    out_.kept_markers.insert(out_.kept_markers.end(), markers_.begin(), markers_.end());
    std::vector<SideSurface> surfaces;
    for (SurfaceChain& chain : chains_) surfaces.emplace_back(domain_, chain, input_);
    mesh_surfaces(surfaces, most_rounds);
    detail::PeriodicPlc made(given_, domain_, input_, points_);
    for (std::size_t c = 0; c < chains_.size(); ++c) {
      const auto triangles = surfaces[c].take_triangles();
      made.add(chains_[c], triangles);
    }
    made.finish(out_);
    return std::move(out_);
  }

 private:
  void mesh_surfaces(std::vector<SideSurface>& surfaces, std::uint32_t most_rounds) {
    const OutputMesh<3> as_it_likes = options_.refine ? mesh_without_pairs() : OutputMesh<3>();
    std::vector<SideSizes> sizes;
    for (const SurfaceChain& chain : chains_) sizes.emplace_back(as_it_likes, chain, options_.size);
    RefineOptions<2> options;
    options.radius_edge_bound = smallest_proved_bound<2>();
    options.refine = options_.refine;
    options.schedule.threads = options_.schedule.threads;
    options.schedule.executor = options_.schedule.executor;
    options.stop = options_.stop;
    for (bool any = true; any;) {
      const bool keep = out_.rounds >= most_rounds;
      detail::PieceCuts cuts;
      for (std::size_t c = 0; c < surfaces.size(); ++c) cuts.push_back(surfaces[c].mesh(options, sizes[c], keep));
      if (options_.stop.stop_requested()) throw CancelledError({Errc::cancelled, "cancelled by the caller", {}, 0, {}, {}});
      ++out_.rounds;
      any = detail::cut_pieces<3>(chains_, cuts) && !keep;
    }
  }

  /// Which says how large triangles have to be, on either side. The optimiser changes little of that.
  OutputMesh<3> mesh_without_pairs() const {
    RefineOptions<3> options = options_;
    options.min_dihedral = 0;
    if (options.time_limit) *options.time_limit /= 3;  // most is for the mesh that is wanted
    return refine(given_, options).mesh;
  }

  const Plc<3>& given_;
  const detail::SideMarkers markers_;
  RefineOptions<3> options_;
  const Domain<3> domain_;
  const SideInput<3> input_;
  detail::NearPoints<3> points_;
  std::vector<SurfaceChain> chains_;
  PeriodicInput<3> out_;
};

using InnerEdge = std::array<std::uint32_t, 2>;

/// Edges by the coordinates of their ends.
class InnerEdges {
 public:
  explicit InnerEdges(const PeriodicInput<3>& made) : made_(made) {
    for (const InnerEdge& e : made.inner_edges)
      for (const std::uint32_t v : e) number_.try_emplace(made.plc.points[v].x, v);
  }

  std::optional<InnerEdge> find(const Point3& a, const Point3& b) const {
    const auto v = number_.find(a.x), w = number_.find(b.x);
    if (v == number_.end() || w == number_.end()) return std::nullopt;
    const InnerEdge e{std::min(v->second, w->second), std::max(v->second, w->second)};
    if (!std::ranges::binary_search(made_.inner_edges, e)) return std::nullopt;
    return e;
  }

  /// The given facet that it is inside of.
  std::uint32_t facet_of(const InnerEdge& e) {
    if (facets_.empty())
      for (std::uint32_t f = 0; f < made_.plc.facets.size(); ++f) {
        const auto& polygon = made_.plc.facets[f].polygons[0];
        for (std::size_t i = 0; polygon.size() == 3 && i < 3; ++i) {
          const std::uint32_t v = polygon[i], w = polygon[(i + 1) % 3];
          facets_.try_emplace(InnerEdge{std::min(v, w), std::max(v, w)}, made_.given_facets[f]);
        }
      }
    return facets_.at(e);
  }

 private:
  const PeriodicInput<3>& made_;
  std::map<std::array<double, 3>, std::uint32_t> number_;
  std::map<InnerEdge, std::uint32_t> facets_;
};

}  // namespace

PeriodicInput<3> make_periodic(const Plc<3>& plc, std::span<const PeriodicSides<3>> sides, const RefineOptions<3>& options,
                               std::uint32_t most_rounds) {
  return SurfaceMaker(plc, sides, options).run(most_rounds);
}

void name_as_given(const PeriodicInput<3>& made, OutputMesh<3>& mesh, std::vector<PoorReason>& reasons) {
  if (made.given_facets.empty()) return;
  InnerEdges edges(made);
  std::erase_if(mesh.subsegments,
                [&](const auto& s) { return edges.find(mesh.points[s.vertices[0]], mesh.points[s.vertices[1]]).has_value(); });
  for (PoorReason& reason : reasons)
    for (GivenEntity& e : reason.entities) {
      if (e.kind == EntityKind::facet && e.facet < made.given_facets.size()) e.facet = made.given_facets[e.facet];
      if (e.kind != EntityKind::segment) continue;
      const auto inner = edges.find(Point3{e.ends[0]}, Point3{e.ends[1]});
      if (!inner) continue;
      // Nothing was given there but the facet: what a kept edge does, alone or with another thing, is for the facet that is kept.
      reason.code = PoorReason::Code::kept_boundary;
      reason.angle = 0;
      reason.entities = {GivenEntity{EntityKind::facet, edges.facet_of(*inner), {}}, GivenEntity{}};
      break;
    }
}

}  // namespace pgdr
