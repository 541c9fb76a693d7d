// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The one error vocabulary of the library. Nothing here prints; words for people are made once, in `message`, and the
// data a program needs (code, ids, coordinates, file, line) is beside it. Exceptions leave public functions only.
#pragma once

#include <array>
#include <cstdint>
#include <exception>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "pgdr/export.hpp"

namespace pgdr PGDR_API {

/// What went wrong. `name(code)` is the stable snake_case word of the JSON report.
enum class Errc {
  // usage
  bad_option,
  bad_size,  ///< a size function returned a value that is not positive
  // input: reading
  unknown_format,
  syntax,           ///< a token that is not what the format asks for
  truncated,        ///< the file ends too early
  count_too_large,  ///< a header promises more than the file can hold
  // input: content
  not_finite,
  index_out_of_range,
  degenerate_segment,
  degenerate_facet,
  self_crossing_facet,
  entities_intersect,  ///< two input entities meet where neither has a vertex or an edge in common
  facets_overlap,      ///< two facets have an area of one plane in common
  point_on_facet,      ///< a point lies inside a facet that it does not belong to
  point_on_segment,    ///< a point lies inside a segment, or an edge of a facet
  encloses_nothing,
  seed_on_boundary,
  conflicting_seeds,
  tolerance_too_large,  ///< it joins what is apart, or destroys what it should keep
  no_volume,            ///< all points lie in one plane (3D) or on one line (2D)
  boundary_not_recovered,
  not_orientable,  ///< the facets of a body have no two sides
  bodies_overlap,  ///< two bodies have a volume in common, and none may
  // input: found, and taken as it is
  duplicate_point,
  near_points,  ///< two points that may be meant to be one
  ambiguous,    ///< what hangs together within the tolerance is wider than that allows
  unreferenced_point,
  repeated_facet,
  open_boundary,
  non_manifold,
  inconsistent_orientation,
  bent_facet,     ///< a polygon whose points are far off any plane
  unsure_volume,  ///< an open body leaves open whether it contains this volume
  small_angle,
  beyond_theory,  ///< a bound below the proved one is asked for
  unfit_name,     ///< a format cannot hold a name as it is
  // files
  cannot_open,
  cannot_write,
  // resources and the rest
  cancelled,  ///< the caller's stop token said so
  out_of_memory,
  ids_exhausted,
  // several processes that make one mesh
  rank_failed,   ///< another one has ended, or does not answer
  unlike_ranks,  ///< they did not make the same mesh
  internal,
};

/// The stable snake_case word of the JSON report.
std::string_view name(Errc code);

/// One error or warning, as data. Ids are those of the input file or spans (its own numbering, see `Plc::first_index`).
struct Diagnostic {
  Errc code = Errc::internal;                 ///< what kind it is
  std::string message;                        ///< one sentence that names the culprit
  std::string file;                           ///< empty if the input came from memory
  std::uint64_t line = 0;                     ///< 1-based; 0 = unknown
  std::vector<std::int64_t> ids;              ///< of the culprits (points, facets, segments, as the message says)
  std::vector<std::array<double, 3>> points;  ///< where; z = 0 in 2D
};

/// Base of all exceptions of the library. `what()` is file:line: message.
class Error : public std::exception {
 public:
  explicit Error(Diagnostic d);                                          ///< keeps d, and composes what()
  const Diagnostic& diagnostic() const noexcept { return diagnostic_; }  ///< all that is known
  Errc code() const noexcept { return diagnostic_.code; }                ///< of the diagnostic
  /// "file:line: message", without what is not known. Valid as long as this object.
  const char* what() const noexcept override { return what_.c_str(); }

 private:
  Diagnostic diagnostic_;
  std::string what_;
};

/// An option or callback that cannot be used (exit code 2 of the command).
struct UsageError : Error {
  using Error::Error;
};
/// Malformed or invalid input (exit code 3).
class InputError : public Error {
 public:
  explicit InputError(Diagnostic d) : Error(d), diagnostics_{std::move(d)} {}  ///< this alone is known
  /// The first of all that is wrong.
  InputError(Diagnostic first, std::vector<Diagnostic> all) : Error(std::move(first)), diagnostics_(std::move(all)) {}
  /// All that is wrong with the input, this error among it, where that was looked for: the first twenty of each kind.
  const std::vector<Diagnostic>& diagnostics() const noexcept { return diagnostics_; }

 private:
  std::vector<Diagnostic> diagnostics_;
};
/// Of these, what a diagnosis finds wrong (diagnosis.hpp), before anything is meshed.
struct DiagnosedError : InputError {
  using InputError::InputError;
};
/// A file that cannot be opened or written (exit code 4).
struct FileError : Error {
  using Error::Error;
};
/// The caller's stop token was requested where there is nothing to return: while a Domain or a Diagnosis is made, or a mesh
/// checked.
struct CancelledError : Error {
  using Error::Error;
};
/// Memory or ids exhausted, or a broken invariant (exit code 7).
struct ResourceError : Error {
  using Error::Error;
};

}  // namespace pgdr
