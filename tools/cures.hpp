// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// What a refused input suffers from, and what cures it. Each cure has been tried before it is said.
#pragma once

#include <string>
#include <vector>

#include "pgdr/diagnosis.hpp"
#include "pgdr/plc.hpp"

namespace pgdr::tool {

/// If nothing is wrong but that closed surfaces run through each other: how many, and where first. Else empty.
template <int D>
std::string words_of_bodies(const Plc<D>& plc, const Diagnosis<D>& diagnosis);

/// What makes the input valid: flags of the command, points to add, a tolerance. A sentence each, the best one first.
template <int D>
std::vector<std::string> cures_of(const Plc<D>& plc, const Diagnosis<D>& diagnosis);

}  // namespace pgdr::tool
