// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "arrange/cut_triangles.hpp"

#include <algorithm>
#include <deque>

#include "arrange/exact_cdt.hpp"
#include "input/edges.hpp"
#include "pgdr/predicates.hpp"
#include "space/equal_rows.hpp"
#include "space/make_set.hpp"
#include "space/point_places.hpp"

namespace pgdr::detail {
namespace {

/// What becomes of one triangle. Points: of the Domain, crossings behind these, then `made`.
struct LocalCut {
  std::vector<std::array<std::uint32_t, 3>> pieces;
  std::vector<Point3> made;  ///< where its cuts cross
  double farthest = 0;
};

class TriangleCutter {
 public:
  TriangleCutter(const Domain<3>& domain, std::span<const Piece> pieces, const Crossings& crossings, const Bulk& bulk,
                 const StopCheck& stop)
      : points_(domain.points()), pieces_(pieces), crossings_(crossings), bulk_(bulk), stop_(stop) {}

  CutTriangles run() {
    CutTriangles out;
    find_triangles(out);
    local_.resize(out.cut.size());
    constexpr std::size_t block = 16;
    bulk_.parts((out.cut.size() + block - 1) / block, [&](std::size_t part) {
      for (std::size_t k = part * block; k < std::min(out.cut.size(), (part + 1) * block); ++k) local_[k] = cut(out.cut[k]);
    });
    stop_();
    number_points(out);
    write(out);
    return out;
  }

 private:
  std::uint32_t first_made() const { return static_cast<std::uint32_t>(points_.size() + crossings_.points.size()); }
  const Point3& at(std::uint32_t v) const { return v < points_.size() ? points_[v] : crossings_.points[v - points_.size()].at; }
  std::span<const std::pair<std::uint64_t, std::uint32_t>> on_edge(std::uint64_t key) const {
    return equal_rows(std::span(crossings_.on_edges), key, [](const auto& row) { return row.first; });
  }
  std::span<const Crossings::Cut> cuts_of(std::uint32_t t) const {
    return equal_rows(std::span(crossings_.cuts), t, [](const auto& cut) { return cut.triangle; });
  }

  void find_triangles(CutTriangles& out) const {
    out.cut = bulk_.gather<std::uint32_t>(pieces_.size(), [&](std::size_t i, std::vector<std::uint32_t>& found) {
      const auto& c = pieces_[i].corners;
      if (pieces_[i].count < 3) return;
      const auto is_corner = [&](std::uint32_t v) { return pieces_[i].has(v); };
      const bool has_points = std::ranges::any_of(std::array{0, 1, 2}, [&](int k) {
        return !on_edge(edge_key(c[static_cast<std::size_t>(k)], c[static_cast<std::size_t>((k + 1) % 3)])).empty();
      });
      if (has_points || std::ranges::any_of(cuts_of(static_cast<std::uint32_t>(i)), [&](const Crossings::Cut& cut) {
            return !is_corner(cut.ends[0]) || !is_corner(cut.ends[1]);
          }))
        found.push_back(static_cast<std::uint32_t>(i));
    });
  }

  /// Points in the order of their places, so that no numbers matter.
  std::vector<std::uint32_t> points_of(std::uint32_t t) const {
    std::vector<std::uint32_t> found;
    for (const Crossings::Cut& cut : cuts_of(t)) found.insert(found.end(), cut.ends.begin(), cut.ends.end());
    const auto& c = pieces_[t].corners;
    for (std::size_t k = 0; k < 3; ++k)
      for (const auto& [key, v] : on_edge(edge_key(c[k], c[(k + 1) % 3]))) found.push_back(v);
    make_set(found);
    std::erase_if(found, [&](std::uint32_t v) { return pieces_[t].has(v); });
    std::ranges::stable_sort(found, [&](std::uint32_t v, std::uint32_t w) { return lex_less(at(v), at(w)); });
    return found;
  }

  /// Edges likewise.
  std::vector<Crossings::Cut> ordered_cuts_of(std::uint32_t t) const {
    std::vector<Crossings::Cut> cuts(cuts_of(t).begin(), cuts_of(t).end());
    const auto ends = [&](const Crossings::Cut& cut) {
      const Point3 &p = at(cut.ends[0]), &q = at(cut.ends[1]);
      return lex_less(q, p) ? std::array{q.x, p.x} : std::array{p.x, q.x};
    };
    std::ranges::stable_sort(cuts, [&](const auto& a, const auto& b) { return ends(a) < ends(b); });
    return cuts;
  }

  LocalCut cut(std::uint32_t t) const {
    const auto& c = pieces_[t].corners;
    std::deque<ExactPoint> given;
    const auto exact = [&](std::uint32_t v) -> const ExactPoint& {
      return v < points_.size() ? given.emplace_back(points_[v]) : crossings_.points[v - points_.size()].exact;
    };
    ExactCdt cdt({&exact(c[0]), &exact(c[1]), &exact(c[2])}, pieces_[t].axis);
    std::vector<std::pair<std::uint32_t, std::uint32_t>> vertex_of;  // of points
    std::vector<std::uint32_t> names(c.begin(), c.end());            // of vertices
    for (std::uint32_t k = 0; k < 3; ++k) vertex_of.emplace_back(c[k], k);
    for (const std::uint32_t v : points_of(t)) {
      const std::uint32_t vertex = cdt.insert(exact(v));
      vertex_of.emplace_back(v, vertex);
      if (vertex == names.size()) names.push_back(v);
    }
    std::ranges::sort(vertex_of);
    const auto vertex = [&](std::uint32_t v) { return std::ranges::lower_bound(vertex_of, std::pair{v, 0u})->second; };
    for (const Crossings::Cut& cut : ordered_cuts_of(t)) cdt.constrain(vertex(cut.ends[0]), vertex(cut.ends[1]));
    return named(cdt, names);
  }

  /// The triangles, with the vertices that cuts have made behind all other points.
  LocalCut named(ExactCdt& cdt, std::span<const std::uint32_t> names) const {
    LocalCut out;
    out.pieces = cdt.triangles();
    const auto known = static_cast<std::uint32_t>(names.size());
    for (std::uint32_t v = known; v < cdt.vertex_count(); ++v) {
      out.made.push_back(rounded(cdt.point(v)));
      out.farthest = std::max(out.farthest, distance(cdt.point(v), out.made.back()));
    }
    for (auto& piece : out.pieces)
      for (std::uint32_t& v : piece) v = v < known ? names[v] : first_made() + v - known;
    return out;
  }

  struct New {
    Point3 at;
    PointSource source;
  };
  /// All new points, in the order of their places; of equals the first stays.
  std::vector<New> new_points(const CutTriangles& out) const {
    std::vector<New> all;
    for (const CrossingPoint& p : crossings_.points) all.push_back({p.at, {}});
    for (auto row = crossings_.on_edges.rbegin(); row != crossings_.on_edges.rend(); ++row)
      if (row->second >= points_.size())
        all[row->second - points_.size()].source = {edge_of(row->first)[0], edge_of(row->first)[1], no_entity};
    for (std::size_t k = 0; k < local_.size(); ++k)
      for (const Point3& p : local_[k].made) all.push_back({p, pieces_[out.cut[k]].corners});
    std::ranges::stable_sort(all, [](const New& a, const New& b) { return lex_less(a.at, b.at); });
    all.erase(std::unique(all.begin(), all.end(), [](const New& a, const New& b) { return a.at == b.at; }), all.end());
    return all;
  }

  /// Gives the new points their numbers, by their places; what is at the place of a point of the Domain is that.
  void number_points(CutTriangles& out) {
    PointPlaces places(points_.size());
    for (std::uint32_t v = 0; v < points_.size(); ++v) places.insert(hash_of(points_[v]), v);
    const auto known = [&](const Point3& p) { return places.find(hash_of(p), [&](std::uint32_t v) { return points_[v] == p; }); };
    for (const New& p : new_points(out)) {
      if (known(p.at) != no_entity) continue;
      out.added.push_back(p.at);
      out.sources.push_back(p.source);
    }
    const auto number = [&](const Point3& p) {
      if (const std::uint32_t v = known(p); v != no_entity) return v;
      return static_cast<std::uint32_t>(points_.size()) +
             static_cast<std::uint32_t>(std::ranges::lower_bound(out.added, p, lex_less<3>) - out.added.begin());
    };
    for (const CrossingPoint& p : crossings_.points) {
      number_of_crossing_.push_back(number(p.at));
      out.farthest = std::max(out.farthest, distance(p.exact, p.at));
    }
    for (LocalCut& local : local_) {
      auto& made = made_numbers_.emplace_back();
      for (const Point3& p : local.made) made.push_back(number(p));
      out.farthest = std::max(out.farthest, local.farthest);
    }
  }

  std::uint32_t number(std::uint32_t v, std::size_t k) const {
    if (v < points_.size()) return v;
    return v < first_made() ? number_of_crossing_[v - points_.size()] : made_numbers_[k][v - first_made()];
  }

  void write(CutTriangles& out) const {
    const auto place = [&](std::uint32_t v) -> const Point3& {
      return v < points_.size() ? points_[v] : out.added[v - points_.size()];
    };
    out.begin.push_back(0);
    for (std::size_t k = 0; k < local_.size(); ++k) {
      for (const auto& piece : local_[k].pieces) {
        const std::array t{number(piece[0], k), number(piece[1], k), number(piece[2], k)};
        const bool has_area = t[0] != t[1] && t[1] != t[2] && t[2] != t[0] &&
                              !collinear<3>(place(t[0]), place(t[1]), place(t[2]));
        if (has_area) out.pieces.push_back(t);
      }
      out.begin.push_back(static_cast<std::uint32_t>(out.pieces.size()));
    }
    for (const auto& [key, v] : crossings_.on_edges) {
      const std::uint32_t w = number(v, 0);
      if (w != edge_of(key)[0] && w != edge_of(key)[1]) out.on_edges.emplace_back(key, w);
    }
    make_set(out.on_edges);
  }

  std::span<const Point3> points_;
  std::span<const Piece> pieces_;
  const Crossings& crossings_;
  const Bulk& bulk_;
  const StopCheck& stop_;
  std::vector<LocalCut> local_;
  std::vector<std::uint32_t> number_of_crossing_;
  std::vector<std::vector<std::uint32_t>> made_numbers_;
};

}  // namespace

CutTriangles cut_triangles(const Domain<3>& domain, std::span<const Piece> pieces, const Crossings& crossings, const Bulk& bulk,
                           const StopCheck& stop) {
  return TriangleCutter(domain, pieces, crossings, bulk, stop).run();
}

}  // namespace pgdr::detail
