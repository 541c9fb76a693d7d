// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "pgdr/transfer.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "output/face_groups.hpp"
#include "output/interpolation.hpp"
#include "output/simplices.hpp"
#include "pgdr/error.hpp"
#include "space/box_tree.hpp"
#include "space/bulk.hpp"
#include "transfer/common_part.hpp"

namespace pgdr {
namespace {

constexpr std::uint32_t none = 0xffffffffu;

[[noreturn]] void bad_option(const char* what) { throw UsageError({.code = Errc::bad_option, .message = what}); }

template <int D>
void require_usable(const OutputMesh<D>& mesh) {
  for (const auto& cell : mesh.cells)
    if (std::ranges::any_of(cell, [&](std::uint32_t v) { return v >= mesh.points.size(); }))
      throw InputError({.code = Errc::index_out_of_range, .message = "a cell has a vertex that does not exist"});
  for (const Point<D>& p : mesh.points)
    if (std::ranges::any_of(p.x, [](double x) { return !std::isfinite(x); }))
      throw InputError({.code = Errc::not_finite, .message = "a point of a mesh is not finite"});
  if (!mesh.regions.empty() && mesh.regions.size() != mesh.cells.size())
    throw InputError({.code = Errc::index_out_of_range, .message = "the labels are not one a cell"});
}

void require_count(std::size_t values, std::size_t rows, std::size_t width) {
  if (values != rows * width)
    throw UsageError(
        {.code = Errc::bad_option,
         .message = std::to_string(values) + " values for " + std::to_string(rows) + " rows of " + std::to_string(width)});
}

template <int D>
Point<D> centre_of(const OutputMesh<D>& mesh, std::size_t c) {
  Point<D> centre{};
  for (const Point<D>& p : corners_of(mesh, c))
    for (int k = 0; k < D; ++k) centre[k] += p[k] / (D + 1);
  return centre;
}

/// Labels by numbers from 0 that both meshes have in common; all 0 if their labels are not the same.
template <int D>
std::array<std::vector<std::uint32_t>, 2> common_labels(const OutputMesh<D>& from, const OutputMesh<D>& to) {
  std::map<double, std::array<bool, 2>> there;
  const std::array meshes{&from, &to};
  const auto label = [&](std::size_t m, std::size_t c) { return meshes[m]->regions.empty() ? 0.0 : meshes[m]->regions[c]; };
  for (std::size_t m = 0; m < 2; ++m)
    for (std::size_t c = 0; c < meshes[m]->cells.size(); ++c) there[label(m, c)][m] = true;
  const bool are_same = std::ranges::all_of(there, [](const auto& of) { return of.second[0] && of.second[1]; });
  std::map<double, std::uint32_t> number;
  for (const auto& [value, unused] : there) number.emplace(value, are_same ? static_cast<std::uint32_t>(number.size()) : 0);
  std::array<std::vector<std::uint32_t>, 2> out;
  for (std::size_t m = 0; m < 2; ++m)
    for (std::size_t c = 0; c < meshes[m]->cells.size(); ++c) out[m].push_back(number.at(label(m, c)));
  return out;
}

/// The cell of a label whose centre is nearest; ties: the first. Made when it is asked for the first time, as it seldom is.
template <int D>
class NearestCells {
 public:
  NearestCells(const OutputMesh<D>& mesh, std::span<const std::uint32_t> labels) : mesh_(mesh), labels_(labels) {}

  std::uint32_t of(const Point<D>& x, std::uint32_t label) {
    if (centres_.empty()) {
      std::vector<detail::Box<D>> boxes;
      for (std::size_t c = 0; c < mesh_.cells.size(); ++c) {
        centres_.push_back(centre_of(mesh_, c));
        boxes.push_back(detail::Box<D>::around(centres_.back()));
      }
      tree_.emplace(boxes, detail::TreeCut::at_medians);
    }
    double nearest = std::numeric_limits<double>::infinity();
    std::uint32_t best = none;
    tree_->nearest([&](const detail::Box<D>& box, std::uint32_t) { return box.squared_distance_to(x); },
                   [&](std::uint32_t c) {
                     const double d = squared_distance(centres_[c], x);
                     if (labels_[c] == label && (d < nearest || (d == nearest && c < best))) {
                       nearest = d;
                       best = c;
                     }
                     return nearest;
                   });
    return best;
  }

 private:
  const OutputMesh<D>& mesh_;
  std::span<const std::uint32_t> labels_;
  std::vector<Point<D>> centres_;
  std::optional<detail::BoxTree<D>> tree_;
};

/// Calls f(j, its parts) for the cells [0, cells), on all threads. @param parts  by cells
template <class Part, class F>
void each_with_parts(std::size_t cells, std::span<const Part> parts, const F& f) {
  detail::Bulk(true).blocks(cells, [&](std::size_t begin, std::size_t end) {
    auto first = std::lower_bound(parts.begin(), parts.end(), begin, [](const Part& part, std::size_t j) { return part.to < j; });
    for (std::size_t j = begin; j < end; ++j) {
      auto last = first;
      while (last != parts.end() && last->to == j) ++last;
      f(j, parts.subspan(static_cast<std::size_t>(first - parts.begin()), static_cast<std::size_t>(last - first)));
      first = last;
    }
  });
}

/// A few numbers, of which it is asked whether they are there already: in a table on the stack, until they are many.
class NumberSet {
 public:
  NumberSet() { few_.fill(none); }
  /// @returns false if it was there
  bool add(std::uint32_t number) {
    if (2 * ++count_ > slots().size()) grow();
    const bool is_new = put(number);
    if (!is_new) --count_;
    return is_new;
  }

 private:
  std::span<std::uint32_t> slots() { return many_.empty() ? std::span<std::uint32_t>(few_) : std::span<std::uint32_t>(many_); }
  bool put(std::uint32_t number) {
    const std::span<std::uint32_t> all = slots();
    const std::size_t mask = all.size() - 1;
    std::size_t at = number * 2654435761u & mask;  // Knuth's multiplier
    for (; all[at] != none; at = (at + 1) & mask)
      if (all[at] == number) return false;
    all[at] = number;
    return true;
  }
  void grow() {
    const std::span<std::uint32_t> now = slots();
    const std::vector<std::uint32_t> before(now.begin(), now.end());
    many_.assign(4 * before.size(), none);
    for (const std::uint32_t number : before)
      if (number != none) put(number);
  }

  std::array<std::uint32_t, 128> few_;
  std::vector<std::uint32_t> many_;
  std::size_t count_ = 0;
};

/// Beyond each side of each cell the cell there; none: there is none, or more than one.
template <int D>
std::vector<std::array<std::uint32_t, D + 1>> cells_beyond(const OutputMesh<D>& mesh, const detail::Bulk& bulk) {
  std::array<std::uint32_t, D + 1> alone;
  alone.fill(none);
  std::vector<std::array<std::uint32_t, D + 1>> beyond(mesh.cells.size(), alone);
  std::vector<std::size_t> begin;
  std::vector<detail::CellFace<D>> faces = detail::faces_by_vertex<D>(mesh, begin);
  bulk.each(mesh.points.size(), [&](std::size_t v) {
    const auto group = std::span(faces).subspan(begin[v], begin[v + 1] - begin[v]);
    std::sort(group.begin(), group.end(), [](const detail::CellFace<D>& a, const detail::CellFace<D>& b) {
      for (std::size_t k = 0; k + 1 < D; ++k)
        if (a.others[k] != b.others[k]) return a.others[k] < b.others[k];
      return a.place < b.place;
    });
    for (std::size_t i = 0, next; i < group.size(); i = next) {
      for (next = i + 1; next < group.size() && group[next].others == group[i].others;) ++next;
      if (next - i != 2) continue;
      beyond[group[i].cell()][group[i].corner()] = group[i + 1].cell();
      beyond[group[i + 1].cell()][group[i + 1].corner()] = group[i].cell();
    }
  });
  return beyond;
}

/// Finds the cells of a mesh that have something in common with another cell. Such a cell is convex, and what it has of the mesh
/// hangs together through sides of which it has an area, unless the mesh is not all around it: so the cells are found by a walk
/// from those about its centre through such sides. Where they do not fill it, as at boundaries that differ, all are looked at
/// whose boxes meet its own. Where it begins, and so what it finds, is a function of the meshes alone.
template <int D>
class Overlaps {
 public:
  Overlaps(const OutputMesh<D>& mesh, const detail::Bulk& bulk) : mesh_(mesh), beyond_(cells_beyond(mesh, bulk)) {
    std::vector<detail::Box<D>> boxes(mesh.cells.size());
    bulk.each(boxes.size(), [&](std::size_t c) { boxes[c] = detail::Box<D>::of(corners_of(mesh, c)); });
    tree_.emplace(boxes, bulk);
  }

  /// Calls begin(), and then found(i, measure) for each cell i that has so much in common with `cell`, whose corners are these;
  /// may do so twice, and the second time counts.
  template <class Begin, class Found>
  void find(const detail::InsideOf<D>& cell, const Simplex<D>& corners, const Begin& begin, const Found& found) const {
    begin();
    if (walk(cell, corners, found) >= (1 - missing) * cell.measure()) return;
    begin();
    tree_->meeting(detail::Box<D>::of(corners), [&](std::uint32_t i) {
      unsigned sides = 0;
      if (const double measure = cell.common_with(corners_of(mesh_, i), sides); measure > 0) found(i, measure);
    });
  }

 private:
  static constexpr double missing = 0x1p-42;  // of a measure: more than rounding leaves of usual cells, less than matters

  /// @returns the measure of all that was found
  template <class Found>
  double walk(const detail::InsideOf<D>& cell, const Simplex<D>& corners, const Found& found) const {
    NumberSet seen;
    std::vector<std::uint32_t> waiting;
    const auto add = [&](std::uint32_t i) {
      if (i != none && seen.add(i)) waiting.push_back(i);
    };
    Point<D> centre{};
    for (const Point<D>& p : corners)
      for (int k = 0; k < D; ++k) centre[k] += p[k] / (D + 1);
    tree_->at(centre, add);
    double sum = 0;
    while (!waiting.empty()) {
      const std::uint32_t i = waiting.back();
      waiting.pop_back();
      unsigned sides = 0;
      const double measure = cell.common_with(corners_of(mesh_, i), sides);
      if (!(measure > 0)) continue;
      sum += measure;
      found(i, measure);
      for (std::size_t k = 0; k <= D; ++k)
        if (sides >> k & 1u) add(beyond_[i][k]);
    }
    return sum;
  }

  const OutputMesh<D>& mesh_;
  std::vector<std::array<std::uint32_t, D + 1>> beyond_;
  std::optional<detail::BoxTree<D>> tree_;
};

}  // namespace

template <int D>
PointTransfer<D>::PointTransfer(const OutputMesh<D>& from, std::span<const Point<D>> to)
    : vertices_(from.points.size()), corners_(to.size()), weights_(to.size()) {
  require_usable(from);
  const detail::MeshInterpolation<D> mesh(from.points, from.cells);
  if (mesh.empty()) bad_option("the mesh has no cell with a volume");
  detail::Bulk(true).each(to.size(), [&](std::size_t i) {
    const auto place = mesh.at(to[i]);
    corners_[i] = place.corner;
    weights_[i] = place.weight;
  });
}

template <int D>
std::vector<double> PointTransfer<D>::operator()(std::span<const double> values, std::size_t width) const {
  require_count(values.size(), vertices_, width);
  std::vector<double> out(corners_.size() * width);
  detail::Bulk(true).each(corners_.size(), [&](std::size_t i) {
    const detail::WeightedCorners<D + 1> place{corners_[i], weights_[i]};
    for (std::size_t k = 0; k < width; ++k)
      out[i * width + k] = place.mean([&](std::uint32_t v) { return values[v * width + k]; });
  });
  return out;
}

template <int D>
CellTransfer<D>::CellTransfer(const OutputMesh<D>& from, const OutputMesh<D>& to) : new_cells_(to.cells.size()) {
  require_usable(from);
  require_usable(to);
  const detail::Bulk bulk(true);
  const std::array<std::vector<std::uint32_t>, 2> labels = common_labels(from, to);
  const std::vector<std::uint32_t>&old_labels = labels[0], &new_labels = labels[1];
  measures_.resize(from.cells.size());
  bulk.each(measures_.size(), [&](std::size_t c) { measures_[c] = detail::InsideOf<D>(corners_of(from, c)).measure(); });
  if (std::ranges::all_of(measures_, [](double m) { return m == 0; })) bad_option("the old mesh has no cell with a volume");
  const Overlaps<D> old_cells(from, bulk);
  new_measures_.resize(new_cells_);
  parts_ = bulk.template gather<Part>(new_cells_, [&](std::size_t j, std::vector<Part>& out) {
    const Simplex<D> s = corners_of(to, j);
    const detail::InsideOf<D> cell(s);
    new_measures_[j] = cell.measure();
    const std::size_t first = out.size();
    old_cells.find(
        cell, s, [&] { out.resize(first); },
        [&](std::uint32_t i, double measure) {
          if (old_labels[i] == new_labels[j]) out.push_back({static_cast<std::uint32_t>(j), i, measure});
        });
    std::sort(out.begin() + static_cast<std::ptrdiff_t>(first), out.end(),
              [](const Part& a, const Part& b) { return a.from < b.from; });
  });
  complete(from, to, old_labels, new_labels);
  shared_.assign(measures_.size(), 0);
  for (const Part& part : parts_) shared_[part.from] += part.measure;
}

/// Gives what of new cells is in no old one, and old cells that no new one has, to something.
template <int D>
void CellTransfer<D>::complete(const OutputMesh<D>& from, const OutputMesh<D>& to, std::span<const std::uint32_t> old_labels,
                               std::span<const std::uint32_t> new_labels) {
  std::vector<Part> further;
  NearestCells<D> nearest_old(from, old_labels), nearest_new(to, new_labels);
  std::vector<std::uint8_t> is_taken(measures_.size(), 0);
  auto next = parts_.begin();
  for (std::uint32_t j = 0; j < new_cells_; ++j) {
    const auto first = next;
    double sum = 0;
    for (; next != parts_.end() && next->to == j; ++next) {
      sum += next->measure;
      is_taken[next->from] = 1;
    }
    if (!(sum < new_measures_[j])) continue;
    if (first != next) {
      std::max_element(first, next, [](const Part& a, const Part& b) {
        return a.measure < b.measure;
      })->measure += new_measures_[j] - sum;
    } else if (const std::uint32_t i = nearest_old.of(centre_of(to, j), new_labels[j]); i != none) {
      further.push_back({j, i, new_measures_[j]});
      is_taken[i] = 1;
    }
  }
  for (std::uint32_t i = 0; i < is_taken.size(); ++i) {
    if (is_taken[i] || measures_[i] == 0) continue;
    if (const std::uint32_t j = nearest_new.of(centre_of(from, i), old_labels[i]); j != none)
      further.push_back({j, i, measures_[i]});
  }
  if (further.empty()) return;
  parts_.insert(parts_.end(), further.begin(), further.end());
  std::stable_sort(parts_.begin(), parts_.end(),
                   [](const Part& a, const Part& b) { return a.to != b.to ? a.to < b.to : a.from < b.from; });
}

template <int D>
std::vector<double> CellTransfer<D>::means(std::span<const double> values, std::size_t width) const {
  require_count(values.size(), measures_.size(), width);
  std::vector<double> out(new_cells_ * width, 0);
  each_with_parts(new_cells_, std::span<const Part>(parts_), [&](std::size_t j, std::span<const Part> parts) {
    if (new_measures_[j] == 0) return;
    for (const Part& part : parts) {
      const double share = part.measure / shared_[part.from] * measures_[part.from];
      for (std::size_t k = 0; k < width; ++k) out[j * width + k] += share * values[part.from * width + k];
    }
    for (std::size_t k = 0; k < width; ++k) out[j * width + k] /= new_measures_[j];
  });
  return out;
}

template <int D>
std::vector<double> CellTransfer<D>::largest_share(std::span<const double> values) const {
  require_count(values.size(), measures_.size(), 1);
  std::vector<double> out(new_cells_, 0);
  each_with_parts(new_cells_, std::span<const Part>(parts_), [&](std::size_t j, std::span<const Part> parts) {
    std::vector<std::pair<double, double>> shares;  // value, measure
    for (const Part& part : parts) shares.emplace_back(values[part.from], part.measure);
    std::stable_sort(shares.begin(), shares.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    double most = -1;
    for (std::size_t first = 0, last; first < shares.size(); first = last) {
      double sum = 0;
      for (last = first; last < shares.size() && shares[last].first == shares[first].first; ++last) sum += shares[last].second;
      if (!(sum > most)) continue;
      most = sum;
      out[j] = shares[first].first;
    }
  });
  return out;
}

template <int D>
std::vector<double> PointTransfer<D>::of_nearest_corners(std::span<const double> values, std::size_t width) const {
  require_count(values.size(), vertices_, width);
  std::vector<double> out(corners_.size() * width);
  detail::Bulk(true).each(corners_.size(), [&](std::size_t i) {
    const auto most = static_cast<std::size_t>(std::ranges::max_element(weights_[i]) - weights_[i].begin());
    for (std::size_t k = 0; k < width; ++k) out[i * width + k] = values[corners_[i][most] * width + k];
  });
  return out;
}

template <int D>
void transfer_attributes(const OutputMesh<D>& from, OutputMesh<D>& to) {
  to.point_attributes.clear();
  if (from.point_attributes.empty() || to.points.empty()) return;
  to.point_attributes = PointTransfer<D>(from, to.points)(from.point_attributes,
                                                          from.point_attributes.size() / from.points.size());
}

template <int D>
MeshFields transfer_fields(const OutputMesh<D>& from, const MeshFields& fields, const OutputMesh<D>& to) {
  std::optional<PointTransfer<D>> at_points;
  std::optional<CellTransfer<D>> on_cells;
  MeshFields out;
  for (const MeshField& field : fields) {
    MeshField& made = out.emplace_back(field);
    if (!field.of_points) {
      if (!on_cells) on_cells.emplace(from, to);
      const bool is_label = field.is_integer && field.components == 1;
      made.values = is_label ? on_cells->largest_share(field.values) : on_cells->means(field.values, field.components);
      made.is_integer = is_label;
    } else {
      if (!at_points) at_points.emplace(from, to.points);
      made.values = field.is_integer ? at_points->of_nearest_corners(field.values, field.components)
                                     : (*at_points)(field.values, field.components);
    }
  }
  return out;
}

#define PGDR_INSTANTIATE(D)                                                            \
  template class PointTransfer<D>;                                                     \
  template class CellTransfer<D>;                                                      \
  template PGDR_API void transfer_attributes<D>(const OutputMesh<D>&, OutputMesh<D>&); \
  template PGDR_API MeshFields transfer_fields<D>(const OutputMesh<D>&, const MeshFields&, const OutputMesh<D>&);
PGDR_INSTANTIATE(2)
PGDR_INSTANTIATE(3)
#undef PGDR_INSTANTIATE

}  // namespace pgdr
