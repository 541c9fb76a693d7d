// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Names of labels and markers, as files have them and as meshes hand them on. A plain value: nothing in the meshing depends on
// it.
#pragma once

#include <map>
#include <string>

#include "pgdr/export.hpp"

namespace pgdr PGDR_API {

/// What labels and markers are called. Several may have one name, and most have none. Readers make UTF-8 of them, without control
/// characters, without blanks at either end, and never empty.
struct Names {
  std::map<double, std::string> regions;  ///< by label: an attribute of a region
  std::map<int, std::string> markers;     ///< by marker: of facets, segments and points alike

  bool empty() const { return regions.empty() && markers.empty(); }  ///< has nothing a name?
  friend bool operator==(const Names&, const Names&) = default;      ///< the same names
};

}  // namespace pgdr
