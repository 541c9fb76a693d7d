// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Facets of which a part is in the mesh: what is left over is found exactly once, as an oracle on a lattice counts it; and what
// is missing there, or too much, is a finding still.
#include <gtest/gtest.h>

#include <map>
#include <random>
#include <set>

#include "domain_plcs.hpp"
#include "given/volumes.hpp"
#include "refined_models.hpp"
#include "structure_plcs.hpp"

namespace test_check_given_leftovers {

using namespace pgdr;
using Kind = CheckFinding::Kind;

/// Of whole numbers, in the plane z = 0.
struct Rectangle {
  int x, y, width, height;
  bool has(int i, int k) const { return x <= i && i < x + width && y <= k && k < y + height; }
};

/// Bodies on the plane, of a height of 1 to 3 up or down, apart from each other on each side of it; and plates, which overlap.
struct Scene {
  std::vector<Rectangle> up, down, plates;
  Plc<3> plc;

  explicit Scene(unsigned seed) {
    std::mt19937 random(seed);
    const auto number = [&](int low, int high) {
      return low + static_cast<int>(random() % static_cast<unsigned>(high - low + 1));
    };
    const auto rectangle = [&](int most) { return Rectangle{number(0, 12), number(0, 12), number(1, most), number(1, most)}; };
    for (auto* side : {&up, &down})
      for (int tries = number(1, 5); tries > 0; --tries) {
        const Rectangle r = rectangle(6);
        const auto overlaps = [&](const Rectangle& o) {
          return r.x < o.x + o.width && o.x < r.x + r.width && r.y < o.y + o.height && o.y < r.y + r.height;
        };
        if (std::ranges::none_of(*side, overlaps)) side->push_back(r);
      }
    for (int k = number(1, 5); k > 0; --k) plates.push_back(rectangle(12));
    for (const bool is_up : {true, false})
      for (const Rectangle& r : is_up ? up : down) {
        const double h = number(1, 3);
        const double x = r.x, y = r.y;
        test::add_box(plc, {{x, y, is_up ? 0 : -h}}, {{x + r.width, y + r.height, is_up ? h : 0}}, 0);
      }
    for (const Rectangle& r : plates) {
      const double x = r.x, y = r.y;
      test::add_rectangle(plc, 2, 0, {{x, y}}, {{x + r.width, y + r.height}});
    }
    for (auto& f : plc.facets) f.marker = 0;
    if (seed % 2) plc = test::triangulated(plc);
  }

  /// Squares of the lattice that a plate covers, and no body.
  int left_over() const {
    const auto any = [](const std::vector<Rectangle>& list, int i, int k) {
      return std::ranges::any_of(list, [&](const Rectangle& r) { return r.has(i, k); });
    };
    int count = 0;
    for (int i = 0; i < 30; ++i)
      for (int k = 0; k < 30; ++k) count += any(plates, i, k) && !any(up, i, k) && !any(down, i, k);
    return count;
  }
};

struct Leftovers {
  double area = 0;
  int open_edges = 0;  // subsegments at which one triangle ends alone
};

std::array<std::uint32_t, 2> sorted(std::uint32_t a, std::uint32_t b) { return {std::min(a, b), std::max(a, b)}; }

Leftovers leftovers(const Plc<3>& plc, const OutputMesh<3>& mesh) {
  CheckReport report;
  checking::Findings findings(report, 0, {});
  const checking::GivenInput<3> input(plc, {}, findings);
  const checking::GivenTask<3> task{mesh, input, findings};
  checking::GivenMatch<3> match;
  checking::match_given_points<3>(task, checking::sort_points(mesh, findings), match);
  checking::match_given_segments<3>(task, match);
  checking::match_given_facets(task, match);
  const auto walls = checking::walls_of_mesh<3>(task, match);
  std::map<std::array<std::uint32_t, 2>, int> uses;
  Leftovers out;
  for (std::size_t i = 0; i < walls.simplices.size(); ++i) {
    const auto& v = walls.simplices[i];
    if (i >= mesh.subfacets.size()) out.area += test::area(walls.points[v[0]], walls.points[v[1]], walls.points[v[2]]);
    for (int k = 0; k < 3; ++k) ++uses[sorted(v[k], v[(k + 1) % 3])];
  }
  for (const auto& s : mesh.subsegments) out.open_edges += uses[sorted(s.vertices[0], s.vertices[1])] == 1;
  return out;
}

OutputMesh<3> quick_mesh(const Plc<3>& plc) {
  RefineOptions<3> options;
  options.min_dihedral = 0;
  return refine<3>(plc, options).mesh;
}

CheckReport check_given(const Plc<3>& plc, const OutputMesh<3>& mesh) {
  CheckOptions<3> options;
  options.input = &plc;
  return check(mesh, options);
}

TEST(GivenLeftovers, EachPartOfAPlaneOnce) {
  int in_part = 0;
  for (unsigned seed = 0; seed < 40; ++seed) {
    const Scene scene(seed);
    in_part += scene.left_over() > 0;
    for (const bool turned : {false, true}) {
      const Plc<3> plc = turned ? test::turned(scene.plc) : scene.plc;
      const auto mesh = quick_mesh(plc);
      const Leftovers found = leftovers(plc, mesh);
      EXPECT_NEAR(found.area, scene.left_over(), 1e-9) << seed << (turned ? ", turned" : "");
      EXPECT_EQ(found.open_edges, 0) << seed;
      EXPECT_LE(check_given(plc, mesh).exit_code(), 1)
          << seed << (turned ? ", turned\n" : "\n") << test::findings(check_given(plc, mesh));
    }
  }
  EXPECT_GE(in_part, 30);
}

/// The cells on one side of all subfacets, with those; by a cell of theirs.
OutputMesh<3> without_body(const OutputMesh<3>& mesh, std::uint32_t start) {
  using Face = std::array<std::uint32_t, 3>;
  const auto face = [&](std::uint32_t c, int i) {
    Face f{};
    for (int k = 0, n = 0; k < 4; ++k)
      if (k != i) f[n++] = mesh.cells[c][k];
    std::sort(f.begin(), f.end());
    return f;
  };
  std::map<Face, std::vector<std::uint32_t>> cells;
  for (std::uint32_t c = 0; c < mesh.cells.size(); ++c)
    for (int i = 0; i < 4; ++i) cells[face(c, i)].push_back(c);
  std::set<Face> walls;
  for (const auto& s : mesh.subfacets) {
    Face f = s.vertices;
    std::sort(f.begin(), f.end());
    walls.insert(f);
  }
  std::set<std::uint32_t> body{start};
  for (std::vector<std::uint32_t> stack{start}; !stack.empty();) {
    const std::uint32_t c = stack.back();
    stack.pop_back();
    for (int i = 0; i < 4; ++i)
      for (const std::uint32_t d : cells[face(c, i)])
        if (!walls.contains(face(c, i)) && body.insert(d).second) stack.push_back(d);
  }
  OutputMesh<3> out = mesh;
  out.cells.clear();
  out.regions.clear();
  std::set<std::uint32_t> used;
  std::set<Face> left;
  std::set<std::array<std::uint32_t, 2>> edges;
  for (std::uint32_t c = 0; c < mesh.cells.size(); ++c) {
    if (body.contains(c)) continue;
    out.cells.push_back(mesh.cells[c]);
    if (!mesh.regions.empty()) out.regions.push_back(mesh.regions[c]);
    for (int i = 0; i < 4; ++i) {
      left.insert(face(c, i));
      for (int k = 0; k < 4; ++k) edges.insert({mesh.cells[c][i], mesh.cells[c][k]});
    }
  }
  std::erase_if(out.subfacets, [&](const auto& s) {
    Face f = s.vertices;
    std::sort(f.begin(), f.end());
    return !left.contains(f);
  });
  std::erase_if(out.subsegments, [&](const auto& s) { return !edges.contains(s.vertices); });
  return out;
}

// All of a body is left over then, and its walls bound a volume that is to be meshed, with facets of other planes on the rest of
// its floor, whose edges cross its own.
TEST(GivenLeftovers, ABodyThatIsMissing) {
  int bodies = 0;
  for (unsigned seed = 100; seed < 110; ++seed) {
    const Scene scene(seed);
    for (const bool turned : {false, true}) {
      const Plc<3> plc = turned ? test::turned(scene.plc) : scene.plc;
      const auto mesh = quick_mesh(plc);
      for (std::uint32_t c = 0; c < mesh.cells.size(); c += static_cast<std::uint32_t>(mesh.cells.size()) / 4 + 1) {
        const auto other = without_body(mesh, c);
        if (other.cells.empty()) continue;
        ++bodies;
        const auto report = check_given(plc, other);
        EXPECT_GT(report.count(Kind::wrong_volume), 0u) << seed << ", " << c << test::findings(report);
      }
    }
  }
  EXPECT_GE(bodies, 30);
}

// A room with voids on its floor, side by side.
Plc<3> room() {
  Plc<3> plc = test::boxes(
      {{{{0, 0, 0}}, {{10, 10, 10}}}, {{{2, 2, 0}}, {{4, 4, 3}}}, {{{4, 2, 0}}, {{6, 4, 2}}}, {{{1, 7, 0}}, {{4, 9, 2}}}});
  for (auto& f : plc.facets) f.marker = 0;
  plc.holes = {{{3, 3, 1}}, {{5, 3, 1}}, {{2, 8, 1}}};
  return plc;
}

TEST(GivenLeftovers, WhatIsMissingBesideAVoid) {
  for (const Plc<3>& plc : {room(), test::turned(room()), test::triangulated(room())}) {
    const auto mesh = quick_mesh(plc);
    ASSERT_LE(check_given(plc, mesh).exit_code(), 1) << test::findings(check_given(plc, mesh));
    for (std::size_t s = 0; s < mesh.subfacets.size(); ++s) {
      auto other = mesh;
      other.subfacets.erase(other.subfacets.begin() + static_cast<std::ptrdiff_t>(s));
      const auto report = check_given(plc, other);
      EXPECT_GT(report.count(Kind::facet_not_conforming), 0u) << s << test::findings(report);
    }
    for (std::size_t h = 0; h < plc.holes.size(); ++h) {
      Plc<3> filled = plc;
      filled.holes.erase(filled.holes.begin() + static_cast<std::ptrdiff_t>(h));
      EXPECT_GT(check_given(plc, quick_mesh(filled)).count(Kind::hole_filled), 0u) << h;
      EXPECT_GT(check_given(filled, mesh).count(Kind::wrong_volume), 0u) << h;
    }
  }
}

}  // namespace test_check_given_leftovers
