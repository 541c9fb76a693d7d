// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <set>

#include "input/words.hpp"
#include "space/point_places.hpp"
#include "weld/joining.hpp"

namespace pgdr::detail {
namespace {

template <int D>
class DataJoiner {
 public:
  explicit DataJoiner(Joining<D>& joining) : j_(joining), mesh_(joining.out.mesh) {}

  void run() {
    join_labels();
    join_leaves();
    join_point_data(
        "markers of points", [](const OutputMesh<D>& mesh) -> const auto& { return mesh.point_markers; }, mesh_.point_markers);
    join_point_data(
        "attributes of points", [](const OutputMesh<D>& mesh) -> const auto& { return mesh.point_attributes; },
        mesh_.point_attributes);
    for (std::uint32_t m = 0; m < j_.meshes.size(); ++m)
      for (const auto& [marker, name] : j_.meshes[m]->names.markers) give_name(mesh_.names.markers, marker, m, name, "marker");
  }

 private:
  void join_labels() {
    bool any = false;
    for (std::uint32_t m = 0; m < j_.meshes.size(); ++m) {
      const OutputMesh<D>& mesh = *j_.meshes[m];
      std::set<double> given(mesh.regions.begin(), mesh.regions.end());
      if (mesh.regions.empty()) given.insert(0);
      for (const double label : given) {
        const double kept = j_.options->relabel ? static_cast<double>(j_.out.labels.size() + 1) : label;
        j_.out.labels.push_back({m, label, kept});
        any = any || kept != 0;
      }
      for (const auto& [label, name] : mesh.names.regions)
        if (given.contains(label)) give_name(mesh_.names.regions, label_of(m, label), m, name, "label");
    }
    if (!any) return;
    mesh_.regions.reserve(mesh_.cells.size());
    for (std::uint32_t m = 0; m < j_.meshes.size(); ++m)
      for (std::size_t c = 0; c < j_.meshes[m]->cells.size(); ++c) mesh_.regions.push_back(label_of(m, j_.label(m, c)));
  }

  /// By bisection: labels are sorted.
  double label_of(std::uint32_t m, double given) const {
    const auto at = std::ranges::lower_bound(j_.out.labels, std::pair(m, given), {},
                                             [](const JoinedLabel& l) { return std::pair(l.mesh, l.given); });
    return at->label;
  }

  template <class Number>
  void give_name(std::map<Number, std::string>& names, Number number, std::uint32_t m, const std::string& name,
                 const char* what) {
    const auto [at, is_new] = names.try_emplace(number, name);
    if (is_new || at->second == name) return;
    j_.out.dropped.push_back(std::string("the name \"") + name + "\" that " + j_.name(m) + " has for the " + what + " " +
                             to_text(static_cast<double>(number)) + ", which is called \"" + at->second + "\"");
  }

  /// Leaves of one mesh are none of another.
  void join_leaves() {
    if (!have_all("leaves of cells", [](const OutputMesh<D>& mesh) { return mesh.leaves.size() / mesh.cells.size(); })) return;
    std::uint32_t first = 0;
    for (const OutputMesh<D>* mesh : j_.meshes) {
      std::uint32_t last = 0;
      for (const std::uint32_t leaf : mesh->leaves) {
        mesh_.leaves.push_back(first + leaf);
        last = std::max(last, leaf);
      }
      first += last + 1;
    }
  }

  /// Has each mesh as many numbers, and not none? If they are unlike, that is said.
  template <class Columns>
  bool have_all(const char* what, const Columns& columns) {
    const std::size_t count = columns(*j_.meshes[0]);
    for (std::uint32_t m = 1; m < j_.meshes.size(); ++m)
      if (const std::size_t other = columns(*j_.meshes[m]); other != count) {
        j_.out.dropped.push_back(std::string("the ") + what + ", of which " + j_.name(0) + " has " + std::to_string(count) +
                                 " each, and " + j_.name(m) + " " + std::to_string(other));
        return false;
      }
    return count > 0;
  }

  template <class Values, class Made>
  void join_point_data(const char* what, const Values& values, Made& made) {
    const auto columns = [&](const OutputMesh<D>& mesh) { return values(mesh).size() / mesh.points.size(); };
    if (!have_all(what, columns)) return;
    const std::size_t count = columns(*j_.meshes[0]);
    made.resize(mesh_.points.size() * count);
    std::vector<bool> has(mesh_.points.size());
    std::vector<std::uint64_t> unlike(j_.meshes.size());
    for (std::uint32_t m = 0; m < j_.meshes.size(); ++m)
      for (std::size_t v = 0; v < j_.out.vertices[m].size(); ++v) {
        const std::uint32_t to = j_.out.vertices[m][v];
        const auto row = values(*j_.meshes[m]).begin() + static_cast<std::ptrdiff_t>(v * count);
        const auto at = made.begin() + static_cast<std::ptrdiff_t>(to * count);
        if (has[to])
          unlike[m] += !std::equal(row, row + static_cast<std::ptrdiff_t>(count), at);
        else
          std::copy_n(row, count, at);
        has[to] = true;
      }
    for (std::uint32_t m = 0; m < j_.meshes.size(); ++m)
      if (unlike[m] > 0)
        j_.out.dropped.push_back(std::string("the ") + what + " of " + j_.name(m) + " at " + std::to_string(unlike[m]) +
                                 (unlike[m] == 1 ? " common vertex" : " common vertices") +
                                 ", where a mesh before it has others");
  }

  Joining<D>& j_;
  OutputMesh<D>& mesh_;
};

/// Vertices of one mesh alone on faces of one cell alone that may be meant to be one.
template <int D>
std::vector<Diagnostic> near_points(const Joining<D>& j) {
  const std::vector<Point<D>>& points = j.out.mesh.points;
  constexpr std::uint32_t none = 0xffffffffu, several = 0xfffffffeu;
  constexpr double distance = 0x1p-22;  // two ulps of a float between 1 and 2
  std::vector<std::uint32_t> mesh_of(points.size(), none);
  for (std::uint32_t m = 0; m < j.meshes.size(); ++m)
    for (const std::uint32_t v : j.out.vertices[m]) mesh_of[v] = mesh_of[v] == none || mesh_of[v] == m ? m : several;
  std::vector<std::vector<std::uint32_t>> loose(j.meshes.size());
  for (const OuterFace<D>& f : j.outer)
    for (const std::uint32_t v : f.vertices)
      if (!f.is_shared && mesh_of[v] == f.mesh) loose[f.mesh].push_back(v);
  const double scale = scale_of<D>(points).first;
  std::size_t count = 0;
  for (const auto& of_mesh : loose) count += of_mesh.size();
  PointGrid<D> grid(count, scale, distance);
  std::vector<Diagnostic> found;
  for (std::uint32_t m = 0; m < j.meshes.size(); ++m) {
    std::ranges::sort(loose[m]);
    loose[m].erase(std::unique(loose[m].begin(), loose[m].end()), loose[m].end());
    for (const std::uint32_t v : loose[m]) {
      const std::uint32_t near = found.size() < max_listed ? grid.nearest(points[v], points) : no_entity;
      if (near == no_entity) continue;
      const std::uint32_t a = j.number_in(mesh_of[near], near), b = j.number_in(m, v);
      found.push_back({.code = Errc::near_points,
                       .message = "vertex " + std::to_string(a) + " of " + j.name(mesh_of[near]) + " and vertex " +
                                  std::to_string(b) + " of " + j.name(m) + " are " +
                                  to_text(std::sqrt(squared_distance(points[near], points[v]))) + " apart, and not one, at " +
                                  to_text(points[v]),
                       .ids = {a, b},
                       .points = {in_space(points[near]), in_space(points[v])}});
    }
    for (const std::uint32_t v : loose[m]) grid.insert(points[v], v);
  }
  return found;
}

}  // namespace

template <int D>
void join_data(Joining<D>& joining) {
  DataJoiner<D>(joining).run();
}

template <int D>
void find_near_points(Joining<D>& joining) {
  joining.out.warnings = near_points(joining);
}

template void join_data<2>(Joining<2>&);
template void join_data<3>(Joining<3>&);
template void find_near_points<2>(Joining<2>&);
template void find_near_points<3>(Joining<3>&);

}  // namespace pgdr::detail
