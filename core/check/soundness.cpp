// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Soundness that needs no input: indices, coordinates, equal points, stars of vertices, subsegments that are edges.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "given/links.hpp"
#include "pgdr/predicates.hpp"

namespace pgdr::checking {
namespace {

template <std::size_t N>
bool has_repeated(std::array<std::uint32_t, N> v) {
  std::sort(v.begin(), v.end());
  return std::adjacent_find(v.begin(), v.end()) != v.end();
}

/// Bad and repeated vertices of one list of simplices; false if one does not exist.
template <class List, class Vertices>
bool check_vertices(const List& list, Vertices vertices, std::size_t points, const char* what, Findings& findings) {
  bool usable = true;
  for (std::size_t n = 0; n < list.size(); ++n) {
    const auto& v = vertices(list[n]);
    const auto id = static_cast<std::int64_t>(n);
    const auto text = [&] { return what + std::to_string(n) + " (" + list_words(v) + ") "; };
    if (*std::max_element(v.begin(), v.end()) >= points) {
      usable = false;
      findings.add(Kind::bad_index, {id},
                   [&] { return text() + "names a vertex that does not exist; there are " + std::to_string(points) + "."; });
    } else if (has_repeated(v)) {
      findings.add(Kind::repeated_vertex, {id}, [&] { return text() + "has a vertex twice."; });
    }
  }
  return usable;
}

}  // namespace

template <int D>
bool check_indices(const OutputMesh<D>& mesh, Findings& findings) {
  if (mesh.cells.size() >= none / (D + 1) || mesh.points.size() >= none)
    throw ResourceError({Errc::ids_exhausted, "The mesh has too many cells for 32-bit numbers of faces.", {}, 0, {}, {}});
  bool usable = true;
  for (std::size_t v = 0; v < mesh.points.size(); ++v) {
    bool finite = true;
    for (const double x : mesh.points[v].x) finite = finite && std::isfinite(x);
    if (finite) continue;
    usable = false;
    findings.add(Kind::not_finite, {static_cast<std::int64_t>(v)},
                 [&] { return "Vertex " + std::to_string(v) + " has coordinates that are not finite."; });
  }
  const std::size_t n = mesh.points.size();
  usable &= check_vertices(
      mesh.cells, [](const auto& c) -> const auto& { return c; }, n, "Cell ", findings);
  const auto of_constraint = [](const auto& c) -> const auto& { return c.vertices; };
  usable &= check_vertices(mesh.subsegments, of_constraint, n, "Subsegment ", findings);
  usable &= check_vertices(mesh.subfacets, of_constraint, n, "Subfacet ", findings);
  if (!mesh.regions.empty() && mesh.regions.size() != mesh.cells.size()) {
    usable = false;
    findings.add(Kind::bad_index, {}, [&] {
      return "There are " + std::to_string(mesh.regions.size()) + " region labels for " + std::to_string(mesh.cells.size()) +
             " cells.";
    });
  }
  if (!mesh.point_markers.empty() && mesh.point_markers.size() != n) {
    usable = false;
    findings.add(Kind::bad_index, {}, [&] {
      return "There are " + std::to_string(mesh.point_markers.size()) + " point markers for " + std::to_string(n) + " points.";
    });
  }
  return usable;
}

template <int D>
std::vector<std::uint32_t> sort_points(const OutputMesh<D>& mesh, Findings& findings) {
  std::vector<std::uint32_t> order(mesh.points.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    if (lex_less(mesh.points[a], mesh.points[b])) return true;
    return mesh.points[a] == mesh.points[b] && a < b;
  });
  for (std::size_t i = 1; i < order.size(); ++i) {
    const std::uint32_t a = order[i - 1], b = order[i];
    if (!(mesh.points[a] == mesh.points[b])) continue;
    findings.add(Kind::duplicate_point, {a, b}, [&] {
      return "Vertices " + std::to_string(a) + " and " + std::to_string(b) + " are both at " + words(mesh.points[a]) + ".";
    });
  }
  return order;
}

namespace {

/// Sign of n . (1, e, e^2) for an infinitesimal e > 0, n the normal of the face towards its left (2D), or by the right
/// hand (3D). Zero for no proper face.
template <int D>
Sign normal_sign(const OutputMesh<D>& mesh, const std::array<std::uint32_t, D>& face) {
  const auto& a = mesh.points[face[0]];
  const auto& b = mesh.points[face[1]];
  if constexpr (D == 2) {
    if (a[1] != b[1]) return a[1] > b[1] ? Sign::positive : Sign::negative;
    return b[0] > a[0] ? Sign::positive : Sign::negative;
  } else {
    for (int axis = 0; axis < 3; ++axis)
      if (const Sign s = orient_projected(a, b, mesh.points[face[2]], axis); s != Sign::zero) return s;
    return Sign::zero;
  }
}

}  // namespace

// A fixed direction d = (1, e, e^2) is in no plane spanned by doubles, so that from each vertex it points into the
// inside of a cell or out of the mesh. Seen from corner i of a cell it points into the cell iff the (inward) normals of
// the faces at i have a positive product with it; as all normals sum to zero, that is: the one of face i alone is
// negative. If every cell is positive and faces match, the number of cells round an inner vertex that hold a direction
// is the same for all directions, so that one direction is enough; on the hull it is a sample.
template <int D>
void check_stars(const OutputMesh<D>& mesh, const Links<D>& links, Findings& findings) {
  std::vector<std::uint8_t> covered(mesh.points.size(), 0);  // 0, 1, 2 = more
  std::vector<std::uint8_t> seen(mesh.points.size(), 0);     // bit 0: in a cell, bit 1: on the hull
  for (std::uint32_t c = 0; c < mesh.cells.size(); ++c) {
    findings.heed_stop();
    int negative = 0, corner = 0;
    for (int i = 0; i <= D; ++i) {
      const std::uint32_t face = (D + 1) * c + static_cast<std::uint32_t>(i);
      seen[mesh.cells[c][i]] |= 1;
      const auto v = face_vertices(mesh, face);
      if (links.neighbour[face] == none)
        for (const std::uint32_t u : v) seen[u] |= 2;
      if (normal_sign<D>(mesh, v) == Sign::negative) {
        ++negative;
        corner = i;
      }
    }
    if (auto& count = covered[mesh.cells[c][corner]]; negative == 1 && count < 2) ++count;
  }
  for (std::uint32_t v = 0; v < mesh.points.size(); ++v) {
    if (covered[v] <= 1 && (covered[v] == 1 || seen[v] != 1)) continue;
    findings.add(Kind::overlapping, {v}, [&] {
      return "The cells round " + vertex_words(mesh, v) +
             (covered[v] > 1 ? " overlap." : " do not close round it, though it is not on the hull.");
    });
  }
}

template <int D>
void check_subsegments_used(const OutputMesh<D>& mesh, Findings& findings) {
  if constexpr (D == 2) return;
  using Edge = std::array<std::uint32_t, 2>;
  const auto edge = [](std::uint32_t a, std::uint32_t b) { return a < b ? Edge{a, b} : Edge{b, a}; };
  std::vector<std::pair<Edge, std::uint32_t>> list;
  std::vector<std::uint8_t> on_segment(mesh.points.size(), 0);
  for (std::uint32_t s = 0; s < mesh.subsegments.size(); ++s) {
    const auto& v = mesh.subsegments[s].vertices;
    list.push_back({edge(v[0], v[1]), s});
    on_segment[v[0]] = on_segment[v[1]] = 1;
  }
  std::sort(list.begin(), list.end());
  std::vector<std::uint8_t> used(list.size(), 0);
  for (const auto& cell : mesh.cells) {
    findings.heed_stop();
    for (int i = 0; i <= D; ++i)
      for (int j = i + 1; j <= D; ++j) {
        if (!on_segment[cell[i]] || !on_segment[cell[j]]) continue;
        const std::pair key{edge(cell[i], cell[j]), 0u};
        const auto at = std::lower_bound(list.begin(), list.end(), key);
        if (at != list.end() && at->first == key.first) used[at - list.begin()] = 1;
      }
  }
  for (std::size_t n = 0; n < list.size(); ++n) {
    const bool repeated = n > 0 && list[n - 1].first == list[n].first;
    if (used[n] && !repeated) continue;
    if (repeated) used[n] = used[n - 1];
    findings.add(Kind::stray_constraint, {list[n].second}, [&] {
      return "Subsegment " + std::to_string(list[n].second) + " (" + list_words(list[n].first) + ") " +
             (repeated ? "is listed more than once." : "is an edge of no cell.");
    });
  }
}

template bool check_indices(const OutputMesh<2>&, Findings&);
template bool check_indices(const OutputMesh<3>&, Findings&);
template std::vector<std::uint32_t> sort_points(const OutputMesh<2>&, Findings&);
template std::vector<std::uint32_t> sort_points(const OutputMesh<3>&, Findings&);
template void check_stars(const OutputMesh<2>&, const Links<2>&, Findings&);
template void check_stars(const OutputMesh<3>&, const Links<3>&, Findings&);
template void check_subsegments_used(const OutputMesh<2>&, Findings&);
template void check_subsegments_used(const OutputMesh<3>&, Findings&);

}  // namespace pgdr::checking
