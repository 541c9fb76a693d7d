// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Which faces of the hull of cells bound one void, or the outside: neighbours at a ridge are those between which there is no
// cell. Of two faces there that is clear; of more, cells stand about the ridge in several fans, each between two of the faces,
// and those on both sides of the gap between a fan and the next one are neighbours. The order of fans is that of angles about the
// ridge: gaps may be as thin as rounding, or less than that where cells overlap by it, but fans are not.
#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

#include "numbers/vectors.hpp"
#include "output/cell_surface.hpp"
#include "pgdr/predicates.hpp"
#include "space/disjoint_sets.hpp"

namespace pgdr::detail {
namespace {

/// A ridge of a face of the hull.
template <int D>
struct Ridge {
  std::array<std::uint32_t, D - 1> corners;  ///< ascending
  std::uint32_t face, apex;                  ///< the face, and its corner opposite
  bool operator<(const Ridge& o) const { return corners != o.corners ? corners < o.corners : face < o.face; }
};

/// Cells about a ridge that hang together, from their first face of the hull to their last one, the positive way round.
struct Fan {
  std::uint32_t first, last;  ///< faces of the hull
  double angle;               ///< of the first, from 0 to 4, growing with it
};

template <int D>
class HullParts {
 public:
  HullParts(const std::vector<Point<D>>& points, const std::vector<LabelledCell<D>>& cells, const CellLinks<D>& links,
            const std::vector<HullFace<D>>& hull)
      : points_(points), cells_(cells), links_(links), hull_(hull), parts_(hull.size()) {}

  std::vector<std::uint32_t> find() {
    const std::vector<Ridge<D>> ridges = sorted_ridges();
    for (std::size_t begin = 0, end; begin < ridges.size(); begin = end) {
      end = begin + 1;
      while (end < ridges.size() && ridges[end].corners == ridges[begin].corners) ++end;
      const std::span here(ridges.begin() + static_cast<std::ptrdiff_t>(begin), end - begin);
      if (here.size() == 2)
        parts_.unite(here[0].face, here[1].face);
      else
        unite_across_gaps(here);
    }
    std::vector<std::uint32_t> parts;
    for (std::uint32_t f = 0; f < hull_.size(); ++f) parts.push_back(parts_.find(f));
    return parts;
  }

 private:
  std::vector<Ridge<D>> sorted_ridges() const {
    std::vector<Ridge<D>> ridges;
    ridges.reserve(D * hull_.size());
    for (std::uint32_t f = 0; f < hull_.size(); ++f)
      for (std::size_t skip = 0; skip < D; ++skip) {
        Ridge<D> ridge{{}, f, hull_[f].corners[skip]};
        std::size_t k = 0;
        for (std::size_t i = 0; i < D; ++i)
          if (i != skip) ridge.corners[k++] = hull_[f].corners[i];
        std::sort(ridge.corners.begin(), ridge.corners.end());
        ridges.push_back(ridge);
      }
    std::sort(ridges.begin(), ridges.end());
    return ridges;
  }

  void unite_across_gaps(std::span<const Ridge<D>> ridges) {
    std::vector<Fan> fans;
    for (const Ridge<D>& ridge : ridges)
      if (const auto fan = fan_from(ridge, ridges)) fans.push_back(*fan);
    std::sort(fans.begin(), fans.end(),
              [](const Fan& a, const Fan& b) { return a.angle != b.angle ? a.angle < b.angle : a.first < b.first; });
    for (std::size_t i = 0; i < fans.size(); ++i) parts_.unite(fans[i].last, fans[(i + 1) % fans.size()].first);
  }

  /// The fan that begins at a face; none if one ends there, or it is none.
  std::optional<Fan> fan_from(const Ridge<D>& ridge, std::span<const Ridge<D>> ridges) const {
    std::uint32_t cell = hull_[ridge.face].cell, from = ridge.apex, to = next(ridge, cell, from);
    if (to == no_entity || side(ridge, from, to) != Sign::positive) return std::nullopt;
    for (std::size_t steps = 0; steps <= cells_.size(); ++steps) {
      const auto& v = cells_[cell].corners;
      const std::uint32_t beyond = links_[cell][static_cast<std::size_t>(std::find(v.begin(), v.end(), from) - v.begin())];
      if (beyond == no_entity) break;
      cell = beyond;
      from = to;
      to = next(ridge, cell, from);
      if (to == no_entity) return std::nullopt;
    }
    for (const Ridge<D>& other : ridges)
      if (other.apex == to && hull_[other.face].cell == cell) return Fan{ridge.face, other.face, angle(ridge)};
    return std::nullopt;
  }

  /// The corner of the cell that neither the ridge has nor is `from`.
  std::uint32_t next(const Ridge<D>& ridge, std::uint32_t cell, std::uint32_t from) const {
    for (const std::uint32_t v : cells_[cell].corners)
      if (v != from && !std::binary_search(ridge.corners.begin(), ridge.corners.end(), v)) return v;
    return no_entity;  // it has a corner twice
  }

  Sign side(const Ridge<D>& ridge, std::uint32_t p, std::uint32_t q) const {
    Simplex<D> s;
    for (std::size_t i = 0; i + 1 < D; ++i) s[i] = points_[ridge.corners[i]];
    s[D - 1] = points_[p];
    s[D] = points_[q];
    return orient<D>(s);
  }

  /// Of the face about the ridge, from any direction that all faces of this ridge have in common.
  double angle(const Ridge<D>& ridge) const {
    const auto to = difference(points_[ridge.apex], points_[ridge.corners[0]]);
    double x = to[0], y = to[1];
    if constexpr (D == 3) {
      const auto along = difference(points_[ridge.corners[1]], points_[ridge.corners[0]]);
      Vector<3> axis{};  // that along which least is seen of the ridge
      const auto least = std::ranges::min_element(along, {}, [](double c) { return std::fabs(c); });
      axis[static_cast<std::size_t>(least - along.begin())] = 1;
      const Vector<3> u = cross(along, axis), w = cross(along, u);
      x = dot(to, u) / std::sqrt(dot(u, u));
      y = dot(to, w) / std::sqrt(dot(w, w));
    }
    const double part = y / (std::fabs(x) + std::fabs(y));  // grows from -1 to 1 where x is positive
    return x >= 0 ? 1 + part : 3 - part;
  }

  const std::vector<Point<D>>& points_;
  const std::vector<LabelledCell<D>>& cells_;
  const CellLinks<D>& links_;
  const std::vector<HullFace<D>>& hull_;
  DisjointSets parts_;
};

}  // namespace

template <int D>
std::vector<std::uint32_t> parts_of_hull(const std::vector<Point<D>>& points, const std::vector<LabelledCell<D>>& cells,
                                         const CellLinks<D>& links, const std::vector<HullFace<D>>& hull) {
  return HullParts<D>(points, cells, links, hull).find();
}

template std::vector<std::uint32_t> parts_of_hull<2>(const std::vector<Point2>&, const std::vector<LabelledCell<2>>&,
                                                     const CellLinks<2>&, const std::vector<HullFace<2>>&);
template std::vector<std::uint32_t> parts_of_hull<3>(const std::vector<Point3>&, const std::vector<LabelledCell<3>>&,
                                                     const CellLinks<3>&, const std::vector<HullFace<3>>&);

}  // namespace pgdr::detail
