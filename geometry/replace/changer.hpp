// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "pgdr/surface.hpp"
#include "replace/patch_tests.hpp"
#include "replace/shape.hpp"
#include "space/bulk.hpp"

namespace pgdr::detail {

/// Which corners a change has to make.
enum class CornerRule : std::uint8_t {
  coarsen,  ///< none worse than the worst that goes, or than `floor`
  improve,  ///< all on a higher level than the worst that goes; where that is as wanted all others, too, and fewer cells expected
  split,    ///< none worse than about half of the worst that goes, or than `floor`
};

/// What is asked of a change.
struct ChangeGoal {
  CornerRule rule = CornerRule::coarsen;
  double distance = 0;    ///< that the surfaces may be apart
  HalfTangent floor = 0;  ///< see CornerRule; of `improve` the corner that is wanted, above which no level is
};

/// The first test that said no.
enum class Verdict : std::uint8_t { yes, angle, fold, cells, size, distance, meets, gap, swept };

/// What came of a candidate: of its changes, judged one after the other until one passed.
struct Trial {
  std::vector<Verdict> refused;         ///< in their order
  std::optional<SurfaceChange> change;  ///< that passed
  std::optional<Expected> growth;       ///< of what the one judged last makes expect, once it is asked for
  /// How many changes had been made, where others may be made before this one: then `read` has to be known.
  std::optional<std::size_t> ahead_of;
  /// Where all lies that had a part in it: a face, point or kept edge that does not meet this box had none.
  Box<3> read = Box<3>::empty();
};

/// Makes changes that pass all tests. Trials may be made by any number of threads at once while no change is made.
class Changer {
 public:
  /// @param tolerance  E: what gaps and new places are measured with
  Changer(ChangingSurface& surface, double tolerance, const std::function<double(const Point3&)>& size, SurfaceReport& report)
      : s_(surface), tolerance_(tolerance), size_(size), report_(report), touched_(surface.complex.points.size()) {}

  /// Judges a change, whose verdict goes to the trial. @pre the trial has none that passed; it has read around what the change
  /// takes away
  Verdict judge(SurfaceChange change, const ChangeGoal& goal, Trial& trial) const;
  /// Notes that what is about these vertices is read: faces at their neighbours, and as far beyond as any test looks.
  void read_around(std::span<const std::uint32_t> vertices, Trial& trial) const;
  /// Counts what was judged, and makes the change that passed. @pre nothing in trial.read has changed since. @returns was there
  /// one?
  bool settle(const Trial& trial);

  /// Changes that are made from here on can be taken back, by end_transaction().
  void begin_transaction() {
    is_transaction_ = true;
    made_.clear();
  }
  /// How many have been made since.
  std::size_t made() const { return made_.size(); }
  /// How much more the surface makes expect than the given one.
  const Expected& growth() const { return growth_; }
  /// Takes all but the first `kept` back: the surface is what it was then, to the numbers of its faces and points. If none is
  /// kept, that counts as refused.
  void end_transaction(std::size_t kept);

  /// May trials be made ahead, by several threads?
  bool looks_ahead() const { return bulk_.is_parallel(); }
  const Bulk& bulk() const { return bulk_; }
  /// Forgets where changes were made before.
  void begin_changes() { changed_.clear(); }
  /// How many have been made since begin_changes().
  std::size_t changes() const { return changed_.size(); }
  /// Has a change been made since that a trial made ahead might have gone otherwise for? The box of the faces that went and came
  /// meets what the trial has read: else these had no part in it, and nothing else has changed.
  bool has_changed(const Trial& trial) const {
    return std::any_of(changed_.begin() + static_cast<std::ptrdiff_t>(*trial.ahead_of), changed_.end(),
                       [&](const Box<3>& box) { return box.meets(trial.read); });
  }

  const SurfaceComplex& complex() const { return s_.complex; }
  const GivenSurface& given() const { return s_.given; }
  std::uint64_t attempts() const { return attempts_; }  ///< changes that were judged
  /// Says that so many faces were left to themselves.
  void give_up(std::uint64_t faces) { report_.given_up += faces; }
  /// How often something at this vertex has changed.
  std::uint32_t touched(std::uint32_t v) const { return touched_[v]; }
  /// The faces that came with the change made last.
  const std::vector<std::uint32_t>& last() const { return last_; }

 private:
  Verdict verdict_of(SurfaceChange& change, const ChangeGoal& goal, Trial& trial) const;
  const Expected& growth_of(const SurfaceChange& change, Trial& trial) const;
  bool are_corners_fine(const SurfaceChange& change, const ChangeGoal& goal, Trial& trial) const;
  bool are_edges_short(const SurfaceChange& change) const;
  void make(const SurfaceChange& change);
  void count_refused(Verdict verdict);
  void count_made(SurfaceChange::Kind kind, bool is_taken_back = false);
  void note(const SurfaceChange& change);
  void take_back_last();

  ChangingSurface& s_;
  double tolerance_;
  const std::function<double(const Point3&)>& size_;
  SurfaceReport& report_;
  Bulk bulk_{true};
  std::uint64_t attempts_ = 0;
  std::vector<std::uint32_t> touched_;
  std::vector<std::uint32_t> last_;
  std::vector<Box<3>> changed_;

  /// Of a transaction.
  struct Made {
    SurfaceChange change;
    Point3 from;      // where the vertex that moved was
    Expected growth;  // before it
  };
  Expected growth_;
  bool is_transaction_ = false;
  std::vector<Made> made_;
};

/// Levels of corners, by one percent each, from flat to the corner that is wanted: how many are passed.
class CornerLevels {
 public:
  CornerLevels();
  std::size_t of(HalfTangent corner, HalfTangent wanted) const;

 private:
  std::vector<HalfTangent> least_;
};

}  // namespace pgdr::detail
