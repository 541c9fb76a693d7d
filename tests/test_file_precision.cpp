// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Files whose numbers are floats. (A tray of 2,216 points, 65,680 cells within every bound, had 23,005 poor ones after 280 seconds
// once it was turned and written as .stl again: faces are then off their planes by the seventh digit, and every edge between the
// thin triangles of one was a segment.)
#include <gtest/gtest.h>

#include <cmath>

#include "parallel_support.hpp"
#include "pgdr/written_precision.hpp"
#include "test_io_support.hpp"

namespace pgdr::test_file_precision {

constexpr double default_precision = Plc<3>{}.precision;

std::string stl_of(const Plc<3>& plc) {
  std::vector<std::array<float, 9>> triangles;
  for (const auto& facet : plc.facets) {
    auto& t = triangles.emplace_back();
    for (std::size_t c = 0; c < 3; ++c)
      for (std::size_t i = 0; i < 3; ++i) t[3 * c + i] = static_cast<float>(plc.points[facet.polygons[0][c]].x[i]);
  }
  return test::binary_stl("", triangles);
}

std::string ply_of(const Plc<3>& plc, const std::string& type) {
  std::ostringstream text;
  text.precision(9);
  text << "ply\nformat ascii 1.0\nelement vertex " << plc.points.size();
  for (const char c : {'x', 'y', 'z'}) text << "\nproperty " << type << ' ' << c;
  text << "\nelement face " << plc.facets.size() << "\nproperty list uchar int vertex_indices\nend_header\n";
  for (const Point3& p : plc.points) text << p[0] << ' ' << p[1] << ' ' << p[2] << '\n';
  for (const auto& f : plc.facets) text << "3 " << f.polygons[0][0] << ' ' << f.polygons[0][1] << ' ' << f.polygons[0][2] << '\n';
  return text.str();
}

/// A pipe whose flat ends are rings of thin triangles, turned.
Plc<3> turned_pipe() {
  Plc<3> plc;
  const Plc<3> pipe = test::pipe(48, 1.9, 2);
  plc.points = pipe.points;
  const Domain<3> straight(pipe);
  for (EntityId f = 0; f < straight.facets().size(); ++f)
    for (const auto& t : straight.triangles(f)) plc.facets.push_back({{{t[0], t[1], t[2]}}, {}, 0});
  return test::turned(plc);
}

TEST(FilePrecision, PlanarFacesOfAnStlFileStayPlanarWhenTurned) {
  const test::TempFolder folder;
  const Plc<3> pipe = turned_pipe();
  const auto facets = Domain<3>(pipe).facets().size();
  const Plc<3> plc = read_plc<3>(folder.put("pipe.stl", stl_of(pipe)));
  EXPECT_TRUE(plc.precision_of_file);
  EXPECT_EQ(plc.precision, 0x1p-22);
  EXPECT_EQ(Domain<3>(plc).facets().size(), facets);
  EXPECT_GT(Domain<3>(with_default_precision(plc)).facets().size(), facets + 48);
  const auto result = test::expect_reproducible<3>(plc, {}, "turned pipe");
  EXPECT_EQ(result.precision, plc.precision);
  EXPECT_EQ(result.poor_left, 0u);
}

// Where the file says which its numbers are; and numbers of few digits are meant as they are.
TEST(FilePrecision, IsThatOfFloatsAlone) {
  const test::TempFolder folder;
  const Plc<3> pipe = turned_pipe();
  EXPECT_EQ(read_plc<3>(folder.put("float.ply", ply_of(pipe, "float"))).precision, 0x1p-22);
  const Plc<3> doubles = read_plc<3>(folder.put("double.ply", ply_of(pipe, "double")));
  EXPECT_EQ(doubles.precision, default_precision);
  EXPECT_FALSE(doubles.precision_of_file);

  Plc<3> box;
  box.points = {{{0, 0, 0}}, {{1, 0, 0}}, {{0, 0.5, 0}}, {{0, 0, 0.125}}};
  for (const std::vector<std::uint32_t>& t : {std::vector<std::uint32_t>{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}) box.facets.push_back({{t}, {}, 0});
  const Plc<3> exact = read_plc<3>(folder.put("few.stl", stl_of(box)));
  EXPECT_EQ(exact.precision, default_precision);
  EXPECT_FALSE(exact.precision_of_file);
}

/// A tetrahedron as flat as the precision of floats: two of its facets are one plane within that, and so are the others.
Plc<3> flat_tetrahedron() {
  Plc<3> plc;
  plc.points = {{{0.123456789, 0, 0}}, {{1.0000001, 0, 0}}, {{0, 1.0000001, 0}}, {{0.7654321, 0.7654321, 1e-7}}};
  for (const std::vector<std::uint32_t>& t : {std::vector<std::uint32_t>{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}}) plc.facets.push_back({{t}, {}, 0});
  return plc;
}

TEST(FilePrecision, GivesWayWhereFacetsFoldOver) {
  const test::TempFolder folder;
  const Plc<3> plc = read_plc<3>(folder.put("flat.stl", stl_of(flat_tetrahedron())));
  ASSERT_TRUE(plc.precision_of_file);
  EXPECT_LT(Domain<3>(plc).facets().size(), 4u);

  RefineOptions<3> recovery;
  recovery.refine = false;
  const auto result = refine(plc, recovery);
  EXPECT_EQ(result.precision, default_precision);
  EXPECT_GE(result.mesh.cells.size(), 1u);
  const Domain<3> domain(with_default_precision(plc));
  CheckOptions<3> options;
  options.domain = &domain;
  const CheckReport report = check(result.mesh, options);
  EXPECT_EQ(report.exit_code(), 0) << test::findings(report);

  Plc<3> asked = plc;  // for just this precision
  asked.precision_of_file = false;
  EXPECT_THROW(refine(asked, recovery), InputError);
}

// What is wrong with an input whatever its precision is told as ever.
TEST(FilePrecision, IsNoWayRoundAnError) {
  const test::TempFolder folder;
  Plc<3> open = turned_pipe();
  open.facets.pop_back();
  const Plc<3> plc = read_plc<3>(folder.put("open.stl", stl_of(open)));
  ASSERT_TRUE(plc.precision_of_file);
  const Diagnostic d = test::error_of<InputError>([&] { refine(plc, RefineOptions<3>{}); });
  EXPECT_EQ(d.code, Errc::encloses_nothing);
}

}  // namespace pgdr::test_file_precision
