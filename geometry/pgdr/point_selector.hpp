// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Where a Steiner point goes: selection disks (Def. 2.4 to 2.9 of the dissertation) and selectors. A selector is called
// concurrently from any worker, must be a deterministic function of its argument, may use TBB, may throw.
#pragma once

#include <functional>

#include "pgdr/export.hpp"
#include "pgdr/types.hpp"

namespace pgdr PGDR_API {

/// The open ball (disk) in which the theory allows a Steiner point. radius <= 0: the centre alone.
template <int D>
struct SelectionDisk {
  Point<D> center;
  double radius = 0;
};

enum class DiskType {
  type1,  ///< radius r - k l: termination (Def. 2.4, 2.7)
  type2,  ///< radius r (1 - k / bound), or r (1 - delta): termination and good grading (Def. 2.5, 2.8)
};

/// The constant k of both types: sqrt(2) in 2D, 2 in 3D; also the smallest radius-edge bound with a proof (section 2.1).
template <int D>
constexpr double smallest_proved_bound() {
  return D == 2 ? 1.4142135623730951 : 2.0;
}

struct DiskOptions {
  DiskType type = DiskType::type2;
  double delta = 0;  ///< 0: as far as the bound allows, delta = k / bound; else k / bound <= delta <= 1 (Def. 2.6, 2.9)
};

/// A poor element, as a selector sees it. An element that is only too big has a disk of radius 0.
template <int D>
struct PoorElement {
  Simplex<D> corners;  ///< in lexicographic order
  Point<D> circumcenter;
  double circumradius = 0, shortest_edge = 0;
  double radius_edge_bound = 0;
  SelectionDisk<D> disk;
  bool over_radius_edge = false;  ///< else it is only too big
};

/// @pre element fields other than `disk` are set.
template <int D>
SelectionDisk<D> selection_disk(const PoorElement<D>& element, const DiskOptions& options);

template <int D>
using PointSelector = std::function<Point<D>(const PoorElement<D>&)>;

/// What to do with a selector's point outside its disk.
enum class OutsidePolicy { replace_by_circumcenter, error };

}  // namespace pgdr
