// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "pgdr/cell_bounds.hpp"

#include <algorithm>
#include <string>

#include "pgdr/error.hpp"

namespace pgdr {
namespace {

template <int D>
double checked_size(const SizingField<D>& size, const Point<D>& x) {
  const double s = size.at(x);
  if (s > 0) return s;  // false for NaN too
  Diagnostic d{Errc::bad_size, {}, {}, 0, {}, {{x[0], x[1], D == 3 ? x[D - 1] : 0.0}}};
  d.message = "the size function returned " + std::to_string(s) + " at (" + std::to_string(x[0]) + ", " +
              std::to_string(x[1]) + (D == 3 ? ", " + std::to_string(x[D - 1]) : "") + "); sizes must be positive";
  throw UsageError(std::move(d));
}

}  // namespace

// The cached squared radius is off by at most the half width of the filter's band (mesh.cpp: 6 |d| / r bounds the
// relative error 2 |d| / r of r^2, and 2^-46 the roundings here), so outside the band around the bound it decides.
template <int D>
CellVerdict CellBounds<D>::test(const Mesh<D>& mesh, CellId c) const {
  const Simplex<D> s = mesh.simplex(c);
  CellVerdict verdict;
  const auto [low, high] = mesh.squared_radius_bounds(c);
  const double limit = radius_edge_bound * radius_edge_bound * shortest_edge_squared<D>(s);
  if (low > limit) {
    verdict.over_radius_edge = true;
  } else if (!(high < limit)) {
    verdict.over_radius_edge = !radius_edge_within<D>(s, radius_edge_bound);
  }
  verdict.over_size = over_size(mesh, c, s);
  return verdict;
}

template <int D>
bool CellBounds<D>::over_size(const Mesh<D>& mesh, CellId c, const Simplex<D>& s) const {
  if (size.bounded()) {
    const double bound = size.is_constant() ? size.at({}) : checked_size<D>(size, centroid<D>(s));
    if constexpr (D == 3) {
      const auto [low, high] = mesh.squared_radius_bounds(c);
      const double limit = bound * bound;
      if (low > limit) return true;
      if (!(high < limit) && !circumradius_within<D>(s, bound)) return true;
    } else {
      if (!measure_within<D>(s, bound)) return true;
    }
  }
  double measure = max_measure;
  if (!region_measure.empty()) measure = std::min(measure, region_measure[mesh.region(c)]);
  return measure != std::numeric_limits<double>::infinity() && !measure_within<D>(s, measure);
}

template class CellBounds<2>;
template class CellBounds<3>;

}  // namespace pgdr
