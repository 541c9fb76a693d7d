// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Where a Steiner point goes: selection disks (Def. 2.4 to 2.9 of the dissertation) and selectors. A selector is called
// concurrently from any worker, must be a deterministic function of its argument, may use TBB, may throw.
#pragma once

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <functional>
#include <initializer_list>
#include <limits>
#include <memory>
#include <span>
#include <stdexcept>
#include <type_traits>
#include <utility>
#include <vector>

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

/// Where the points of one poor element go: the first in its selection disk, others, if there are any, inside its circumsphere.
/// These are *further points*: each goes in behind the first, in their order, if it is as far from all vertices that are there by
/// then as every point of the disk is from the element's (docs/selectors.md, "Several points"), and is left out if not. Converts
/// from a point. Copies are independent; const calls are safe from several threads.
template <int D>
class SelectedPoints {
 public:
  static constexpr std::size_t most = 8;  ///< points of one element

  SelectedPoints() = default;                                  ///< none: as a point outside of the disk
  SelectedPoints(const Point<D>& p) : points_{p}, size_(1) {}  ///< one
  /// As many as `most` of them. @throws std::length_error
  SelectedPoints(std::initializer_list<Point<D>> points) {
    for (const Point<D>& p : points) push_back(p);
  }

  /// Adds one behind the others. @throws std::length_error beyond `most`
  void push_back(const Point<D>& p) {
    if (size_ == most) throw std::length_error("a selector puts eight points or fewer into an element");
    points_[size_++] = p;
  }
  void clear() { size_ = 0; }                                             ///< none are left
  std::size_t size() const { return size_; }                              ///< so many points
  bool empty() const { return size_ == 0; }                               ///< are there none?
  const Point<D>& operator[](std::size_t i) const { return points_[i]; }  ///< the i-th. @pre i < size()
  const Point<D>* begin() const { return points_.data(); }                ///< the first
  const Point<D>* end() const { return points_.data() + size_; }          ///< behind the last
  /// The first; of none one of NaN, which is in no disk.
  Point<D> first() const { return size_ > 0 ? points_[0] : nowhere(); }
  /// A point of NaN.
  static Point<D> nowhere() {
    Point<D> p;
    p.x.fill(std::numeric_limits<double>::quiet_NaN());
    return p;
  }

 private:
  std::array<Point<D>, most> points_;
  std::size_t size_ = 0;
};

/// Where the points of many poor elements go: puts that of elements[i] into points[i], for all i, and keeps neither span. Each
/// must be a function of its element alone, whatever block the element is in, and of elements that are never treated too: a visit
/// asks for the element that is next together with those that wait behind it, and some of these go before their turn. It is
/// called concurrently from any worker, with one element or more: it must be deterministic and thread-safe, may throw. What it
/// leaves unset is NaN, which is in no disk.
template <int D>
using SelectorBlock = std::function<void(std::span<const PoorElement<D>> elements, std::span<Point<D>> points)>;

/// The same for selectors of several points. What it leaves as it is has none, as a point outside of the disk.
template <int D>
using SeveralSelectorBlock = std::function<void(std::span<const PoorElement<D>> elements, std::span<SelectedPoints<D>> points)>;

/// Where the point of a poor element goes. Holds any `Point<D>(const PoorElement<D>&)`, or, to look at the mesh about the
/// element, `Point<D>(const PoorElement<D>&, Neighborhood<D>&)`; either may return `SelectedPoints<D>`, up to eight. Empty: the
/// circumcentre. See selectors.hpp for those that come with the library.
template <int D>
class PointSelector {
 public:
  PointSelector() = default;        ///< empty: circumcentres
  PointSelector(std::nullptr_t) {}  ///< empty
  /// Holds a copy of f, which is called from several threads at once; empty if f is an empty std::function.
  template <class F>
  requires(!std::same_as<std::remove_cvref_t<F>, PointSelector> &&
           (std::is_invocable_r_v<SelectedPoints<D>, std::decay_t<F>&, const PoorElement<D>&> ||
            std::is_invocable_r_v<SelectedPoints<D>, std::decay_t<F>&, const PoorElement<D>&, Neighborhood<D>&> ||
            std::is_invocable_r_v<Point<D>, std::decay_t<F>&, const PoorElement<D>&> ||
            std::is_invocable_r_v<Point<D>, std::decay_t<F>&, const PoorElement<D>&, Neighborhood<D>&>)) PointSelector(F&& f) {
    using Function = std::decay_t<F>&;
    using Element = const PoorElement<D>&;
    if constexpr (std::is_invocable_r_v<Point<D>, Function, Element>)
      hold_simple(call_, std::function<Point<D>(Element)>(std::forward<F>(f)));
    else if constexpr (std::is_invocable_r_v<Point<D>, Function, Element, Neighborhood<D>&>)
      call_ = std::forward<F>(f);
    else if constexpr (std::is_invocable_r_v<SelectedPoints<D>, Function, Element>)
      hold_simple(several_, std::function<SelectedPoints<D>(Element)>(std::forward<F>(f)));
    else
      several_ = std::forward<F>(f);
  }

  /// A function that is asked by blocks; empty if it is empty. It makes the mesh that the same function makes element by element.
  static PointSelector by_blocks(SelectorBlock<D> block) {
    PointSelector selector;
    if (!block) return selector;
    selector.block_ = std::make_shared<const SelectorBlock<D>>(std::move(block));
    selector.call_ = [block = selector.block_](const PoorElement<D>& element, Neighborhood<D>&) {
      Point<D> point = SelectedPoints<D>::nowhere();
      (*block)({&element, 1}, {&point, 1});
      return point;
    };
    return selector;
  }
  /// The same of several points each.
  static PointSelector by_blocks_of_several(SeveralSelectorBlock<D> block) {
    PointSelector selector;
    if (!block) return selector;
    selector.several_block_ = std::make_shared<const SeveralSelectorBlock<D>>(std::move(block));
    selector.several_ = [block = selector.several_block_](const PoorElement<D>& element, Neighborhood<D>&) {
      SelectedPoints<D> points;
      (*block)({&element, 1}, {&points, 1});
      return points;
    };
    return selector;
  }

  explicit operator bool() const { return call_ || several_; }        ///< is there a function?
  bool is_by_blocks() const { return block_ || several_block_; }      ///< is it to be asked for many elements at once?
  bool is_of_several() const { return static_cast<bool>(several_); }  ///< may it put several points into an element?
  /// Where the function puts the (first) point; throws what it throws. @pre not empty.
  Point<D> operator()(const PoorElement<D>& element, Neighborhood<D>& neighborhood) const {
    return call_ ? call_(element, neighborhood) : several_(element, neighborhood).first();
  }
  /// Where it puts all; throws what it throws. @pre not empty
  SelectedPoints<D> all(const PoorElement<D>& element, Neighborhood<D>& neighborhood) const {
    return several_ ? several_(element, neighborhood) : SelectedPoints<D>(call_(element, neighborhood));
  }
  /// Where it puts the (first) points of the elements, asked as one block; throws what it throws. @pre is_by_blocks(); as many
  /// points
  void operator()(std::span<const PoorElement<D>> elements, std::span<Point<D>> points) const {
    std::fill(points.begin(), points.end(), SelectedPoints<D>::nowhere());
    if (block_) return (*block_)(elements, points);
    std::vector<SelectedPoints<D>> several(elements.size());
    (*several_block_)(elements, several);
    for (std::size_t i = 0; i < points.size(); ++i) points[i] = several[i].first();
  }
  /// The same with all points of each.
  void all(std::span<const PoorElement<D>> elements, std::span<SelectedPoints<D>> points) const {
    std::fill(points.begin(), points.end(), SelectedPoints<D>());
    if (several_block_) return (*several_block_)(elements, points);
    std::vector<Point<D>> one(elements.size(), SelectedPoints<D>::nowhere());
    (*block_)(elements, one);
    std::copy(one.begin(), one.end(), points.begin());
  }

 private:
  template <class Result>
  static void hold_simple(std::function<Result(const PoorElement<D>&, Neighborhood<D>&)>& to,
                          std::function<Result(const PoorElement<D>&)> f) {
    if (f) to = [f = std::move(f)](const PoorElement<D>& e, Neighborhood<D>&) { return f(e); };
  }

  // Of the first two one is set, or none; of the others that of the same kind, if it is asked by blocks.
  std::function<Point<D>(const PoorElement<D>&, Neighborhood<D>&)> call_;
  std::function<SelectedPoints<D>(const PoorElement<D>&, Neighborhood<D>&)> several_;
  std::shared_ptr<const SelectorBlock<D>> block_;
  std::shared_ptr<const SeveralSelectorBlock<D>> several_block_;
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
