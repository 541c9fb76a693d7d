// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "given/flat_groups.hpp"
#include "given/match.hpp"

namespace pgdr::checking {
namespace {

/// An edge of a subfacet, or a subsegment, which comes first among equal ones.
struct CreaseUse {
  std::array<std::uint32_t, 2> ends;  ///< sorted
  bool of_subfacet;
  std::uint32_t subfacet, apex;
};

CreaseUse edge_use(std::uint32_t a, std::uint32_t b, bool of_subfacet, std::uint32_t subfacet, std::uint32_t apex) {
  return {{std::min(a, b), std::max(a, b)}, of_subfacet, subfacet, apex};
}

}  // namespace

void check_creases(const GivenTask<3>& task, const GivenMatch<3>& match) {
  const OutputMesh<3>& mesh = task.mesh;
  std::vector<double> reach(mesh.subfacets.size(), task.input.reach());
  for (const OnGiven& on : match.on_given) reach[on.wall] = std::max(reach[on.wall], match.reach[on.given]);
  std::vector<CreaseUse> uses;
  uses.reserve(3 * mesh.subfacets.size() + mesh.subsegments.size());
  for (std::uint32_t s = 0; s < mesh.subfacets.size(); ++s)
    for (int i = 0; i < 3; ++i) {
      const auto& v = mesh.subfacets[s].vertices;
      uses.push_back(edge_use(v[(i + 1) % 3], v[(i + 2) % 3], true, s, v[i]));
    }
  for (const auto& s : mesh.subsegments) uses.push_back(edge_use(s.vertices[0], s.vertices[1], false, 0, 0));
  std::sort(uses.begin(), uses.end(), [](const CreaseUse& x, const CreaseUse& y) {
    return x.ends != y.ends ? x.ends < y.ends : x.of_subfacet < y.of_subfacet;
  });
  const auto corners = [&](std::uint32_t s) {
    const auto& v = mesh.subfacets[s].vertices;
    return std::array{mesh.points[v[0]], mesh.points[v[1]], mesh.points[v[2]]};
  };
  const auto are_one_facet = [&](const CreaseUse& x, const CreaseUse& y) {
    const double r = std::max(reach[x.subfacet], reach[y.subfacet]);
    return mesh.subfacets[x.subfacet].marker == mesh.subfacets[y.subfacet].marker &&
           may_be_even(corners(x.subfacet), mesh.points[y.apex], r) && may_be_even(corners(y.subfacet), mesh.points[x.apex], r);
  };
  for (std::size_t i = 0, j; i < uses.size(); i = j) {
    for (j = i + 1; j < uses.size() && uses[j].ends == uses[i].ends;) ++j;
    if (!uses[i].of_subfacet || (j - i == 2 && are_one_facet(uses[i], uses[i + 1]))) continue;
    task.findings.add(Kind::segment_not_conforming, {uses[i].ends[0], uses[i].ends[1]}, [&] {
      return "The edge with " + list_words(uses[i].ends) + ", at which " + std::to_string(j - i) +
             (j - i == 1 ? " subfacet ends" : " subfacets meet that are not one facet") + ", is no subsegment.";
    });
  }
}

}  // namespace pgdr::checking
