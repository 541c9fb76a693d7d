// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Where a Steiner point goes: selection disks (Def. 2.4 to 2.9 of the dissertation) and selectors. A selector is called
// concurrently from any worker, must be a deterministic function of its argument, may use TBB, may throw.
#pragma once

#include <algorithm>
#include <concepts>
#include <cstddef>
#include <functional>
#include <limits>
#include <memory>
#include <span>
#include <type_traits>
#include <utility>

#include "pgdr/export.hpp"
#include "pgdr/types.hpp"

namespace pgdr PGDR_API {

/// The open ball (disk) in which a Steiner point may lie. radius <= 0: the centre alone.
template <int D>
struct SelectionDisk {
  Point<D> center;    ///< the circumcentre
  double radius = 0;  ///< in units of the input
};

/// Is p strictly inside? In doubles, as the refinement asks.
template <int D>
constexpr bool inside(const SelectionDisk<D>& disk, const Point<D>& p) {
  return disk.radius > 0 && squared_distance(p, disk.center) < disk.radius * disk.radius;
}

/// How large the disk of an element is: circumradius r, shortest edge l.
enum class DiskType {
  type1,  ///< radius r - k l: termination (Def. 2.4, 2.7); below the smallest proved bound the insertion rule sees to that
  type2,  ///< radius r (1 - k / bound), or r (1 - delta): termination and good grading (Def. 2.5, 2.8)
};

/// The constant k of both types: sqrt(2) in 2D, 2 in 3D; also the smallest radius-edge bound with a proof (section 2.1).
template <int D>
constexpr double smallest_proved_bound() {
  return D == 2 ? 1.4142135623730951 : 2.0;
}

/// Which disk, and how large.
struct DiskOptions {
  DiskType type = DiskType::type2;  ///< type 1 is the larger; type 2 grades well, too
  double delta = 0;  ///< 0: as far as the bound allows, delta = k / bound; else k / bound <= delta <= 1 (Def. 2.6, 2.9)
};

/// A poor element, as a selector sees it. An element that is only too big has a disk of radius 0.
template <int D>
struct PoorElement {
  Simplex<D> corners;             ///< in lexicographic order
  Point<D> circumcenter;          ///< rounded
  double circumradius = 0;        ///< rounded; lengths in units of the input
  double shortest_edge = 0;       ///< its length, rounded
  double radius_edge_bound = 0;   ///< RefineOptions::radius_edge_bound
  SelectionDisk<D> disk;          ///< where the point may be
  bool over_radius_edge = false;  ///< else it is only too big
};

/// The disk of an element. @pre element fields other than `disk` are set.
template <int D>
SelectionDisk<D> selection_disk(const PoorElement<D>& element, const DiskOptions& options);

/// What the insertion of a candidate point would do.
template <int D>
struct Preview {
  /// Whether there is an answer.
  enum class Status {
    possible,    ///< all that is below is set
    encroaches,  ///< an entity would be split instead; the numbers of cells are those that the point itself would delete
    impossible,  ///< not inside the element's circumsphere, or its star could not be made
    unknown,     ///< the visit's claim ends before the answer: what the selector returns now is not used, it is asked again
  };
  Status status = Status::unknown;  ///< what of the rest is set
  int poor = 0;                     ///< cells deleted that are over a bound
  int good = 0;                     ///< cells deleted that are within their bounds
  /// Cosine of the smallest angle (2D) or dihedral angle (3D) of all cells made: 1 for a flat one. By correctly rounded
  /// operations alone, so that a choice by it is the same everywhere. Set by `Neighborhood::measure`.
  double sharpest_cosine = 1;
};

/// The mesh about a poor element, while its selector runs: to be asked by the selector's thread, during the call.
/// A question costs about as much as the insertion itself.
template <int D>
class Neighborhood {
 public:
  /// Which cells would be deleted.
  virtual Preview<D> count(const Point<D>& candidate) = 0;
  /// That, and the angles of the cells that would be made.
  virtual Preview<D> measure(const Point<D>& candidate) = 0;

 protected:
  ~Neighborhood() = default;
};

/// Where the points of many poor elements go: puts that of elements[i] into points[i], for all i, and keeps neither span. Each
/// must be a function of its element alone, whatever block the element is in, and of elements that are never treated too: a visit
/// asks for the element that is next together with those that wait behind it, and some of these go before their turn. It is
/// called concurrently from any worker, with one element or more: it must be deterministic and thread-safe, may throw. What it
/// leaves unset is NaN, which is in no disk.
template <int D>
using SelectorBlock = std::function<void(std::span<const PoorElement<D>> elements, std::span<Point<D>> points)>;

/// Where the point of a poor element goes. Holds any `Point<D>(const PoorElement<D>&)`, or, to look at the mesh about the
/// element, `Point<D>(const PoorElement<D>&, Neighborhood<D>&)`; empty: the circumcentre. See selectors.hpp for those that
/// come with the library.
template <int D>
class PointSelector {
 public:
  PointSelector() = default;        ///< empty: circumcentres
  PointSelector(std::nullptr_t) {}  ///< empty
  /// Holds a copy of f, which is called from several threads at once; empty if f is an empty std::function.
  template <class F>
  requires(!std::same_as<std::remove_cvref_t<F>, PointSelector> &&
           (std::is_invocable_r_v<Point<D>, std::decay_t<F>&, const PoorElement<D>&> ||
            std::is_invocable_r_v<Point<D>, std::decay_t<F>&, const PoorElement<D>&, Neighborhood<D>&>)) PointSelector(F&& f) {
    if constexpr (std::is_invocable_r_v<Point<D>, std::decay_t<F>&, const PoorElement<D>&>) {
      std::function<Point<D>(const PoorElement<D>&)> simple(std::forward<F>(f));
      if (simple) call_ = [simple = std::move(simple)](const PoorElement<D>& e, Neighborhood<D>&) { return simple(e); };
    } else {
      call_ = std::forward<F>(f);
    }
  }

  /// A function that is asked by blocks; empty if it is empty. It makes the mesh that the same function makes element by element.
  static PointSelector by_blocks(SelectorBlock<D> block) {
    PointSelector selector;
    if (!block) return selector;
    selector.block_ = std::make_shared<const SelectorBlock<D>>(std::move(block));
    selector.call_ = [block = selector.block_](const PoorElement<D>& element, Neighborhood<D>&) {
      Point<D> point = unset();
      (*block)({&element, 1}, {&point, 1});
      return point;
    };
    return selector;
  }

  explicit operator bool() const { return static_cast<bool>(call_); }  ///< is there a function?
  bool is_by_blocks() const { return block_ != nullptr; }              ///< is it to be asked for many elements at once?
  /// Where the function puts the point; throws what it throws. @pre not empty.
  Point<D> operator()(const PoorElement<D>& element, Neighborhood<D>& neighborhood) const { return call_(element, neighborhood); }
  /// Where it puts the points of the elements, asked as one block; throws what it throws. @pre is_by_blocks(); as many points
  void operator()(std::span<const PoorElement<D>> elements, std::span<Point<D>> points) const {
    std::fill(points.begin(), points.end(), unset());
    (*block_)(elements, points);
  }

 private:
  static Point<D> unset() {
    Point<D> point;
    point.x.fill(std::numeric_limits<double>::quiet_NaN());
    return point;
  }

  std::function<Point<D>(const PoorElement<D>&, Neighborhood<D>&)> call_;
  std::shared_ptr<const SelectorBlock<D>> block_;  ///< null: asked element by element
};

/// The default of RefineOptions: in 2D off-centres (`off_center<2>()` of selectors.hpp), in disks of type 1, which make fewer
/// triangles than circumcentres on nearly every input, whatever the bound; in 3D circumcentres.
template <int D>
PointSelector<D> default_selector();
/// The disk for it.
template <int D>
constexpr DiskOptions default_disk() {
  return {D == 2 ? DiskType::type1 : DiskType::type2, 0};
}

/// What to do with a selector's point outside its disk.
enum class OutsidePolicy { replace_by_circumcenter, error };

}  // namespace pgdr
