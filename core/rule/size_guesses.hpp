// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Sizes of cells that decisions rest on, one after the other, where a size function is asked by blocks. As long as a size is not
// known a decision goes on with a guess, and what it made of the guess is noted. In the end all of these are asked for in one
// block. If each size leads to what the guess has led to, the decision is the one that the sizes make. Else it is made again,
// with what is known by then: at least the first wrong guess is right then, so that this ends.
//
// A guess is the size at the cell that the decision is about. Where it counts it is hardly ever right to the last bit. So a long
// decision asks at once then; a short one goes on, as it is soon made again, and asks once. Plain containers; one thread at a
// time.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <utility>
#include <vector>

#include "pgdr/types.hpp"
#include "rule/cell_bounds.hpp"

namespace pgdr {

/// See above.
class SizeGuesses {
 public:
  using Numbers = std::array<double, 3>;
  /// What a decision makes of the size of a cell, beside numbers that it knows.
  using Answer = double (*)(const Simplex<3>& s, const Numbers& numbers, double size);

  /// The bounds must outlive it.
  explicit SizeGuesses(const CellBounds<3>& bounds) : bounds_(&bounds) {}
  SizeGuesses(const SizeGuesses&) = delete;
  SizeGuesses& operator=(const SizeGuesses&) = delete;

  /// Begins a decision about a cell of these corners in the region. Guesses that are not settled are forgotten.
  void begin(const Simplex<3>& s, int region);
  /// answer(s, numbers, CellBounds::size_at()) of a cell, or what a guess makes of it. @throws as CellBounds::sizes_at
  double answer(const Simplex<3>& s, int region, Answer answer, const Numbers& numbers);
  /// So many answers have rested on guesses since begin().
  std::size_t guessed() const { return guessed_; }
  /// Is an answer known to be wrong that was given since begin(), or since settle() said so?
  bool is_wrong() const { return wrong_; }
  /// Asks for the sizes that were guessed, in one block. Are all answers right that were given since begin(), or since this said
  /// that they are not? @throws as CellBounds::sizes_at
  bool settle();

  /// Has the size of a cell asked for as soon as others are; not where it is flat or turned over, which may be outside of the
  /// domain, where no size need be known.
  void add(const Simplex<3>& s, int region);
  /// Asks for those that were added. @throws as CellBounds::sizes_at
  void ask_added() {
    if (asked_ < known_.size()) ask();
  }
  /// How many sizes are remembered from one decision to another.
  static constexpr std::size_t most_remembered = 8192;

  /// As long as it lives, a decision is short.
  class Short {
   public:
    /// Of these guesses; null: none.
    explicit Short(SizeGuesses* guesses) : guesses_(guesses) {
      if (guesses_) guesses_->is_short_ = true;
    }
    Short(const Short&) = delete;
    Short& operator=(const Short&) = delete;
    ~Short() {
      if (guesses_) guesses_->is_short_ = false;
    }

   private:
    SizeGuesses* guesses_;
  };

  /// As long as it lives, further cells are asked for where one is asked for at once: those that `add_to(guesses)` adds.
  class Along {
   public:
    /// Of these guesses; null: none.
    template <class F>
    Along(SizeGuesses* guesses, F add_to) : guesses_(guesses) {
      if (guesses_) guesses_->along_ = std::move(add_to);
    }
    Along(const Along&) = delete;
    Along& operator=(const Along&) = delete;
    ~Along() {
      if (guesses_) guesses_->along_ = nullptr;
    }

   private:
    SizeGuesses* guesses_;
  };

 private:
  /// A size, by the centroid of the cell and its region.
  struct Known {
    Point3 at;
    int region;
    double size;
  };
  /// What a guess was used for.
  struct Use {
    std::uint32_t known;  ///< number of the size
    Simplex<3> s;
    Answer answer;
    Numbers numbers;
    double given;  ///< the answer by the guess
  };

  std::uint32_t find(const Simplex<3>& s, int region);
  void ask();
  void forget();
  void grow();

  const CellBounds<3>* bounds_;
  double guess_ = std::numeric_limits<double>::infinity();
  std::uint32_t about_ = 0;           ///< number of the size at the cell that the decision is about
  std::vector<Known> known_;          ///< by number; those from asked_ on are not asked for yet
  std::size_t asked_ = 0;             ///< so many of them are asked for
  std::vector<std::uint32_t> slots_;  ///< finds them: numbers from 1, or 0 where there is none
  std::vector<Use> uses_;             ///< that wait
  std::size_t guessed_ = 0;
  bool wrong_ = false, is_short_ = false;
  std::function<void(SizeGuesses&)> along_;  ///< empty: there are no others
  std::vector<Point3> points_;               // scratch of settle()
  std::vector<int> regions_;
  std::vector<double> sizes_;
};

}  // namespace pgdr
