// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The checker on refined meshes: they pass, and each kind of damage done to them is found. Inputs are axis-aligned, and
// slanted and far from the origin, where points of segments and facets are rounded.
#include <gtest/gtest.h>

#include "dimensions.hpp"
#include "mesh_mutations.hpp"
#include "pgdr/check.hpp"
#include "pgdr/refine.hpp"
#include "test_check_models.hpp"

namespace test_check_refined {

using namespace pgdr;
using namespace pgdr::test;
using Kind = CheckFinding::Kind;

template <class Tag>
class CheckRefined : public testing::Test {};
TYPED_TEST_SUITE(CheckRefined, test::Dimensions);

std::string listed(const CheckReport& report) {
  std::string text;
  for (const auto& f : report.findings) text += std::string(name(f.kind)) + ": " + f.message + "\n";
  return text;
}

TYPED_TEST(CheckRefined, SoundMeshesPassAndDamageIsFound) {
  constexpr int D = TypeParam::value;
  std::map<std::string, int> applied;
  int number = 0;
  for (const auto& model : all_models<D>()) {
    const std::string name = model.name + " " + std::to_string(number++);
    const Domain<D> domain(model.plc);
    RefineOptions<D> refine_options;
    refine_options.size = 0.9;
    refine_options.min_dihedral = 0;
    const auto refined = refine(domain, refine_options);
    CheckOptions<D> options;
    options.input = &model.plc;
    options.radius_edge_bound = refine_options.radius_edge_bound;
    options.size = refine_options.size;
    options.delaunay = true;
    options.reasons = &refined.reasons;
    const auto sound = check(refined.mesh, options);
    EXPECT_EQ(sound.exit_code(), refined.reasons.empty() ? 0 : 1) << name << "\n" << listed(sound);
    EXPECT_EQ(sound.not_delaunay_refused, 0u) << name;
    for (const auto& mutations : {soundness_mutations<D>(), conformity_mutations<D>()})
      for (const auto& mutation : mutations) {
        auto mesh = refined.mesh;
        applied[mutation.name];
        // Beside an entity whose split was refused a face may be other than Delaunay.
        if (!refined.reasons.empty() && mutation.expected == std::vector{Kind::not_delaunay}) continue;
        if (!mutation.apply(mesh)) continue;
        ++applied[mutation.name];
        const auto report = check(mesh, options);
        EXPECT_EQ(report.exit_code(), 6) << name << ": " << mutation.name;
        EXPECT_TRUE(std::any_of(mutation.expected.begin(), mutation.expected.end(), [&](Kind k) { return report.count(k) > 0; }))
            << name << ": " << mutation.name << " is found as\n"
            << listed(report);
      }
  }
  for (const auto& [mutation, times] : applied) EXPECT_GT(times, 0) << mutation << " was never tried";
}

}  // namespace test_check_refined
