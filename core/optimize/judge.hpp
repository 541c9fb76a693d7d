// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The judge of changes: is what comes better than what goes?
//
// Better: at the worst level of which the numbers of cells differ, fewer cells come than go. Rule `better` asks for that, of the
// changes within a detour. Rule `no_more_poor`, of all that is kept, asks that the poor cells weigh less, or as much, and that
// they are better. A cell weighs one, and one more for each factor of five that its quality is below the bounds: so one that is
// much too bad may go for a few that are nearly good. By both no cell that comes is below the worst level of those that go, and
// none that is too big takes the place of cells that are not.
//
// Why each phase ends. There are finitely many levels, and the order of Dershowitz and Manna, which compares multisets by what is
// said of "better", has no infinite descent. By `no_more_poor` the weight of the poor cells, a whole number, gets smaller, or
// stays, and the multiset of their levels gets smaller. That is so whoever makes the changes, and in whatever order. Within a
// detour there are few changes. What no change could help, a flat cell between walls that stay, say, holds up nothing beside it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "change/replacement.hpp"
#include "refine/workspace.hpp"
#include "rule/cell_quality.hpp"

namespace pgdr {

/// See above. Part of a worker: one thread at a time.
class Judge {
 public:
  enum class Rule { no_more_poor, better };
  /// What cells are like together.
  struct Standing {
    double worst = 1;         ///< least quality
    std::vector<int> levels;  ///< of the poor ones, those of quality below 1, the worst first
    int weight = 0;           ///< of these
    std::size_t too_big = 0;  ///< over a bound of size; counted for `poor` ones alone
    double shortest2 = 0;     ///< square of the shortest edge, where `min_edge` is asked for
    void add_poor(int level) {
      levels.push_back(level);
      weight += CellQuality::weight(level);
    }
  };

  /// The workspace must outlive it.
  Judge(Workspace<3>& workspace, double min_dihedral)
      : w_(&workspace),
        guesses_(workspace.context.bounds),
        asks_blocks_(workspace.context.bounds.asks_blocks()),
        quality_(workspace.context.bounds, min_dihedral, sizes()),
        known_(known_size) {}

  const CellQuality& quality() const { return quality_; }
  /// How many qualities were asked for. It does not depend on what is remembered, as that depends on slots and workers.
  std::uint64_t asked() const { return quality_.evaluated() + remembered_ - repeated_; }
  /// Where sizes are asked by blocks, what is judged rests on guesses (size_guesses.hpp) of these; null: they are asked at once.
  SizeGuesses* sizes() { return asks_blocks_ ? &guesses_ : nullptr; }
  /// Begins decisions about the cell.
  void begin(CellId c);
  /// Must be called before the mesh is changed: false if a guess was wrong, so that all since begin() is to be decided again.
  bool may_change();
  /// Must be called when all is decided. If it is to be decided again it returns false, and asked() is as it was before.
  bool settle(std::uint64_t asked_before);
  /// Is it known that all since begin() is to be decided again?
  bool guessed_wrong() const { return guessed_wrong_ || guesses_.is_wrong(); }
  double of(CellId c);  ///< quality of a cell of the mesh
  Standing standing_of(std::span<const CellId> cells);
  /// The largest quality of a level below that of the worst of those: no cell that comes may have it.
  static double too_bad(const Standing& before);
  /// Is one better than the other, as is said above?
  static bool is_better(const Standing& now, const Standing& before);

  /// May these cells take the place of those? Asks their levels, sizes and shortest edges, whether they are positive, exactly,
  /// and whether any is flat but for rounding.
  /// Returns what they would be like together, if they may.
  std::optional<Standing> accepts(const Replacement<3>& r, const Standing& before, Rule rule);
  /// Are all cells that come positive, exactly, and is none of them flat but for rounding?
  bool is_valid(const Replacement<3>& r) const;
  /// accepts() of cells of the mesh, for changes that were accepted one by one.
  bool accepts(std::span<const CellId> made, const Standing& before, Rule rule);

 private:
  struct Known {
    CellId cell{0xffffffffu};
    std::uint16_t birth = 0;
    double quality = 0;
  };
  static constexpr std::size_t known_size = 1 << 12;

  bool is_allowed(const Standing& now, const Standing& before, Rule rule) const;
  bool add(const Simplex<3>& s, int region, double enough, Standing& standing);
  bool is_flat(const std::array<VertexId, 4>& vertices, std::span<const EntityId> facets) const;

  Workspace<3>* w_;
  SizeGuesses guesses_;
  const bool asks_blocks_;
  bool guessed_wrong_ = false;
  CellQuality quality_;
  std::vector<Known> known_;      ///< of the cells asked for last
  std::uint64_t remembered_ = 0;  ///< so many answers were among them
  std::uint64_t repeated_ = 0;    ///< so many were asked for by decisions that were made again
};

}  // namespace pgdr
