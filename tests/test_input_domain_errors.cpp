// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Input that a Domain refuses: which error, which ids in the numbering of the source, which coordinates, which line.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "domain_plcs.hpp"
#include "pgdr/domain.hpp"

namespace pgdr::test_input_domain_errors {

using test::box;
using test::numbered;
using Ids = std::vector<std::int64_t>;

template <int D>
Diagnostic refusal(const Plc<D>& plc) {
  try {
    const Domain<D> domain(plc);
  } catch (const InputError& e) {
    return e.diagnostic();
  }
  ADD_FAILURE() << "accepted";
  return {};
}

TEST(DomainErrors, NotFinite) {
  Plc<3> plc = numbered(box());
  plc.points[4][1] = std::numeric_limits<double>::infinity();
  Diagnostic d = refusal(plc);
  EXPECT_EQ(d.code, Errc::not_finite);
  EXPECT_EQ(d.ids, Ids{5});
  EXPECT_EQ(d.line, 104u);
  EXPECT_EQ(d.file, "box.poly");
  EXPECT_EQ(d.points.size(), 1u);
  EXPECT_EQ(d.message, "point 5 (0, inf, 3) is not finite");

  plc = numbered(box());
  plc.holes = {{0, 0, 0}, {0, std::nan(""), 0}};
  EXPECT_EQ(refusal(plc).line, 701u);
  plc = numbered(box());
  plc.regions = {{{0, 0, 0}, std::nan(""), 0}};
  d = refusal(plc);
  EXPECT_EQ(d.code, Errc::not_finite);
  EXPECT_EQ(d.line, 900u);
  plc = numbered(box());
  plc.facets[2].holes = {{0, 0, std::nan("")}};
  EXPECT_EQ(refusal(plc).line, 502u);
}

TEST(DomainErrors, IndexOutOfRange) {
  Plc<3> plc = numbered(box());
  plc.facets[3].polygons[0][2] = 8;
  Diagnostic d = refusal(plc);
  EXPECT_EQ(d.code, Errc::index_out_of_range);
  EXPECT_EQ(d.ids, (Ids{4, 9}));
  EXPECT_EQ(d.line, 503u);
  EXPECT_EQ(d.message, "facet 4 refers to point 9; the points are 1 to 8");
  plc = numbered(box());
  plc.segments.push_back({{0, 4000000000u}, 0});
  d = refusal(plc);
  EXPECT_EQ(d.ids, (Ids{1, 4000000001}));
  EXPECT_EQ(d.line, 300u);
  Plc<2> flat;
  flat.segments.push_back({{0, 1}, 0});
  EXPECT_EQ(refusal(flat).code, Errc::index_out_of_range);
}

TEST(DomainErrors, DegenerateFacet) {
  const auto with_facet = [](std::vector<std::vector<std::uint32_t>> polygons) {
    Plc<3> plc = numbered(box());
    plc.points.insert(plc.points.end(), {{1, 1, 1}, {2, 2, 2}, {3, 3, 3}, {4, 4, 4}, {1, 1, 1}, {5, 0, 0}});
    plc.facets.push_back({std::move(polygons), {}, 0});
    return plc;
  };
  for (const auto& polygons : std::vector<std::vector<std::vector<std::uint32_t>>>{{},    // nothing
                                                                                   {{}},  // a polygon of nothing
                                                                                   {{8, 9, 10}, {9, 10, 11}},  // on a line
                                                                                   {{0, 1}, {1, 2}, {2, 5}},  // enclosing nothing
                                                                                   {{0}, {1}, {6}}}) {
    const Diagnostic d = refusal(with_facet(polygons));
    EXPECT_EQ(d.code, Errc::degenerate_facet) << d.message;
    ASSERT_FALSE(d.ids.empty());
    EXPECT_EQ(d.ids[0], 7);
    EXPECT_EQ(d.line, 506u);
  }
  const Diagnostic d = refusal(with_facet({{8, 9, 10}, {8, 9}}));
  EXPECT_EQ(d.ids, (Ids{7, 9, 10, 11}));
  EXPECT_EQ(d.message, "facet 7 has all its points on one line: point 9 (1, 1, 1), 10 (2, 2, 2), 11 (3, 3, 3)");
  EXPECT_EQ(d.points[2], (std::array<double, 3>{3, 3, 3}));
}

TEST(DomainErrors, SelfCrossingFacet) {
  Plc<3> plc = numbered(box());
  plc.facets[1].polygons = {{4, 6, 5, 7}};
  Diagnostic d = refusal(plc);
  EXPECT_EQ(d.code, Errc::self_crossing_facet);
  ASSERT_EQ(d.ids.size(), 5u);
  EXPECT_EQ(d.ids[0], 2);
  EXPECT_EQ(d.points.size(), 4u);
  EXPECT_EQ(d.line, 501u);

  plc = numbered(box());  // a polygon through another one of its facet
  plc.points.insert(plc.points.end(), {{1, 0.5, 0}, {3, 0.25, 0}, {3, 0.75, 0}});
  plc.facets[0].polygons.push_back({8, 9, 10});
  EXPECT_EQ(refusal(plc).code, Errc::self_crossing_facet);

  plc = numbered(box());  // a point that lies inside an edge in the projection alone: exactly there, it would split it
  plc.points.push_back({1, 0, 0.25});
  plc.facets[0].polygons.push_back({8});
  d = refusal(plc);
  EXPECT_EQ(d.code, Errc::self_crossing_facet);
  EXPECT_EQ(d.ids[0], 1);
  EXPECT_EQ(d.ids[3], 9);
  EXPECT_NE(d.message.find("its point 9 (1, 0, 0.25) lies inside its edge"), std::string::npos) << d.message;

  for (const double angle : {0.3, 0.9, 2.0}) {  // turned, and not planar
    plc = numbered(box());
    plc.facets[1].polygons = {{4, 6, 5, 7}};
    EXPECT_EQ(refusal(test::turned(plc, angle)).code, Errc::self_crossing_facet);
  }
}

TEST(DomainErrors, AFacetThatIsNoPlane) {
  Plc<3> plc = numbered(box());
  plc.facets[0].polygons = {{0, 1, 2, 6, 3}};  // 6 is above 2
  const Diagnostic d = refusal(plc);
  EXPECT_TRUE(d.code == Errc::degenerate_facet || d.code == Errc::self_crossing_facet) << d.message;
  EXPECT_EQ(d.ids[0], 1);
}

TEST(DomainErrors, SeedOnTheRimOfItsFacet) {
  Plc<3> plc = numbered(box());
  plc.facets[0].holes = {{1, 0, 7}};
  EXPECT_EQ(refusal(plc).code, Errc::seed_on_boundary);
  plc.facets[0].holes = {{2, 1, 0}};
  const Diagnostic d = refusal(plc);
  EXPECT_EQ(d.code, Errc::seed_on_boundary);
  EXPECT_EQ(d.line, 500u);
  plc.facets[0].holes = {{1, 0.5, 0}};
  EXPECT_EQ(refusal(plc).code, Errc::degenerate_facet);  // all of it is a hole
}

TEST(DomainErrors, NoVolume) {
  Plc<3> plc;
  EXPECT_EQ(refusal(plc).code, Errc::no_volume);
  plc.points = {{0, 0, 1}, {1, 0, 1}, {0, 1, 1}, {1, 1, 1}, {0.5, 0.25, 1}};
  EXPECT_EQ(refusal(plc).code, Errc::no_volume);
  plc.points = {{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {3, 3, 3}};
  EXPECT_EQ(refusal(plc).code, Errc::no_volume);
  Plc<2> flat;
  EXPECT_EQ(refusal(flat).code, Errc::no_volume);
  flat.points = {{0, 0}, {1, 3}, {2, 6}, {2, 6}};
  EXPECT_EQ(refusal(flat).code, Errc::no_volume);
  flat.points = {{0, 0}, {0, 0}, {0, 0}};
  EXPECT_EQ(refusal(flat).code, Errc::no_volume);
  flat.points = {{0, 0}, {0, 1}, {1, 0}};
  flat.facets.push_back({{{0, 1, 2}}, {}, 0});
  EXPECT_EQ(refusal(flat).code, Errc::degenerate_facet);
}

}  // namespace pgdr::test_input_domain_errors
