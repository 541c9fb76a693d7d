// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The single stages of the predicates, for the ladder that calls them in turn and for the tests, which check that no
// stage contradicts a later one. A stage that cannot decide returns nothing. Pure functions but for the counters.
#pragma once

#include <array>
#include <optional>

#include "pgdr/predicates.hpp"

namespace pgdr::detail {

using MaybeSign = std::optional<Sign>;

/// The arithmetics of the middle stage; the ladder tries all, tests ask for one.
enum class Middle { all, short_int, fixed_point, expansion };

/// Of the calling thread. The one mutable state of the layer.
extern constinit thread_local PredicateCounts counts;

template <int D>
MaybeSign orient_filter(const Simplex<D>& s);
template <int D>
MaybeSign orient_middle(const Simplex<D>& s, Middle stage = Middle::all);
template <int D>
Sign orient_exact(const Simplex<D>& s);

template <int D>
MaybeSign in_sphere_filter(const Simplex<D>& s, const Point<D>& p);
template <int D>
MaybeSign in_sphere_middle(const Simplex<D>& s, const Point<D>& p, Middle stage = Middle::all);
template <int D>
Sign in_sphere_exact(const Simplex<D>& s, const Point<D>& p);

/// In-circle in a plane without perturbation, see in_circle_perturbed; t holds a, b, c.
using Triangle3 = std::array<Point3, 3>;
MaybeSign in_circle_filter(const Triangle3& t, const Point3& p, int axis);
MaybeSign in_circle_middle(const Triangle3& t, const Point3& p, int axis, Middle stage = Middle::all);
Sign in_circle_exact(const Triangle3& t, const Point3& p, int axis);

/// Sign of (a-v).(b-v).
template <int D>
MaybeSign dot_filter(const Point<D>& v, const Point<D>& a, const Point<D>& b);
template <int D>
MaybeSign dot_middle(const Point<D>& v, const Point<D>& a, const Point<D>& b, Middle stage = Middle::all);
template <int D>
Sign dot_exact(const Point<D>& v, const Point<D>& a, const Point<D>& b);
template <int D>
Sign dot_sign(const Point<D>& v, const Point<D>& a, const Point<D>& b);  ///< all stages, counted

/// Sign of 4 ((a-v).(b-v))^2 - |a-v|^2 |b-v|^2.
template <int D>
MaybeSign angle_60_filter(const Point<D>& v, const Point<D>& a, const Point<D>& b);
template <int D>
MaybeSign angle_60_middle(const Point<D>& v, const Point<D>& a, const Point<D>& b, Middle stage = Middle::all);
template <int D>
Sign angle_60_exact(const Point<D>& v, const Point<D>& a, const Point<D>& b);

/// The bounds; `exact` has the same preconditions as the public functions, but no shortcut.
template <int D>
std::optional<bool> radius_edge_filter(const Simplex<D>& s, double bound);
template <int D>
std::optional<bool> circumradius_filter(const Simplex<D>& s, double size);
template <int D>
std::optional<bool> measure_filter(const Simplex<D>& s, double bound);
template <int D>
bool radius_edge_exact(const Simplex<D>& s, double bound);
template <int D>
bool circumradius_exact(const Simplex<D>& s, double size);
template <int D>
bool measure_exact(const Simplex<D>& s, double bound);

/// The exact circumcentre, each coordinate rounded to nearest (infinite if it overflows); NaN for a flat simplex.
Point2 circumcenter_exact(const Simplex<2>& s);
Point3 circumcenter_exact(const Simplex<3>& s);
/// The same for three points of space, in their plane.
Point3 circumcenter_exact(const Triangle3& t);

}  // namespace pgdr::detail
