// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// What a refused input suffers from, and what cures it. Each cure has been tried before it is said.
#pragma once

#include <string>

#include "pgdr/diagnosis.hpp"
#include "pgdr/plc.hpp"

namespace pgdr::tool {

/// If nothing is wrong but that closed surfaces run through each other: how many, and where first. Else empty.
template <int D>
std::string words_of_bodies(const Plc<D>& plc, const Diagnosis<D>& diagnosis);

/// Prints on stderr what makes the input valid: flags, points to add, a tolerance.
template <int D>
void say_cures(const Plc<D>& plc, const Diagnosis<D>& diagnosis);

}  // namespace pgdr::tool
