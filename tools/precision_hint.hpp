// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Whether small angles of an input are those of faces that lack digits, and what to do about it.
#pragma once

#include <cstddef>
#include <optional>

#include "options.hpp"
#include "pgdr/domain.hpp"
#include "pgdr/plc.hpp"
#include "report.hpp"

namespace pgdr::tool {

/// Says what the precision of the file (Plc::precision_of_file) is, or that the default was `used` since facets fold over within
/// it.
template <int D>
void note_precision(const Plc<D>& plc, double used);

/// Where suggested_precision makes one face of many facets that the input as it is keeps apart.
struct PrecisionHint {
  double precision = 0;
  bool by_digits = false;  ///< or by how faces look
  std::size_t facets = 0, facets_then = 0;
};
/// Nothing if a precision was asked for, or for lack of memory. @param domain  of `plc`; null: not at hand
template <int D>
std::optional<PrecisionHint> find_precision_hint(const Plc<D>& plc, const Domain<D>* domain, const InputArguments& reading);
/// In the report as `precision_hint`, and on the terminal unless `quiet`.
void give(const std::optional<PrecisionHint>& hint, bool quiet, Report& report);

}  // namespace pgdr::tool
