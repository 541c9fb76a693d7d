// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The last stage of arithmetic: rationals (CGAL's Exact_rational over GMP), of any exponent. Slow (allocates), so only for
// what the other stages leave. For .cpp files of this layer alone.
#pragma once

#include <CGAL/Exact_rational.h>

#include "pgdr/types.hpp"

namespace pgdr::detail {

/// A type of this namespace, for argument-dependent lookup and against expression templates behind `auto`.
struct Rational {
  using Number = CGAL::Exact_rational;
  Number q = 0;
};

inline Rational add(const Rational& a, const Rational& b) { return {Rational::Number(a.q + b.q)}; }
inline Rational sub(const Rational& a, const Rational& b) { return {Rational::Number(a.q - b.q)}; }
inline Rational mul(const Rational& a, const Rational& b) { return {Rational::Number(a.q * b.q)}; }
inline Rational rational_difference(double a, double b) { return {Rational::Number(Rational::Number(a) - Rational::Number(b))}; }
inline Sign sign(const Rational& a) { return sign_of(a.q.sign()); }

}  // namespace pgdr::detail
