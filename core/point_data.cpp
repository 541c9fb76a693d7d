// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "pgdr/point_data.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "detail/bulk.hpp"
#include "detail/interpolation.hpp"

namespace pgdr {
namespace {

constexpr std::uint32_t none = 0xffffffffu;

/// Calls f(number, record) for each Steiner point of the finished mesh.
template <int D, class F>
void each_steiner_point(const Mesh<D>& mesh, const Compacted<D>& out, const detail::Bulk& bulk, const F& f) {
  bulk.each(out.vertex_number.size(), [&](std::size_t i) {
    const std::uint32_t number = out.vertex_number[i];
    if (number != none && number >= out.mesh.input_points) f(number, mesh.vertex(VertexId{static_cast<std::uint32_t>(i)}));
  });
}

/// Rows of attributes of points: those of the domain's are there from the start.
class Rows {
 public:
  Rows(std::vector<double>& values, std::size_t columns) : values_(&values), columns_(columns) {}

  template <std::size_t N>
  void set(std::size_t row, const detail::WeightedCorners<N>& place, std::span<const double> from) const {
    for (std::size_t k = 0; k < columns_; ++k)
      (*values_)[row * columns_ + k] = place.mean([&](std::uint32_t v) { return from[v * columns_ + k]; });
  }

 private:
  std::vector<double>* values_;
  std::size_t columns_;
};

/// The triangles that define a facet, by what is next to them.
class FacetInterpolation {
 public:
  FacetInterpolation(const Domain<3>& domain, EntityId facet)
      : points_(domain.points()), triangles_(domain.triangles(facet)), tree_(boxes()) {}

  detail::WeightedCorners<3> at(const Point3& x) const {
    double nearest = std::numeric_limits<double>::infinity();
    std::uint32_t best = none;
    detail::WeightedCorners<3> place{triangles_[0], {1, 0, 0}};
    tree_.search([&](const Box& box) { return box.squared_distance_to(x) * (1 - 0x1p-40); },
                 [&](std::uint32_t t) {
                   const auto& v = triangles_[t];
                   const auto weight = detail::nearest_weights({points_[v[0]], points_[v[1]], points_[v[2]]}, x);
                   Point3 p{};
                   for (std::size_t i = 0; i < 3; ++i)
                     for (int k = 0; k < 3; ++k) p[k] += weight[i] * points_[v[i]][k];
                   const double d = squared_distance(p, x);
                   if (d < nearest || (d == nearest && t < best)) {
                     nearest = d;
                     best = t;
                     place = {v, weight};
                   }
                   return nearest;
                 });
    return place;
  }

 private:
  using Box = detail::SearchBox<3>;
  std::vector<Box> boxes() const {
    std::vector<Box> all;
    for (const auto& t : triangles_) {
      Box box = Box::empty();
      for (const std::uint32_t v : t) box.add(points_[v]);
      all.push_back(box);
    }
    return all;
  }

  std::span<const Point3> points_;
  std::span<const std::array<std::uint32_t, 3>> triangles_;
  detail::SearchTree<3> tree_;
};

/// Attributes of the Steiner points on facets, facet by facet.
void fill_on_facets(const Mesh<3>& mesh, const Domain<3>& domain, const Compacted<3>& out, const detail::Bulk& bulk,
                    const Rows& rows) {
  struct OnFacet {
    EntityId facet;
    std::uint32_t number;
  };
  auto list = bulk.gather<OnFacet>(out.vertex_number.size(), [&](std::size_t i, std::vector<OnFacet>& found) {
    if (out.vertex_number[i] == none || out.vertex_number[i] < out.mesh.input_points) return;
    const Home home = mesh.vertex(VertexId{static_cast<std::uint32_t>(i)}).home;
    if (home.kind() == EntityKind::facet) found.push_back({home.id(), out.vertex_number[i]});
  });
  bulk.sort(list, [](const OnFacet& a, const OnFacet& b) { return a.facet < b.facet; });
  for (std::size_t i = 0, j; i < list.size() && !bulk.stopped(); i = j) {
    for (j = i; j < list.size() && list[j].facet == list[i].facet;) ++j;
    const FacetInterpolation facet(domain, list[i].facet);
    bulk.each(j - i, [&](std::size_t k) {
      const std::uint32_t number = list[i + k].number;
      rows.set(number, facet.at(out.mesh.points[number]), domain.point_attributes());
    });
  }
}

/// The attributes of all points of a mesh in compact form. `unrefined`: what those inside are interpolated on.
template <int D>
std::vector<double> attributes_of(const Mesh<D>& mesh, const Domain<D>& domain, const Compacted<D>& out,
                                  const detail::Bulk& bulk, const detail::MeshInterpolation<D>* unrefined,
                                  std::span<const double> of_unrefined) {
  const auto input = domain.point_attributes();
  const std::size_t columns = domain.attributes_per_point();
  std::vector<double> values(input.begin(), input.end());
  values.resize(out.mesh.points.size() * columns);
  const Rows rows(values, columns);
  each_steiner_point<D>(mesh, out, bulk, [&](std::uint32_t number, const VertexRecord<D>& v) {
    if (v.home.kind() == EntityKind::segment) {
      const double t = segment_parameter<D>(domain, v.home.id(), v.point);
      rows.set(number, detail::WeightedCorners<2>{domain.segments()[v.home.id()].points, {1 - t, t}}, input);
    } else if (v.home.kind() == EntityKind::volume && unrefined) {
      rows.set(number, unrefined->at(v.point), of_unrefined);
    }
  });
  if constexpr (D == 3) fill_on_facets(mesh, domain, out, bulk, rows);
  return values;
}

/// Of a segment, or, in 3D where it has none, of the first of its facets that has one.
template <int D>
int marker_of(const Domain<D>& domain, Home home) {
  if (D == 3 && home.kind() == EntityKind::facet) return domain.facets()[home.id()].marker;
  if (home.kind() != EntityKind::segment) return 0;
  int marker = domain.segments()[home.id()].marker;
  if constexpr (D == 3)
    for (const EntityId f : domain.facets_of_segment(home.id()))
      if (marker == 0) marker = domain.facets()[f].marker;
  return marker;
}

}  // namespace

template <int D>
PointData<D>::PointData(const Mesh<D>& unrefined, const Domain<D>& domain) : domain_(&domain) {
  if (domain.attributes_per_point() == 0) return;
  const Compacted<D> compacted = compact<D>(unrefined, domain, {}, false);
  attributes_ = attributes_of<D>(unrefined, domain, compacted, detail::Bulk(false), nullptr, {});
  unrefined_ = std::make_unique<detail::MeshInterpolation<D>>(compacted.mesh.points, compacted.mesh.cells);
}

template <int D>
PointData<D>::PointData(PointData&&) noexcept = default;
template <int D>
PointData<D>::~PointData() = default;

template <int D>
void PointData<D>::fill_markers(const Mesh<D>& refined, const detail::Bulk& bulk, Compacted<D>& out) const {
  auto& markers = out.mesh.point_markers;
  const auto input = domain_->point_markers();
  markers.assign(input.begin(), input.end());
  markers.resize(out.mesh.points.size(), 0);
  const auto is_marked = [](const auto& entity) { return entity.marker != 0; };
  if (std::none_of(domain_->segments().begin(), domain_->segments().end(), is_marked) &&
      std::none_of(domain_->facets().begin(), domain_->facets().end(), is_marked))
    return;
  each_steiner_point<D>(refined, out, bulk, [&](std::uint32_t number, const VertexRecord<D>& v) {
    markers[number] = marker_of<D>(*domain_, v.home);
  });
  if constexpr (D == 2)
    for (const DomainSegment& s : domain_->segments())
      for (const std::uint32_t v : s.points)
        if (markers[v] == 0) markers[v] = s.marker;
}

template <int D>
void PointData<D>::fill(const Mesh<D>& refined, Compacted<D>& out, bool parallel, std::stop_token stop) const {
  const detail::Bulk bulk(parallel, std::move(stop));
  fill_markers(refined, bulk, out);
  if (unrefined_)
    out.mesh.point_attributes = attributes_of<D>(refined, *domain_, out, bulk, unrefined_.get(), attributes_);
}

template class PointData<2>;
template class PointData<3>;

}  // namespace pgdr
