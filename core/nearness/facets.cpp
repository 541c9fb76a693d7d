// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <map>

#include "nearness/near_items.hpp"
#include "nearness/nearness.hpp"

namespace pgdr::checking {
namespace {

class NearFacets {
 public:
  explicit NearFacets(const NearTask& task) : task_(task), mesh_(task.mesh), input_(task.input) {
    std::map<int, std::vector<Triangle3>> given, meshed;
    for (const GivenTriangle& t : input_.triangles()) {
      given[input_.marker(t)].push_back(input_.corners(t));
      double& bend = bend_[input_.marker(t)];
      bend = std::max(bend, input_.bend(t.facet));
    }
    for (const auto& s : mesh_.subfacets) meshed[s.marker].push_back(corners(s.vertices));
    for (auto& [marker, triangles] : given) given_.try_emplace(marker, std::move(triangles));
    for (auto& [marker, triangles] : meshed) meshed_.try_emplace(marker, std::move(triangles));
  }

  void run() {
    const auto off = look_at_all(task_.findings, mesh_.subfacets.size(), [&](std::size_t s) {
      return farther(given_, mesh_.subfacets[s].marker, corners(mesh_.subfacets[s].vertices));
    });
    for (std::uint32_t s = 0; s < off.size(); ++s)
      if (off[s]) report_off(s, *off[s]);
    const auto left = look_at_all(task_.findings, input_.triangles().size(),
                                  [&](std::size_t t) { return uncovered(static_cast<std::uint32_t>(t)); });
    for (std::uint32_t t = 0; t < left.size(); ++t)
      if (left[t]) report_left(t, *left[t]);
  }

 private:
  using Sets = std::map<int, NearSet>;

  Triangle3 corners(const std::array<std::uint32_t, 3>& v) const {
    return {mesh_.points[v[0]], mesh_.points[v[1]], mesh_.points[v[2]]};
  }
  /// A facet that is bent may have been triangulated otherwise.
  double limit(int marker) const {
    const auto bend = bend_.find(marker);
    return task_.limit() + (bend == bend_.end() ? 0 : bend->second);
  }
  std::optional<FarPlace> farther(const Sets& sets, int marker, const Triangle3& piece) const {
    const auto set = sets.find(marker);
    if (set == sets.end()) return FarPlace{piece[0], std::numeric_limits<double>::infinity(), true};
    return set->second.farther(piece, limit(marker));
  }

  /// Of a given triangle what is to be in the mesh, and is not near. Where it touches a volume that is to be meshed in part
  /// alone, or other facets overlap it, its parts count: each as one of any facet that has it.
  std::optional<FarPlace> uncovered(std::uint32_t t) const {
    const GivenSurface& given = task_.given;
    const Triangle3 whole = input_.corners(input_.triangles()[t]);
    const int marker = input_.marker(input_.triangles()[t]);
    const auto parts = given.parts(t);
    const auto is_wanted = [&](const GivenSurface::Part& part) { return given.is_wanted(part.triangle); };
    const auto is_shared = [&](const GivenSurface::Part& part) { return given.markers(part.triangle).size() > 1; };
    if (parts.empty() && !given.wants_place(whole[0])) return std::nullopt;
    if (std::ranges::all_of(parts, is_wanted)) {
      auto far = farther(meshed_, marker, whole);
      if (!far || std::ranges::none_of(parts, is_shared)) return far;
    }
    for (const GivenSurface::Part& part : parts) {
      if (!is_wanted(part)) continue;
      std::optional<FarPlace> far;
      for (const int any : given.markers(part.triangle))
        if (far = farther(meshed_, any, given.corners(part.triangle)); !far) break;
      if (far) return far;
    }
    return std::nullopt;
  }

  std::string words_of(const FarPlace& far, const char* from) const {
    if (!far.is_certain)
      return std::string("whether it is within ") + words(task_.distance) + " of " + from + " could not be certified at " +
             words(far.where) + ", where it is " + words(far.distance) + " away.";
    if (std::isinf(far.distance)) return std::string("there are no ") + from + ", as at " + words(far.where) + ".";
    return std::string("it is ") + words(far.distance) + " from " + from + " at " + words(far.where) + ", farther than " +
           words(task_.distance) + ".";
  }

  void report_off(std::uint32_t s, const FarPlace& far) {
    const Triangle3 t = corners(mesh_.subfacets[s].vertices);
    const int marker = mesh_.subfacets[s].marker;
    const bool marked = far.is_certain && is_near_any(t);
    task_.findings.add(marked ? Kind::wrong_marker : Kind::off_surface, {s}, [&] {
      const std::string name = "Subfacet " + std::to_string(s) + " (" + list_words(mesh_.subfacets[s].vertices) +
                               ") has marker " + std::to_string(marker);
      return marked ? name + ", but is near input facets of other markers alone, as at " + words(far.where) + "."
                    : name + ": " + words_of(far, "input facets of that marker");
    });
  }

  bool is_near_any(const Triangle3& t) const {
    if (!all_given_) {
      std::vector<Triangle3> all;
      for (const GivenTriangle& g : input_.triangles()) all.push_back(input_.corners(g));
      all_given_ = std::make_unique<NearSet>(std::move(all));
    }
    return !all_given_->farther(t, task_.limit());
  }

  void report_left(std::uint32_t t, const FarPlace& far) {
    const std::uint32_t facet = input_.triangles()[t].facet;
    task_.findings.add(Kind::surface_not_covered, {facet}, [&] {
      return "Facet " + std::to_string(facet) + " of the input has marker " +
             std::to_string(input_.marker(input_.triangles()[t])) + ": " + words_of(far, "subfacets of that marker");
    });
  }

  const NearTask& task_;
  const OutputMesh<3>& mesh_;
  const GivenInput<3>& input_;
  Sets given_, meshed_;
  std::map<int, double> bend_;
  mutable std::unique_ptr<NearSet> all_given_;  // once something is near none of its marker
};

}  // namespace

void check_near_facets(const NearTask& task) { NearFacets(task).run(); }

}  // namespace pgdr::checking
