// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "pgdr/surface.hpp"
#include "replace/patch_tests.hpp"
#include "replace/shape.hpp"

namespace pgdr::detail {

/// Which corners a change has to make.
enum class CornerRule : std::uint8_t {
  coarsen,  ///< none worse than the worst that goes, or than `floor`
  improve,  ///< all on a higher level than the worst that goes
  split,    ///< none worse than about half of the worst that goes, or than `floor`
};

/// What is asked of a change.
struct ChangeGoal {
  CornerRule rule = CornerRule::coarsen;
  double distance = 0;    ///< that the surfaces may be apart
  HalfTangent floor = 0;  ///< see CornerRule; of `improve` the corner that is wanted, above which no level is
};

/// The first test that said no.
enum class Verdict : std::uint8_t { yes, angle, fold, size, distance, meets, gap, swept };

/// Makes changes that pass all tests.
class Changer {
 public:
  /// @param tolerance  E: what gaps and new places are measured with
  Changer(ChangingSurface& surface, double tolerance, const std::function<double(const Point3&)>& size, SurfaceReport& report)
      : s_(surface), tolerance_(tolerance), size_(size), report_(report), touched_(surface.complex.points.size()) {}

  /// Reads the surface alone.
  Verdict judge(SurfaceChange& change, const ChangeGoal& goal) const;
  /// Makes the change if it may be made.
  Verdict attempt(SurfaceChange change, const ChangeGoal& goal);

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
  bool are_corners_fine(const SurfaceChange& change, const ChangeGoal& goal) const;
  bool are_edges_short(const SurfaceChange& change) const;
  void make(const SurfaceChange& change);
  void count(Verdict verdict, SurfaceChange::Kind kind);

  ChangingSurface& s_;
  double tolerance_;
  const std::function<double(const Point3&)>& size_;
  SurfaceReport& report_;
  std::uint64_t attempts_ = 0;
  std::vector<std::uint32_t> touched_;
  std::vector<std::uint32_t> last_;
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
