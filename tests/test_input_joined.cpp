// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Several inputs as one: what each had is there, told apart, and messages name the file that it stood in.
#include <gtest/gtest.h>

#include <algorithm>

#include "pgdr/diagnosis.hpp"
#include "pgdr/domain.hpp"
#include "pgdr/joined_plc.hpp"
#include "pgdr/planar_plc.hpp"

namespace pgdr::test::test_input_joined {

Plc<3> box(const std::string& file, double x, int marker = 0) {
  Plc<3> plc;
  for (const double z : {0.0, 1.0})
    for (const double y : {0.0, 1.0})
      for (const double dx : {0.0, 1.0}) plc.points.push_back({{x + dx, y, z}});
  using Polygon = std::vector<std::uint32_t>;
  for (const Polygon& p : {Polygon{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}) {
    plc.facets.push_back({{p}, {}, marker});
    plc.source.facet_lines.push_back(static_cast<std::uint32_t>(100 + plc.facets.size()));
  }
  plc.source.file = file;
  return plc;
}

std::vector<int> markers_of(const Plc<3>& plc) {
  std::vector<int> markers;
  for (const auto& f : plc.facets) markers.push_back(f.marker);
  markers.erase(std::unique(markers.begin(), markers.end()), markers.end());
  return markers;
}

TEST(Joined, TellsInputsApart) {
  std::vector<Plc<3>> inputs{box("parts/gear.stl", 0), box("parts/shaft.off", 1), box("cover.obj", 2, 1)};
  inputs[1].regions.push_back({{{1.5, 0.5, 0.5}}, 0, 0.25});
  inputs[2].regions.push_back({{{2.5, 0.5, 0.5}}, 1, 0});
  inputs[2].names.markers[1] = "lid";
  inputs[2].names.regions[1] = "steel";
  inputs[0].are_floats = true;
  inputs[1].tolerance = 1e-9;
  inputs[1].segments.push_back({{0, 1}, 0});
  const Plc<3> all = joined<3>(inputs);
  EXPECT_EQ(all.points.size(), 24u);
  EXPECT_EQ(all.facets[7].polygons[0], (std::vector<std::uint32_t>{12, 13, 15, 14}));
  EXPECT_EQ(markers_of(all), (std::vector<int>{2, 3, 1})) << "the first free ones; that of the cover is its own";
  EXPECT_EQ(all.names.markers, (std::map<int, std::string>{{1, "lid"}, {2, "gear"}, {3, "shaft"}}));
  EXPECT_EQ(all.regions[0].attribute, 2);
  EXPECT_EQ(all.regions[1].attribute, 1);
  EXPECT_EQ(all.names.regions, (std::map<double, std::string>{{1, "steel"}, {2, "shaft"}}));
  EXPECT_EQ(all.segments[0].points, (std::array<std::uint32_t, 2>{8, 9}));
  EXPECT_EQ(all.segments[0].marker, 0);
  EXPECT_EQ(all.body_names, (std::vector<std::string>{"gear", "shaft", "lid"}));
  ASSERT_EQ(all.facet_bodies.size(), 18u);
  EXPECT_EQ(all.facet_bodies[5], 0u);
  EXPECT_EQ(all.facet_bodies[6], 1u);
  EXPECT_EQ(all.facet_bodies[17], 2u);
  EXPECT_TRUE(all.are_floats);
  EXPECT_EQ(all.tolerance, 1e-9);
  EXPECT_NO_THROW(Domain<3>{all});
  const std::vector<std::string> called{"a", "", "c"};
  EXPECT_EQ(joined<3>(inputs, called).names.markers, (std::map<int, std::string>{{1, "lid"}, {2, "a"}, {3, "shaft"}}));
}

TEST(Joined, VoidsBetweenCellsStayThose) {
  std::vector<Plc<3>> inputs{box("a.msh", 0), box("b.off", 2), box("c.msh", 4)};
  for (Plc<3>& plc : inputs) plc.holes.push_back({{0.5, 0.5, 0.5}});
  inputs[0].source.void_widths = {1e-3};
  inputs[2].source.void_widths = {1};
  const Plc<3> all = joined<3>(inputs);
  EXPECT_EQ(holes_within(all, 0.01).size(), 2u) << "the first is no thicker";
  EXPECT_EQ(holes_within(all, 10).size(), 1u) << "what a user made stays";
}

TEST(Joined, NamesThatAreAlikeAreToldApart) {
  std::vector<Plc<3>> inputs{box("a/part.stl", 0, 1), box("b/part.stl", 2, 1), box("c/other.stl", 4, 1), box("part.off", 6)};
  for (std::size_t i = 0; i < 3; ++i) inputs[i].names.markers[1] = "solid";
  const Plc<3> all = joined<3>(inputs);
  EXPECT_EQ(all.names.markers,
            (std::map<int, std::string>{{1, "part:solid"}, {2, "part:solid:2"}, {3, "other:solid"}, {4, "part"}}));
  EXPECT_EQ(all.body_names, (std::vector<std::string>{"part:solid", "part:solid:2", "other:solid", "part"}));
  const Plc<3> again = joined<3>(std::vector{all, box("last.stl", 8)});
  EXPECT_EQ(again.body_names.size(), 5u);
  EXPECT_EQ(again.source.place(SourceItem::facet, 9).file, "b/part.stl");
  EXPECT_EQ(again.source.place(SourceItem::facet, 9).line, 104u);
  EXPECT_EQ(again.source.place(SourceItem::point, 33).file, "last.stl");
  EXPECT_EQ(again.source.place(SourceItem::point, 33).line, 0u);
  EXPECT_EQ(again.facet_bodies.back(), 4u);
}

TEST(Joined, MessagesNameTheFileAndLine) {
  std::vector<Plc<3>> inputs{box("first.stl", 0), box("second.stl", 2), box("third.stl", 4)};
  inputs[1].facets[3].polygons[0] = {0, 1};  // too few corners for a facet: a segment; and an index that is none
  inputs[1].facets[4].polygons[0][2] = 999;
  const Plc<3> all = joined<3>(inputs);
  try {
    const Domain<3> domain(all);
    FAIL() << "the index was taken";
  } catch (const InputError& e) {
    EXPECT_EQ(e.diagnostic().code, Errc::index_out_of_range);
    EXPECT_EQ(e.diagnostic().file, "second.stl");
    EXPECT_EQ(e.diagnostic().line, 105u);
  }
  // Bodies that cross: the culprit is of the first of the two.
  std::vector<Plc<3>> crossing{box("x.stl", 8), box("y.stl", 0), box("z.stl", 0.5)};
  for (Point3& p : crossing[2].points)
    for (const int k : {1, 2}) p[k] += 0.5;
  const Diagnosis<3> diagnosis = diagnose<3>(joined<3>(crossing));
  const auto& crossings = diagnosis[Finding::facets_cross];
  ASSERT_FALSE(crossings.listed.empty());
  EXPECT_EQ(crossings.listed.front().what.file, "y.stl");
  EXPECT_GE(crossings.listed.front().what.line, 101u);
}

TEST(Joined, PlanarInputsKeepTheirFilesWhereSegmentsAreSplit) {
  const auto square = [](const std::string& file, double x) {
    Plc<2> plc;
    plc.points = {{{x, 0}}, {{x + 2, 0}}, {{x + 2, 2}}, {{x, 2}}};
    for (std::uint32_t i = 0; i < 4; ++i) plc.segments.push_back({{i, (i + 1) % 4}, 0});
    plc.source = {.file = file, .segment_lines = {1, 2, 3, 4}};
    return plc;
  };
  std::vector<Plc<2>> inputs{square("a.poly", 0), square("b.poly", 1)};
  inputs[1].points[0][1] = inputs[1].points[1][1] = 1;
  inputs[1].points[2][1] = inputs[1].points[3][1] = 3;
  std::vector<Diagnostic> repairs;
  const Plc<2> split = resolve_crossings(joined<2>(inputs), repairs);
  ASSERT_EQ(split.segments.size(), 12u);
  EXPECT_EQ(split.source.place(SourceItem::segment, 5).file, "a.poly");
  EXPECT_EQ(split.source.place(SourceItem::segment, 6).file, "b.poly");
  EXPECT_EQ(split.source.place(SourceItem::segment, 6).line, 1u);
  EXPECT_EQ(split.segments[0].marker, 1);
  EXPECT_EQ(split.segments[6].marker, 2);
  EXPECT_EQ(split.names.markers, (std::map<int, std::string>{{1, "a"}, {2, "b"}}));
}

TEST(Joined, OneIsItselfAndNoneIsRefused) {
  const Plc<3> one = box("one.stl", 0);
  EXPECT_TRUE(joined<3>(std::span(&one, 1)).names.empty());
  EXPECT_THROW(joined<3>({}), UsageError);
  const std::vector<std::string> too_many{"a", "b"};
  EXPECT_THROW(joined<3>(std::span(&one, 1), too_many), UsageError);
}

}  // namespace pgdr::test::test_input_joined
