// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Collects pieces: edges of subfacets and subsegments are sorted together, so that equal ones stand beside each other;
// then a flood over the edges that are no subsegments.
#include "check/pieces.hpp"

#include <algorithm>

namespace pgdr::checking {
namespace {

/// An edge of a subfacet, or a subsegment (listed first among equal ones).
struct EdgeUse {
  std::array<std::uint32_t, 2> vertices;  ///< sorted
  bool of_subfacet;
  std::uint32_t index;  ///< 3 * subfacet + k, or the subsegment
  bool reversed;        ///< it runs from the larger vertex to the smaller
  friend auto operator<=>(const EdgeUse&, const EdgeUse&) = default;
};

EdgeUse edge_use(std::uint32_t a, std::uint32_t b, bool of_subfacet, std::uint32_t index) {
  return {{std::min(a, b), std::max(a, b)}, of_subfacet, index, a > b};
}

class PieceCollector {
 public:
  PieceCollector(const ConformityTask<3>& task, const Conformity<3>& conformity)
      : task_(task), mesh_(task.mesh), conformity_(conformity) {}

  Pieces run() {
    collect_edges();
    out_.turned.assign(mesh_.subfacets.size(), 0);
    seen_.assign(mesh_.subfacets.size(), 0);
    for (std::uint32_t t = 0; t < mesh_.subfacets.size(); ++t)
      if (!seen_[t]) flood(t);
    return std::move(out_);
  }

 private:
  void collect_edges() {
    std::vector<EdgeUse> uses;
    uses.reserve(3 * mesh_.subfacets.size() + mesh_.subsegments.size());
    for (std::uint32_t t = 0; t < mesh_.subfacets.size(); ++t)
      for (std::uint32_t k = 0; k < 3; ++k) {
        const auto& v = mesh_.subfacets[t].vertices;
        uses.push_back(edge_use(v[(k + 1) % 3], v[(k + 2) % 3], true, 3 * t + k));
      }
    for (std::uint32_t s = 0; s < mesh_.subsegments.size(); ++s)
      uses.push_back(edge_use(mesh_.subsegments[s].vertices[0], mesh_.subsegments[s].vertices[1], false, s));
    std::sort(uses.begin(), uses.end());
    links_.assign(3 * mesh_.subfacets.size(), {none, false});
    bound_.assign(3 * mesh_.subfacets.size(), {});
    for (std::size_t i = 0, j; i < uses.size(); i = j) {
      for (j = i + 1; j < uses.size() && uses[j].vertices == uses[i].vertices;) ++j;
      const auto group = std::span(uses).subspan(i, j - i);
      if (group[0].of_subfacet)
        link(group);
      else
        bound(group);
    }
  }

  void link(std::span<const EdgeUse> group) {
    if (group.size() == 2) {
      const bool turn = group[0].reversed == group[1].reversed;
      links_[group[0].index] = {group[1].index / 3, turn};
      links_[group[1].index] = {group[0].index / 3, turn};
      return;
    }
    const std::uint32_t t = group[0].index / 3;
    task_.findings.add(Kind::facet_not_conforming, {t}, [&] {
      return "The edge with " + list_words(group[0].vertices) + " of subfacet " + std::to_string(t) + " is used by " +
             std::to_string(group.size()) + " subfacets and is no subsegment.";
    });
  }

  void bound(std::span<const EdgeUse> group) {
    const Place place = conformity_.segment_of[group[0].index];
    for (const EdgeUse& use : group)
      if (use.of_subfacet && place.entity != none)
        bound_[use.index] = {place.entity, (use.reversed != group[0].reversed) != place.reversed, use.index / 3};
  }

  void flood(std::uint32_t start) {
    Piece piece{{start}, {}};
    seen_[start] = 1;
    bool orientable = true;
    for (std::size_t i = 0; i < piece.subfacets.size(); ++i) {
      const std::uint32_t t = piece.subfacets[i];
      for (std::uint32_t k = 0; k < 3; ++k) {
        if (bound_[3 * t + k].segment != no_entity) {
          piece.bounds.push_back(bound_[3 * t + k]);
          piece.bounds.back().reversed ^= out_.turned[t] != 0;
        }
        const auto [other, turn] = links_[3 * t + k];
        if (other == none) continue;
        const std::uint8_t turned = out_.turned[t] ^ static_cast<std::uint8_t>(turn);
        if (!seen_[other]) {
          seen_[other] = 1;
          out_.turned[other] = turned;
          piece.subfacets.push_back(other);
        } else {
          orientable &= out_.turned[other] == turned;
        }
      }
    }
    if (!orientable)
      task_.findings.add(Kind::facet_not_conforming, {start}, [&] {
        return "The subfacets connected to subfacet " + std::to_string(start) + " cannot all be turned the same way.";
      });
    out_.list.push_back(std::move(piece));
  }

  const ConformityTask<3>& task_;
  const OutputMesh<3>& mesh_;
  const Conformity<3>& conformity_;
  Pieces out_;
  std::vector<std::pair<std::uint32_t, bool>> links_;  ///< of 3 * subfacet + k: the one across the edge, turned over
  std::vector<PieceBound> bound_;
  std::vector<std::uint8_t> seen_;
};

}  // namespace

Pieces collect_pieces(const ConformityTask<3>& task, const Conformity<3>& conformity) {
  return PieceCollector(task, conformity).run();
}

}  // namespace pgdr::checking
