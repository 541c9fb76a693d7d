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
  double shortest_edge_squared;
  double det, det_error;  ///< of orient(), see ShapeBlock; an infinite error: not known
};

struct CellVerdict {
  bool over_radius_edge = false, over_size = false;
  explicit operator bool() const { return over_radius_edge || over_size; }
};

template <int D>
class CellBounds {
 public:
  double radius_edge_bound = std::numeric_limits<double>::infinity();
  SizingField<D> size;
  double max_measure = std::numeric_limits<double>::infinity();
  /// Measure bound of each region (by region number); infinity for none. Empty: none at all.
  std::vector<double> region_measure;

  /// @throws UsageError bad_size if the size function returns a value that is not positive.
  CellVerdict test(const Mesh<D>& mesh, CellId c) const;
  /// The same of a cell whose shape is known.
  CellVerdict test(const Mesh<D>& mesh, CellId c, const CellShape& shape) const;

 private:
  bool within_measure(const Mesh<D>& mesh, CellId c, const CellShape& shape, double bound) const;
  bool over_size(const Mesh<D>& mesh, CellId c, const CellShape& shape) const;
};

extern template class CellBounds<2>;
extern template class CellBounds<3>;

}  // namespace pgdr
