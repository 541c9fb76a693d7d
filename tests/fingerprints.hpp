// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Fingerprints of meshes, in fingerprints.txt: every build, optimised or not, sanitized or not, must make the meshes that
// are written down there. The file's head says when it may change, and how to write it again.
#pragma once

#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "pgdr/refine.hpp"

namespace pgdr::test {

/// FNV-1a, 64 bits.
class Fnv {
 public:
  Fnv& number(std::uint64_t n) {
    bytes(&n, sizeof n);
    return *this;
  }
  template <class T>
  Fnv& list(const std::vector<T>& all) {
    number(all.size());
    if (!all.empty()) bytes(all.data(), all.size() * sizeof(T));
    return *this;
  }
  /// Of subsegments or subfacets, their vertices and markers.
  template <class Constraint>
  Fnv& constraints(const std::vector<Constraint>& all) {
    number(all.size());
    for (const Constraint& c : all) {
      bytes(c.vertices.data(), sizeof c.vertices);
      bytes(&c.marker, sizeof c.marker);
    }
    return *this;
  }
  std::string text() const {
    char digits[17];
    std::snprintf(digits, sizeof digits, "%016llx", static_cast<unsigned long long>(hash_));
    return digits;
  }

 private:
  void bytes(const void* data, std::size_t size) {
    for (std::size_t i = 0; i < size; ++i) hash_ = (hash_ ^ static_cast<const unsigned char*>(data)[i]) * 0x100000001b3u;
  }
  std::uint64_t hash_ = 0xcbf29ce484222325u;
};

/// Four columns, each a count and a hash, so that a difference says where it is: points (places and markers), cells (corners and
/// regions), pieces of the boundary (subsegments, subfacets and their markers), and reasons (why cells stayed poor; but for
/// angles, which the C library computes).
template <int D>
std::string fingerprint(const RefineResult<D>& r) {
  const OutputMesh<D>& mesh = r.mesh;
  Fnv points, cells, boundary, reasons;
  points.number(mesh.input_points).list(mesh.points).list(mesh.point_markers);
  cells.list(mesh.cells).list(mesh.regions);
  boundary.constraints(mesh.subsegments).constraints(mesh.subfacets);
  reasons.number(r.poor_left);
  for (const PoorReason& reason : r.reasons) {
    reasons.number(reason.cell).number(static_cast<std::uint64_t>(reason.code));
    for (const auto& entity : reason.entities) {
      reasons.number(static_cast<std::uint64_t>(entity.kind) << 32 | entity.facet);
      for (const auto& end : entity.ends)
        for (const double x : end) reasons.number(std::bit_cast<std::uint64_t>(x));
    }
  }
  const auto column = [](std::size_t count, const char* what, const Fnv& hash) {
    return std::to_string(count) + ' ' + what + ' ' + hash.text();
  };
  return column(mesh.points.size(), "points", points) + '\t' + column(mesh.cells.size(), "cells", cells) + '\t' +
         column(mesh.subsegments.size() + mesh.subfacets.size(), "boundary", boundary) + '\t' +
         column(r.reasons.size(), "reasons", reasons);
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
