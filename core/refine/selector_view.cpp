// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "refine/selector_view.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>

#include "numbers/vectors.hpp"
#include "refine/encroachment.hpp"
#include "refine/visibility.hpp"

namespace pgdr {
namespace {

using detail::cross;
using detail::difference;
using detail::dot;

/// The largest cosine of an angle between two of the faces, from vectors normal to them that point all outwards or all
/// inwards. 1 where one has no length.
template <int D>
double largest_cosine(const std::array<std::array<double, D>, D + 1>& normal) {
  double largest = -1;
  for (int i = 0; i <= D; ++i)
    for (int j = i + 1; j <= D; ++j) {
      const double lengths = std::sqrt(dot(normal[i], normal[i])) * std::sqrt(dot(normal[j], normal[j]));
      largest = std::max(largest, lengths > 0 ? -dot(normal[i], normal[j]) / lengths : 1);
    }
  return largest;
}

/// The cosine of the smallest (dihedral) angle; corners in lexicographic order.
template <int D>
double sharpest_cosine(const Simplex<D>& s) {
  const auto u = difference(s[1], s[0]), v = difference(s[2], s[0]);
  if constexpr (D == 2) {
    const auto w = difference(s[2], s[1]);
    return largest_cosine<2>({{{-u[1], u[0]}, {-w[1], w[0]}, {v[1], -v[0]}}});
  } else {
    const auto w = difference(s[3], s[0]);
    const auto a = cross(u, v), b = cross(v, w), c = cross(w, u), d = cross(difference(s[3], s[1]), difference(s[2], s[1]));
    return largest_cosine<3>({a, b, c, d});
  }
}

/// What a selector may ask. Collects in the worker's own cavity, which is empty while a selector runs, so that it obeys the claim
/// as an insertion does: where that would step on from a cell that the visit does not own, there is no answer, now or to later
/// questions.
template <int D>
class View final : public Neighborhood<D> {
 public:
  using Status = typename Preview<D>::Status;

  View(Workspace<D>& workspace, CellId seed, const SelectionDisk<D>& disk) : w_(&workspace), seed_(seed), disk_(disk) {}

  Preview<D> count(const Point<D>& p) override {
    const Preview<D> preview = collect(p);
    w_->cavity.release();
    return preview;
  }

  Preview<D> measure(const Point<D>& p) override {
    using Collected = typename Cavity<D>::Status;
    Preview<D> preview = collect(p);
    Cavity<D>& cavity = w_->cavity;
    if (preview.status == Status::possible) {
      const Collected status = cavity.make_star_shaped();
      if (status != Collected::ok) preview.status = status == Collected::not_owned ? end() : Status::impossible;
    }
    if (preview.status == Status::possible) preview.sharpest_cosine = sharpest_made(p);
    cavity.release();
    return preview;
  }

  bool ended() const { return ended_; }

 private:
  Status end() {
    ended_ = true;
    return Status::unknown;
  }

  Preview<D> collect(const Point<D>& p) {
    using Collected = typename Cavity<D>::Status;
    Preview<D> preview;
    if (ended_) return preview;
    preview.status = Status::impossible;
    if (!(p == disk_.center) && !inside(disk_, p)) return preview;
    Cavity<D>& cavity = w_->cavity;
    const Collected status = cavity.collect(p, seed_);
    if (status == Collected::not_owned) preview.status = end();
    if (status != Collected::ok) return preview;
    for (const CellId c : cavity.cells()) ++(w_->context.bounds.test(w_->mesh, c) ? preview.poor : preview.good);
    preview.status = encroached_entity<D>(w_->context, cavity, p) || wall_that_hides<D>(*w_, seed_, p) ? Status::encroaches
                                                                                                       : Status::possible;
    return preview;
  }

  double sharpest_made(const Point<D>& p) const {
    const Mesh<D>& mesh = w_->mesh;
    double largest = -1;
    for (const auto& f : w_->cavity.boundary()) {
      Simplex<D> s = mesh.simplex(f.cell);
      s[f.face] = p;
      std::sort(s.begin(), s.end(), lex_less<D>);
      largest = std::max(largest, sharpest_cosine<D>(s));
    }
    return largest;
  }

  Workspace<D>* w_;
  CellId seed_;
  const SelectionDisk<D>& disk_;
  bool ended_ = false;
};

/// What the selector is told of a cell over the radius-edge bound: a function of the cell alone.
template <int D>
PoorElement<D> poor_element(const Workspace<D>& w, CellId c, const Point<D>& center) {
  PoorElement<D> element;
  element.corners = w.mesh.simplex(c);
  std::sort(element.corners.begin(), element.corners.end(), lex_less<D>);
  element.circumcenter = center;
  element.circumradius = std::sqrt(squared_distance(center, element.corners[0]));
  element.shortest_edge = std::sqrt(shortest_edge_squared<D>(element.corners));
  element.radius_edge_bound = w.options.radius_edge_bound;
  element.over_radius_edge = true;
  element.disk = selection_disk<D>(element, w.options.disk);
  return element;
}

}  // namespace

/// Adds the element to what is asked for, if it may come to its turn: if the visit owns it, which others may not change then, and
/// the selector is asked for such. One whose circumcentre takes exact arithmetic is asked for when it is next.
template <int D>
void SelectorAnswers<D>::add(const Workspace<D>& w, const Entry<D>& e) {
  const Mesh<D>& mesh = w.mesh;
  std::array<VertexId, D + 1> vertices;
  if (e.kind() != EntryKind::cell || has(e) || !mesh.read_vertices(e.cell, e.birth, vertices)) return;
  if (w.visit->area && !w.visit->area->owns(mesh, vertices)) return;
  const FilterSphere<D> sphere = mesh.sphere(e.cell);
  if (!mesh.is_accurate(sphere)) return;
  if (e.which() != Entry<D>::over_radius_edge && !w.context.bounds.over_radius_edge(mesh, e.cell)) return;
  entries_.push_back(e);
  elements_.push_back(poor_element<D>(w, e.cell, sphere.center));
}

template <int D>
void SelectorAnswers<D>::ask(const Workspace<D>& w, const Entry<D>& next, const PoorElement<D>& element) {
  entries_.assign(1, next);
  elements_.assign(1, element);
  const auto add_too = [&](const Entry<D>& e) {
    if (entries_.size() < most) add(w, e);
  };
  if (std::exchange(is_first_, false)) std::for_each(w.visit->given.begin(), w.visit->given.end(), add_too);
  if (w.visit->treat_list) w.visit->list->for_next(next, most, add_too);
  points_.resize(elements_.size());
  w.options.selector.all(std::span<const PoorElement<D>>(elements_), std::span<SelectedPoints<D>>(points_));
  if (answers_.size() >= 2 * most) drop_dead(w.mesh);
  for (std::size_t i = 0; i < entries_.size(); ++i)
    answers_.insert_or_assign(index(entries_[i].cell), Answer{entries_[i].birth, points_[i]});
}

/// Forgets the answers to elements that are gone.
template <int D>
void SelectorAnswers<D>::drop_dead(const Mesh<D>& mesh) {
  std::erase_if(answers_, [&](const auto& a) { return mesh.birth(CellId{a.first}) != a.second.birth; });
}

template <int D>
const SelectedPoints<D>& SelectorAnswers<D>::points_of(const Workspace<D>& w, const Entry<D>& e, const PoorElement<D>& element) {
  if (!has(e)) ask(w, e, element);
  return answers_.find(index(e.cell))->second.points;
}

template <int D>
std::optional<Point<D>> selected_point(Workspace<D>& w, SelectorAnswers<D>& answers, const Entry<D>& e, const Point<D>& center,
                                       FurtherPoints<D>& further) {
  const PoorElement<D> element = poor_element<D>(w, e.cell, center);
  const auto is_fit = [&](const Point<D>& p) { return p == center || inside(element.disk, p); };
  const auto take_all = [&](const SelectedPoints<D>& points) {
    if (is_fit(points.first())) further.take(points, element);
    return points.first();
  };
  Point<D> p;
  if (w.options.selector.is_by_blocks()) {
    p = take_all(answers.points_of(w, e, element));
  } else {
    View<D> view(w, e.cell, element.disk);
    p = w.options.selector.is_of_several() ? take_all(w.options.selector.all(element, view)) : w.options.selector(element, view);
    if (view.ended()) return std::nullopt;
  }
  if (is_fit(p)) return p;
  if (w.options.outside == OutsidePolicy::error) {
    Diagnostic d{Errc::bad_option, "the selector returned a point outside the selection disk", {}, 0, {}, {}};
    for (const Point<D>& q : {p, element.disk.center}) d.points.push_back({q[0], q[1], D == 3 ? q[D - 1] : 0.0});
    throw UsageError(std::move(d));
  }
  ++w.visit->counts.selector_outside;
  return center;
}

template class SelectorAnswers<2>;
template class SelectorAnswers<3>;
template std::optional<Point<2>> selected_point(Workspace<2>&, SelectorAnswers<2>&, const Entry<2>&, const Point<2>&,
                                                FurtherPoints<2>&);
template std::optional<Point<3>> selected_point(Workspace<3>&, SelectorAnswers<3>&, const Entry<3>&, const Point<3>&,
                                                FurtherPoints<3>&);

}  // namespace pgdr
