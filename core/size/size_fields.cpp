// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Fields made of others and of points, and growth along edges.
#include "pgdr/size_fields.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <queue>
#include <string>

#include "size/checks.hpp"
#include "size/region_sizes.hpp"
#include "space/box_tree.hpp"
#include "space/bulk.hpp"

namespace pgdr {

template <int D>
SizingField<D> smallest(std::vector<SizingField<D>> fields) {
  double constant = std::numeric_limits<double>::infinity();
  std::vector<SizingField<D>> functions;
  for (SizingField<D>& f : fields) {
    if (!f.is_constant()) {
      functions.push_back(std::move(f));
      continue;
    }
    const double value = f.at({});
    if (!(value >= constant) && !std::isnan(constant)) constant = value;  // a NaN comes through
  }
  if (functions.empty() || std::isnan(constant)) return constant;
  if (functions.size() == 1 && constant == std::numeric_limits<double>::infinity()) return functions[0];
  const bool by_blocks = std::any_of(functions.begin(), functions.end(), [](const auto& f) { return f.is_by_blocks(); });
  const auto shared = std::make_shared<const std::vector<SizingField<D>>>(std::move(functions));
  if (by_blocks)
    return SizingField<D>::by_blocks([constant, functions = shared](std::span<const Point<D>> points, std::span<double> sizes) {
      std::fill(sizes.begin(), sizes.end(), constant);
      std::vector<double> values(points.size());
      for (const SizingField<D>& f : *functions) {
        f.at(points, values);
        for (std::size_t i = 0; i < points.size(); ++i)
          if (!(values[i] >= sizes[i]) && !std::isnan(sizes[i])) sizes[i] = values[i];  // a NaN comes through
      }
    });
  return [constant, functions = shared](const Point<D>& x) {
    double least = constant;
    for (const SizingField<D>& f : *functions) {
      const double value = f.at(x);
      if (std::isnan(value)) return value;
      least = std::min(least, value);
    }
    return least;
  };
}

template <int D>
SizingField<D> sizes_at_points(std::span<const Point<D>> points, std::span<const double> sizes, double growth) {
  if (points.empty()) throw UsageError({Errc::bad_option, "a sizing field of points needs points", {}, 0, {}, {}});
  detail::require_growth(growth);
  detail::require_sizes<D>(points, sizes);
  struct Source {
    std::vector<Point<D>> points;
    std::vector<double> lengths;
    detail::BoxTree<D> tree;
    std::vector<double> least;  // of the lengths below each node
  };
  std::vector<detail::Box<D>> boxes;
  std::vector<double> lengths;
  for (std::size_t i = 0; i < points.size(); ++i) {
    lengths.push_back(detail::length_of<D>(sizes[i]));
    boxes.push_back(detail::Box<D>::around(points[i]));
  }
  detail::BoxTree<D> tree(boxes, detail::TreeCut::at_medians);
  std::vector<double> least = tree.least_below(lengths, detail::Bulk(false));
  const auto source = std::make_shared<const Source>(
      Source{{points.begin(), points.end()}, std::move(lengths), std::move(tree), std::move(least)});
  return [source, growth](const Point<D>& x) {
    double least = std::numeric_limits<double>::infinity();
    source->tree.nearest([&](const detail::Box<D>& box,
                             std::uint32_t node) { return source->least[node] + growth * std::sqrt(box.squared_distance_to(x)); },
                         [&](std::uint32_t i) {
                           least = std::min(least,
                                            source->lengths[i] + growth * std::sqrt(squared_distance(x, source->points[i])));
                           return least;
                         });
    return detail::size_of_length<D>(least);
  };
}

/// Of a line with the length r (its size, or in 2D the root of it), points h apart, with r less growth h / 2 each. Between them
/// the field is r at most; h is such that it is r less r / 20 at least.
template <int D>
SizingField<D> sizes_along(std::span<const std::array<Point<D>, 2>> lines, std::span<const double> sizes, double growth) {
  constexpr double most_points = 1e8, loss = 0.1;
  detail::require_growth(growth);
  std::vector<Point<D>> ends;
  for (const auto& line : lines) ends.push_back(line[0]);
  detail::require_sizes<D>(ends, sizes);
  std::vector<Point<D>> points;
  std::vector<double> values;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const auto& [a, b] = lines[i];
    const double r = detail::length_of<D>(sizes[i]), length = std::sqrt(squared_distance(a, b));
    const double parts = std::ceil(length * growth / (loss * r));
    if (!(parts + static_cast<double>(points.size()) <= most_points))
      throw UsageError({Errc::bad_option,
                        "sizes along a line are so small, beside its length, that they take too many points",
                        {},
                        0,
                        {static_cast<std::int64_t>(i)},
                        {}});
    const auto n = static_cast<std::size_t>(parts);
    const double lowered = n == 0 ? r : r - growth * (length / parts) / 2;
    for (std::size_t k = 0; k <= n; ++k) {
      const double t = n == 0 ? 0 : static_cast<double>(k) / parts;
      Point<D> p = k == n && n > 0 ? b : a;
      if (k > 0 && k < n)
        for (int d = 0; d < D; ++d) p[d] = a[d] + t * (b[d] - a[d]);
      points.push_back(p);
      values.push_back(detail::size_of_length<D>(lowered));
    }
  }
  return sizes_at_points<D>(points, values, growth);
}

template <int D>
std::vector<double> limit_growth(const OutputMesh<D>& mesh, std::span<const double> values, double growth) {
  detail::require_growth(growth);
  detail::require_sizes<D>(mesh.points, values);
  detail::require_indices<D>(mesh);
  // The edges at each vertex; an edge may occur several times.
  std::vector<std::uint32_t> begin(mesh.points.size() + 1, 0);
  for (const auto& cell : mesh.cells)
    for (const std::uint32_t v : cell) begin[v + 1] += D;
  for (std::size_t v = 1; v < begin.size(); ++v) begin[v] += begin[v - 1];
  std::vector<std::uint32_t> other(begin.back()), place(begin.begin(), begin.end() - 1);
  for (const auto& cell : mesh.cells)
    for (int i = 0; i <= D; ++i)
      for (int j = 0; j <= D; ++j)
        if (i != j) other[place[cell[i]]++] = cell[j];
  // Dijkstra: each vertex is settled at its final value, the smallest first.
  std::vector<double> length(values.size());
  using Waiting = std::pair<double, std::uint32_t>;
  std::priority_queue<Waiting, std::vector<Waiting>, std::greater<>> queue;
  for (std::uint32_t v = 0; v < values.size(); ++v) queue.push({length[v] = detail::length_of<D>(values[v]), v});
  std::vector<double> limited(values.begin(), values.end());
  while (!queue.empty()) {
    const auto [from, v] = queue.top();
    queue.pop();
    if (from > length[v]) continue;
    for (std::uint32_t e = begin[v]; e < begin[v + 1]; ++e) {
      const std::uint32_t w = other[e];
      const double most = from + growth * std::sqrt(squared_distance(mesh.points[v], mesh.points[w]));
      if (!(most < length[w])) continue;
      length[w] = most;
      limited[w] = std::min(values[w], detail::size_of_length<D>(most));
      queue.push({most, w});
    }
  }
  return limited;
}

template <int D>
std::vector<double> sizes_of_regions(const OutputMesh<D>& mesh, const RegionSizes<D>& sizes, double otherwise) {
  detail::require_indices<D>(mesh);
  if (!(otherwise > 0) || !std::isfinite(otherwise))
    throw UsageError({Errc::bad_option, "the size beside the regions must be positive and finite", {}, 0, {}, {}});
  if (!mesh.regions.empty() && mesh.regions.size() != mesh.cells.size())
    throw InputError({Errc::index_out_of_range, "the labels are not one a cell", {}, 0, {}, {}});
  const std::vector<double> labels = mesh.regions.empty() ? std::vector<double>{0} : detail::labels_of(mesh);
  detail::require_labels<D>(sizes, labels);
  std::vector<double> values(mesh.points.size(), std::numeric_limits<double>::infinity());
  for (const double label : labels) {
    const SizingField<D> field = detail::sizes_of_label<D>(sizes, label);
    if (!field.bounded()) continue;
    std::vector<bool> done(values.size());
    for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
      if (!mesh.regions.empty() && mesh.regions[c] != label) continue;
      for (const std::uint32_t v : mesh.cells[c]) {
        if (done[v]) continue;
        done[v] = true;
        const double size = field.at(mesh.points[v]);
        if (!(size > 0))
          values[v] = size;  // said of the vertex below
        else if (values[v] > 0)
          values[v] = std::min(values[v], size);
      }
    }
  }
  for (double& value : values)
    if (value == std::numeric_limits<double>::infinity()) value = otherwise;
  detail::require_sizes<D>(mesh.points, values);
  return values;
}

template PGDR_API SizingField<2> smallest<2>(std::vector<SizingField<2>>);
template PGDR_API SizingField<3> smallest<3>(std::vector<SizingField<3>>);
template PGDR_API SizingField<2> sizes_at_points<2>(std::span<const Point<2>>, std::span<const double>, double);
template PGDR_API SizingField<3> sizes_at_points<3>(std::span<const Point<3>>, std::span<const double>, double);
template PGDR_API SizingField<2> sizes_along<2>(std::span<const std::array<Point<2>, 2>>, std::span<const double>, double);
template PGDR_API SizingField<3> sizes_along<3>(std::span<const std::array<Point<3>, 2>>, std::span<const double>, double);
template PGDR_API std::vector<double> limit_growth<2>(const OutputMesh<2>&, std::span<const double>, double);
template PGDR_API std::vector<double> sizes_of_regions<2>(const OutputMesh<2>&, const RegionSizes<2>&, double);
template PGDR_API std::vector<double> sizes_of_regions<3>(const OutputMesh<3>&, const RegionSizes<3>&, double);
template PGDR_API std::vector<double> limit_growth<3>(const OutputMesh<3>&, std::span<const double>, double);

}  // namespace pgdr
