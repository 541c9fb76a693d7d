// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Reading an input, which may be several files, and what flags ask to be done to it.
#pragma once

#include <string>
#include <vector>

#include "json.hpp"
#include "options.hpp"
#include "pgdr/io.hpp"
#include "pgdr/plc.hpp"
#include "report.hpp"

namespace pgdr::tool {

/// The files of one input.
class Inputs {
 public:
  explicit Inputs(const std::vector<std::string>& names);  ///< opens none yet

  /// Of all of them. @throws UsageError where they do not agree; what file_dimension throws
  int dimension();
  /// As they stand in the files, with the seeds of flags. @throws UsageError for a flag of the other dimension, or a seed that is
  /// none; what read_plc throws
  template <int D>
  Plc<D> read_given(const InputArguments& reading);
  /// An input that comes from elsewhere, with the tolerance and the seeds of flags. @throws likewise
  template <int D>
  static Plc<D> as_asked(Plc<D> plc, const InputArguments& reading);

  std::string words() const;                    ///< their names, with commas
  Json json() const;                            ///< the name, or an array of several
  std::vector<Diagnostic> warnings() const;     ///< of what was read last, file by file
  InputFile& only() { return files_.front(); }  ///< @pre there is one

 private:
  std::vector<InputFile> files_;
};

/// Puts the keys of names into the report.
void set_names(Report& report, const Names& names);

}  // namespace pgdr::tool
