// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "nearness/given_creases.hpp"
#include "nearness/near_items.hpp"
#include "nearness/nearness.hpp"
#include "nearness/surface_edges.hpp"
#include "space/make_set.hpp"

namespace pgdr::checking {
namespace {

/// What surfaces do at an edge, so that it is a curve that is kept.
struct CurveKind {
  enum class What { end, branch, border } what;
  int low = 0, high = 0;  ///< of an end its marker, twice; of a border its two
  friend auto operator<=>(const CurveKind&, const CurveKind&) = default;
};

std::string words_of(const CurveKind& kind) {
  switch (kind.what) {
    case CurveKind::What::end: return "where facets of marker " + std::to_string(kind.low) + " end";
    case CurveKind::What::branch: return "where three or more facets meet";
    case CurveKind::What::border: break;
  }
  return "between facets of markers " + std::to_string(kind.low) + " and " + std::to_string(kind.high);
}

using Curves = std::map<CurveKind, std::vector<Segment3>>;

/// Appends the curves of a surface. @param markers(t): those that triangle t may have. @param certain: only those whose kind is
/// certain. @param points gets the ends of all
template <class Markers>
void append_curves(std::span<const Point3> points, const SurfaceEdges& edges, const Markers& markers, bool certain, Curves& out,
                   std::vector<std::uint32_t>& used) {
  edges.each([&](std::span<const SurfaceEdges::AtEdge> uses) {
    std::vector<int> all;
    bool is_certain = true;
    for (const auto& use : uses) {
      const auto of = markers(use.triangle);
      is_certain = is_certain && of.size() == 1;
      all.insert(all.end(), of.begin(), of.end());
    }
    if (certain && !is_certain) return;
    detail::make_set(all);
    const Segment3 ends{points[uses[0].ends[0]], points[uses[0].ends[1]]};
    const auto add = [&](const CurveKind& kind) {
      out[kind].push_back(ends);
      used.insert(used.end(), uses[0].ends.begin(), uses[0].ends.end());
    };
    if (uses.size() == 1)
      for (const int m : all) add({CurveKind::What::end, m, m});
    if (uses.size() > 2) add({CurveKind::What::branch});
    for (std::size_t i = 0; i < all.size(); ++i)
      for (std::size_t k = i + 1; k < all.size(); ++k) add({CurveKind::What::border, all[i], all[k]});
  });
}

std::map<CurveKind, NearSet> sets_of(const Curves& curves) {
  std::map<CurveKind, NearSet> sets;
  for (const auto& [kind, segments] : curves) sets.try_emplace(kind, segments);
  return sets;
}

class NearCurves {
 public:
  explicit NearCurves(const NearTask& task)
      : task_(task), mesh_(task.mesh), input_(task.input), given_(task.given), subsegments_(all_subsegments()) {}

  void run() {
    check_segments();
    if (!given_.volumes()) return;  // a finding; there are no curves without a complex
    check_curves();
  }

 private:
  std::vector<Segment3> all_subsegments() const {
    std::vector<Segment3> list;
    for (const auto& s : mesh_.subsegments) list.push_back({mesh_.points[s.vertices[0]], mesh_.points[s.vertices[1]]});
    return list;
  }
  Segment3 ends_of(const GivenSegment& s) const { return {input_.point(s.points[0]), input_.point(s.points[1])}; }

  std::string words_of_far(const FarPlace& far) const {
    if (!far.is_certain) return "which could not be certified at " + words(far.where);
    return "of which none is within " + words(task_.distance) + " at " + words(far.where) +
           (std::isinf(far.distance) ? std::string(": there is none") : ", but " + words(far.distance) + " away");
  }

  /// Subsegments with a marker and given segments of that marker; given segments without one and all subsegments.
  void check_segments() {
    std::map<int, std::vector<Segment3>> given, meshed;
    for (const GivenSegment& s : input_.segments()) given[s.marker].push_back(ends_of(s));
    for (std::size_t i = 0; i < mesh_.subsegments.size(); ++i)
      meshed[mesh_.subsegments[i].marker].push_back(
          {mesh_.points[mesh_.subsegments[i].vertices[0]], mesh_.points[mesh_.subsegments[i].vertices[1]]});
    std::map<int, NearSet> near_given, near_meshed;
    for (const auto& [marker, list] : given) near_given.try_emplace(marker, list);
    for (const auto& [marker, list] : meshed) near_meshed.try_emplace(marker, list);
    const auto far = look_at_all(task_.findings, mesh_.subsegments.size(), [&](std::size_t i) -> std::optional<FarPlace> {
      const auto& s = mesh_.subsegments[i];
      if (s.marker == 0) return std::nullopt;
      const Segment3 ends{mesh_.points[s.vertices[0]], mesh_.points[s.vertices[1]]};
      const auto set = near_given.find(s.marker);
      if (set == near_given.end()) return FarPlace{ends[0], std::numeric_limits<double>::infinity(), true};
      return set->second.farther(ends, task_.limit());
    });
    for (std::uint32_t i = 0; i < far.size(); ++i)
      if (far[i])
        task_.findings.add(Kind::off_surface, {i}, [&] {
          return "Subsegment " + std::to_string(i) + " (" + list_words(mesh_.subsegments[i].vertices) +
                 ") is near no input segment of its marker, " + std::to_string(mesh_.subsegments[i].marker) + ", " +
                 words_of_far(*far[i]) + ".";
        });
    for (const GivenSegment& s : input_.segments()) check_given_segment(s, near_given, near_meshed);
  }

  void check_given_segment(const GivenSegment& s, const std::map<int, NearSet>& near_given,
                           const std::map<int, NearSet>& near_meshed) {
    task_.findings.heed_stop();
    static const NearSet nothing(std::vector<Segment3>{});
    const auto own = near_meshed.find(s.marker);
    const Segment3 ends = ends_of(s);
    const NearSet& set = s.marker == 0 ? subsegments_ : own == near_meshed.end() ? nothing : own->second;
    const auto far = wanted_far_place(ends, set);
    if (!far) return;
    // Where others have the same place, subsegments have the marker of one of them.
    for (const auto& [marker, same] : near_given) {
      const auto other = near_meshed.find(marker);
      if (marker == s.marker || other == near_meshed.end() || same.farther(ends, input_.reach())) continue;
      if (!wanted_far_place(ends, other->second)) return;
    }
    task_.findings.add(Kind::surface_not_covered, {s.item}, [&] {
      return std::string(s.of_facet ? "Facet " : "Segment ") + std::to_string(s.item) + " of the input, from point " +
             std::to_string(s.points[0]) + " to " + std::to_string(s.points[1]) + ", is to be near subsegments of marker " +
             std::to_string(s.marker) + ", " + words_of_far(*far) + ".";
    });
  }

  /// Where it is far and to be in the mesh. What is in a volume that is not to be meshed is left out, ball by ball.
  std::optional<FarPlace> wanted_far_place(const Segment3& ends, const NearSet& set) const {
    std::vector<Segment3> pieces{ends};
    while (!pieces.empty()) {
      const Segment3 piece = pieces.back();
      pieces.pop_back();
      const auto far = set.farther(piece, task_.limit());
      if (!far) continue;
      if (given_.wants_place(far->where)) return far;
      const double length = std::sqrt(squared_distance(piece[0], piece[1]));
      const double at = std::sqrt(squared_distance(piece[0], far->where));
      const double free = std::max(given_.distance(far->where), task_.distance / 64);
      if (at > free) pieces.push_back({piece[0], along(piece, (at - free) / length)});
      if (at + free < length) pieces.push_back({along(piece, (at + free) / length), piece[1]});
    }
    return std::nullopt;
  }

  static Point3 along(const Segment3& s, double t) {
    Point3 p;
    for (int i = 0; i < 3; ++i) p[i] = s[0][i] + t * (s[1][i] - s[0][i]);
    return p;
  }

  void check_curves() {
    const auto is_wanted = [&](std::uint32_t t) { return given_.is_wanted(t); };
    const auto of_given = [&](std::uint32_t t) { return given_.markers(t); };
    const SurfaceEdges wanted(given_.triangles(), is_wanted), all(given_.triangles(), [](std::uint32_t) { return true; });
    std::vector<SurfaceEdges::Corners> subfacets;
    for (const auto& s : mesh_.subfacets) subfacets.push_back(s.vertices);
    const SurfaceEdges of_mesh(subfacets, [](std::uint32_t) { return true; });
    Curves required, allowed, meshed;
    std::vector<std::uint32_t> kept, unused;
    append_curves(given_.points(), wanted, of_given, true, required, kept);
    append_curves(given_.points(), wanted, of_given, false, allowed, unused);
    append_curves(given_.points(), all, of_given, false, allowed, unused);
    append_curves(
        std::span<const Point3>(mesh_.points), of_mesh,
        [&](std::uint32_t s) { return std::span<const int>(&mesh_.subfacets[s].marker, 1); }, true, meshed, unused);
    compare(meshed, sets_of(allowed), Kind::off_surface, "The mesh has an edge ", "the input has one ");
    compare(required, sets_of(meshed), Kind::surface_not_covered, "The input has an edge ", "the mesh has one ");
    check_creases(wanted, kept);
  }

  void compare(const Curves& curves, const std::map<CurveKind, NearSet>& others, Kind finding, const char* has,
               const char* lacks) {
    for (const auto& curve : curves) {
      const CurveKind& kind = curve.first;
      const std::vector<Segment3>& segments = curve.second;
      const auto set = others.find(kind);
      const auto far = look_at_all(task_.findings, segments.size(), [&](std::size_t i) -> std::optional<FarPlace> {
        if (set == others.end()) return FarPlace{segments[i][0], std::numeric_limits<double>::infinity(), true};
        return set->second.farther(segments[i], task_.limit());
      });
      for (std::size_t i = 0; i < far.size(); ++i)
        if (far[i])
          task_.findings.add(finding, {}, [&] {
            return has + words_of(kind) + ", from " + words(segments[i][0]) + " to " + words(segments[i][1]) + "; " + lacks +
                   "as near as " + words(task_.distance) + ", " + words_of_far(*far[i]) + ".";
          });
    }
  }

  void check_creases(const SurfaceEdges& edges, std::vector<std::uint32_t>& kept) {
    const NearSet segments([&] {
      std::vector<Segment3> list;
      for (const GivenSegment& s : input_.segments()) list.push_back(ends_of(s));
      return list;
    }());
    for (std::uint32_t v = 0; v < given_.points().size() && !segments.empty(); ++v)
      if (segments.distance(given_.points()[v], input_.reach()) <= input_.reach()) kept.push_back(v);
    detail::make_set(kept);
    const auto creases = given_creases(given_, edges, kept, task_.distance, task_.feature_angle);
    const auto far = look_at_all(task_.findings, creases.size(), [&](std::size_t i) {
      const auto [a, b] = creases[i];
      return subsegments_.farther(Segment3{given_.points()[a], given_.points()[b]}, task_.limit());
    });
    for (std::size_t i = 0; i < far.size(); ++i)
      if (far[i])
        task_.findings.add(Kind::surface_not_covered, {}, [&] {
          const auto [a, b] = creases[i];
          return "The input has a crease from " + words(given_.points()[a]) + " to " + words(given_.points()[b]) +
                 ", which is to be near subsegments, " + words_of_far(*far[i]) + ".";
        });
  }

  const NearTask& task_;
  const OutputMesh<3>& mesh_;
  const GivenInput<3>& input_;
  const GivenSurface& given_;
  NearSet subsegments_;
};

}  // namespace

void check_near_curves(const NearTask& task) { NearCurves(task).run(); }

}  // namespace pgdr::checking
