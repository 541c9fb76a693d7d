// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Fingerprints of meshes, in fingerprints.txt: every build, optimised or not, sanitized or not, must make the meshes that
// are written down there. The file's head says when it may change, and how to write it again.
#pragma once

#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "pgdr/refine.hpp"

namespace pgdr::test {

/// FNV-1a, 64 bits, of the bytes of all that a mesh and the reasons of its poor cells are made of (but for angles, which
/// the C library computes).
template <int D>
std::string fingerprint(const RefineResult<D>& r) {
  std::uint64_t hash = 0xcbf29ce484222325u;
  const auto bytes = [&hash](const void* data, std::size_t size) {
    for (std::size_t i = 0; i < size; ++i) hash = (hash ^ static_cast<const unsigned char*>(data)[i]) * 0x100000001b3u;
  };
  const auto all = [&bytes](const auto& list) {
    const std::uint64_t size = list.size();
    bytes(&size, sizeof size);
    if (size > 0) bytes(list.data(), size * sizeof list[0]);
  };
  const auto number = [&bytes](std::uint64_t n) { bytes(&n, sizeof n); };
  number(r.mesh.input_points);
  all(r.mesh.points);
  all(r.mesh.point_markers);
  all(r.mesh.cells);
  all(r.mesh.regions);
  all(r.mesh.subsegments);
  all(r.mesh.subfacets);
  number(r.poor_left);
  for (const PoorReason& reason : r.reasons) {
    number(reason.cell);
    number(static_cast<std::uint64_t>(reason.code));
    for (const auto& entity : reason.entities) number(static_cast<std::uint64_t>(entity.kind) << 32 | entity.id);
  }
  char text[64];
  std::snprintf(text, sizeof text, "%016llx %zu points %zu cells", static_cast<unsigned long long>(hash), r.mesh.points.size(),
                r.mesh.cells.size());
  return text;
}

/// Where PGDR_WRITE_FINGERPRINTS is set nothing is compared: the file is written when all tests of the program have run.
class Fingerprints : public testing::Environment {
 public:
  static bool writing() { return std::getenv("PGDR_WRITE_FINGERPRINTS") != nullptr; }

  void SetUp() override {
    std::ifstream in(PGDR_FINGERPRINTS);
    for (std::string line; std::getline(in, line);) {
      const auto tab = line.find('\t');
      if (line.starts_with("#")) {
        head_.push_back(line);
      } else if (tab != line.npos) {
        known_[line.substr(0, tab)] = line.substr(tab + 1);
      }
    }
  }
  void TearDown() override {
    if (!writing()) return;
    std::ofstream out(PGDR_FINGERPRINTS);
    for (const std::string& line : head_) out << line << '\n';
    for (const auto& [name, value] : found_) out << name << '\t' << value << '\n';
    ASSERT_TRUE(out.flush()) << PGDR_FINGERPRINTS;
  }
  void expect(const std::string& name, const std::string& value) {
    EXPECT_TRUE(found_.emplace(name, value).second) << name << " twice";
    if (writing()) return;
    const auto known = known_.find(name);
    ASSERT_NE(known, known_.end()) << "no fingerprint of " << name << " in " << PGDR_FINGERPRINTS;
    EXPECT_EQ(known->second, value) << name << ": another mesh than in " << PGDR_FINGERPRINTS;
  }

 private:
  std::vector<std::string> head_;
  std::map<std::string, std::string> known_, found_;
};

}  // namespace pgdr::test
