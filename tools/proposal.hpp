// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// A tolerance for a file of few digits: two units of the last digit of its coordinates. Never a default: what is given is meshed
// as it is, and the user is told. Prints nothing.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <stop_token>
#include <string_view>

#include "pgdr/diagnosis.hpp"
#include "pgdr/domain.hpp"
#include "pgdr/plc.hpp"
#include "treatment.hpp"

namespace pgdr::tool {

/// The unit of the last digit with which these numbers were written: of as many decimals each, or of as many digits each, when it
/// is that of the largest. None if they are integers, or have so many digits that they were rounded to doubles alone.
std::optional<double> unit_of_last_digit(std::span<const double> numbers);

/// What a tolerance would do.
struct Proposal {
  double tolerance = 0;
  std::size_t facets = 0, facets_then = 0;  ///< 3D: of the Domain as it is, and with it
  std::size_t joined = 0;                   ///< points that it joins to points, segments and facets
};

/// Of an input that is valid: nothing if a tolerance was asked for, or the digits are too many, or it would change nothing, or
/// close a gap that is not meshed, or breaks what a Domain demands of a tolerance, or for lack of memory.
template <int D>
std::optional<Proposal> find_proposal(const Plc<D>& plc, const Domain<D>& domain);
/// Of an input whose gaps take too many cells: that tolerance, if it is proposed and cures that.
template <int D>
std::optional<double> cure_of_gaps(const Plc<D>& plc, const Domain<D>& domain,
                                   const std::function<bool(const Domain<D>&)>& is_cured);

/// Of an input that is refused after this was done to it: that tolerance, if it makes the input valid, and nothing is left then
/// that is nearer than ten times as much: no features could be taken for rounding.
template <int D>
std::optional<double> tolerance_for_refused(const Plc<D>& plc, const Treatment& done, const std::stop_token& stop);
/// What is said of it, behind the flag.
inline constexpr std::string_view what_tolerance_does =
    " makes it valid: what is no farther apart than two units of the last digit of the coordinates then meets";

}  // namespace pgdr::tool
