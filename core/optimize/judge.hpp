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
//
// Where sizes vary, those at cells that might come are taken from the sizes at the cells that go (local_sizes.hpp), while changes
// are looked for. What would be kept is judged once more by the sizes at the cells that come, which are asked for in one
// block (is_better_by_own_sizes). So for all that is kept the above holds with qualities that are functions of the cells alone.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "change/replacement.hpp"
#include "optimize/cell_quality.hpp"
#include "refine/workspace.hpp"

namespace pgdr {

/// See above. Part of a worker: one thread at a time.
class Judge {
 public:
  static constexpr std::size_t most_known = 1 << 12;  ///< cells whose qualities are remembered
  enum class Rule { no_more_poor, better };
  /// What cells are like together.
  struct Standing {
    double worst = 1;         ///< least quality
    std::vector<int> levels;  ///< of the poor ones, those of quality below 1, the worst first
    int weight = 0;           ///< of these
    std::size_t too_big = 0;  ///< over a bound of size; counted for `poor` ones alone
    /// Square of the shortest edge, where `min_edge` is asked for.
    double shortest2 = std::numeric_limits<double>::infinity();
    void add_poor(int level) {
      levels.push_back(level);
      weight += CellQuality::weight(level);
    }
  };

  /// The workspace must outlive it.
  Judge(Workspace<3>& workspace, double min_dihedral)
      : w_(&workspace),
        sizes_vary_(workspace.context.bounds.sizes_vary()),
        quality_(workspace.context.bounds, min_dihedral),
        known_(most_known) {}

  const CellQuality& quality() const { return quality_; }
  /// How many qualities were asked for. It depends neither on what is remembered, as that depends on slots and workers, nor on
  /// whether sizes are functions.
  std::uint64_t asked() const { return quality_.evaluated() + looked_at_; }
  double of(CellId c);  ///< quality of a cell of the mesh, by the size at it
  /// Asks for the sizes at these cells of the mesh in one block, as far as they vary and are not known, as of() would for each.
  /// @throws UsageError bad_size; what the size function throws
  void ask(std::span<const CellId> cells);
  /// ask(), and takes sizes at cells that might come from these from now on (CellQuality::sizes_near).
  void take_sizes(std::span<const CellId> cells);
  /// What these cells of the mesh are like, by the size at each. Also takes their sizes. @throws as ask()
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

  /// Is what is accepted by rule `no_more_poor` better by the size at each cell that comes, too? If sizes vary it asks for these
  /// in one block. @throws as ask()
  bool is_better_by_own_sizes(const Replacement<3>& r);
  /// Remembers the sizes of these cells, which the replacement of which that was asked last has made.
  void learn_made(const Replacement<3>& r, std::span<const CellId> made);

 private:
  struct Known {
    CellId cell{0xffffffffu};
    std::uint16_t birth = 0;
    double quality = 0, size = 0;
  };
  /// Cells whose sizes are asked for in one block.
  struct SizeBlock {
    std::vector<Point3> centroids;
    std::vector<int> regions;
    std::vector<double> sizes;
    void clear();
    void add(const Simplex<3>& s, int region);
    void ask(const CellBounds<3>& bounds);
  };

  bool is_allowed(const Standing& now, const Standing& before, Rule rule) const;
  template <class WithinSize>
  void count(const Simplex<3>& s, double q, WithinSize within_size, Standing& standing) const;
  bool is_known(CellId c) const;
  const Known& learn(CellId c, double size);
  const Known& known_about(CellId c);
  bool is_flat(const std::array<VertexId, 4>& vertices, std::span<const EntityId> facets) const;

  Workspace<3>* w_;
  const bool sizes_vary_;
  CellQuality quality_;
  std::vector<Known> known_;     ///< of the cells asked for last
  std::uint64_t looked_at_ = 0;  ///< so often the quality of a cell of the mesh was asked for
  SizeBlock block_;
  std::vector<CellId> unknown_;        // scratch of ask()
  std::vector<double> sizes_of_made_;  ///< of is_better_by_own_sizes()
};

}  // namespace pgdr
