// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Files whose numbers are floats. (A tray of 2,216 points, 65,680 cells within every bound, had 23,005 poor ones after 280
// seconds once it was turned and written as .stl again: faces are then off their planes by the seventh digit, and every edge
// between the thin triangles of one was a segment.)
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "parallel_support.hpp"
#include "pgdr/diagnosis.hpp"
#include "pgdr/written_precision.hpp"
#include "test_io_support.hpp"

namespace pgdr::test_precision_files {

const double default_precision = Plc<3>{}.precision;  // Clang 14 has no constant vectors

std::string stl_of(const Plc<3>& plc) {
  std::vector<std::array<float, 9>> triangles;
  for (const auto& facet : plc.facets) {
    auto& t = triangles.emplace_back();
    for (std::size_t c = 0; c < 3; ++c)
      for (std::size_t i = 0; i < 3; ++i) t[3 * c + i] = static_cast<float>(plc.points[facet.polygons[0][c]].x[i]);
  }
  return test::binary_stl("", triangles);
}

std::string ply_of(const Plc<3>& plc, const std::string& type, int digits) {
  std::ostringstream text;
  text.precision(digits);
  text << "ply\nformat ascii 1.0\nelement vertex " << plc.points.size();
  for (const char c : {'x', 'y', 'z'}) text << "\nproperty " << type << ' ' << c;
  text << "\nelement face " << plc.facets.size() << "\nproperty list uchar int vertex_indices\nend_header\n";
  for (const Point3& p : plc.points) text << p[0] << ' ' << p[1] << ' ' << p[2] << '\n';
  for (const auto& f : plc.facets) text << "3 " << f.polygons[0][0] << ' ' << f.polygons[0][1] << ' ' << f.polygons[0][2] << '\n';
  return text.str();
}

/// A pipe whose flat ends are rings of thin triangles, turned.
Plc<3> turned_pipe() { return test::turned<3>(test::triangles_of(test::pipe(48, 1.9, 2)), 0); }

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
  EXPECT_EQ(read_plc<3>(folder.put("float.ply", ply_of(pipe, "float", 9))).precision, 0x1p-22);
  const Plc<3> doubles = read_plc<3>(folder.put("double.ply", ply_of(pipe, "double", 17)));
  EXPECT_EQ(doubles.precision, default_precision);
  EXPECT_FALSE(doubles.precision_of_file);

  Plc<3> box;
  box.points = {{{0, 0, 0}}, {{1, 0, 0}}, {{0, 0.5, 0}}, {{0, 0, 0.125}}};
  for (const std::vector<std::uint32_t>& t : {std::vector<std::uint32_t>{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}})
    box.facets.push_back({{t}, {}, 0});
  const Plc<3> exact = read_plc<3>(folder.put("few.stl", stl_of(box)));
  EXPECT_EQ(exact.precision, default_precision);
  EXPECT_FALSE(exact.precision_of_file);
}

/// A plate of n x n rectangles, each of two triangles; the points of its upper side are from one to two times as high as
/// `height`.
Plc<3> rough_plate(int n, double height, std::mt19937& random) {
  Plc<3> plc;
  const auto number = [n](int side, int i, int j) { return static_cast<std::uint32_t>((side * (n + 1) + i) * (n + 1) + j); };
  for (int side = 0; side < 2; ++side)
    for (int i = 0; i <= n; ++i)
      for (int j = 0; j <= n; ++j) {
        const double rise = random() % 3 == 0 ? 0x1p-32 * random() : 0;
        plc.points.push_back({{double(i) / n, double(j) / n, side * height * (1 + rise)}});
      }
  const auto rectangle = [&plc](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d) {
    plc.facets.push_back({{{a, b, c}}, {}, 0});
    plc.facets.push_back({{{a, c, d}}, {}, 0});
  };
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j)
      for (int side = 0; side < 2; ++side)
        rectangle(number(side, i, j), number(side, i + 1, j), number(side, i + 1, j + 1), number(side, i, j + 1));
  for (int i = 0; i < n; ++i)
    for (const int end : {0, n}) {
      rectangle(number(0, i, end), number(0, i + 1, end), number(1, i + 1, end), number(1, i, end));
      rectangle(number(0, end, i), number(0, end, i + 1), number(1, end, i + 1), number(1, end, i));
    }
  return plc;
}

std::string off_of(const Plc<3>& plc, int digits, bool as_soup = false) {
  std::ostringstream text;
  text.precision(digits);
  std::size_t rows = 0;
  std::ostringstream facets;
  std::vector<std::uint32_t> points;
  for (const auto& f : plc.facets) {
    facets << f.polygons[0].size();
    for (const std::uint32_t v : f.polygons[0]) {
      if (as_soup) points.push_back(v);
      facets << ' ' << (as_soup ? rows++ : v);
    }
    facets << '\n';
  }
  if (!as_soup)
    for (std::uint32_t v = 0; v < plc.points.size(); ++v) points.push_back(v);
  text << "OFF\n" << points.size() << ' ' << plc.facets.size() << " 0\n";
  for (const std::uint32_t v : points) text << plc.points[v][0] << ' ' << plc.points[v][1] << ' ' << plc.points[v][2] << '\n';
  return text.str() + facets.str();
}

// (A spool of 649 points had 397 poor cells, 365 of them in corners of facets which its six digits had made of its flat sides.)
TEST(FilePrecision, DigitsCountWhereTheyMakeNeedles) {
  const test::TempFolder folder;
  const Plc<3> pipe = turned_pipe();
  const auto facets = Domain<3>(pipe).facets().size();
  for (const bool as_soup : {false, true}) {
    const Plc<3> plc = read_plc<3>(folder.put("pipe.off", off_of(pipe, 6, as_soup)));
    EXPECT_TRUE(plc.precision_of_file);
    EXPECT_EQ(plc.precision, 1e-5);
    EXPECT_EQ(Domain<3>(plc).facets().size(), facets);
    EXPECT_GT(Domain<3>(with_default_precision(plc)).facets().size(), facets + 48);
    if (as_soup) continue;
    const auto result = test::expect_reproducible<3>(plc, {}, "turned pipe of six digits");
    EXPECT_EQ(result.precision, plc.precision);
    EXPECT_EQ(result.poor_left, 0u);
    EXPECT_GT(refine(with_default_precision(plc), RefineOptions<3>{}).poor_left, 0u);
  }
}

// What is scaled by a power of two is meshed as it was, and the mesh scaled.
TEST(FilePrecision, DigitsAreThoseOfScaledCopies) {
  const test::TempFolder folder;
  const Plc<3> plc = read_plc<3>(folder.put("pipe.off", off_of(turned_pipe(), 6)));
  const OutputMesh<3> mesh = refine(plc, RefineOptions<3>{}).mesh;
  for (const int scale : {-40, 3, 20}) {
    Plc<3> scaled = with_default_precision(plc);
    for (Point3& p : scaled.points)
      for (double& x : p.x) x = std::ldexp(x, scale);
    const Plc<3> again = read_plc<3>(folder.put("scaled.off", off_of(scaled, 17)));
    EXPECT_EQ(again.precision, plc.precision) << scale;
    EXPECT_TRUE(again.precision_of_file) << scale;
    OutputMesh<3> copy = refine(again, RefineOptions<3>{}).mesh;
    for (Point3& p : copy.points)
      for (double& x : p.x) x = std::ldexp(x, -scale);
    EXPECT_TRUE(copy.points == mesh.points && copy.cells == mesh.cells) << scale;
  }
  Plc<3> far = with_default_precision(plc);
  for (Point3& p : far.points)
    for (double& x : p.x) x = std::ldexp(x, 700);
  set_precision_of_digits(far);
  EXPECT_EQ(far.precision, plc.precision);
}

// Where there are too few digits to go by, or all of them; where the planar faces are planar; and where triangles are no needles.
TEST(FilePrecision, DigitsDoNotCountElsewhere) {
  const test::TempFolder folder;
  const auto keeps_default = [&](const std::string& text) {
    const Plc<3> plc = read_plc<3>(folder.put("other.off", text));
    return plc.precision == default_precision && !plc.precision_of_file;
  };
  EXPECT_TRUE(keeps_default(off_of(turned_pipe(), 5)));
  EXPECT_TRUE(keeps_default(off_of(turned_pipe(), 17)));
  EXPECT_TRUE(keeps_default(off_of(test::triangles_of(test::pipe(48, 1.9, 2)), 6)));
  EXPECT_TRUE(keeps_default(off_of(test::turned<3>(test::icosphere(3), 0.3), 6)));
  std::mt19937 random(3);
  EXPECT_TRUE(keeps_default(off_of(test::turned<3>(rough_plate(6, 0.1, random), 0.2), 6)));
}

// (The spool, turned and written with all digits, had 397 poor cells of 14,456 again, not 47 of 9,047.)
TEST(FilePrecision, TurnedDigitsCountWhereTheyMakeNeedles) {
  const test::TempFolder folder;
  const Plc<3> pipe = turned_pipe();
  const auto facets = Domain<3>(pipe).facets().size();
  const Plc<3> rounded = read_plc<3>(folder.put("pipe.off", off_of(pipe, 6)));
  for (const int scale : {0, 30}) {
    Plc<3> turned = test::turned<3>(with_default_precision(rounded), 0.7);
    for (Point3& p : turned.points)
      for (double& x : p.x) x = std::ldexp(x, scale);
    const Plc<3> plc = read_plc<3>(folder.put("turned.off", off_of(turned, 17)));
    EXPECT_TRUE(plc.precision_of_file);
    EXPECT_GT(plc.precision, 1e-6);
    EXPECT_LT(plc.precision, 4.01e-5);
    EXPECT_EQ(Domain<3>(plc).facets().size(), facets);
    EXPECT_EQ(suggested_precision(plc), plc.precision) << "auto is no worse";
    if (scale != 0) continue;
    const auto result = test::expect_reproducible<3>(plc, {}, "turned pipe of six digits, turned again");
    EXPECT_EQ(result.precision, plc.precision);
    EXPECT_EQ(result.poor_left, 0u);
  }
}

/// A body of revolution whose sides, of so many meridians, are long strips: as wide as z, of the radius that `radius` says.
Plc<3> revolved(std::uint32_t meridians, const std::vector<double>& radius) {
  Plc<3> plc;
  const auto rings = static_cast<std::uint32_t>(radius.size());
  for (std::uint32_t r = 0; r < rings; ++r)
    for (std::uint32_t i = 0; i < meridians; ++i) {
      const double a = 2 * 3.14159265358979323846 * i / meridians;
      plc.points.push_back({{radius[r] * std::cos(a), radius[r] * std::sin(a), 0.2 * r}});
    }
  for (std::uint32_t r = 0; r + 1 < rings; ++r)
    for (std::uint32_t i = 0; i < meridians; ++i) {
      const std::uint32_t a = r * meridians + i, b = r * meridians + (i + 1) % meridians;
      plc.facets.push_back({{{a, b, b + meridians}}, {}, 0});
      plc.facets.push_back({{{a, b + meridians, a + meridians}}, {}, 0});
    }
  for (const std::uint32_t r : {0u, rings - 1}) {
    auto& cap = plc.facets.emplace_back().polygons.emplace_back();
    for (std::uint32_t i = 0; i < meridians; ++i) cap.push_back(r * meridians + (r == 0 ? meridians - 1 - i : i));
  }
  return plc;
}

// Needles that are nearly coplanar by pairs, but all together are no face.
TEST(FilePrecision, RoundSidesAreNoRounding) {
  for (const auto& radius : {std::vector{1., 1.}, std::vector{1.3, 1.1, 1., 1.1, 1.3}}) {
    Plc<3> plc = test::turned<3>(revolved(2000, radius), 0.3);
    set_precision_of_digits(plc);
    EXPECT_EQ(plc.precision, default_precision) << radius.size();
    EXPECT_FALSE(plc.precision_of_file);
  }
}

// (Two parts of a robot, which had been moved from elsewhere, had 97 poor cells of 7,716 and 227 of 20,173, and have none now.)
TEST(FilePrecision, FloatsThatWereConvertedBefore) {
  const test::TempFolder folder;
  Plc<3> moved = turned_pipe();
  const auto facets = Domain<3>(moved).facets().size();
  for (Point3& p : moved.points)
    for (double& x : p.x) x = static_cast<float>(x + 40) - 40.f;
  const Plc<3> plc = read_plc<3>(folder.put("moved.stl", stl_of(moved)));
  EXPECT_TRUE(plc.precision_of_file);
  EXPECT_GT(plc.precision, 1e-6);
  EXPECT_LT(plc.precision, 2e-5);
  EXPECT_EQ(Domain<3>(plc).facets().size(), facets);
  EXPECT_EQ(suggested_precision(plc), plc.precision) << "auto is no worse";
  const auto result = test::expect_reproducible<3>(plc, {}, "pipe of floats, moved");
  EXPECT_EQ(result.precision, plc.precision);
  EXPECT_EQ(result.poor_left, 0u);

  for (const auto& radius : {std::vector{1., 1.}, std::vector{1.3, 1.1, 1., 1.1, 1.3}}) {
    Plc<3> round = test::triangles_of(test::turned<3>(revolved(2000, radius), 0.3));
    EXPECT_EQ(read_plc<3>(folder.put("round.stl", stl_of(round))).precision, 0x1p-22) << radius.size();
  }
}

// It is asked before anything else is.
TEST(FilePrecision, DigitsOfWhatIsNoInput) {
  Plc<3> plc = read_plc<3>(test::TempFolder().put("pipe.off", off_of(turned_pipe(), 6)));
  plc = with_default_precision(plc);
  Plc<3> other = plc;
  other.facets[3].polygons[0][1] = 100000;
  other.facets[5].polygons[0] = {};
  other.facets[7].polygons = {};
  other.facets[9].polygons[0] = {1, 1, 1};
  set_precision_of_digits(other);
  EXPECT_EQ(other.precision, 1e-5);
  plc.points[2][1] = NAN;
  set_precision_of_digits(plc);
  EXPECT_EQ(plc.precision, default_precision);
}

/// A tetrahedron as flat as the precision of floats: two of its facets are one plane within that, and so are the others.
Plc<3> flat_tetrahedron() {
  Plc<3> plc;
  plc.points = {{{0.123456789, 0, 0}}, {{1.0000001, 0, 0}}, {{0, 1.0000001, 0}}, {{0.7654321, 0.7654321, 1e-7}}};
  for (const std::vector<std::uint32_t>& t : {std::vector<std::uint32_t>{0, 1, 2}, {0, 3, 1}, {1, 3, 2}, {2, 3, 0}})
    plc.facets.push_back({{t}, {}, 0});
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

// A text and a logo of six digits, 7,442 points: of three thousand facets that are planar within their rounding those at one
// segment fold over, and with all triangles apart there were four times as many elements as TetGen needs.
TEST(FilePrecision, ATenthOfItMayDo) {
  const test::TempFolder folder;
  Plc<3> plc = read_plc<3>(folder.put("pipe.off", off_of(turned_pipe(), 7)));
  ASSERT_TRUE(plc.precision_of_file);
  plc.precision = 1e-5;
  const auto facets = Domain<3>(plc).facets().size();
  const auto first = static_cast<std::uint32_t>(plc.points.size());
  Plc<3> flat = flat_tetrahedron();  // 0.5 of the rounding high
  flat.points[3][2] = 3e-5;
  for (Point3 p : flat.points) {
    p[0] += 5;
    plc.points.push_back(p);
  }
  for (auto& f : flat.facets) {
    for (std::uint32_t& v : f.polygons[0]) v += first;
    plc.facets.push_back(f);
  }

  RefineOptions<3> recovery;
  recovery.refine = false;
  const auto result = refine(plc, recovery);
  EXPECT_NEAR(result.precision, 1e-6, 1e-9);
  plc.precision = result.precision;
  const Domain<3> domain(plc);
  EXPECT_EQ(domain.facets().size(), facets + 4);
  CheckOptions<3> options;
  options.domain = &domain;
  const CheckReport report = check(result.mesh, options);
  EXPECT_EQ(report.exit_code(), 0) << test::findings(report);

  plc.precision = 1e-5;
  plc.precision_of_file = false;  // asked for
  EXPECT_THROW(refine(plc, recovery), InputError);
}

// A pyramid lower than the rounding of its coordinates: its sides are one plane by the default precision, and came out below its
// base, with all segments, and volumes that are none.
TEST(FilePrecision, DefaultGivesWayToExactPlanes) {
  Plc<3> plc;
  plc.points = {{{0.12887, -2.08387, -0.86967}},
                {{-0.12887, -1.13085, 0.86967}},
                {{0.31905, -0.75708, -0.41860}},
                {{-0.31905, -2.45764, 0.41860}},
                {{0, -1.60736, 0}}};
  for (const std::vector<std::uint32_t>& t :
       {std::vector<std::uint32_t>{0, 1, 2}, {0, 3, 1}, {0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}})
    plc.facets.push_back({{t}, {}, 0});
  ASSERT_LT(Domain<3>(plc).facets().size(), 4u);
  RefineOptions<3> recovery;
  recovery.refine = false;
  const auto result = refine(plc, recovery);
  EXPECT_EQ(result.precision, 0);
  plc.precision = 0;
  const Domain<3> domain(plc);
  CheckOptions<3> options;
  options.domain = &domain;
  const CheckReport report = check(result.mesh, options);
  EXPECT_EQ(report.exit_code(), 0) << test::findings(report);
  plc.precision = 1e-14;  // asked for
  EXPECT_THROW(refine(plc, recovery), InputError);
}

// Plates as thin as that, or twice as thick: their sides had triangles in common, or were inside out, with all their segments in
// the mesh, which lacked cells or had others.
TEST(FilePrecision, MakesNoOtherVolume) {
  const test::TempFolder folder;
  std::mt19937 random(7);
  int made_with[2] = {0, 0};
  for (int k = 0; k < 60; ++k) {
    const double height = std::exp2(-27 + 0.14 * k);  // from 7e-9 to 2e-6
    const Plc<3> plc = read_plc<3>(
        folder.put("plate.stl", stl_of(test::turned<3>(rough_plate(1 + k % 4, height, random), 0.1 * k))));
    RefineOptions<3> recovery;
    recovery.refine = false;
    RefineResult<3> result;
    try {
      result = refine(plc, recovery);
    } catch (const InputError& e) {  // floats may let it intersect itself
      EXPECT_GT(diagnose(plc).error_count(), 0u) << k << ": " << e.what();
      continue;
    }
    ++made_with[result.precision > default_precision];
    Plc<3> as_made = plc;
    as_made.precision = result.precision;
    const Domain<3> domain(as_made);
    CheckOptions<3> options;
    options.domain = &domain;
    const CheckReport report = check(result.mesh, options);
    EXPECT_EQ(report.exit_code(), 0) << k << ": " << test::findings(report);
  }
  EXPECT_GT(made_with[0], 10);
  EXPECT_GT(made_with[1], 10);
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

}  // namespace pgdr::test_precision_files
