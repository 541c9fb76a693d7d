// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Markers and attributes of the points of a finished mesh. Input points keep theirs. A Steiner point on a segment or facet
// has its marker, any other 0. An input point of a 2D input whose own marker is 0 has that of the first segment that ends
// there and has one, as with Triangle. Attributes of Steiner points are interpolated linearly in the input: on a segment
// between its ends, on a facet in the triangle of it that the point lies in, elsewhere in the cell of the mesh as it was
// before the refinement. They are functions of the point alone, whatever came between, and never beyond the values that
// they lie between.
#pragma once

#include <memory>
#include <span>
#include <stop_token>

#include "compact/compact.hpp"
#include "pgdr/domain.hpp"
#include "space/pieces.hpp"

namespace pgdr {

namespace detail {
class Bulk;
template <int D>
class MeshInterpolation;
}

/// The data of points: made before the refinement, of what is interpolated on, and used after it.
template <int D>
class PointData {
 public:
  /// `unrefined`: the mesh once the boundary is there and the exterior gone. Kept if the input has attributes. Linear time.
  PointData(const Mesh<D>& unrefined, const Domain<D>& domain, const detail::Pieces& pieces = detail::OneByOne());
  PointData(PointData&&) noexcept;  ///< moves the data
  ~PointData();

  /// Sets markers and attributes of the points of `out`, which is `refined` in compact form. `pieces` and `stop` as for
  /// compact().
  void fill(const Mesh<D>& refined, Compacted<D>& out, const detail::Pieces& pieces, std::stop_token stop = {}) const;

  /// Sets those of some points, which are all that `out` has, by the records of their vertices in the same order.
  void fill_rows(std::span<const VertexRecord<D>> vertices, OutputMesh<D>& out, const detail::Pieces& pieces) const;

 private:
  void fill_markers(const Mesh<D>& refined, const detail::Bulk& bulk, Compacted<D>& out) const;

  const Domain<D>* domain_;
  std::vector<double> attributes_;  ///< of the points of the unrefined mesh
  std::unique_ptr<detail::MeshInterpolation<D>> unrefined_;
};

extern template class PointData<2>;
extern template class PointData<3>;

}  // namespace pgdr
