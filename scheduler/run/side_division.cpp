// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// An orbit is all pieces, of all chains, that hang together by edges which they have in common on some side: what the motions
// make of one edge, in any order. It is cut where one of the meshes has cut one of its edges, that with the most cuts: as a mesh
// cuts its segments, in the middle or on shells about acute corners, so that neighbours which it has cut likewise do not cut each
// other again. What comes is carried from piece to piece. Where motions turn an edge round onto itself it is cut in the middle,
// so that its halves are pieces that are turned no more.
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

  Division(std::vector<Chain>& chains, const PieceCuts& cuts) : chains_(chains), cuts_(cuts) {
    for (std::uint32_t c = 0; c < chains.size(); ++c)
      for (std::uint32_t k = 0; k < chains[c].pieces().size(); ++k) nodes_.push_back({.chain = c, .piece = k});
    for (std::uint32_t n = 0; n < nodes_.size(); ++n)
      for (std::uint32_t s = 0; s < chain(n).sides().size(); ++s) uses_[edge(n, s)].push_back({n, s});
  }

  bool run() {
    bool any = false;
    for (std::uint32_t n = 0; n < nodes_.size(); ++n)
      if (!nodes_[n].is_known) any = cut_orbit(n) || any;
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

  static Cuts turned_round(Cuts cuts) {
    std::ranges::reverse(cuts);
    for (double& t : cuts) t = 1 - t;
    return cuts;
  }

  /// Where meshes have cut the pieces of an orbit: the cuts of the one with the most, of several the first.
  Cuts most_cuts(std::uint32_t first, const std::vector<Member>& members) const {
    Cuts most;
    const auto look_at = [&](std::uint32_t n) {
      for (const Cuts& cuts : cuts_[nodes_[n].chain][nodes_[n].piece])
        if (cuts.size() > most.size()) most = nodes_[n].is_reversed ? turned_round(cuts) : cuts;
    };
    look_at(first);
    for (const Member& m : members) look_at(m.here.node);
    return most;
  }

  void cut(std::uint32_t n, const Cuts& cuts) {
    const auto& piece = chain(n).pieces()[nodes_[n].piece];
    const Point<D> a = chain(n).point(chain(n).first(), piece[0]), b = chain(n).point(chain(n).first(), piece[1]);
    for (const double t : cuts) {
      Point<D> p;
      for (int j = 0; j < D; ++j) p[j] = (1 - t) * a[j] + t * b[j];
      nodes_[n].middles.push_back({t, chain(n).add_place(p)});
    }
  }

  bool cut_orbit(std::uint32_t first) {
    bool turned = false;
    const std::vector<Member> members = find_orbit(first, turned);
    Cuts cuts = most_cuts(first, members);
    if (turned && !cuts.empty()) cuts = {0.5};
    cut(first, cuts);
    for (const auto& [from, here] : members)
      for (const auto& [at, place] : nodes_[from.node].middles) {
        const std::uint32_t point = chain(from.node).sides()[from.side].at[place];
        const bool is_along = nodes_[from.node].is_reversed == nodes_[here.node].is_reversed;
        nodes_[here.node].middles.push_back({is_along ? at : 1 - at, chain(here.node).add_place_of(here.side, point)});
      }
    return !nodes_[first].middles.empty();
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
  const PieceCuts& cuts_;
  std::vector<Node> nodes_;
  std::map<Edge, std::vector<Use>> uses_;
};

}  // namespace

template <int D>
bool cut_pieces(std::vector<SideChain<D>>& chains, const PieceCuts& cuts) {
  return Division<D>(chains, cuts).run();
}

template bool cut_pieces<2>(std::vector<SideChain<2>>&, const PieceCuts&);
template bool cut_pieces<3>(std::vector<SideChain<3>>&, const PieceCuts&);

}  // namespace pgdr::detail
