// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Is a cell within its bounds? Decided as the checker decides it (the exact functions of predicates.hpp), most often from
// the cached circumsphere alone. Reads one cell and its vertices; any thread that may read these.
#pragma once

#include <vector>

#include "pgdr/mesh.hpp"
#include "pgdr/sizing.hpp"

namespace pgdr {

/// What is known of a cell besides its circumsphere.
struct CellShape {
  double shortest_edge_squared;  ///< as circumsphere.hpp has it
  double det;        ///< of orient(), see ShapeBlock
  double det_error;  ///< its error; infinite: not known
};

/// Which bounds a cell is over.
struct CellVerdict {
  bool over_radius_edge = false;  ///< of shape
  bool over_size = false;         ///< of size, volume or area
  explicit operator bool() const { return over_radius_edge || over_size; }  ///< any of them
};

/// All bounds that cells have to meet. A value; copies of functions share what these point to.
template <int D>
class CellBounds {
 public:
  static constexpr double infinity = std::numeric_limits<double>::infinity();  ///< no bound

  double radius_edge_bound = infinity;  ///< on circumradius over shortest edge
  SizingField<D> size;            ///< of all cells
  /// Further ones of each region (by region number). Empty: none at all.
  std::vector<SizingField<D>> region_size;
  double max_measure = infinity;  ///< of all cells
  /// Measure bound of each region (by region number); infinity for none. Empty: none at all.
  std::vector<double> region_measure;

  /// @throws UsageError bad_size if the size function returns a value that is not positive.
  CellVerdict test(const Mesh<D>& mesh, CellId c) const;
  /// A quick look that most cells within their bounds pass, in 3D without bounds on the measure.
  bool surely_within(const Mesh<D>& mesh, CellId c, const CellShape& shape) const {
    if (D == 2 || !size.is_constant() || !region_size.empty() || !region_measure.empty() || max_measure != infinity) return false;
    const double bound = size.at({}), high = mesh.squared_radius_bounds(c).second;
    return high < bound * bound && high < radius_edge_bound * radius_edge_bound * shape.shortest_edge_squared;
  }
  /// The same of a cell whose shape is known.
  CellVerdict test(const Mesh<D>& mesh, CellId c, const CellShape& shape) const;
  /// How far a cell of these corners in the region would be over its bounds: 0 within; over any of them 1, and over that of shape an
  /// eighth more for each power of two by which it is, up to 2.5 more. Called of cells that are not there, too.
  double excess(const Simplex<D>& s, int region) const;
  /// Would it be within those of size?
  bool within_size(const Simplex<D>& s, int region) const;
  /// Is it over the bound of shape?
  bool over_radius_edge(const Mesh<D>& mesh, CellId c) const;

 private:
  bool over_radius_edge(const Mesh<D>& mesh, CellId c, double shortest_squared) const;
  double size_of(const Simplex<D>& s, int region) const;
  double measure_of(int region) const;
  bool within_measure(const Mesh<D>& mesh, CellId c, const CellShape& shape, double bound) const;
  bool over_size(const Mesh<D>& mesh, CellId c, const CellShape& shape) const;
};

extern template class CellBounds<2>;
extern template class CellBounds<3>;

}  // namespace pgdr
