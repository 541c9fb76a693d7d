// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Reading inputs: what each format means, and what is said about each kind of mistake, and where.
#include <clocale>
#include <cmath>
#include <set>

#include "test_io_support.hpp"

namespace pgdr::test::test_io_read {

using Corners = std::vector<std::uint32_t>;
using Lines = std::vector<std::uint32_t>;

TEST(ReadPoly, TrianglesFormatWithAllItsParts) {
  const TempFolder folder;
  const auto file = folder.put("a.poly", triangle_poly);
  EXPECT_EQ(file_dimension(file), 2);
  const auto plc = read_plc<2>(file);
  ASSERT_EQ(plc.points.size(), 5u);
  EXPECT_EQ(plc.points[4], (Point2{{2, 2.5}}));
  EXPECT_EQ(plc.point_markers, (std::vector<int>{10, 20, 0, 40, -50}));
  EXPECT_EQ(plc.first_index, 1u);
  ASSERT_EQ(plc.segments.size(), 4u);
  EXPECT_EQ(plc.segments[0].points, (std::array<std::uint32_t, 2>{0, 1}));
  EXPECT_EQ(plc.segments[0].marker, 7);
  EXPECT_EQ(plc.segments[1].marker, 0);
  EXPECT_EQ(plc.segments[3].points, (std::array<std::uint32_t, 2>{3, 0}));
  EXPECT_EQ(plc.segments[3].marker, -1);
  ASSERT_EQ(plc.holes.size(), 1u);
  EXPECT_EQ(plc.holes[0], (Point2{{1.5, 1.25}}));
  ASSERT_EQ(plc.regions.size(), 2u);
  EXPECT_EQ(plc.regions[0].attribute, 3);
  EXPECT_EQ(plc.regions[0].size, 0.125);
  EXPECT_EQ(plc.regions[1].attribute, 4);
  EXPECT_EQ(plc.regions[1].size, 0);  // one number is a label
  EXPECT_EQ(read_plc<2>(file, {.region_areas = true}).regions[0].size, 0.125);
  EXPECT_EQ(read_plc<2>(file, {.region_areas = true}).regions[1].size, 4);  // Triangle's manual: it is both
  EXPECT_EQ(plc.source.file, file.string());
  EXPECT_EQ(plc.source.point_lines, (Lines{3, 4, 5, 6, 7}));
  EXPECT_EQ(plc.source.segment_lines, (Lines{10, 11, 12, 13}));
  EXPECT_EQ(plc.source.hole_lines, (Lines{15}));
  EXPECT_EQ(plc.source.region_lines, (Lines{17, 18}));
}

TEST(ReadPoly, TetgensFormatWithAllItsParts) {
  const TempFolder folder;
  const auto file = folder.put("a.POLY", tetgen_poly);
  EXPECT_EQ(file_dimension(file), 3);
  const auto plc = read_plc<3>(file);
  ASSERT_EQ(plc.points.size(), 8u);
  EXPECT_EQ(plc.points[6], (Point3{{.75, .75, 0}}));
  EXPECT_EQ(plc.point_markers, (std::vector<int>{1, 2, 3, 4, 5, 6, 7, 8}));
  EXPECT_EQ(plc.first_index, 0u);
  ASSERT_EQ(plc.facets.size(), 2u);
  EXPECT_EQ(plc.facets[0].polygons, (std::vector<Corners>{{0, 1, 2, 3}, {4, 5, 6}, {4, 6}}));
  EXPECT_EQ(plc.facets[0].holes, (std::vector<Point3>{{{.5, .5, 0}}}));
  EXPECT_EQ(plc.facets[0].marker, -5);
  EXPECT_EQ(plc.facets[1].polygons, (std::vector<Corners>{{0, 1, 7}}));
  EXPECT_TRUE(plc.facets[1].holes.empty());
  EXPECT_EQ(plc.facets[1].marker, 0);
  EXPECT_EQ(plc.holes, (std::vector<Point3>{{{.5, .25, .125}}}));
  ASSERT_EQ(plc.regions.size(), 2u);
  EXPECT_EQ(plc.regions[0].point, (Point3{{.1, .2, .3}}));
  EXPECT_EQ(plc.regions[0].attribute, 11);
  EXPECT_EQ(plc.regions[0].size, .5);
  EXPECT_EQ(plc.regions[1].attribute, -2.5);
  EXPECT_EQ(plc.regions[1].size, 0);  // in space one value is a label
  EXPECT_EQ(plc.source.facet_lines, (Lines{12, 20}));
}

TEST(ReadPoly, MarkersThatTheHeaderDoesNotAnnounceMeanNothing) {
  const TempFolder folder;
  const auto plc = read_plc<2>(folder.put("a.poly", "2 2 0 0\n0 0 0 9\n1 1 0\n1 0\n1 0 1 8\n0\n"));
  EXPECT_TRUE(plc.point_markers.empty());
  EXPECT_EQ(plc.segments.at(0).marker, 0);
}

TEST(ReadPoly, PointsInANodeFileBesideIt) {
  const TempFolder folder;
  const auto file = folder.put("a.poly", "0\n1 0\n1 1 2\n0\n");
  EXPECT_EQ(error_of<FileError>([&] { read_plc<2>(file); }).code, Errc::cannot_open);
  folder.put("a.node", "2 2 0 1\n1 0 0 5\n2 1 0.5 6\n");
  EXPECT_EQ(file_dimension(file), 2);
  const auto plc = read_plc<2>(file);
  EXPECT_EQ(plc.points, (std::vector<Point2>{{{0, 0}}, {{1, .5}}}));
  EXPECT_EQ(plc.point_markers, (std::vector<int>{5, 6}));
  EXPECT_EQ(plc.first_index, 1u);
  EXPECT_EQ(plc.segments.at(0).points, (std::array<std::uint32_t, 2>{0, 1}));
  EXPECT_TRUE(plc.source.point_lines.empty());  // they are lines of another file
  folder.put("a.node", "2 2 0 1\n1 0 0 5\n2 1 x 6\n");
  const auto error = error_of<InputError>([&] { read_plc<2>(file); });
  EXPECT_EQ(std::filesystem::path(error.file).filename(), "a.node");
  EXPECT_EQ(error.line, 3u);
}

TEST(ReadNode, IsPointsAlone) {
  const TempFolder folder;
  const auto file = folder.put("a.node", "\xEF\xBB\xBF# points\r\n2 3\r\n0 1 2 3\r\n1 4 5 6e-400\r\n\r\n");
  EXPECT_EQ(file_dimension(file), 3);
  const auto plc = read_plc<3>(file);
  EXPECT_EQ(plc.points, (std::vector<Point3>{{{1, 2, 3}}, {{4, 5, 0}}}));
  EXPECT_EQ(plc.source.point_lines, (Lines{3, 4}));
  EXPECT_TRUE(plc.facets.empty() && plc.segments.empty());
}

TEST(ReadSmesh, FacetsThatSpanLines) {
  const TempFolder folder;
  const auto file = folder.put("a.smesh", tetgen_smesh);
  EXPECT_EQ(file_dimension(file), 3);
  const auto plc = read_plc<3>(file);
  ASSERT_EQ(plc.facets.size(), 4u);
  EXPECT_EQ(plc.facets[0].polygons, (std::vector<Corners>{{0, 1, 2}}));
  EXPECT_EQ(plc.facets[1].polygons, (std::vector<Corners>{{0, 1, 3}}));
  EXPECT_EQ(plc.facets[0].marker, 11);
  EXPECT_EQ(plc.facets[1].marker, 12);
  EXPECT_EQ(plc.facets[2].marker, 0);
  EXPECT_EQ(plc.facets[3].marker, -14);
  EXPECT_EQ(plc.source.facet_lines, (Lines{7, 8, 10, 11}));
  EXPECT_EQ(plc.holes.size(), 1u);
  EXPECT_EQ(plc.regions.at(0).size, .01);
}

TEST(ReadOff, ColoursAndLargeFaces) {
  const TempFolder folder;
  const auto plc = read_plc<3>(folder.put("a.off", colour_off));
  EXPECT_EQ(plc.points.size(), 5u);
  EXPECT_EQ(plc.points.at(4), (Point3{{0, 0, 1}}));
  ASSERT_EQ(plc.facets.size(), 3u);
  EXPECT_EQ(plc.facets[0].polygons, (std::vector<Corners>{{0, 1, 2, 3}}));
  EXPECT_EQ(plc.facets[2].polygons, (std::vector<Corners>{{1, 2, 4}}));
  EXPECT_EQ(plc.first_index, 0u);
  EXPECT_EQ(plc.source.point_lines, (Lines{4, 5, 6, 7, 8}));
  EXPECT_EQ(plc.source.facet_lines, (Lines{9, 10, 11}));
}

TEST(ReadOff, EveryWayToBegin) {
  const TempFolder folder;
  const std::string rest = "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
  for (const std::string head :
       {"OFF\n3 1 0\n", "OFF 3 1\n", "OFF3 1 0\n", "3 1 3\n", "# x\n\nNOFF\n\n3 1 0\n", "STCNOFF 3 1 0 # x\n", "OFF\n3\n1\n"}) {
    const auto plc = read_plc<3>(folder.put("a.off", head + rest));
    EXPECT_EQ(plc.points.size(), 3u) << head;
    EXPECT_EQ(plc.facets.size(), 1u) << head;
  }
}

TEST(ReadObj, CornersOfAllKinds) {
  const TempFolder folder;
  const auto file = folder.put("a.obj", wavefront_obj);
  EXPECT_EQ(file_dimension(file), 3);
  const auto plc = read_plc<3>(file);
  EXPECT_EQ(plc.points, (std::vector<Point3>{{{0, 0, 0}}, {{1, 0, 0}}, {{1, 1, 0}}, {{0, 1, 0}}}));
  ASSERT_EQ(plc.facets.size(), 2u);
  EXPECT_EQ(plc.facets[0].polygons, (std::vector<Corners>{{0, 1, 1, 3}}));  // -1 was the second point then
  EXPECT_EQ(plc.facets[1].polygons, (std::vector<Corners>{{0, 1, 3}}));
  EXPECT_EQ(plc.first_index, 1u);
  EXPECT_EQ(plc.source.point_lines, (Lines{3, 4, 9, 10}));
  EXPECT_EQ(plc.source.facet_lines, (Lines{8, 12}));
}

TEST(ReadStl, SeveralAsciiSolidsShareTheirPoints) {
  const TempFolder folder;
  const auto plc = read_plc<3>(folder.put("a.stl", ascii_stl));
  // -0 and 0 are the same coordinate.
  EXPECT_EQ(plc.points, (std::vector<Point3>{{{0, 0, 0}}, {{1, 0, 0}}, {{0, 1, 0}}, {{0, 0, 1}}}));
  ASSERT_EQ(plc.facets.size(), 2u);
  EXPECT_EQ(plc.facets[0].polygons, (std::vector<Corners>{{0, 1, 2}}));
  EXPECT_EQ(plc.facets[1].polygons, (std::vector<Corners>{{0, 2, 3}}));
  EXPECT_EQ(plc.facets[0].marker, 1);
  EXPECT_EQ(plc.facets[1].marker, 2);
  EXPECT_EQ(plc.source.facet_lines, (Lines{2, 11}));
  EXPECT_EQ(read_plc<3>(folder.put("mark.stl", "\xEF\xBB\xBF" + std::string(ascii_stl))).points, plc.points)
      << "a byte order mark";
}

TEST(ReadStl, BinaryThatCallsItselfSolid) {
  const TempFolder folder;
  const std::string bytes = binary_stl("solid facet", {{0, 0, 0, 1, 0, 0, 0, .5f, 0}, {-0.f, 0, 0, 0, .5f, 0, 0, 0, 3}});
  const auto plc = read_plc<3>(folder.put("a.stl", bytes));
  EXPECT_EQ(plc.points, (std::vector<Point3>{{{0, 0, 0}}, {{1, 0, 0}}, {{0, .5, 0}}, {{0, 0, 3}}}));
  ASSERT_EQ(plc.facets.size(), 2u);
  EXPECT_EQ(plc.facets[1].polygons, (std::vector<Corners>{{0, 2, 3}}));
  EXPECT_EQ(plc.facets[1].marker, 1) << "which is called \"facet\"";
}

TEST(ReadStl, ManyDistinctPointsKeepTheirNumbers) {
  std::mt19937 random(7);
  std::vector<std::array<float, 9>> triangles(3000);
  for (auto& t : triangles) {
    for (float& x : t) x = static_cast<float>(random() % 12);
  }
  const TempFolder folder;
  const auto plc = read_plc<3>(folder.put("a.stl", binary_stl("", triangles)));
  std::set<std::array<float, 3>> distinct;
  for (const auto& t : triangles) {
    for (std::size_t k = 0; k < 9; k += 3) distinct.insert({t[k], t[k + 1], t[k + 2]});
  }
  EXPECT_EQ(plc.points.size(), distinct.size());
  for (std::size_t i = 0; i < triangles.size(); ++i) {
    for (std::size_t k = 0; k < 9; ++k) ASSERT_EQ(plc.points.at(plc.facets[i].polygons[0][k / 3]).x[k % 3], triangles[i][k]);
  }
}

struct Mistake {
  std::string name, file, text;
  Errc code;
  std::uint64_t line;
  std::vector<std::int64_t> ids;
  std::string words;  ///< part of the message
};

void PrintTo(const Mistake& m, std::ostream* out) { *out << m.name; }

class ReadMistake : public testing::TestWithParam<Mistake> {};

TEST_P(ReadMistake, IsNamedWithItsLine) {
  const Mistake& m = GetParam();
  const TempFolder folder;
  const auto file = folder.put(m.file, m.text);
  const bool planar = m.file == "2.poly" || m.file == "2.node";
  const auto error = error_of<InputError>([&] {
    if (planar)
      read_plc<2>(file);
    else
      read_plc<3>(file);
  });
  EXPECT_EQ(name(error.code), name(m.code)) << error.message;
  EXPECT_EQ(error.line, m.line) << error.message;
  EXPECT_EQ(error.file, file.string());
  EXPECT_EQ(error.ids, m.ids) << error.message;
  EXPECT_NE(error.message.find(m.words), std::string::npos) << error.message;
}

const std::string four_points = "4 3 0 0\n1 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n";
const std::string four_off = "OFF\n4 1 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n";
const std::string four_obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n";
const std::string stl_start = "solid\nfacet normal 0 0 1\nouter loop\n";

INSTANTIATE_TEST_SUITE_P(
    Nodes, ReadMistake,
    testing::Values(Mistake{"empty", "2.node", "# nothing\n", Errc::truncated, 2, {}, "file ends"},
                    Mistake{"billion", "2.node", "#\n1000000000 2 0 0\n1 0 0\n", Errc::count_too_large, 2, {}, "1000000000"},
                    Mistake{"astronomic", "3.node", "99999999999999999999999 3\n1 0 0 0\n", Errc::count_too_large, 1, {}, ""},
                    Mistake{"negative", "3.node", "-4 3\n", Errc::syntax, 1, {}, "'-4' is not a count"},
                    Mistake{"dimension", "3.node", "1 4 0 0\n1 0 0 0 0\n", Errc::syntax, 1, {}, "4"},
                    Mistake{"planar", "3.node", "1 2 0 0\n1 0 0\n", Errc::syntax, 1, {}, "2 coordinates"},
                    Mistake{"garbage", "2.node", "2 2\n1 0 0\n2 1 1x5\n", Errc::syntax, 3, {2}, "'1x5' is not a number"},
                    Mistake{"nan", "2.node", "2 2\n1 0 0\n\n2 NaN 5\n", Errc::not_finite, 4, {2}, "'NaN'"},
                    Mistake{"infinite", "2.node", "2 2\n0 -inf 0\n1 0 5\n", Errc::not_finite, 2, {0}, "'-inf'"},
                    Mistake{"overflow", "2.node", "1 2\n1 0 1e400\n", Errc::not_finite, 2, {1}, "'1e400'"},
                    Mistake{"microsoft", "2.node", "1 2\n1 0 1.#QNAN\n", Errc::not_finite, 2, {1}, "1.#QNAN"},
                    Mistake{"short_line", "2.node", "2 2\n1 0\n2 0 0\n", Errc::syntax, 2, {1}, "line ends within point 1"},
                    Mistake{"cut_line", "2.node", "2 2\n1 0 0\n2 0", Errc::truncated, 3, {2}, "file ends within point 2"},
                    Mistake{"cut", "2.node", "3 2\n1 0 0.00\n2 0 0.00\n", Errc::truncated, 4, {3}, "point 3"},
                    Mistake{"numbers", "2.node", "2 2\n1 0 0\n3 1 1\n", Errc::syntax, 3, {3}, "point 2 belongs"},
                    Mistake{"first", "2.node", "1 2\n5 0 0\n", Errc::syntax, 2, {}, "number 5"},
                    Mistake{"marker", "2.node", "1 2 0 1\n1 0 0 99999999999\n", Errc::syntax, 2, {1}, "'99999999999'"},
                    Mistake{"more", "2.node", "1 2 0 0\n1 0 0 5 6\n", Errc::syntax, 2, {}, "'6' is left over"},
                    Mistake{"behind", "2.node", "1 2 0 0\n1 0 0\nmore\n", Errc::syntax, 3, {}, "'more'"}),
    [](const auto& info) { return info.param.name; });

INSTANTIATE_TEST_SUITE_P(
    Polys, ReadMistake,
    testing::Values(
        Mistake{"reference", "2.poly", "2 2\n1 0 0\n2 1 0\n1\n1 1 3\n0\n", Errc::index_out_of_range, 5, {1, 3}, "point 3"},
        Mistake{"reference_0", "2.poly", "2 2\n1 0 0\n2 1 0\n1\n1 0 1\n0\n", Errc::index_out_of_range, 5, {1, 0}, "1 to 2"},
        Mistake{"segments", "2.poly", "2 2\n1 0 0\n2 1 0\n800\n1 1 2\n0\n", Errc::count_too_large, 4, {}, "800"},
        Mistake{"no_holes", "2.poly", "2 2\n1 0 0\n2 1 0\n1\n1 1 2\n", Errc::truncated, 6, {}, "list of holes"},
        Mistake{"hole", "2.poly", "2 2\n1 0 0\n2 1 0\n0\n1\n1 0.5\n0\n", Errc::syntax, 6, {1}, "hole 1"},
        Mistake{"region", "2.poly", "2 2\n1 0 0\n2 1 0\n0\n0\n1\n1 0 0 z\n", Errc::syntax, 7, {1}, "'z'"},
        Mistake{"region_nan", "2.poly", "2 2\n1 0 0\n2 1 0\n0\n0\n1\n1 0 0 nan\n", Errc::not_finite, 7, {1}, "'nan'"},
        Mistake{"corner", "3.poly", four_points + "1 0\n1 0\n3 1 2 -7\n0\n", Errc::index_out_of_range, 8, {1, -7}, "facet 1"},
        Mistake{"corners", "3.poly", four_points + "1 0\n1 0\n3000 1 2 3\n0\n", Errc::count_too_large, 8, {1}, "3000"},
        Mistake{"no_corner", "3.poly", four_points + "1 0\n1 0\n0  \n0 #####\n", Errc::degenerate_facet, 8, {1}, "corners"},
        Mistake{"no_polygon", "3.poly", four_points + "1 0\n0 0\n0   \n0\n", Errc::degenerate_facet, 7, {1}, "facet 1"},
        Mistake{"facets", "3.poly", four_points + "90 0\n1 0\n3 1 2 3\n0\n", Errc::count_too_large, 6, {}, "90"},
        Mistake{"facet_hole", "3.poly", four_points + "1 0\n1 1\n3 1 2 3\n1 0 inf 0\n0\n", Errc::not_finite, 9, {1}, "inf"},
        Mistake{"polygon_end", "3.poly", four_points + "1 0\n1 0\n3 1 2 3 4\n0\n", Errc::syntax, 8, {}, "'4'"},
        Mistake{"smesh_cut", "3.smesh", four_points + "2 0\n3 1 2 3\n3 1", Errc::truncated, 8, {2}, "facet 2"},
        Mistake{"smesh_word", "3.smesh", four_points + "1 0\n3 1 two 3\n0\n", Errc::syntax, 7, {1}, "'two' is not an integer"},
        Mistake{"smesh_corner", "3.smesh", four_points + "1 0\n3 1 2\n\n5\n0\n", Errc::index_out_of_range, 9, {1, 5}, "point 5"}),
    [](const auto& info) { return info.param.name; });

INSTANTIATE_TEST_SUITE_P(
    Surfaces, ReadMistake,
    testing::Values(
        Mistake{"not_off", "3.off", "PLY\n", Errc::syntax, 1, {}, "'PLY'"},
        Mistake{"binary_off", "3.off", "OFF BINARY\n", Errc::unknown_format, 1, {}, "binary"},
        Mistake{"off_points", "3.off", "OFF\n353535235358 6 0\n0 0 0\n", Errc::count_too_large, 2, {}, "353535235358"},
        Mistake{"off_faces", "3.off", "OFF\n1 600000 0\n0 0 0\n", Errc::count_too_large, 2, {}, "600000"},
        Mistake{"off_counts", "3.off", "OFF\n1 1 0 7\n0 0 0\n", Errc::syntax, 2, {}, "'7'"},
        Mistake{"off_column", "3.off", "OFF\n1 1 0\n0 0 0 0\n3 0 0 0\n", Errc::syntax, 3, {}, "'0'"},
        Mistake{"off_colour", "3.off", "COFF\n1 1 0\n0 0 0 red\n3 0 0 0\n", Errc::syntax, 3, {0}, "'red'"},
        Mistake{"off_nan", "3.off", "OFF\n1 1 0\n0 0 nan\n3 0 0 0\n", Errc::not_finite, 3, {0}, "point 0"},
        Mistake{"off_reference", "3.off", four_off + "3 0 1 4\n", Errc::index_out_of_range, 7, {0, 4}, "0 to 3"},
        Mistake{"off_corners", "3.off", four_off + "2 0 1\n", Errc::degenerate_facet, 7, {0}, "three"},
        Mistake{"off_many", "3.off", four_off + "99 0 1 2\n", Errc::count_too_large, 7, {0}, "99"},
        Mistake{"off_cut", "3.off", four_off + "3 0 1 ", Errc::truncated, 7, {0}, "face 0"},
        Mistake{"off_behind", "3.off", four_off + "3 0 1 2\n3 1 2 3\n", Errc::syntax, 8, {}, "behind"},
        Mistake{"obj_word", "3.obj", "v 0 0 0\nvertex 1 0 0\n", Errc::syntax, 2, {}, "'vertex'"},
        Mistake{"obj_nan", "3.obj", "v 0 0 0\nv 1 nan 0\n", Errc::not_finite, 2, {2}, "'nan'"},
        Mistake{"obj_cut", "3.obj", "v 0 0 0\nv 1 0", Errc::truncated, 2, {2}, "point 2"},
        Mistake{"obj_zero", "3.obj", four_obj + "f 1 2 0\n", Errc::index_out_of_range, 5, {1, 0}, "point 0"},
        Mistake{"obj_forward", "3.obj", four_obj + "f 1 2 5\n\n", Errc::index_out_of_range, 5, {1, 5}, "point 5"},
        Mistake{"obj_back", "3.obj", four_obj + "f 1 2 -5\n", Errc::index_out_of_range, 5, {1, -5}, "point -5"},
        Mistake{"obj_corner", "3.obj", four_obj + "f 1 2 3/x\n", Errc::syntax, 5, {1}, "'3/x'"},
        Mistake{"obj_corners", "3.obj", four_obj + "f 1 2\n", Errc::degenerate_facet, 5, {1}, "three"},
        Mistake{"stl_empty", "3.stl", "", Errc::truncated, 0, {}, "header"},
        Mistake{"stl_binary_more", "3.stl", binary_stl("x", {{}}) + "x", Errc::syntax, 0, {}, "135"},
        Mistake{"stl_binary_cut", "3.stl", binary_stl("x", {{}}).substr(0, 120), Errc::count_too_large, 0, {}, "134"},
        Mistake{"stl_binary_nan",
                "3.stl",
                binary_stl("x", {{}, {0, 0, 0, NAN, 0, 0, 0, 0, 0}}),
                Errc::not_finite,
                0,
                {1},
                "triangle 1"},
        Mistake{"stl_word", "3.stl", stl_start + "vertex 0 0 blah\n", Errc::syntax, 4, {0}, "'blah'"},
        Mistake{"stl_nan", "3.stl", stl_start + "vertex 0 0 -nan(ind)\n", Errc::not_finite, 4, {0}, "nan"},
        Mistake{"stl_four",
                "3.stl",
                stl_start + "vertex 0 0 0\nvertex 0 0 0\nvertex 0 0 0\nvertex 0 0 0\n",
                Errc::syntax,
                7,
                {},
                "'endloop'"},
        Mistake{"stl_cut", "3.stl", stl_start + "vertex 0 0 0\nvertex 0 0 0\nvertex", Errc::truncated, 6, {0}, "facet 0"},
        Mistake{"stl_unfinished", "3.stl", "solid x\n", Errc::truncated, 2, {}, "end of the solid"},
        Mistake{"stl_behind", "3.stl", "solid x\nendsolid x\nmore\n", Errc::syntax, 3, {}, "'solid'"}),
    [](const auto& info) { return info.param.name; });

TEST(ReadPlc, FilesThatAreNoInput) {
  const TempFolder folder;
  EXPECT_EQ(error_of<FileError>([&] { read_plc<3>(folder / "missing.off"); }).code, Errc::cannot_open);
  EXPECT_EQ(error_of<FileError>([&] { file_dimension(folder / "missing.poly"); }).code, Errc::cannot_open);
  std::filesystem::create_directory(folder / "folder.stl");
  EXPECT_EQ(error_of<FileError>([&] { read_plc<3>(folder / "folder.stl"); }).code, Errc::cannot_open);
  for (const std::string name : {"a.xyz", "a", "off"}) {
    const auto error = error_of<InputError>([&] { read_plc<3>(folder.put(name, "OFF\n")); });
    EXPECT_EQ(error.code, Errc::unknown_format);
    EXPECT_EQ(error.file, (folder / name).string());
    EXPECT_EQ(error_of<InputError>([&] { file_dimension(folder / name); }).code, Errc::unknown_format);
  }
  EXPECT_EQ(error_of<InputError>([&] { read_plc<2>(folder.put("a.off", colour_off)); }).code, Errc::unknown_format);
}

TEST(ReadPlc, UsesNoLocale) {
  const char* const before = std::setlocale(LC_ALL, nullptr);
  const std::string saved = before == nullptr ? "C" : before;
  for (const char* name : {"de_DE.UTF-8", "de_DE.utf8", "fr_FR.UTF-8"}) {
    if (std::setlocale(LC_ALL, name) != nullptr) break;
  }
  const TempFolder folder;
  EXPECT_EQ(read_plc<2>(folder.put("a.node", "1 2\n1 0.5 -1.25e1\n")).points.at(0), (Point2{{.5, -12.5}}));
  std::setlocale(LC_ALL, saved.c_str());
}

}  // namespace pgdr::test::test_io_read
