// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>

#include "given/cover.hpp"
#include "given/facet_sizes.hpp"
#include "given/flat_groups.hpp"
#include "given/match.hpp"
#include "space/box_tree.hpp"

namespace pgdr::checking {
namespace {

using Triangle = std::array<Point3, 3>;

class GivenFacetMatcher {
 public:
  GivenFacetMatcher(const GivenTask<3>& task, GivenMatch<3>& out)
      : task_(task), mesh_(task.mesh), input_(task.input), out_(out) {}

  void run() {
    set_reaches();
    plant_trees();
    for (std::uint32_t s = 0; s < mesh_.subfacets.size(); ++s) {
      task_.findings.heed_stop();
      match_subfacet(s);
    }
    for (std::uint32_t t = 0; t < input_.triangles().size(); ++t) {
      task_.findings.heed_stop();
      cover_triangle(t);
    }
  }

 private:
  Triangle corners(std::uint32_t subfacet) const {
    const auto& v = mesh_.subfacets[subfacet].vertices;
    return {mesh_.points[v[0]], mesh_.points[v[1]], mesh_.points[v[2]]};
  }
  Triangle given(std::uint32_t t) const { return input_.corners(input_.triangles()[t]); }

  /// A facet is met up to the tolerance. Further away may be where its points were moved to (twice the tolerance at most), what
  /// is one facet with others, within the tolerance of one plane (the same), and how else its polygons could be triangulated.
  void set_reaches() {
    const std::vector<bool> uneven = triangles_of_uneven_groups(input_);
    for (std::uint32_t t = 0; t < input_.triangles().size(); ++t) {
      const GivenTriangle& triangle = input_.triangles()[t];
      double most = input_.tolerance() * (uneven[t] ? 2 : 1);
      for (const std::uint32_t p : triangle.points) most = std::max(most, out_.moved[p]);
      out_.reach.push_back(most + input_.rounding() + input_.bend(triangle.facet));
    }
  }

  void plant_trees() {
    std::vector<detail::Box<3>> boxes;
    boxes.reserve(std::max(input_.triangles().size(), mesh_.subfacets.size()));
    for (std::uint32_t t = 0; t < input_.triangles().size(); ++t)
      boxes.push_back(detail::Box<3>::of(given(t)).widened(out_.reach[t]));
    given_ = std::make_unique<detail::BoxTree<3>>(boxes);
    boxes.clear();
    for (std::uint32_t s = 0; s < mesh_.subfacets.size(); ++s) boxes.push_back(detail::Box<3>::of(corners(s)));
    subfacets_ = std::make_unique<detail::BoxTree<3>>(boxes);
  }

  /// The tolerances alone tell its sides apart: its plane may be any.
  bool is_needle(const PlaneFrame& frame, double reach) const { return frame.width() <= 10 * reach; }

  static FlatPolygon in_frame(const PlaneFrame& frame, const Triangle& t) {
    FlatPolygon polygon;
    for (const Point3& x : t) {
      const auto p = frame.place(x);
      polygon.push_back({{p[0], p[1]}});
    }
    return polygon;
  }

  /// The parts of a subfacet that lie on no given triangle for which take(t).
  template <class Take>
  std::vector<FlatPolygon> off_given(const PlaneFrame& frame, const Triangle& s, const Take& take) {
    covers_.clear();
    given_->meeting(detail::Box<3>::of(s), [&](std::uint32_t t) {
      if (take(t)) covers_.emplace_back(frame, given(t), out_.reach[t], out_.reach[t]);
    });
    return uncovered_parts(in_frame(frame, s), covers_, input_.rounding());
  }

  void match_subfacet(std::uint32_t s) {
    const Triangle t = corners(s);
    const PlaneFrame frame(t);
    const int marker = mesh_.subfacets[s].marker;
    bool beside_others = false;
    const auto own = [&](std::uint32_t i) {
      const bool is_own = input_.marker(input_.triangles()[i]) == marker;
      beside_others |= !is_own;
      return is_own;
    };
    if (is_needle(frame, input_.reach())) {
      if (std::ranges::all_of(t, [&](const Point3& x) { return is_on_given(x, own); })) return;
      return report_off(s, t[0], false);
    }
    const auto off = off_given(frame, t, own);
    if (off.empty() && beside_others) match_overlaps(s, frame, t);
    if (off.empty()) return;
    const bool marked = off_given(frame, t, [](std::uint32_t) { return true; }).empty();
    report_off(s, frame.in_space(centre(off[0])), marked);
  }

  /// Where facets of several markers have the subfacet, it has the marker of the smallest one: none that is certainly smaller
  /// than those of its marker has all of it.
  void match_overlaps(std::uint32_t s, const PlaneFrame& frame, const Triangle& t) {
    const int marker = mesh_.subfacets[s].marker;
    const Point2 middle = centre(in_frame(frame, t));
    std::vector<std::uint32_t> own, others;
    double reach = 0;
    given_->meeting(detail::Box<3>::of(t), [&](std::uint32_t i) {
      const bool is_own = input_.marker(input_.triangles()[i]) == marker;
      const CoveringTriangle cover(frame, given(i), out_.reach[i], is_own ? out_.reach[i] : input_.tolerance());
      if (!cover.contains(middle)) return;
      (is_own ? own : others).push_back(i);
      reach = std::max(reach, out_.reach[i]);
    });
    if (others.empty() || is_needle(frame, reach)) return;
    if (!sizes_) sizes_.emplace(input_, *given_, out_.reach);
    double least = std::numeric_limits<double>::infinity();
    for (const std::uint32_t i : own) least = std::min(least, sizes_->least(i));
    const auto is_smaller = [&](std::uint32_t i) {
      return input_.marker(input_.triangles()[i]) != marker && sizes_->most(i) < least;
    };
    if (own.empty() || std::ranges::none_of(others, is_smaller) || !off_given(frame, t, is_smaller).empty()) return;
    task_.findings.add(Kind::wrong_marker, {s}, [&] {
      return "Subfacet " + std::to_string(s) + " (" + list_words(mesh_.subfacets[s].vertices) + ") has marker " +
             std::to_string(marker) + ", but lies on a smaller input facet of another marker, too, at " +
             words(frame.in_space(middle)) + ".";
    });
  }

  /// Within reach of a triangle, as far as its own plane and sides tell.
  template <class Take>
  bool is_on_given(const Point3& x, const Take& take) const {
    bool found = false;
    given_->meeting(detail::Box<3>::around(x), [&](std::uint32_t t) {
      if (found || !take(t)) return;
      const double reach = out_.reach[t];
      const Triangle corners = given(t);
      const PlaneFrame frame(corners);
      if (is_needle(frame, reach)) {
        found = true;  // its box has x
        return;
      }
      const auto p = frame.place(x);
      found = std::abs(p[2]) <= reach && CoveringTriangle(frame, corners, reach, reach).contains({{p[0], p[1]}});
    });
    return found;
  }

  void report_off(std::uint32_t s, const Point3& where, bool marked) {
    task_.findings.add(marked ? Kind::wrong_marker : Kind::stray_constraint, {s}, [&] {
      const std::string marker = std::to_string(mesh_.subfacets[s].marker);
      return "Subfacet " + std::to_string(s) + " (" + list_words(mesh_.subfacets[s].vertices) + ") has marker " + marker +
             (marked ? ", but lies on input facets of other markers alone" : " and leaves the input facets of that marker") +
             " at " + words(where) + ".";
    });
  }

  // Any marker will do: a subfacet of another one lies on given facets of that marker, which overlap this one there.
  void cover_triangle(std::uint32_t t) {
    const Triangle corners_of_t = given(t);
    const PlaneFrame frame(corners_of_t);
    const double reach = out_.reach[t];
    if (is_needle(frame, input_.reach())) return;
    covers_.clear();
    const FlatPolygon polygon = in_frame(frame, corners_of_t);
    const CoveringTriangle whole(frame, corners_of_t, input_.rounding(), reach);
    subfacets_->meeting(detail::Box<3>::of(corners_of_t).widened(reach), [&](std::uint32_t s) {
      const CoveringTriangle cover(frame, corners(s), reach, reach);
      if (cover.covers_nothing()) return;
      covers_.push_back(cover);
      if (whole.contains(centre(in_frame(frame, corners(s)))) || cover.contains(centre(polygon)))
        out_.on_given.push_back({t, s, cover.turned()});
    });
    for (const FlatPolygon& part : uncovered_parts(polygon, covers_, input_.rounding())) {
      Leftover<3> leftover{EntityKind::facet, t, {}};
      for (const Point2& x : part) leftover.corners.push_back(frame.in_space(x));
      out_.leftovers.push_back(std::move(leftover));
    }
  }

  const GivenTask<3>& task_;
  const OutputMesh<3>& mesh_;
  const GivenInput<3>& input_;
  GivenMatch<3>& out_;
  std::unique_ptr<detail::BoxTree<3>> given_, subfacets_;
  std::optional<FacetSizes> sizes_;  // once facets of several markers are beside each other
  std::vector<CoveringTriangle> covers_;
};

}  // namespace

void match_given_facets(const GivenTask<3>& task, GivenMatch<3>& out) { GivenFacetMatcher(task, out).run(); }

}  // namespace pgdr::checking
