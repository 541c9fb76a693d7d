// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The checker on meshes made by hand: sound ones pass, each kind of damage is found as what it is.
#include <gtest/gtest.h>

#include <stop_token>

#include "dimensions.hpp"
#include "mesh_mutations.hpp"
#include "pgdr/check.hpp"
#include "pgdr/error.hpp"
#include "test_check_models.hpp"

namespace test_check_by_hand {

using namespace pgdr;
using namespace pgdr::test;
using Kind = CheckFinding::Kind;

template <int D>
CheckReport check_model(const Model<D>& model, const OutputMesh<D>& mesh, int ulps = 2) {
  CheckOptions<D> options;
  options.input = &model.plc;
  options.conformity_ulps = ulps;
  options.delaunay = true;
  return check(mesh, options);
}

std::string listed(const CheckReport& report) {
  std::string text;
  for (const auto& f : report.findings) text += std::string(name(f.kind)) + ": " + f.message + "\n";
  return text;
}

template <int D>
CheckReport check_alone(const OutputMesh<D>& mesh) {
  CheckOptions<D> options;
  options.delaunay = true;
  return check(mesh, options);
}

template <class Tag>
class Check : public testing::Test {};
TYPED_TEST_SUITE(Check, test::Dimensions);

TYPED_TEST(Check, SoundMeshesPass) {
  constexpr int D = TypeParam::value;
  for (const auto& model : all_models<D>()) {
    const auto report = check_model(model, model.mesh);
    EXPECT_EQ(report.exit_code(), 0) << model.name << "\n" << listed(report);
    EXPECT_EQ(report.not_delaunay_rounding, 0u) << model.name;
    EXPECT_EQ(report.not_delaunay_refused, 0u) << model.name;
    EXPECT_EQ(check_alone(model.mesh).exit_code(), 0) << model.name << " without its input";
  }
}

TYPED_TEST(Check, EachKindOfDamageIsFound) {
  constexpr int D = TypeParam::value;
  std::map<std::string, int> applied;
  for (const auto& model : all_models<D>())
    for (const auto& mutations : {soundness_mutations<D>(), conformity_mutations<D>()})
      for (const auto& mutation : mutations) {
        auto mesh = model.mesh;
        applied[mutation.name];
        if (!mutation.apply(mesh)) continue;
        ++applied[mutation.name];
        const auto report = check_model(model, mesh);
        const auto found = [&](Kind k) { return report.count(k) > 0; };
        EXPECT_EQ(report.exit_code(), 6) << model.name << ": " << mutation.name;
        EXPECT_TRUE(std::any_of(mutation.expected.begin(), mutation.expected.end(), found))
            << model.name << ": " << mutation.name << " is found as\n"
            << listed(report);
      }
  for (const auto& [mutation, times] : applied) EXPECT_GT(times, 0) << mutation << " was never tried";
}

TYPED_TEST(Check, DamageOfSoundnessIsFoundWithoutTheInput) {
  constexpr int D = TypeParam::value;
  for (const auto& model : all_models<D>())
    for (const auto& mutation : soundness_mutations<D>()) {
      auto mesh = model.mesh;
      if (!mutation.apply(mesh)) continue;
      if (mutation.expected == std::vector{Kind::unreferenced_point}) continue;
      const auto report = check_alone(mesh);
      // In 2D a dropped hull wall is an open hull; nothing else needs the input.
      EXPECT_EQ(report.exit_code(), 6) << model.name << ": " << mutation.name;
    }
}

TYPED_TEST(Check, AStopTokenEndsIt) {
  constexpr int D = TypeParam::value;
  int stopped = 0;
  for (const auto& model : all_models<D>()) {
    std::stop_source stop;
    int asked = 0;
    CheckOptions<D> options;
    options.input = &model.plc;
    options.stop = stop.get_token();
    options.size = [&](const Point<D>&) {
      ++asked;
      stop.request_stop();
      return 1e9;
    };
    if (model.mesh.cells.size() < 2) continue;
    EXPECT_THROW(check(model.mesh, options), CancelledError) << model.name;
    EXPECT_EQ(asked, 1) << model.name << ": the next cell is not looked at any more";
    EXPECT_THROW(check(model.mesh, options), CancelledError) << model.name;
    EXPECT_EQ(asked, 1) << model.name << ": it is asked for before that, too";
    ++stopped;
  }
  EXPECT_GT(stopped, 2);
}

}  // namespace test_check_by_hand
