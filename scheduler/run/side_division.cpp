// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// An orbit is all pieces, of all chains, that hang together by edges which they have in common on some side: what the motions
// make of one edge, in any order. It is halved as its first piece is, on the first side of that, and what comes is carried from
// piece to piece. Where motions turn an edge round onto itself, parts of meshes count both ways round; so halves do, too.
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <utility>

#include "run/periodic_sides.hpp"

namespace pgdr::detail {
namespace {

template <int D>
class Division {
 public:
  using Chain = SideChain<D>;
  using Piece = typename Chain::Piece;

  Division(std::vector<Chain>& chains, const std::vector<std::vector<std::vector<SidePart>>>& parts)
      : chains_(chains), parts_(parts) {
    for (std::uint32_t c = 0; c < chains.size(); ++c)
      for (std::uint32_t k = 0; k < chains[c].pieces().size(); ++k) nodes_.push_back({.chain = c, .piece = k});
    for (std::uint32_t n = 0; n < nodes_.size(); ++n)
      for (std::uint32_t s = 0; s < chain(n).sides().size(); ++s) uses_[edge(n, s)].push_back({n, s});
  }

  bool run() {
    bool any = false;
    for (std::uint32_t n = 0; n < nodes_.size(); ++n)
      if (!nodes_[n].is_known) any = halve_orbit(n) || any;
    std::vector<std::vector<Piece>> made(chains_.size());
    for (std::uint32_t n = 0; n < nodes_.size(); ++n) append_pieces(n, made[nodes_[n].chain]);
    for (std::size_t c = 0; c < chains_.size(); ++c) chains_[c].set_pieces(std::move(made[c]));
    return any;
  }

 private:
  using Edge = std::array<std::uint32_t, 2>;
  /// A new place, so far along a piece.
  struct Middle {
    double at;
    std::uint32_t place;
    bool operator<(const Middle& other) const { return at < other.at; }
  };
  /// A piece of a chain.
  struct Node {
    std::uint32_t chain, piece;
    bool is_known = false, is_reversed = false;  // the latter: against the first of its orbit
    std::vector<Middle> middles{};
  };
  struct Use {
    std::uint32_t node, side;
  };
  /// One more of an orbit, and the edge in common with one that is known.
  struct Member {
    Use from, here;
  };

  Chain& chain(std::uint32_t n) { return chains_[nodes_[n].chain]; }
  /// The points of a piece's ends on a side.
  Edge ends(std::uint32_t n, std::uint32_t s) {
    const auto& [a, b] = chain(n).pieces()[nodes_[n].piece];
    const auto& at = chain(n).sides()[s].at;
    return {at[a], at[b]};
  }
  Edge edge(std::uint32_t n, std::uint32_t s) {
    Edge e = ends(n, s);
    std::ranges::sort(e);
    return e;
  }

  /// All of the orbit of a piece but itself. @param turned  set: it is its own image, the other way round
  std::vector<Member> find_orbit(std::uint32_t first, bool& turned) {
    std::vector<Member> members;
    std::vector<std::uint32_t> order{first};
    nodes_[first].is_known = true;
    for (std::size_t i = 0; i < order.size(); ++i) {
      const std::uint32_t n = order[i];
      for (std::uint32_t s = 0; s < chain(n).sides().size(); ++s)
        for (const Use& use : uses_.at(edge(n, s))) {
          const bool is_reversed = nodes_[n].is_reversed != (ends(n, s) != ends(use.node, use.side));
          if (!std::exchange(nodes_[use.node].is_known, true)) {
            nodes_[use.node].is_reversed = is_reversed;
            members.push_back({{n, s}, use});
            order.push_back(use.node);
          }
          turned = turned || nodes_[use.node].is_reversed != is_reversed;
        }
    }
    return members;
  }

  void add_parts(std::uint32_t n, bool is_reversed, std::vector<SidePart>& parts) const {
    for (const SidePart& part : parts_[nodes_[n].chain][nodes_[n].piece])
      parts.push_back(is_reversed ? SidePart{1 - part.to, 1 - part.from, part.length} : part);
  }

  bool halve_orbit(std::uint32_t first) {
    bool turned = false;
    const std::vector<Member> members = find_orbit(first, turned);
    std::vector<SidePart> parts;
    for (const bool round : {false, true}) {
      if (round && !turned) break;
      add_parts(first, round, parts);
      for (const Member& m : members) add_parts(m.here.node, nodes_[m.here.node].is_reversed != round, parts);
    }
    halve(first, 0, 1, parts);
    for (const auto& [from, here] : members)
      for (const auto& [at, place] : nodes_[from.node].middles) {
        const std::uint32_t point = chain(from.node).sides()[from.side].at[place];
        const bool is_along = nodes_[from.node].is_reversed == nodes_[here.node].is_reversed;
        nodes_[here.node].middles.push_back({is_along ? at : 1 - at, chain(here.node).add_place_of(here.side, point)});
      }
    return !nodes_[first].middles.empty();
  }

  /// Halves the part of a piece from one number to another until no part of the mesh there is shorter.
  void halve(std::uint32_t n, double from, double to, const std::vector<SidePart>& parts) {
    constexpr double rounding = 1 + 0x1p-20;  // of what is as long, but for the ulps of its ends
    const auto& [i, k] = chain(n).pieces()[nodes_[n].piece];
    const Point<D> a = chain(n).point(chain(n).first(), i), b = chain(n).point(chain(n).first(), k);
    const double length = (to - from) * std::sqrt(squared_distance(a, b)), slack = (to - from) * 0x1p-20;
    const bool is_short = std::ranges::all_of(parts, [&](const SidePart& part) {
      return part.to <= from + slack || part.from >= to - slack || length <= part.length * rounding;
    });
    if (is_short) return;
    const double t = (from + to) / 2;
    Point<D> middle;
    for (int j = 0; j < D; ++j) middle[j] = (1 - t) * a[j] + t * b[j];
    nodes_[n].middles.push_back({t, chain(n).add_place(middle)});
    halve(n, from, t, parts);
    halve(n, t, to, parts);
  }

  void append_pieces(std::uint32_t n, std::vector<Piece>& made) {
    auto& middles = nodes_[n].middles;
    std::ranges::sort(middles, std::less<>());
    const auto [first, last] = chain(n).pieces()[nodes_[n].piece];
    std::uint32_t at = first;
    for (const auto& [t, place] : middles) {
      made.push_back({std::min(at, place), std::max(at, place)});
      at = place;
    }
    made.push_back({std::min(at, last), std::max(at, last)});
  }

  std::vector<Chain>& chains_;
  const std::vector<std::vector<std::vector<SidePart>>>& parts_;
  std::vector<Node> nodes_;
  std::map<Edge, std::vector<Use>> uses_;
};

}  // namespace

template <int D>
bool halve_pieces(std::vector<SideChain<D>>& chains, const std::vector<std::vector<std::vector<SidePart>>>& parts) {
  return Division<D>(chains, parts).run();
}

template bool halve_pieces<2>(std::vector<SideChain<2>>&, const std::vector<std::vector<std::vector<SidePart>>>&);
template bool halve_pieces<3>(std::vector<SideChain<3>>&, const std::vector<std::vector<std::vector<SidePart>>>&);

}  // namespace pgdr::detail
