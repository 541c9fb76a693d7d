// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "optimize/local_sizes.hpp"

#include <algorithm>

#include "numbers/vectors.hpp"

namespace pgdr {
namespace {

/// What the centroids of few cells tell nothing of, as they lie in a plane or nearly so, counts as no change of size: this part
/// of the sum of the squares of all distances is added along each axis. From 1e-8 to 1e-2 the optimiser leaves as many poor
/// cells.
constexpr double stiffness = 1e-3;

}  // namespace

void LocalSizes::add(const Point3& at, int region, double size) {
  auto r = std::find_if(regions_.begin(), regions_.end(), [region](const Region& known) { return known.region == region; });
  if (r == regions_.end()) {
    regions_.emplace_back();
    r = regions_.end() - 1;
    r->region = region;
  }
  r->known.push_back({at, size});
}

void LocalSizes::fit(Region& r) {
  // Differences from the first, so that equal sizes give exactly that size.
  const auto n = static_cast<double>(r.known.size());
  const Known& first = r.known.front();
  r.centre = first.at;
  r.least = r.most = r.mean = first.size;
  double sum = 0;
  detail::Vector<3> to_centre{};
  for (const Known& k : r.known) {
    const auto d = detail::difference<3>(k.at, first.at);
    for (int i = 0; i < 3; ++i) to_centre[i] += d[i] / n;
    sum += k.size - first.size;
    r.least = std::min(r.least, k.size);
    r.most = std::max(r.most, k.size);
  }
  r.mean += sum / n;
  for (int i = 0; i < 3; ++i) r.centre[i] += to_centre[i];
  r.gradient = {};
  if (r.least == r.most) return;
  // Normal equations of the gradient, a symmetric matrix by its columns.
  std::array<detail::Vector<3>, 3> a{};
  detail::Vector<3> b{};
  for (const Known& k : r.known) {
    const auto d = detail::difference<3>(k.at, r.centre);
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) a[i][j] += d[i] * d[j];
      b[i] += d[i] * (k.size - r.mean);
    }
  }
  const double trace = a[0][0] + a[1][1] + a[2][2];
  for (int i = 0; i < 3; ++i) a[i][i] += stiffness * trace;
  const auto c0 = detail::cross(a[1], a[2]), c1 = detail::cross(a[2], a[0]), c2 = detail::cross(a[0], a[1]);
  const double det = detail::dot(a[0], c0);
  if (!(det > 0)) return;
  for (int i = 0; i < 3; ++i) r.gradient[i] = (c0[i] * b[0] + c1[i] * b[1] + c2[i] * b[2]) / det;
}

void LocalSizes::fit() {
  for (Region& r : regions_) fit(r);
}

std::optional<double> LocalSizes::at(const Point3& x, int region) const {
  for (const Region& r : regions_)
    if (r.region == region)
      return std::clamp(r.mean + detail::dot(r.gradient, detail::difference<3>(x, r.centre)), r.least, r.most);
  return std::nullopt;
}

}  // namespace pgdr
