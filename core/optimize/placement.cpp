// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "optimize/placement.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "numbers/vectors.hpp"
#include "optimize/numbers.hpp"

namespace pgdr {
namespace {

double height_over_base(const Star::Cell& cell, const Point3& x, detail::Vector<3>& normal) {
  using detail::difference;
  normal = detail::cross(difference<3>(cell.base[1], cell.base[0]), difference<3>(cell.base[2], cell.base[0]));
  const double length = std::sqrt(detail::dot(normal, normal));
  for (double& n : normal) n /= length;
  return detail::dot(normal, difference<3>(x, cell.base[0]));
}

/// The distance of the vertex from the nearest other one of its cells.
double shortest_arm(const Star& star) {
  double least = std::numeric_limits<double>::infinity();
  for (const auto& cell : star.cells)
    for (const Point3& p : cell.base) least = std::min(least, squared_distance<3>(p, star.vertex));
  return std::sqrt(least);
}

/// What is left of a gradient for a vertex that is bound to a plane or a line.
void project(const Star& star, std::array<double, 3>& g) {
  if (star.freedom == 3) return;
  const double along = detail::dot(g, star.axis);
  for (int i = 0; i < 3; ++i) g[i] = star.freedom == 2 ? g[i] - along * star.axis[i] : along * star.axis[i];
}

/// The terms that hold a step, and their weights, of which the sum is 1.
class Holding {
 public:
  using Term = CellQuality::Term;

  void begin(const Term& t) {
    n_ = 1;
    terms_[0] = &t;
    weights_[0] = 1;
  }
  detail::Vector<3> step(double trust) const {
    detail::Vector<3> s{};
    for (int k = 0; k < n_; ++k)
      for (int i = 0; i < 3; ++i) s[i] += trust * weights_[k] * terms_[k]->gradient[i];
    return s;
  }
  double gain(double worst, const detail::Vector<3>& s) const {
    return terms_[0]->value - worst + detail::dot(terms_[0]->gradient, s);
  }
  /// Makes a term that is less hold, too. False if rounding forbids it.
  bool add(const Term& t, double trust);

 private:
  /// How the step changes as the weight of t grows, in units of the trust, and the weights.
  detail::Vector<3> growth(const Term& t, std::array<double, 4>& of_weights) const;

  int n_ = 0;
  std::array<const Term*, 4> terms_;
  std::array<double, 4> weights_;
};

detail::Vector<3> Holding::growth(const Term& t, std::array<double, 4>& of_weights) const {
  // What is orthogonal to all differences of the gradients that hold: along it their terms stay equal.
  detail::Vector<3> rest = detail::difference<3>({t.gradient}, {terms_[0]->gradient});
  std::array<detail::Vector<3>, 3> base;  // orthogonal
  double factors[3][3], of_rest[3];
  for (int k = 0; k + 1 < n_; ++k) {
    base[k] = detail::difference<3>({terms_[k + 1]->gradient}, {terms_[0]->gradient});
    for (int l = 0; l < k; ++l) {
      factors[l][k] = detail::dot(base[l], base[k]) / detail::dot(base[l], base[l]);
      for (int i = 0; i < 3; ++i) base[k][i] -= factors[l][k] * base[l][i];
    }
    of_rest[k] = detail::dot(base[k], rest) / detail::dot(base[k], base[k]);
    for (int i = 0; i < 3; ++i) rest[i] -= of_rest[k] * base[k][i];
  }
  of_weights[0] = -1;
  for (int k = n_ - 2; k >= 0; --k) {
    double x = of_rest[k];
    for (int l = k + 1; l + 1 < n_; ++l) x += factors[k][l] * of_weights[l + 1];
    of_weights[k + 1] = -x;
    of_weights[0] += x;
  }
  return rest;
}

bool Holding::add(const Term& t, double trust) {
  constexpr double independent = 1e-10;  // a change that is so small a part of the difference is its rounding
  for (double weight = 0;;) {
    std::array<double, 4> of_weights;
    const detail::Vector<3> rest = growth(t, of_weights), d = detail::difference<3>({t.gradient}, {terms_[0]->gradient});
    const double rest2 = detail::dot(rest, rest);
    const bool ends = n_ < 4 && rest2 > independent * independent * detail::dot(d, d);
    // Here the weight is where the terms that hold are more than t by `gap`.
    detail::Vector<3> s = step(trust);
    for (int i = 0; i < 3; ++i) s[i] += trust * weight * t.gradient[i];
    const double gap = terms_[0]->value - t.value - detail::dot(d, s);
    double part = ends ? std::max(gap, 0.0) / (trust * rest2) : std::numeric_limits<double>::infinity();
    int out = -1;
    for (int k = 0; k < n_; ++k)
      if (of_weights[k] < 0 && weights_[k] < -of_weights[k] * part) {
        part = weights_[k] / -of_weights[k];
        out = k;
      }
    if (!std::isfinite(part)) return false;
    weight += part;
    for (int k = 0; k < n_; ++k) weights_[k] += part * of_weights[k];
    if (out < 0) {
      terms_[n_] = &t;
      weights_[n_++] = weight;
      return true;
    }
    --n_;
    for (int k = out; k < n_; ++k) {
      terms_[k] = terms_[k + 1];
      weights_[k] = weights_[k + 1];
    }
    if (n_ == 0) {
      begin(t);
      return true;
    }
  }
}

}  // namespace

std::optional<Point3> Placement::find(const Star& star, const CellQuality& quality) {
  star_ = &star;
  quality_ = &quality;
  x_ = star.vertex;
  rated_.clear();
  for (std::uint32_t i = 0; i < star.cells.size(); ++i) rated_.push_back({0, i});
  measure(false);
  const double before = least_;
  if (rated_.empty() || before >= 1) return std::nullopt;
  if (before == 0) {
    if (!ascend(true)) return std::nullopt;
    measure(false);
  }
  if (least_ > 0 && least_ < 1) ascend(false);
  if (!(least_ > before * (1 + numbers::least_placement_gain))) return std::nullopt;
  return x_;
}

/// Rates all cells where the vertex is.
void Placement::measure(bool heights) {
  for (Rated& r : rated_) r.value = value_at(r, x_, heights, 0);
  std::sort(rated_.begin(), rated_.end(), worse);
  least_ = rated_.empty() ? 1 : rated_[0].value;
}

double Placement::value_at(const Rated& r, const Point3& x, bool heights, double enough) const {
  const Star::Cell& cell = star_->cells[r.cell];
  if (!heights) {
    const double q = quality_->of({cell.base[0], cell.base[1], cell.base[2], x}, cell.region, enough);
    return q > 0 ? q : 0;  // never NaN
  }
  detail::Vector<3> normal;
  const double height = height_over_base(cell, x, normal);
  return height == height ? height : -std::numeric_limits<double>::infinity();
}

/// Takes steps from the best place so far as long as they help. By heights it ends as soon as all cells have a quality.
bool Placement::ascend(bool heights) {
  if (heights) measure(true);
  if (!std::isfinite(least_)) return false;
  double trust = 0;  // a step is that times a mean of gradients
  for (int round = 0; round < numbers::most_placement_rounds; ++round) {
    if (!try_steps(heights, trust)) break;
    if (!heights && least_ >= 1) break;
    if (heights && least_ > 0) {
      measure(false);
      if (least_ > 0) return true;
      measure(true);
    }
  }
  return !heights;
}

/// One step from the best place so far, if there is one that helps.
bool Placement::try_steps(bool heights, double& trust) {
  terms_.clear();
  modelled_ = 0;
  const double enough = heights ? least_ : numbers::share_of_cells * least_;
  while (modelled_ < rated_.size() && (modelled_ == 0 || rated_[modelled_].value <= enough)) model(modelled_, heights);
  if (terms_.empty()) return false;
  if (trust == 0) {
    // No step is longer than the trust times the longest gradient: at first, half the way to the nearest vertex.
    double steepest = 0;
    for (const Term& t : terms_) steepest = std::max(steepest, detail::dot(t.gradient, t.gradient));
    if (!(steepest > 0)) return false;
    trust = shortest_arm(*star_) / (2 * std::sqrt(steepest));
  }
  for (int halving = 0; halving <= numbers::most_step_halvings;) {
    const Direction s = step(trust);
    Point3 x = x_;
    for (int i = 0; i < 3; ++i) x[i] += s[i];
    if (star_->onto_entity) x = star_->onto_entity(x);
    if (x == x_ || (!heights && gain_ < numbers::least_step_gain * least_)) return false;
    std::size_t stopped_by = 0;
    if (try_place(x, heights, stopped_by)) {
      if (halving == 0) trust *= 2;
      return true;
    }
    if (stopped_by >= modelled_) {
      model(stopped_by, heights);
    } else {
      trust /= 2;
      ++halving;
    }
  }
  return false;
}

/// Adds the terms of the i-th of the cells, and puts it behind those that have theirs.
void Placement::model(std::size_t i, bool heights) {
  const auto first = rated_.begin() + static_cast<std::ptrdiff_t>(modelled_),
             it = rated_.begin() + static_cast<std::ptrdiff_t>(i);
  std::rotate(first, it, it + 1);
  const Star::Cell& cell = star_->cells[rated_[modelled_++].cell];
  const std::size_t before = terms_.size();
  if (heights) {
    Term t;
    t.value = height_over_base(cell, x_, t.gradient);
    terms_.push_back(t);
  } else {
    quality_->append_terms({cell.base[0], cell.base[1], cell.base[2], x_}, cell.region, numbers::share_of_terms, terms_);
  }
  for (std::size_t k = before; k < terms_.size(); ++k) project(*star_, terms_[k].gradient);
}

/// The step s for which the least of value + gradient s, less s^2 / (2 trust), is largest: the trust times a mean of the
/// gradients of at most four terms, which hold it, and which are equal there. By the dual method of Goldfarb and Idnani: as long
/// as a term is less than those that hold, its weight grows, while these stay equal, until it is equal, too, and holds. A term
/// whose weight gets 0 on the way holds no longer.
Placement::Direction Placement::step(double trust) {
  const double worst = std::min_element(terms_.begin(), terms_.end(), [](const Term& a, const Term& b) {
                         return a.value < b.value;
                       })->value;
  Holding holding;
  Direction s{};
  for (int addition = 0;; ++addition) {
    const Term* least = nullptr;
    double of_least = 0;
    for (const Term& t : terms_) {
      const double gain = t.value - worst + detail::dot(t.gradient, s);
      if (!least || gain < of_least) {
        least = &t;
        of_least = gain;
      }
    }
    gain_ = of_least;
    if (addition == 0) {
      holding.begin(*least);
    } else {
      const double of_holding = holding.gain(worst, s);
      if (addition > numbers::most_step_terms || of_holding - of_least <= numbers::balanced_step * std::fabs(of_holding))
        return s;
      if (!holding.add(*least, trust)) return s;
    }
    s = holding.step(trust);
  }
}

/// The first of the cells that is flat or turned over at x; their number if none is.
std::size_t Placement::first_turned_over(const Point3& x) const {
  detail::Vector<3> normal;
  std::size_t i = 0;
  while (i < rated_.size() && height_over_base(star_->cells[rated_[i].cell], x, normal) > 0) ++i;
  return i;
}

/// Goes to x if the worst cell is better there; else says which cell is not. A cell that is turned over, which is seen quickly,
/// is looked for before any quality is computed.
bool Placement::try_place(const Point3& x, bool heights, std::size_t& stopped_by) {
  at_trial_.clear();
  if (!heights && (stopped_by = first_turned_over(x)) < rated_.size()) return false;
  for (std::size_t i = 0; i < rated_.size(); ++i) {
    const double value = value_at(rated_[i], x, heights, least_);
    if (!(value > least_)) {
      stopped_by = i;
      return false;
    }
    at_trial_.push_back({value, rated_[i].cell});
  }
  x_ = x;
  std::swap(rated_, at_trial_);
  std::sort(rated_.begin(), rated_.end(), worse);
  least_ = rated_[0].value;
  return true;
}

}  // namespace pgdr
