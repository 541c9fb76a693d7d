// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "given/given_input.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "given/given_facet.hpp"
#include "numbers/rounding.hpp"
#include "space/box.hpp"

namespace pgdr::checking {
namespace {

template <int D>
double largest_coordinate(const Plc<D>& plc) {
  double largest = 0;
  for (const Point<D>& p : plc.points)
    for (const double x : p.x) largest = std::max(largest, std::abs(x));
  return largest;
}

}  // namespace

template <int D>
double default_tolerance(const Plc<D>& plc) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const double largest = largest_coordinate(plc);
  const double of_doubles = 8 * (std::nextafter(largest, infinity) - largest);
  if (!plc.are_floats || !(largest <= std::numeric_limits<float>::max())) return of_doubles;
  const auto as_float = static_cast<float>(largest);
  const double of_floats = 2 * (double{std::nextafter(as_float, std::numeric_limits<float>::infinity())} - double{as_float});
  const auto box = detail::Box<D>::of(plc.points);
  return of_floats <= 1e-6 * std::sqrt(squared_distance(box.low, box.high)) ? of_floats : of_doubles;
}

template <int D>
GivenInput<D>::GivenInput(const Plc<D>& plc, std::optional<double> tolerance, Findings& findings) : plc_(&plc) {
  require_usable();
  places_ = number_places(plc);
  tolerance_ = tolerance ? *tolerance : default_tolerance(plc);
  rounding_ = 2 * rounding::ulp * largest_coordinate(plc);
  for (std::uint32_t s = 0; s < plc.segments.size(); ++s) add_segment({plc.segments[s].points, plc.segments[s].marker, s, false});
  add_facets(findings);
}

template <int D>
void GivenInput<D>::require_usable() const {
  for (std::size_t p = 0; p < plc_->points.size(); ++p)
    for (const double x : plc_->points[p].x)
      if (!std::isfinite(x))
        throw InputError({Errc::not_finite, "point " + std::to_string(p + plc_->first_index) + " is not finite", {}, 0, {}, {}});
  const auto require = [&](std::uint32_t p) {
    if (p < plc_->points.size()) return;
    throw InputError({Errc::index_out_of_range, "there is no point " + std::to_string(p + plc_->first_index), {}, 0, {}, {}});
  };
  for (const auto& s : plc_->segments)
    for (const std::uint32_t p : s.points) require(p);
  for (const auto& f : plc_->facets)
    for (const auto& polygon : f.polygons)
      for (const std::uint32_t p : polygon) require(p);
}

template <int D>
void GivenInput<D>::add_segment(const GivenSegment& segment) {
  if (!(point(segment.points[0]) == point(segment.points[1]))) segments_.push_back(segment);
}

template <int D>
void GivenInput<D>::add_facets(Findings& findings) {
  bends_.assign(plc_->facets.size(), 0);
  if constexpr (D == 3) {
    const ExplicitEdges explicit_edges(*plc_, places_);
    for (std::uint32_t f = 0; f < plc_->facets.size(); ++f) {
      const auto& facet = plc_->facets[f];
      if (facet.polygons.size() == 1 && facet.polygons[0].size() == 2) {
        add_segment({{facet.polygons[0][0], facet.polygons[0][1]}, facet.marker, f, true});
        continue;
      }
      const FacetTriangulation parts = triangulate_given(*plc_, explicit_edges, f, reach());
      bends_[f] = parts.bend;
      for (const auto& t : parts.triangles) triangles_.push_back({t, f});
      for (const auto& e : parts.inner_edges) add_segment({e, 0, f, true});
      if (parts.failed)
        findings.add(Kind::facet_not_conforming, {f}, [&] {
          return "The polygons of facet " + std::to_string(f) + " cross, so that nothing can be compared with it.";
        });
    }
  }
}

template class GivenInput<2>;
template class GivenInput<3>;
template double default_tolerance(const Plc<2>&);
template double default_tolerance(const Plc<3>&);

}  // namespace pgdr::checking
