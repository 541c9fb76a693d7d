// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// How the checker's stages report: every finding is counted, the first few of a kind are put into words. One object a
// check, one thread.
#pragma once

#include <initializer_list>
#include <string>

#include "pgdr/check.hpp"
#include "space/stop_check.hpp"

namespace pgdr::checking {

using Kind = CheckFinding::Kind;
inline constexpr std::uint32_t none = 0xffffffffu;

class Findings {
 public:
  Findings(CheckReport& report, std::size_t max_listed, const std::stop_token& stop)
      : report_(report), max_listed_(max_listed), stop_(stop), heed_stop_(stop) {}

  /// `message` is called only if the finding is listed: words cost more than most checks.
  template <class Message>
  void add(Kind kind, std::initializer_list<std::int64_t> ids, Message&& message) {
    ++report_.finding_count;
    if (report_.count_of_kind[static_cast<std::size_t>(kind)]++ < max_listed_) report_.findings.push_back({kind, message(), ids});
  }
  CheckReport& report() { return report_; }
  bool clean() const { return report_.finding_count == 0; }
  /// Asked in loops over all cells, or over what takes as long. @throws CancelledError
  void heed_stop() const { heed_stop_(); }
  const std::stop_token& stop() const { return stop_; }

 private:
  CheckReport& report_;
  std::size_t max_listed_;
  std::stop_token stop_;
  detail::StopCheck heed_stop_;
};

/// The shortest decimal that reads back to the same double.
std::string words(double x);
/// "(0.5, 1, 2)"
template <int D>
std::string words(const Point<D>& p);
/// "vertex 12 (0.5, 1, 2)"
template <int D>
std::string vertex_words(const OutputMesh<D>& mesh, std::uint32_t vertex);
/// "cell 7 (vertices 1, 2, 3, 4)"
template <int D>
std::string cell_words(const OutputMesh<D>& mesh, std::uint32_t cell);
/// "vertices 1, 2, 3"
template <std::size_t N>
std::string list_words(const std::array<std::uint32_t, N>& vertices) {
  std::string text = "vertices ";
  for (std::size_t i = 0; i < N; ++i) text += (i ? ", " : "") + std::to_string(vertices[i]);
  return text;
}

}  // namespace pgdr::checking
