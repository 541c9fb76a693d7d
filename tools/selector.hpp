// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The selectors by name: NAME or NAME:PARAMETER.
#pragma once

#include <string>

#include "pgdr/point_selector.hpp"

namespace pgdr::tool {

/// What is wrong with the argument of --selector; empty if nothing is.
std::string selector_error(const std::string& text);

/// The selector that is taken unless one is asked for, by name: off-center in 2D, circumcenter in 3D.
template <int D>
std::string usual_selector() {
  return D == 2 ? "off-center" : "circumcenter";
}

/// @pre selector_error(text) is empty.
template <int D>
PointSelector<D> make_selector(const std::string& text);

/// The disk for it, unless one is asked for: type 1 for selectors that are defined on it, so for all but the circumcentre.
DiskType usual_disk(const std::string& text);

}  // namespace pgdr::tool
