// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "compact/point_data.hpp"

#include <algorithm>
#include <atomic>
#include <limits>
#include <utility>

#include "input/entities.hpp"
#include "numbers/rounding.hpp"
#include "output/interpolation.hpp"
#include "space/box_tree.hpp"
#include "space/bulk.hpp"

namespace pgdr {
namespace {

constexpr std::uint32_t none = 0xffffffffu;

/// What each vertex of a mesh is numbered, by index(VertexId); `none` if it is not.
using Numbers = std::span<const std::uint32_t>;

/// The numbered vertices of a mesh.
template <int D>
class VerticesOfMesh {
 public:
  VerticesOfMesh(const Mesh<D>& mesh, Numbers numbers) : mesh_(&mesh), numbers_(numbers) {}
  std::size_t size() const { return numbers_.size(); }
  std::uint32_t number(std::size_t i) const { return numbers_[i]; }  ///< `none`: there is no such vertex
  const VertexRecord<D>& operator[](std::size_t i) const { return mesh_->vertex(VertexId{static_cast<std::uint32_t>(i)}); }

 private:
  const Mesh<D>* mesh_;
  Numbers numbers_;
};

/// Vertices in the order of their numbers.
template <int D>
class ListedVertices {
 public:
  explicit ListedVertices(std::span<const VertexRecord<D>> vertices) : vertices_(vertices) {}
  std::size_t size() const { return vertices_.size(); }
  std::uint32_t number(std::size_t i) const { return static_cast<std::uint32_t>(i); }
  const VertexRecord<D>& operator[](std::size_t i) const { return vertices_[i]; }

 private:
  std::span<const VertexRecord<D>> vertices_;
};

/// Calls f(number, record) for each numbered vertex that is no input point.
template <class Vertices, class F>
void each_steiner_point(const Vertices& vertices, const detail::Bulk& bulk, const F& f) {
  bulk.each(vertices.size(), [&](std::size_t i) {
    if (vertices.number(i) != none && vertices[i].home.kind() != EntityKind::vertex) f(vertices.number(i), vertices[i]);
  });
}

/// Rows of attributes of points, by their number.
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
      : points_(domain.points()), triangles_(domain.triangles(facet)), tree_(boxes(), detail::TreeCut::at_medians) {}

  detail::WeightedCorners<3> at(const Point3& x) const {
    double nearest = std::numeric_limits<double>::infinity();
    std::uint32_t best = none;
    detail::WeightedCorners<3> place{triangles_[0], {1, 0, 0}};
    tree_.nearest([&](const Box& box, std::uint32_t) { return box.squared_distance_to(x) * (1 - rounding::of_pruning); },
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
  using Box = detail::Box<3>;
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
  detail::BoxTree<3> tree_;
};

/// Attributes of the Steiner points on facets, facet by facet.
template <class Vertices>
void fill_on_facets(const Vertices& vertices, const Domain<3>& domain, const detail::Bulk& bulk, const Rows& rows) {
  struct OnFacet {
    EntityId facet;
    std::uint32_t number;
    Point3 point;
  };
  auto list = bulk.gather<OnFacet>(vertices.size(), [&](std::size_t i, std::vector<OnFacet>& found) {
    if (vertices.number(i) == none) return;
    const VertexRecord<3>& v = vertices[i];
    if (v.home.kind() == EntityKind::facet) found.push_back({v.home.id(), vertices.number(i), v.point});
  });
  bulk.sort(list, [](const OnFacet& a, const OnFacet& b) { return a.facet < b.facet; });
  // The facets of few points side by side, then those of many, each with its points side by side.
  constexpr std::size_t many = 4096, facets_a_part = 64;
  const auto begin = bulk.gather<std::size_t>(list.size(), [&](std::size_t i, std::vector<std::size_t>& found) {
    if (i == 0 || list[i].facet != list[i - 1].facet) found.push_back(i);
  });
  const auto end_of = [&](std::size_t k) { return k + 1 < begin.size() ? begin[k + 1] : list.size(); };
  const auto is_small = [&](std::size_t k) { return end_of(k) - begin[k] < many; };
  const auto set = [&](const FacetInterpolation& facet, std::size_t i) {
    rows.set(list[i].number, facet.at(list[i].point), domain.point_attributes());
  };
  bulk.parts((begin.size() + facets_a_part - 1) / facets_a_part, [&](std::size_t part) {
    for (std::size_t k = part * facets_a_part; k < std::min(begin.size(), (part + 1) * facets_a_part); ++k) {
      if (!is_small(k)) continue;
      const FacetInterpolation facet(domain, list[begin[k]].facet);
      for (std::size_t i = begin[k]; i < end_of(k); ++i) set(facet, i);
    }
  });
  for (std::size_t k = 0; k < begin.size() && !bulk.stopped(); ++k) {
    if (is_small(k)) continue;
    const FacetInterpolation facet(domain, list[begin[k]].facet);
    bulk.each(end_of(k) - begin[k], [&](std::size_t i) { set(facet, begin[k] + i); });
  }
}

/// Sets the attributes of all numbered points but those of the input. `unrefined`: what those inside are interpolated on.
template <int D, class Vertices>
void fill_attributes(const Vertices& vertices, const Domain<D>& domain, const detail::Bulk& bulk,
                     const detail::MeshInterpolation<D>* unrefined, std::span<const double> of_unrefined, const Rows& rows) {
  each_steiner_point(vertices, bulk, [&](std::uint32_t number, const VertexRecord<D>& v) {
    if (v.home.kind() == EntityKind::segment) {
      const double t = segment_parameter<D>(domain, v.home.id(), v.point);
      const detail::WeightedCorners<2> place{domain.segments()[v.home.id()].points, {1 - t, t}};
      rows.set(number, place, domain.point_attributes());
    } else if (v.home.kind() == EntityKind::volume && unrefined) {
      rows.set(number, unrefined->at(v.point), of_unrefined);
    }
  });
  if constexpr (D == 3) fill_on_facets(vertices, domain, bulk, rows);
}

/// The marker of a segment or facet; in 3D, of a segment without one, that of the first of its facets that has one.
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
PointData<D>::PointData(const Mesh<D>& unrefined, const Domain<D>& domain, const detail::Pieces& pieces) : domain_(&domain) {
  const std::size_t columns = domain.attributes_per_point();
  if (columns == 0) return;
  const detail::Bulk bulk(pieces);
  std::vector<std::uint32_t> numbers(unrefined.vertex_bound(), none);
  std::vector<Point<D>> points(numbers.size());
  attributes_.resize(numbers.size() * columns);
  using Cell = std::array<std::uint32_t, D + 1>;
  const auto is_before = [&](std::uint32_t v, std::uint32_t w) {
    return lex_less(unrefined.point(VertexId{v}), unrefined.point(VertexId{w}));
  };
  std::vector<Cell> cells = bulk.gather<Cell>(unrefined.cell_bound(), [&](std::size_t i, std::vector<Cell>& out) {
    const CellId c{static_cast<std::uint32_t>(i)};
    if (!unrefined.alive(c)) return;
    Cell cell;
    for (int k = 0; k <= D; ++k) {
      cell[k] = index(unrefined.cell(c).vertices[k]);
      std::atomic_ref<std::uint32_t>(numbers[cell[k]]).store(cell[k], std::memory_order_relaxed);  // as other cells at it do
    }
    std::sort(cell.begin(), cell.end(), is_before);
    out.push_back(cell);
  });
  bulk.each(numbers.size(), [&](std::size_t i) {
    if (numbers[i] == none) return;
    const VertexRecord<D>& v = unrefined.vertex(VertexId{numbers[i]});
    points[i] = v.point;
    if (v.home.kind() == EntityKind::vertex)
      std::copy_n(domain.point_attributes().begin() + v.home.id() * columns, columns, attributes_.begin() + i * columns);
  });
  // The cell with the smallest number counts where several hold a point: numbers that are no matter of chance.
  bulk.sort(cells, [&](const Cell& a, const Cell& b) {
    return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end(), is_before);
  });
  const Rows rows(attributes_, columns);
  fill_attributes<D>(VerticesOfMesh<D>(unrefined, numbers), domain, bulk, nullptr, {}, rows);
  unrefined_ = std::make_unique<detail::MeshInterpolation<D>>(std::move(points), cells);
}

template <int D>
PointData<D>::PointData(PointData&&) noexcept = default;
template <int D>
PointData<D>::~PointData() = default;

/// Has a segment or facet a marker?
template <int D>
bool has_markers(const Domain<D>& domain) {
  const auto is_marked = [](const auto& entity) { return entity.marker != 0; };
  return std::any_of(domain.segments().begin(), domain.segments().end(), is_marked) ||
         std::any_of(domain.facets().begin(), domain.facets().end(), is_marked);
}

/// 2D: gives input points without a marker that of the first segment in the order of the input that has one.
template <int D>
void mark_input_points(const Domain<D>& domain, std::vector<int>& markers) {
  if constexpr (D == 2) {
    std::vector<std::uint32_t> first(markers.size(), no_entity);  // of points without a marker
    for (const DomainSegment& s : domain.segments())
      for (const std::uint32_t v : s.points) {
        if (s.marker == 0 || s.input >= first[v] || (markers[v] != 0 && first[v] == no_entity)) continue;
        first[v] = s.input;
        markers[v] = s.marker;
      }
  }
}

template <int D>
void PointData<D>::fill_markers(const Mesh<D>& refined, const detail::Bulk& bulk, Compacted<D>& out) const {
  auto& markers = out.mesh.point_markers;
  const auto input = domain_->point_markers();
  markers = detail::vector_of_capacity<int>(out.mesh.points.size());
  markers.assign(input.begin(), input.end());
  markers.resize(out.mesh.points.size(), 0);
  if (!has_markers(*domain_)) return;
  each_steiner_point(VerticesOfMesh<D>(refined, out.vertex_number), bulk,
                     [&](std::uint32_t number, const VertexRecord<D>& v) { markers[number] = marker_of<D>(*domain_, v.home); });
  mark_input_points(*domain_, markers);
}

template <int D>
void PointData<D>::fill(const Mesh<D>& refined, Compacted<D>& out, const detail::Pieces& pieces, std::stop_token stop) const {
  const detail::Bulk bulk(pieces, std::move(stop));
  fill_markers(refined, bulk, out);
  if (!unrefined_) return;
  const std::size_t columns = domain_->attributes_per_point();
  auto& values = out.mesh.point_attributes;
  values = detail::vector_of_capacity<double>(out.mesh.points.size() * columns);
  values.assign(domain_->point_attributes().begin(), domain_->point_attributes().end());
  values.resize(out.mesh.points.size() * columns);
  fill_attributes<D>(VerticesOfMesh<D>(refined, out.vertex_number), *domain_, bulk, unrefined_.get(), attributes_,
                     Rows(values, columns));
}

template <int D>
void PointData<D>::fill_rows(std::span<const VertexRecord<D>> vertices, OutputMesh<D>& out, const detail::Pieces& pieces) const {
  const detail::Bulk bulk(pieces);
  const ListedVertices<D> list(vertices);
  std::vector<int> of_input(domain_->point_markers().begin(), domain_->point_markers().end());
  of_input.resize(domain_->points().size(), 0);
  mark_input_points(*domain_, of_input);
  out.point_markers.assign(vertices.size(), 0);
  const std::size_t columns = unrefined_ ? domain_->attributes_per_point() : 0;
  out.point_attributes.assign(vertices.size() * columns, 0);
  bulk.each(vertices.size(), [&](std::size_t i) {
    const Home home = vertices[i].home;
    const bool is_input = home.kind() == EntityKind::vertex;
    out.point_markers[i] = is_input ? of_input[home.id()] : marker_of<D>(*domain_, home);
    if (is_input)
      std::copy_n(domain_->point_attributes().begin() + static_cast<std::ptrdiff_t>(home.id() * columns), columns,
                  out.point_attributes.begin() + static_cast<std::ptrdiff_t>(i * columns));
  });
  if (columns > 0) fill_attributes<D>(list, *domain_, bulk, unrefined_.get(), attributes_, Rows(out.point_attributes, columns));
}

template class PointData<2>;
template class PointData<3>;

}  // namespace pgdr
