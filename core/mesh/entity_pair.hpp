// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Two entities of the input, named together.
#pragma once

#include <array>

#include "pgdr/domain.hpp"

namespace pgdr {

/// Two input entities that meet where a split or a point was refused.
struct EntityPair {
  std::array<EntityRef, 2> entities;  ///< the two, of the Domain
};

}  // namespace pgdr
