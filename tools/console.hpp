// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// What people see: a summary on stdout, errors, warnings and a progress line on stderr. And what is measured of the
// process itself.
#pragma once

#include <chrono>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "pgdr/error.hpp"
#include "pgdr/refine.hpp"
#include "text.hpp"

namespace pgdr::tool {

/// `label      text` on stdout.
void print_row(std::string_view label, const std::string& text);
/// What main() does first. Descriptors 0 to 2 that are closed are taken, so that no file gets one of them, and what is printed
/// into it. A pipe that nobody reads any more is an error of who writes, and ends no process.
void prepare_process();
/// Sends what has been printed on its way. @throws FileError cannot_write if any of it, now or before, did not get there
void require_printed();
/// The first few as `pgdr: warning: ...` on stderr, and how many more there are.
void print_warnings(const std::vector<Diagnostic>& warnings);

/// One line on stderr that is written over; nothing at all if stderr is not a terminal.
class ProgressLine {
 public:
  explicit ProgressLine(bool wanted);
  ~ProgressLine() { clear(); }
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;
  bool is_shown() const { return shown_; }  ///< would it be seen?
  void operator()(const Progress& p);
  void clear();

 private:
  bool shown_, dirty_ = false;
  std::chrono::steady_clock::time_point next_{};
};

class Stopwatch {
 public:
  double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

std::uint64_t peak_rss_bytes();

}  // namespace pgdr::tool
