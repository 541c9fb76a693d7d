// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Checks of random simplices of every family of points.
#pragma once

#include <gtest/gtest.h>

#include <iostream>

#include "oracles.hpp"

namespace pgdr::oracle {

/// Calls check(s, random) with up to `rounds` simplices of each family, but for flat ones. After a failure prints the
/// simplex, and ends.
template <int D, class Check>
void check_simplices(int rounds, Check check) {
  Random random(seed());
  for (const Family<D>& family : families<D>()) {
    SCOPED_TRACE(family.name);
    for (int round = 0; round < rounds; ++round) {
      Simplex<D> s;
      for (Point<D>& p : s) p = family.point(random);
      if (oracle::orient<D>(s) == Sign::zero) continue;
      check(s, random);
      if (testing::Test::HasFailure()) {
        for (const Point<D>& p : s)
          for (const double x : p.x) std::cout << std::hexfloat << x << ' ';
        FAIL();
      }
    }
  }
}

}  // namespace pgdr::oracle
