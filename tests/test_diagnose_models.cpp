// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Diagnosis of real inputs (models_folder.hpp): what is proper is found to be so, what is defective to have errors.
#include <gtest/gtest.h>

#include <map>
#include <set>

#include "models_folder.hpp"
#include "pgdr/diagnosis.hpp"
#include "pgdr/io.hpp"

namespace pgdr::test_diagnose_models {

// Errors found, or -1 where the file cannot be read.
int errors_in(const std::filesystem::path& file) {
  try {
    return static_cast<int>(diagnose(read_plc<3>(file)).error_count());
  } catch (const InputError&) {
    return -1;
  }
}

TEST(DiagnosisModels, Verdicts) {
  // Defective for some, but proper input, or repaired: facets given twice or at one edge or point, or without an area; odd
  // blanks in the file.
  const std::set<std::string> fine{"trimesh_joined_tetrahedra.obj", "openscad_cubes-touching.stl", "gc_hourglass_ico.obj",
                                   "trimesh_whitespace.off", "openscad_issue1580-zero-area-triangle.stl"};
  std::map<std::string, int> seen;
  for (const test::IndexRow& row : test::models_index()) {
    const std::string extension = row.file.substr(row.file.rfind('.') + 1);
    if (row.set != "surfaces" && row.set != "plc" && row.set != "defective") continue;
    const int errors = errors_in(test::models_folder() / row.file);
    ++seen[row.set];
    if (row.set == "defective") {
      EXPECT_EQ(errors == 0, fine.contains(row.file.substr(row.file.rfind('/') + 1))) << row.file << ": " << errors;
    } else {
      EXPECT_TRUE(errors == 0 || (errors < 0 && extension == "ply")) << row.file << ": " << errors;
    }
  }
  EXPECT_GE(seen["surfaces"], 10);
  EXPECT_GE(seen["plc"], 3);
  EXPECT_GE(seen["defective"], 8);
}

}  // namespace pgdr::test_diagnose_models
