// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The checker against the input as given, without a Domain: sound meshes made by hand pass, and each kind of damage is found.
#include <gtest/gtest.h>

#include "dimensions.hpp"
#include "mesh_mutations.hpp"
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

TYPED_TEST(GivenByHand, EachKindOfDamageIsFound) {
  constexpr int D = TypeParam::value;
  int tried = 0;
  for (const auto& model : test::all_models<D>())
    for (const auto& mutations : {test::soundness_mutations<D>(), test::conformity_mutations<D>()})
      for (const auto& mutation : mutations) {
        auto mesh = model.mesh;
        if (!mutation.apply(mesh)) continue;
        ++tried;
        EXPECT_EQ(check_given(model.plc, mesh).exit_code(), 6) << model.name << ": " << mutation.name;
      }
  EXPECT_GT(tried, 50);
}

}  // namespace test_check_given_by_hand
