// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Bounds, with the exact functions that the refiner uses, and the local Delaunay property of unconstrained faces.
#include "check/bounds.hpp"

#include <algorithm>
#include <cmath>

#include "numbers/exact_tests.hpp"
#include "numbers/rounding.hpp"
#include "pgdr/circumsphere.hpp"
#include "pgdr/predicates.hpp"
#include "size/region_sizes.hpp"
#include "space/bulk.hpp"

namespace pgdr::checking {
namespace {

template <int D>
void require_positive(double size, const Point<D>& x) {
  if (size > 0) return;
  std::array<double, 3> where{};
  std::copy(x.x.begin(), x.x.end(), where.begin());
  throw UsageError(
      {Errc::bad_size, "The size is " + words(size) + " at " + words(x) + "; it must be positive.", {}, 0, {}, {where}});
}

template <int D>
bool measure_over(const Simplex<D>& s, double bound) {
  return bound < std::numeric_limits<double>::infinity() && !measure_within<D>(s, bound);
}

/// The least size that applies to each cell: of all, and of its label. Functions by blocks are asked for many successive cells at
/// once; any other for each cell when its turn comes, so that a check with a slow one ends when it is stopped.
template <int D>
class Sizes {
 public:
  /// All must outlive it.
  Sizes(const OutputMesh<D>& mesh, const Links<D>& links, const CheckOptions<D>& options)
      : mesh_(mesh), links_(links), of_all_(options.size) {
    const RegionSizes<D>& sizes = options.region_sizes;
    if (sizes.empty()) return;
    std::vector<double> labels = detail::labels_of(mesh);
    detail::require_labels<D>(sizes, labels);
    for (const RegionSize<D>& s : sizes)
      if (std::none_of(of_labels_.begin(), of_labels_.end(), [&](const auto& known) { return known.label == s.label; }))
        of_labels_.push_back({s.label, detail::sizes_of_label<D>(sizes, s.label)});
  }
  /// Of a positive cell; infinity if there is none. Cells are asked for in ascending order.
  double of_cell(std::uint32_t c) {
    if (c >= first_ + sizes_.size()) look(c);
    return sizes_[c - first_];
  }

 private:
  static constexpr std::size_t most = 4096;  // cells at once

  /// Finds the sizes of cells from this one on.
  void look(std::uint32_t first) {
    first_ = first;
    const bool by_blocks = of_all_.is_by_blocks() ||
                           std::any_of(of_labels_.begin(), of_labels_.end(), [](const auto& s) { return s.size.is_by_blocks(); });
    sizes_.assign(by_blocks ? std::min(most, mesh_.cells.size() - first) : 1, std::numeric_limits<double>::infinity());
    ask(of_all_, [](std::uint32_t) { return true; });
    for (const RegionSize<D>& s : of_labels_)
      ask(s.size, [&](std::uint32_t c) { return (mesh_.regions.empty() ? 0 : mesh_.regions[c]) == s.label; });
  }
  template <class Applies>
  void ask(const SizingField<D>& field, Applies applies) {
    if (!field.bounded()) return;
    std::vector<std::uint32_t> cells;
    std::vector<Point<D>> points;
    for (std::uint32_t c = first_; c < first_ + sizes_.size(); ++c) {
      if (!links_.positive(c) || !applies(c)) continue;
      cells.push_back(c);
      points.push_back(centroid<D>(corners_of(mesh_, c)));
    }
    std::vector<double> found(points.size());
    field.at(points, found);
    for (std::size_t i = 0; i < cells.size(); ++i) {
      require_positive(found[i], points[i]);
      sizes_[cells[i] - first_] = std::min(sizes_[cells[i] - first_], found[i]);
    }
  }

  const OutputMesh<D>& mesh_;
  const Links<D>& links_;
  const SizingField<D>& of_all_;
  std::vector<RegionSize<D>> of_labels_;
  std::uint32_t first_ = 0;
  std::vector<double> sizes_;  // of cells from first_ on
};

template <int D>
bool size_over(const Simplex<D>& s, double size) {
  if constexpr (D == 2)
    return measure_over<2>(s, size);
  else
    return size < std::numeric_limits<double>::infinity() && !circumradius_within<3>(s, size);
}

bool dihedral_holds(const Simplex<2>&, double) { return true; }
bool dihedral_holds(const Simplex<3>& s, double largest_cosine) { return dihedral_within(s, largest_cosine); }

template <int D>
void report_bad_reason(const OutputMesh<D>& mesh, std::uint32_t c, const std::string& why, Findings& findings) {
  findings.add(Kind::bad_reason, {c},
               [&] { return "The reason given for " + cell_words(mesh, c) + " does not hold: " + why + "."; });
}

/// Counts a cell that is over a bound of shape (`thin`) or of size, and perhaps `below` that on dihedral angles.
template <int D>
void judge_poor_cell(const OutputMesh<D>& mesh, std::uint32_t c, bool thin, bool below, Reasons<D>& reasons, Findings& findings) {
  using Verdict = typename Reasons<D>::Verdict;
  std::string why;
  const Verdict verdict = reasons.judge(c, why);
  if (verdict == Verdict::fails) {
    report_bad_reason(mesh, c, why, findings);
  } else if (verdict == Verdict::absent) {
    findings.add(thin ? Kind::over_radius_edge : Kind::over_size, {c}, [&] {
      return "The " + cell_words(mesh, c) + " at " + words(centroid<D>(corners_of(mesh, c))) + " is over the " +
             (thin ? "radius-edge bound" : "size bound") + ", without a reason.";
    });
  } else {
    const bool excused = verdict == Verdict::holds && (!below || reasons.excuses_dihedral(c));
    ++(excused ? findings.report().explained : findings.report().unexplained);
  }
}

}  // namespace

template <int D>
void check_bounds(const OutputMesh<D>& mesh, const CheckOptions<D>& options, const Links<D>& links, const Components& components,
                  const InputVolumes<D>* input, Reasons<D>& reasons, Findings& findings) {
  CheckReport& report = findings.report();
  const double ratio = options.radius_edge_bound;
  Sizes<D> sizes(mesh, links, options);
  for (std::uint32_t c = 0; c < mesh.cells.size(); ++c) {
    findings.heed_stop();
    if (!links.positive(c)) continue;
    const Simplex<D> s = corners_of(mesh, c);
    const std::uint32_t volume = input ? components.volume[components.of_cell[c]] : none;
    const bool thin = ratio < std::numeric_limits<double>::infinity() && !radius_edge_within<D>(s, ratio);
    const bool large = size_over<D>(s, sizes.of_cell(c)) || measure_over<D>(s, options.max_measure) ||
                       (volume != none && options.seed_sizes && measure_over<D>(s, input->volumes()[volume].size));
    const bool below = !dihedral_holds(s, options.largest_cosine);
    report.over_radius_edge += thin;
    report.over_size += large;
    report.below_dihedral += below;
    if (thin || large) {
      judge_poor_cell(mesh, c, thin, below, reasons, findings);
      continue;
    }
    if (below) ++(reasons.excuses_dihedral(c) ? report.explained : report.unexplained);
    if (std::string why; reasons.misstates_angle(c, why)) report_bad_reason(mesh, c, why, findings);
  }
}

template <int D>
void check_delaunay(const OutputMesh<D>& mesh, const Links<D>& links, std::span<const double> slack,
                    std::span<const std::uint8_t> refused, std::uint64_t left, Findings& findings) {
  CheckReport& report = findings.report();
  std::vector<std::uint32_t> unexplained;  // faces
  const auto touches_refused = [&](std::uint32_t cell) {
    const auto& v = mesh.cells[cell];
    return !refused.empty() && std::any_of(v.begin(), v.end(), [&](std::uint32_t u) { return refused[u]; });
  };
  for (std::uint32_t face = 0; face < links.neighbour.size(); ++face) {
    findings.heed_stop();
    const std::uint32_t back = links.neighbour[face], cell = face / (D + 1), other = back / (D + 1);
    if (back == none || back < face || links.is_wall(face) || !links.positive(cell) || !links.positive(other)) continue;
    const std::uint32_t apex = mesh.cells[other][back % (D + 1)];
    const Simplex<D> s = corners_of(mesh, cell);
    if (in_sphere<D>(s, mesh.points[apex]) != Sign::positive) continue;
    std::array<double, D + 2> delta;
    for (int i = 0; i <= D; ++i) delta[i] = slack[mesh.cells[cell][i]];
    delta[D + 1] = slack[apex];
    if (rounding_cancels<D>(s, mesh.points[apex], delta)) {
      ++report.not_delaunay_rounding;
    } else if (touches_refused(cell) || touches_refused(other)) {
      ++report.not_delaunay_refused;
    } else {
      unexplained.push_back(face);
    }
  }
  if (unexplained.size() + report.not_delaunay_refused <= left) {
    report.not_delaunay_unexplained = unexplained.size();
    return;
  }
  for (const std::uint32_t face : unexplained) {
    const std::uint32_t back = links.neighbour[face], cell = face / (D + 1), other = back / (D + 1);
    findings.add(Kind::not_delaunay, {cell, other}, [&] {
      return "The " + vertex_words(mesh, mesh.cells[other][back % (D + 1)]) + " of cell " + std::to_string(other) +
             " lies inside the circumsphere of its neighbour " + cell_words(mesh, cell) + ".";
    });
  }
}

template <int D>
double largest_coordinate(const OutputMesh<D>& mesh) {
  double largest = 0;
  for (const Point<D>& p : mesh.points)
    for (const double x : p.x) largest = std::max(largest, std::abs(x));
  return largest;
}

template <int D>
std::vector<double> slack_of_vertices(const OutputMesh<D>& mesh, int ulps) {
  const double width = ulps * rounding::ulp * largest_coordinate(mesh);
  std::vector<double> slack = detail::vector_of_capacity<double>(mesh.points.size());
  slack.resize(mesh.points.size(), 0);
  const auto mark = [&](const auto& constraints, int aligned_axes) {
    for (const auto& constraint : constraints) {
      const auto& v = constraint.vertices;
      int equal = 0;
      for (int i = 0; i < D; ++i) {
        const double first = mesh.points[v[0]][i];
        equal += std::all_of(v.begin(), v.end(), [&](std::uint32_t u) { return mesh.points[u][i] == first; });
      }
      if (equal >= aligned_axes) continue;
      for (const std::uint32_t u : v) slack[u] = width;
    }
  };
  mark(mesh.subsegments, D - 1);
  mark(mesh.subfacets, 1);
  return slack;
}

#define PGDR_INSTANTIATE(D)                                                                                                   \
  template void check_bounds(const OutputMesh<D>&, const CheckOptions<D>&, const Links<D>&, const Components&,                \
                             const InputVolumes<D>*, Reasons<D>&, Findings&);                                                 \
  template void check_delaunay(const OutputMesh<D>&, const Links<D>&, std::span<const double>, std::span<const std::uint8_t>, \
                               std::uint64_t, Findings&);                                                                     \
  template double largest_coordinate(const OutputMesh<D>&);                                                                   \
  template std::vector<double> slack_of_vertices(const OutputMesh<D>&, int);
PGDR_INSTANTIATE(2)
PGDR_INSTANTIATE(3)
#undef PGDR_INSTANTIATE

}  // namespace pgdr::checking
