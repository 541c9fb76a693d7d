// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <utility>

#include "input/words.hpp"
#include "output/whole_arrays.hpp"
#include "pgdr/predicates.hpp"
#include "space/point_places.hpp"
#include "weld/joining.hpp"

namespace pgdr::detail {

void Refusals::throw_any(const std::vector<Diagnostic>& behind) const {
  if (listed_.empty()) return;
  std::vector<Diagnostic> all = listed_;
  all.insert(all.end(), behind.begin(), behind.end());
  Diagnostic first = all.front();
  throw InputError(std::move(first), std::move(all));
}

namespace {

constexpr std::uint64_t most_ids = 0xfffffffe;

[[noreturn]] void refuse_as_too_many() {
  throw ResourceError({.code = Errc::ids_exhausted, .message = "all meshes have more points or cells than can be numbered"});
}

template <int D>
class CellJoiner {
 public:
  explicit CellJoiner(Joining<D>& joining) : j_(joining), mesh_(joining.out.mesh) {}

  void run() {
    for (std::uint32_t m = 0; m < j_.meshes.size(); ++m) require_usable(m);
    number_points();
    add_cells();
    j_.refusals.throw_any();
  }

 private:
  static constexpr std::uint32_t none = 0xffffffffu;
  /// The mesh, and the number in it, of the point that was last seen at a place.
  struct Last {
    std::uint32_t mesh = none, point = 0;
    bool is_shared = false;
  };

  void require_usable(std::uint32_t m) {
    const OutputMesh<D>& mesh = *j_.meshes[m];
    require_whole(mesh, j_.options->names.empty() ? "" : j_.name(m));
    points_ += mesh.points.size();
    for (std::uint32_t v = 0; v < mesh.points.size(); ++v)
      for (const double x : mesh.points[v].x)
        if (!std::isfinite(x))
          throw InputError(
              {.code = Errc::not_finite,
               .message = "vertex " + std::to_string(v) + " of " + j_.name(m) + " has coordinates that are not finite",
               .ids = {v}});
  }

  /// Each gets a number when it is first met; points with equal coordinates have one hash once -0 is 0.
  void number_points() {
    if (points_ > most_ids) refuse_as_too_many();
    const bool knows_inputs = std::ranges::all_of(j_.meshes, [](const OutputMesh<D>* mesh) { return mesh->input_points > 0; });
    PointPlaces places(points_);
    j_.out.vertices.resize(j_.meshes.size());
    for (std::uint32_t m = 0; m < j_.meshes.size(); ++m) j_.out.vertices[m].resize(j_.meshes[m]->points.size());
    const auto number = [&](std::uint32_t m, std::size_t begin, std::size_t end) {
      for (std::size_t v = begin; v < end; ++v) j_.out.vertices[m][v] = number_of(j_.meshes[m]->points[v], places);
    };
    const auto inputs = [&](std::uint32_t m) { return std::min(j_.meshes[m]->input_points, j_.meshes[m]->points.size()); };
    if (knows_inputs)
      for (std::uint32_t m = 0; m < j_.meshes.size(); ++m) number(m, 0, inputs(m));
    mesh_.input_points = mesh_.points.size();
    for (std::uint32_t m = 0; m < j_.meshes.size(); ++m) number(m, knows_inputs ? inputs(m) : 0, j_.meshes[m]->points.size());
    require_distinct();
  }

  std::uint32_t number_of(const Point<D>& given, PointPlaces& places) {
    Point<D> p = given;
    for (double& x : p.x) x += 0.0;
    const std::size_t hash = hash_of(p);
    std::uint32_t number = places.find(hash, [&](std::uint32_t v) { return mesh_.points[v] == p; });
    if (number != no_entity) return number;
    number = static_cast<std::uint32_t>(mesh_.points.size());
    mesh_.points.push_back(given);
    places.insert(hash, number);
    return number;
  }

  /// Within a mesh. Counts the points of several meshes on the way.
  void require_distinct() {
    std::vector<Last> last(mesh_.points.size());
    for (std::uint32_t m = 0; m < j_.meshes.size(); ++m)
      for (std::uint32_t v = 0; v < j_.out.vertices[m].size(); ++v) {
        Last& there = last[j_.out.vertices[m][v]];
        if (there.mesh == m)
          j_.refusals.add(Errc::duplicate_point, [&] { return twice(m, there.point, v); });
        else if (there.mesh != none && !std::exchange(there.is_shared, true))
          ++j_.out.shared_points;
        there.mesh = m;
        there.point = v;
      }
  }

  Diagnostic twice(std::uint32_t m, std::uint32_t a, std::uint32_t b) const {
    const Point<D>& p = j_.meshes[m]->points[a];
    return {.code = Errc::duplicate_point,
            .message = "vertices " + std::to_string(a) + " and " + std::to_string(b) + " of " + j_.name(m) + " are both at " +
                       to_text(p),
            .ids = {a, b},
            .points = {in_space(p)}};
  }

  void add_cells() {
    j_.out.first_cell.push_back(0);
    for (const OutputMesh<D>* mesh : j_.meshes) j_.out.first_cell.push_back(j_.out.first_cell.back() + mesh->cells.size());
    if (j_.out.first_cell.back() > most_ids) refuse_as_too_many();
    mesh_.cells.reserve(j_.out.first_cell.back());
    for (std::uint32_t m = 0; m < j_.meshes.size(); ++m) {
      j_.heed_stop();
      for (std::uint32_t c = 0; c < j_.meshes[m]->cells.size(); ++c) {
        auto cell = j_.meshes[m]->cells[c];
        for (auto& v : cell) v = j_.out.vertices[m][v];
        Simplex<D> s;
        for (std::size_t i = 0; i <= D; ++i) s[i] = mesh_.points[cell[i]];
        if (orient<D>(s) != Sign::positive) j_.refusals.add(Errc::inconsistent_orientation, [&] { return inverted(m, c, s[0]); });
        mesh_.cells.push_back(cell);
      }
    }
  }

  Diagnostic inverted(std::uint32_t m, std::uint32_t c, const Point<D>& p) const {
    return {.code = Errc::inconsistent_orientation,
            .message = "cell " + std::to_string(c) + " of " + j_.name(m) + " is flat or turned over, at " + to_text(p),
            .ids = {c},
            .points = {in_space(p)}};
  }

  Joining<D>& j_;
  OutputMesh<D>& mesh_;
  std::uint64_t points_ = 0;
};

}  // namespace

template <int D>
void join_cells(Joining<D>& joining) {
  CellJoiner<D>(joining).run();
}

template void join_cells<2>(Joining<2>&);
template void join_cells<3>(Joining<3>&);

}  // namespace pgdr::detail
