// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// What a refused input suffers from, and what cures it. Each cure has been tried before it is said: the diagnosis accepts the
// input with it.
#pragma once

#include <chrono>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "pgdr/diagnosis.hpp"
#include "pgdr/plc.hpp"
#include "treatment.hpp"

namespace pgdr::tool {

/// That cures are looked for.
inline constexpr std::chrono::duration<double> longest_search{30};

/// What makes an input valid.
struct Cure {
  std::string ailment;  ///< what is wrong, in a few words
  std::string flags;    ///< of the command, besides those given; empty: it takes something else
  std::string words;    ///< a sentence of it

  /// In one line: "5 closed bodies that overlap: --resolve-crossings --regions union".
  std::string need() const { return flags.empty() ? words : ailment + ": " + flags; }
};

/// If nothing is wrong but that closed surfaces run through each other: how many, and where first. Else empty.
template <int D>
std::string words_of_bodies(const Plc<D>& plc, const Diagnosis<D>& diagnosis, const std::stop_token& stop = {});

/// What makes the input valid: flags of the command, points to add, a tolerance; the best one first. Searches for half a minute
/// at most, and until `stop` is requested; what is found by then comes back.
/// @param given  as it was read
/// @param done  what was done to it before it was refused
/// @param diagnosis  of what came out of that
template <int D>
std::vector<Cure> cures_of(const Plc<D>& given, const Treatment& done, const Diagnosis<D>& diagnosis,
                           const std::stop_token& stop = {});

/// What `disjoint` bodies that overlap, and such as have no two sides, take instead; none for other errors.
std::optional<Cure> cure_of_bodies(const Plc<3>& given, const Treatment& done, Errc code, const std::stop_token& stop = {});

}  // namespace pgdr::tool
