// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "replace/coarsen.hpp"

#include <algorithm>
#include <optional>
#include <unordered_map>
#include <utility>

#include "input/edges.hpp"
#include "replace/ahead.hpp"
#include "space/distances.hpp"

namespace pgdr::detail {
namespace {

/// An edge that waits, by its length and its ends.
struct WaitingEdge {
  double square;
  Point3 low, high;
  std::uint32_t a, b;  ///< at these
  double key() const { return square; }
  bool operator<(const WaitingEdge& o) const {  // the shortest is the top of a queue
    if (square != o.square) return square > o.square;
    return lex_less(o.low, low) || (low == o.low && lex_less(o.high, high));
  }
  bool is_same(const WaitingEdge& o) const { return a == o.a && b == o.b && low == o.low && high == o.high; }
};

class Coarsening {
 public:
  Coarsening(Changer& changer, double distance, HalfTangent floor)
      : changer_(changer), s_(changer.complex()), goal_{CornerRule::coarsen, distance, floor}, queue_(changer) {}

  bool run(const std::stop_token& stop) {
    const auto try_it = [this](const WaitingEdge& e, Trial& trial) { return try_edge(e, trial); };
    std::optional<WaitingEdge> refused;  // the last one, if nothing has changed since
    for (bool any = true; any;) {
      any = false;
      push_all();
      while (!queue_.empty()) {
        if (stop.stop_requested()) return false;
        const WaitingEdge e = queue_.pop(try_it);
        // An edge waits once for each change that was made at it: those follow each other.
        if (!is_there(e) || (refused && e.is_same(*refused))) continue;
        if (changer_.settle(queue_.trial(e, try_it))) {
          any = true;
          refused.reset();
          push_edges(changer_.last());
        } else {
          refused_[edge_key(e.a, e.b)] = touched(e.a, e.b);
          refused = e;
        }
      }
    }
    return true;
  }

 private:
  std::uint32_t touched(std::uint32_t a, std::uint32_t b) const { return changer_.touched(a) + changer_.touched(b); }
  /// All edges but those that were refused, and nothing at whose ends has changed since.
  void push_all() {
    std::vector<std::uint32_t> all;
    for (std::uint32_t f = 0; f < s_.faces.size(); ++f)
      if (s_.faces[f].alive) all.push_back(f);
    push_edges(all);
  }
  void push_edges(const std::vector<std::uint32_t>& faces) {
    std::vector<std::uint64_t> keys;
    for (const std::uint32_t f : faces)
      for (std::size_t i = 0; i < 3; ++i) keys.push_back(edge_key(s_.faces[f].corners[i], s_.faces[f].corners[(i + 1) % 3]));
    std::sort(keys.begin(), keys.end());
    keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
    for (const std::uint64_t key : keys) {
      auto [a, b] = edge_of(key);
      if (lex_less(s_.at(b), s_.at(a))) std::swap(a, b);
      if (s_.order[a] == VertexOrder::fixed && s_.order[b] == VertexOrder::fixed) continue;
      const auto refused = refused_.find(key);
      if (refused != refused_.end() && refused->second == touched(a, b)) continue;
      queue_.push({squared_distance(s_.at(a), s_.at(b)), s_.at(a), s_.at(b), a, b});
    }
  }
  bool is_there(const WaitingEdge& e) const {
    if (!(s_.at(e.a) == e.low && s_.at(e.b) == e.high)) return false;
    const auto& faces = s_.faces_at[e.a];
    return std::any_of(faces.begin(), faces.end(), [&](std::uint32_t f) { return s_.has_corner(f, e.b); });
  }
  /// @returns false if it is not there
  bool try_edge(const WaitingEdge& e, Trial& trial) const {
    if (!is_there(e)) return false;
    changer_.read_around(std::array{e.a, e.b}, trial);
    if (!is_contractible(s_, e.a, e.b)) return true;
    const bool both_free = s_.order[e.a] == VertexOrder::free && s_.order[e.b] == VertexOrder::free;
    if (both_free && try_to_put(e.a, e.b, on_edge(e.low, e.high, 0.5), trial)) return true;
    if (!try_to_put(e.a, e.b, e.high, trial)) try_to_put(e.b, e.a, e.low, trial);
    return true;
  }
  bool try_to_put(std::uint32_t u, std::uint32_t v, const Point3& place, Trial& trial) const {
    auto change = contraction(s_, u, v, place);
    return change && changer_.judge(std::move(*change), goal_, trial) == Verdict::yes;
  }

  Changer& changer_;
  const SurfaceComplex& s_;
  ChangeGoal goal_;
  AheadQueue<WaitingEdge> queue_;
  std::unordered_map<std::uint64_t, std::uint32_t> refused_;  // by the key of an edge, how often its ends had been touched
};

}  // namespace

bool coarsen(Changer& changer, double distance, HalfTangent floor, const std::stop_token& stop) {
  return Coarsening(changer, distance, floor).run(stop);
}

}  // namespace pgdr::detail
