// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The checker's look at bodies: meshes of with_bodies pass, spoilt ones do not.
#include <gtest/gtest.h>

#include <algorithm>

#include "pgdr/check_bodies.hpp"
#include "pgdr/refine.hpp"
#include "structure_plcs.hpp"

namespace pgdr {
namespace {

using Kind = CheckFinding::Kind;
constexpr BodyMode all_modes[] = {BodyMode::united, BodyMode::fragments, BodyMode::priority};

/// A box in a box, and one beside these.
Plc<3> three_boxes() { return test::boxes({{{{0, 0, 0}}, {{4, 4, 4}}}, {{{1, 1, 1}}, {{2, 2, 2}}}, {{{5, 0, 0}}, {{6, 2, 2}}}}); }

OutputMesh<3> mesh_of(const Plc<3>& plc, BodyMode mode) {
  RefineOptions<3> options;
  options.refine = false;
  return refine<3>(with_bodies(plc, mode).plc, options).mesh;
}

TEST(CheckBodies, PassesWhatIsRight) {
  const Plc<3> plc = three_boxes();
  for (const BodyMode mode : all_modes) {
    CheckReport report;
    const BodyCheck done = check_bodies(mesh_of(plc, mode), plc, mode, {}, report);
    EXPECT_TRUE(done.done) << done.left_out;
    EXPECT_EQ(report.finding_count, 0u) << (report.findings.empty() ? "" : report.findings[0].message);
  }
}

/// Cells with this label go.
OutputMesh<3> without(OutputMesh<3> mesh, double label) {
  std::size_t left = 0;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c)
    if (mesh.regions[c] != label) {
      mesh.cells[left] = mesh.cells[c];
      mesh.regions[left++] = mesh.regions[c];
    }
  mesh.cells.resize(left);
  mesh.regions.resize(left);
  return mesh;
}

TEST(CheckBodies, FindsWhatIsMissing) {
  const Plc<3> plc = three_boxes();
  for (const BodyMode mode : {BodyMode::united, BodyMode::fragments}) {
    const OutputMesh<3> mesh = mesh_of(plc, mode);
    const double last = *std::ranges::max_element(mesh.regions);
    CheckReport report;
    check_bodies(without(mesh, last), plc, mode, {}, report);
    EXPECT_EQ(report.count(Kind::wrong_volume), 1u);
  }
}

TEST(CheckBodies, FindsWrongLabels) {
  const Plc<3> plc = three_boxes();
  for (const BodyMode mode : {BodyMode::fragments, BodyMode::priority, BodyMode::disjoint}) {
    OutputMesh<3> mesh = mesh_of(plc, BodyMode::fragments);
    CheckReport report;
    if (mode != BodyMode::disjoint) std::ranges::replace(mesh.regions, 3.0, 1.0);
    check_bodies(mesh, plc, mode, {}, report);
    EXPECT_GT(report.count(Kind::wrong_region), 0u);
  }
}

TEST(CheckBodies, FindsCellsInNoBody) {
  const Plc<3> plc = three_boxes();
  Plc<3> smaller = plc;
  smaller.facets.resize(12);
  for (const BodyMode mode : all_modes) {
    CheckReport report;
    check_bodies(mesh_of(plc, mode), smaller, mode, {}, report);
    EXPECT_GT(report.count(Kind::wrong_region), 0u);
  }
}

TEST(CheckBodies, SaysWhatItLeavesOut) {
  Plc<3> plc = three_boxes();
  const OutputMesh<3> mesh = mesh_of(plc, BodyMode::united);
  CheckReport report;
  Plc<3> open = plc;
  open.facets.pop_back();
  EXPECT_NE(check_bodies(mesh, open, BodyMode::united, {}, report).left_out.find("not closed"), std::string::npos);
  plc.holes.push_back({{0.5, 0.5, 0.5}});
  EXPECT_FALSE(check_bodies(mesh, plc, BodyMode::united, {}, report).done);
  EXPECT_EQ(report.finding_count, 0u);
}

}  // namespace
}  // namespace pgdr
