// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The bounds of cells: is a cell within them? Decided as the checker decides it, by the exact functions of predicates.hpp, most
// often from the cached circumsphere alone. Reads one cell and its vertices; any thread that may read these.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "mesh/mesh.hpp"
#include "numbers/rounding.hpp"
#include "pgdr/sizing.hpp"

namespace pgdr {

/// The shape of a cell, as far as tests of bounds need it.
struct CellShape {
  double shortest_edge_squared;  ///< as circumsphere.hpp computes it
  double squared_radius_low;     ///< lower bound of the square of the circumradius
  double squared_radius_high;    ///< upper bound of the same
  double det;                    ///< of orient(), see ShapeBlock
  double det_error;              ///< its error; infinite: not known
};

/// The shape of a cell of the mesh.
template <int D>
CellShape shape_of(const Mesh<D>& mesh, CellId c);

/// Which bounds a cell is over.
struct CellVerdict {
  bool over_radius_edge = false;  ///< over the bound of shape
  /// Over a bound of size, volume or area: about how many cells within it will take its place; 0 if it is within.
  std::uint32_t over_size = 0;
  explicit operator bool() const { return over_radius_edge || over_size > 0; }  ///< is it over any?
};

/// CellVerdict::over_size is not more than this, as sizes may vary within the cell.
constexpr std::uint32_t most_cells_to_fill = 512;
/// CellVerdict::over_size of a cell of this determinant (D! times its measure), where cells are of that one on average.
inline std::uint32_t cells_to_fill(double det, double average) {
  constexpr double most = most_cells_to_fill;
  const double cells = std::fabs(det) / average;
  return cells < most ? static_cast<std::uint32_t>(std::max(cells, 1.0)) : static_cast<std::uint32_t>(most);
}
/// The average determinant of tetrahedra whose circumradius may be `most`, as meshes of cubes have it.
inline double average_det_of_radius(double most) { return 6 * 0.2 * most * most * most; }
/// The same of cells whose volume, or area, may be `most`, as meshes of cubes and squares have it.
template <int D>
double average_det_of_measure(double most) {
  return D == 3 ? 6 * 0.54 * most : 2 * 0.65 * most;
}

/// All bounds that cells have to meet. A value; copies of functions share what these point to.
template <int D>
class CellBounds {
 public:
  static constexpr double infinity = std::numeric_limits<double>::infinity();  ///< no bound

  double radius_edge_bound = infinity;  ///< on circumradius over shortest edge
  SizingField<D> size;                  ///< bound on the size of all cells
  /// Further bounds on size of each region (by region number). Empty: none at all.
  std::vector<SizingField<D>> region_size;
  double max_measure = infinity;  ///< bound on the volume (2D: area) of all cells
  /// Measure bound of each region (by region number); infinity for none. Empty: none at all.
  std::vector<double> region_measure;

  /// @throws UsageError bad_size if the size function returns a value that is not positive.
  CellVerdict test(const Mesh<D>& mesh, CellId c) const;
  /// test() of a cell whose shape is known.
  CellVerdict test(const Mesh<D>& mesh, CellId c, const CellShape& shape) const;
  /// The least bound of size that applies to a cell of these corners in the region; infinity: none. @throws as test()
  double size_at(const Simplex<D>& s, int region) const;
  /// size_at() of cells with these centroids, in these regions, in one block. @throws as test(); what a size function throws
  void sizes_at(std::span<const Point<D>> centroids, std::span<const int> regions, std::span<double> sizes) const;
  /// Is a bound of size to be asked for many cells at once?
  bool asks_blocks() const;
  bool sizes_vary() const;              ///< is a bound of size a function of position?
  double measure_of(int region) const;  ///< the least bound of its volume (2D: area); infinity: none
  /// Is the cell over the bound of shape?
  bool over_radius_edge(const Mesh<D>& mesh, CellId c) const;
  /// over_radius_edge() of a cell whose shape is known.
  bool over_radius_edge(const Mesh<D>& mesh, CellId c, const CellShape& shape) const;
  /// CellVerdict::over_size of the cell. @throws as test()
  std::uint32_t over_size(const Mesh<D>& mesh, CellId c, const CellShape& shape) const;

  /// A cell as it was made, which may be gone by now; its vertices are not.
  struct MadeCell {
    std::array<VertexId, D + 1> vertices;  ///< of the cell
    int region;                            ///< it is in
    CellShape shape;                       ///< of it
  };
  /// over_radius_edge() of a cell that was made.
  bool over_radius_edge(const Mesh<D>& mesh, const MadeCell& cell) const;
  /// over_size() of a cell that was made, where `size` is the answer of sizes_at(). @pre a size bounds cells
  std::uint32_t over_size(const Mesh<D>& mesh, const MadeCell& cell, double size) const;

 private:
  template <class SimplexOf>
  double size_of(SimplexOf simplex, int region) const;
  template <class SimplexOf>
  bool over_ratio(SimplexOf simplex, const CellShape& shape) const;
  template <class SimplexOf>
  std::uint32_t over(SimplexOf simplex, int region, const CellShape& shape, const double* size) const;
};

/// A quick test where one size bounds all cells. It decides about nearly all cells, as CellBounds does.
template <int D>
class QuickBounds {
 public:
  /// Within all bounds, or over one of size whatever the shape, or unknown.
  enum class Answer { unknown, within, over_size };

  /// Where sizes vary every answer is `unknown`.
  explicit QuickBounds(const CellBounds<D>& bounds) {
    const bool varies = !bounds.size.is_constant() || !bounds.region_size.empty() || !bounds.region_measure.empty() ||
                        bounds.max_measure != CellBounds<D>::infinity;
    if (varies) return;
    const double size = bounds.size.at({});
    most_size_ = D == 3 ? size * size : 2 * size;
    squared_ratio_ = bounds.radius_edge_bound * bounds.radius_edge_bound;
    average_det_ = D == 3 ? average_det_of_radius(size) : average_det_of_measure<D>(size);
  }
  /// Tests a cell of this shape.
  Answer look(const CellShape& shape) const {
    double least = shape.squared_radius_low,
           most = shape.squared_radius_high;  // of the square of the circumradius, or of twice the area
    if constexpr (D == 2) {
      least = (std::fabs(shape.det) - shape.det_error) * (1 - rounding::of_determinant);
      most = (std::fabs(shape.det) + shape.det_error) * (1 + rounding::of_determinant);
    }
    if (least > most_size_) return Answer::over_size;
    const bool fits = shape.squared_radius_high < squared_ratio_ * shape.shortest_edge_squared;
    return most < most_size_ && fits ? Answer::within : Answer::unknown;
  }
  /// CellVerdict::over_size of a cell that is over the size.
  std::uint32_t over_size(const CellShape& shape) const { return cells_to_fill(shape.det, average_det_); }

 private:
  double most_size_ = std::numeric_limits<double>::quiet_NaN(), squared_ratio_ = 0, average_det_ = 1;
};

extern template class CellBounds<2>;
extern template class CellBounds<3>;

}  // namespace pgdr
