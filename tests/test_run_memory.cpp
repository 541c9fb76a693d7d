// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Memory that there is not: refused before anything is meshed where gaps alone ask for it, unless the caller has bounded the run;
// and a typed error where it runs out. (Two plates 1e-5 apart took half a minute until there was none.)
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <new>
#include <stop_token>
#include <string>

#include "diagnose/cells_between.hpp"
#include "pgdr/estimate.hpp"
#include "pgdr/flat_arrays.hpp"
#include "pgdr/refine.hpp"

namespace pgdr::test_run_memory {

/// A slab so thin, or a strip, that no machine has memory for its cells.
template <int D>
Plc<D> thin(double t = D == 3 ? 1e-9 : 1e-13) {
  if constexpr (D == 3) {
    const double xyz[] = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0, 0, 0, t, 1, 0, t, 0, 1, t, 1, 1, t};
    const std::uint32_t triangles[] = {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                                       2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5};
    return plc_from_arrays<3>(xyz, triangles);
  } else {
    const double xy[] = {0, 0, 1, 0, 1, t, 0, t};
    const std::uint32_t segments[] = {0, 1, 1, 2, 2, 3, 3, 0};
    return plc_from_arrays<2>(xy, segments);
  }
}

template <class T>
class Memory : public testing::Test {};
using Dimensions = testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(Memory, Dimensions);

template <int D>
void expect_refused(const RefineOptions<D>& options) {
  try {
    refine<D>(thin<D>(), options);
    FAIL() << "not refused";
  } catch (const ResourceError& e) {
    EXPECT_EQ(e.code(), Errc::out_of_memory);
    EXPECT_EQ(e.diagnostic().points.size(), 2u);
    EXPECT_NE(std::string(e.what()).find("apart"), std::string::npos);
  }
}

TYPED_TEST(Memory, GapsForWhichThereIsNoneAreRefused) {
  constexpr int D = TypeParam::value;
  RefineOptions<D> options;
  bool was_prepared = false;
  options.prepared = [&](const Domain<D>&) { was_prepared = true; };
  expect_refused<D>(options);
  options.schedule.schedule = Schedule::uniform;
  options.radius_edge_bound = 4;
  expect_refused<D>(options);
  EXPECT_FALSE(was_prepared);
}

/// The guard makes the estimate only where the places that it looks at are so near to something that there may be so many cells.
TYPED_TEST(Memory, TheQuickLookAllowsNoFewerCellsThanTheEstimate) {
  constexpr int D = TypeParam::value;
  const detail::Bulk bulk(false);
  for (double t = 0.25; t > 1e-8; t /= 4) {
    const Domain<D> domain(thin<D>(t));
    const double at_least = estimate_cells<D>(domain).at_least;
    const detail::NearPieces<D> pieces(domain, bulk);
    EXPECT_TRUE(detail::may_take_more_cells_between(pieces, 2, at_least * 0.999, bulk)) << t;
    EXPECT_FALSE(detail::may_take_more_cells_between(pieces, 2, 2 * at_least + 100, bulk)) << t;
  }
}

TYPED_TEST(Memory, WhoBoundsTheRunOrSaysSoIsNotRefused) {
  constexpr int D = TypeParam::value;
  RefineOptions<D> options;
  options.max_vertices = 1000;
  EXPECT_EQ(refine<D>(thin<D>(), options).stop, StopCause::max_vertices);
  RefineOptions<D> timed;
  timed.time_limit = std::chrono::milliseconds(100);
  EXPECT_EQ(refine<D>(thin<D>(), timed).stop, StopCause::time_limit);
  RefineOptions<D> unrefined;
  unrefined.refine = false;
  EXPECT_EQ(refine<D>(thin<D>(), unrefined).stop, StopCause::finished);
  RefineOptions<D> unguarded;
  std::stop_source source;
  unguarded.memory_guard = false;
  unguarded.stop = source.get_token();
  unguarded.prepared = [&](const Domain<D>&) { source.request_stop(); };
  EXPECT_EQ(refine<D>(thin<D>(), unguarded).stop, StopCause::cancelled);
}

TYPED_TEST(Memory, WhatRunsOutIsATypedError) {
  constexpr int D = TypeParam::value;
  RefineOptions<D> options;
  options.size = SizingField<D>([calls = std::make_shared<std::atomic<int>>(0)](const Point<D>&) {
    if (++*calls >= 500) throw std::bad_alloc();
    return 1e-12;
  });
  Plc<D> plc = thin<D>();
  for (Point<D>& p : plc.points) p[D - 1] = p[D - 1] > 0 ? 1 : 0;
  try {
    refine<D>(plc, options);
    FAIL() << "not refused";
  } catch (const ResourceError& e) {
    EXPECT_EQ(e.code(), Errc::out_of_memory);
  }
  EXPECT_THROW(refine<D>(Domain<D>(plc), options), ResourceError);
}

TEST(MemoryWords, EntitiesAreNamedByTheirNumbersInTheInput) {
  Plc<3> plc = thin<3>();
  plc.first_index = 1;
  const Domain<3> domain(plc);
  const EntityRef vertex{EntityKind::vertex, 2}, facet{EntityKind::facet, 0}, segment{EntityKind::segment, 0};
  EXPECT_EQ(input_number(domain, vertex), 3u);
  EXPECT_EQ(input_number(domain, segment), std::nullopt);  // an edge of facets
  EXPECT_EQ(words_of<3>(domain, {vertex, facet}).find("point 3 and facet "), 0u);
  EXPECT_EQ(words_of<3>(domain, {facet, facet}).find("facets "), 0u);
  EXPECT_EQ(words_of<3>(domain, {segment, vertex}).find("the edge from point "), 0u);
}

}  // namespace pgdr::test_run_memory
