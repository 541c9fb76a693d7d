// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The checker against inputs with tolerances: sound meshes made by hand pass.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "dimensions.hpp"
#include "domain_plcs.hpp"
#include "numbers/vectors.hpp"
#include "pgdr/check.hpp"
#include "pgdr/predicates.hpp"
#include "test_check_models.hpp"

namespace test_check_given_by_hand {

using namespace pgdr;

template <int D>
CheckReport check_given(const Plc<D>& plc, const OutputMesh<D>& mesh, std::optional<double> tolerance = {}) {
  CheckOptions<D> options;
  options.input = &plc;
  options.tolerance = tolerance;
  options.delaunay = true;
  return check(mesh, options);
}

std::string listed(const CheckReport& report) {
  std::string text;
  for (const auto& f : report.findings) text += std::string(name(f.kind)) + ": " + f.message + "\n";
  return text;
}

template <class Tag>
class GivenByHand : public testing::Test {};
TYPED_TEST_SUITE(GivenByHand, test::Dimensions);

TYPED_TEST(GivenByHand, SoundMeshesPass) {
  constexpr int D = TypeParam::value;
  for (const auto& model : test::all_models<D>())
    for (const std::optional<double> tolerance : {std::optional<double>{}, std::optional<double>{0}}) {
      const auto report = check_given(model.plc, model.mesh, tolerance);
      EXPECT_EQ(report.exit_code(), 0) << model.name << "\n" << listed(report);
    }
}

/// A cell whose corners lie in one plane but for rounding, and a pyramid of the cells between those of its faces that are seen
/// from an apex and that one.
struct PyramidOnFlatCell {
  Plc<3> plc;
  OutputMesh<3> mesh;

  /// @param p  the corners of the cell, which go round, then the apex
  explicit PyramidOnFlatCell(const std::array<Point3, 5>& p) {
    plc.points.assign(p.begin(), p.end());
    plc.facets.push_back({{{0, 1, 2, 3}}, {}, 0});
    for (std::uint32_t i = 0; i < 4; ++i) plc.facets.push_back({{{i, (i + 1) % 4, 4}}, {}, 0});
    mesh.points = plc.points;
    mesh.input_points = p.size();
    std::array<std::uint32_t, 4> flat{0, 1, 2, 3};
    if (orient<3>({p[0], p[1], p[2], p[3]}) == Sign::negative) std::swap(flat[2], flat[3]);
    add_cell(flat);
    for (int i = 0; i < 4; ++i) {
      auto cell = flat;
      cell[i] = 4;
      if (orient<3>({p[cell[0]], p[cell[1]], p[cell[2]], p[cell[3]]}) != Sign::negative) continue;
      std::swap(cell[(i + 1) % 4], cell[(i + 2) % 4]);
      add_cell(cell);
    }
    for (const auto& [face, times] : faces_)
      if (times == 1) mesh.subfacets.push_back({face, 0});
    for (std::uint32_t i = 0; i < 4; ++i) {
      mesh.subsegments.push_back({{std::min(i, (i + 1) % 4), std::max(i, (i + 1) % 4)}, 0});
      mesh.subsegments.push_back({{i, 4}, 0});
    }
    std::ranges::sort(mesh.subsegments, {}, [](const auto& s) { return s.vertices; });
  }

  /// A facet that has the edge of the cell from its first corner to its second inside, is parallel to `along`, and outside.
  void add_sheet(const std::array<double, 3>& along) {
    const Point3 a = plc.points[0], b = plc.points[1];
    std::vector<std::uint32_t> polygon;
    for (const auto& [first, sense] : {std::pair{true, 3.0}, {true, -3.0}, {false, -3.0}, {false, 3.0}}) {
      Point3 x = first ? a : b;
      for (int k = 0; k < 3; ++k) x[k] += (first ? a[k] - b[k] : b[k] - a[k]) + sense * along[k];
      polygon.push_back(static_cast<std::uint32_t>(plc.points.size()));
      plc.points.push_back(x);
    }
    plc.facets.push_back({{polygon}, {}, 0});
    mesh.points = plc.points;
    mesh.input_points = plc.points.size();
  }

 private:
  void add_cell(const std::array<std::uint32_t, 4>& cell) {
    mesh.cells.push_back(cell);
    for (int i = 0; i < 4; ++i) {
      std::array face{cell[(i + 1) % 4], cell[(i + 2) % 4], cell[(i + 3) % 4]};
      std::ranges::sort(face);
      ++faces_[face];
    }
  }
  std::map<std::array<std::uint32_t, 3>, int> faces_;
};

// Rounding says on which side of a face the fourth corner of such a cell is. The sheet meets the cell in edges of it alone.
TEST(GivenByHand3, ASheetBesideAFlatCell) {
  int flat = 0;
  using Corners = std::vector<Point3>;
  for (const Corners& corners : {Corners{{{0, 0, 0}}, {{1, 0, 0}}, {{1, 1, 0}}, {{0, 1, 0}}},
                                 Corners{{{0, 0, 0}}, {{0.5, -0x1p-20, 0}}, {{1, 0, 0}}, {{0, 1, 0}}}})
    for (int turn = 0; turn < 100; ++turn) {
      Plc<3> plc;
      plc.points = corners;
      plc.points.insert(plc.points.end(), {{{0.25, 0.25, -1}}, {{0, 0, 1}}});
      const auto p = test::turned(plc, 0.1 + 0.05 * turn).points;
      if (orient<3>({p[0], p[1], p[2], p[3]}) == Sign::zero) continue;
      ++flat;
      PyramidOnFlatCell pyramid({p[0], p[1], p[2], p[3], p[4]});
      CheckOptions<3> options;
      options.input = &pyramid.plc;
      EXPECT_EQ(check(pyramid.mesh, options).exit_code(), 0) << turn << "\n" << listed(check(pyramid.mesh, options));
      pyramid.add_sheet(detail::difference(p[5], p[0]));
      EXPECT_EQ(check(pyramid.mesh, options).exit_code(), 0) << turn << "\n" << listed(check(pyramid.mesh, options));
    }
  EXPECT_GE(flat, 100);
}

}  // namespace test_check_given_by_hand
