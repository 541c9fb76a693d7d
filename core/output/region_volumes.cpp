// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "pgdr/region_volume.hpp"

#include <map>
#include <tuple>

#include "numbers/corners.hpp"
#include "numbers/exact_sum.hpp"

namespace pgdr {

template <int D>
std::vector<RegionVolume> measure_regions(const OutputMesh<D>& mesh) {
  std::map<double, detail::ExactSum> sums;
  for (std::size_t i = 0; i < mesh.cells.size(); ++i) {
    detail::ExactSum& sum = sums[mesh.regions.empty() ? 0.0 : mesh.regions[i]];
    for (const auto& corners : face_corners<D>) {
      std::array<Point<D>, D> face;
      for (std::size_t k = 0; k < D; ++k) face[k] = mesh.points[mesh.cells[i][corners[k]]];
      if (D == 3) std::swap(face[0], face[1]);  // outwards
      std::apply([&sum](const auto&... p) { sum.add_determinant(p...); }, face);
    }
  }
  std::vector<RegionVolume> volumes;
  for (const auto& [label, sum] : sums) volumes.push_back({label, sum.divided_by(D == 3 ? 6 : 2), std::nullopt});
  return volumes;
}

template PGDR_API std::vector<RegionVolume> measure_regions(const OutputMesh<2>&);
template PGDR_API std::vector<RegionVolume> measure_regions(const OutputMesh<3>&);

}  // namespace pgdr
