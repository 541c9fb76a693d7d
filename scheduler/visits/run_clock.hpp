// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The seconds of a run and of its stages: on the wall, as work, and on the critical path. What runs side by side adds a section:
// the seconds of all that ran in it, and those of its longest chain, which no number of threads makes shorter. All else counts as
// it is, as it runs on one thread. One thread at a time.
#pragma once

#include <algorithm>
#include <chrono>
#include <string>
#include <utility>
#include <vector>

#include "pgdr/refine.hpp"

namespace pgdr::detail {

/// Seconds of something that ran on several threads.
struct SectionSeconds {
  double wall = 0;  ///< from its begin to its end
  double work = 0;  ///< of all threads
  double path = 0;  ///< of the longest chain of work that has to wait for each other
};

/// See above.
class RunClock {
 public:
  using Clock = std::chrono::steady_clock;

  explicit RunClock(Clock::time_point start) : start_(start) { stages_.reserve(most_stages); }

  /// Seconds since the run began.
  double now() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }
  /// Something has run side by side since the last call, or could have: where one thread ran all, what the wall has more than the
  /// work is serial.
  void add_section(double wall, double work, double path, bool on_several_threads) {
    const double serial = on_several_threads ? 0 : std::max(0.0, wall - work);
    sections_.wall += wall;
    sections_.work += work + serial;
    sections_.path += path + serial;
  }
  /// What the sections took so far.
  const SectionSeconds& sections() const { return sections_; }
  /// The whole run so far: serial work, and the sections.
  SectionSeconds total() const { return since(0, {}); }

  /// A stage, from its construction to its destruction. Stages follow each other.
  class Stage {
   public:
    Stage(RunClock& clock, std::string name)
        : clock_(&clock), name_(std::move(name)), start_(clock.now()), before_(clock.sections_) {}
    Stage(const Stage&) = delete;
    Stage& operator=(const Stage&) = delete;
    /// Where memory has run out it must not need any.
    ~Stage() {
      const SectionSeconds s = clock_->since(start_, before_);
      if (clock_->stages_.size() < clock_->stages_.capacity())
        clock_->stages_.push_back({std::move(name_), start_, s.wall, s.work, s.path});
    }

   private:
    RunClock* clock_;
    std::string name_;
    double start_;
    SectionSeconds before_;
  };
  /// Those that have ended, in their order.
  const std::vector<StageTime>& stages() const { return stages_; }

 private:
  static constexpr std::size_t most_stages = 64;

  SectionSeconds since(double start, const SectionSeconds& before) const {
    const double wall = now() - start, serial = wall - (sections_.wall - before.wall);
    return {wall, serial + sections_.work - before.work, serial + sections_.path - before.path};
  }

  Clock::time_point start_;
  SectionSeconds sections_;
  std::vector<StageTime> stages_;
};

}  // namespace pgdr::detail
