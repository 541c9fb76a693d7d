// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Sizes on a background mesh.
#include <memory>

#include "output/interpolation.hpp"
#include "pgdr/size_fields.hpp"
#include "size/checks.hpp"

namespace pgdr {
namespace {

template <int D>
class MeshValues {
 public:
  MeshValues(const OutputMesh<D>& mesh, std::span<const double> values)
      : values_(values.begin(), values.end()), mesh_(mesh.points, mesh.cells) {
    if (mesh_.empty()) throw UsageError({Errc::bad_option, "the background mesh has no cell with a volume", {}, 0, {}, {}});
  }

  double at(const Point<D>& x) const {
    return mesh_.at(x).mean([this](std::uint32_t v) { return values_[v]; });
  }

 private:
  std::vector<double> values_;
  detail::MeshInterpolation<D> mesh_;
};

}  // namespace

template <int D>
SizingField<D> sizes_on_mesh(const OutputMesh<D>& mesh, std::span<const double> values) {
  detail::require_sizes<D>(mesh.points, values);
  detail::require_indices<D>(mesh);
  return [source = std::make_shared<const MeshValues<D>>(mesh, values)](const Point<D>& x) { return source->at(x); };
}

template PGDR_API SizingField<2> sizes_on_mesh<2>(const OutputMesh<2>&, std::span<const double>);
template PGDR_API SizingField<3> sizes_on_mesh<3>(const OutputMesh<3>&, std::span<const double>);

}  // namespace pgdr
