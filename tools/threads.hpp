// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// How many threads the command may run. The library never takes more than TBB allows the program; what it allows is
// the program's business.
#pragma once

#include <memory>
#include <optional>

namespace pgdr::tool {

class Threads {
 public:
  /// While it lives, TBB may run as many as were asked for and no more, even if there are fewer cores. @param asked none: one a
  /// core.
  /// @throws ResourceError if so many cannot be started: TBB would end the process over that.
  explicit Threads(std::optional<int> asked);
  ~Threads();

  int requested() const { return requested_; }

 private:
  struct Control;
  int requested_;
  std::unique_ptr<Control> control_;
};

}  // namespace pgdr::tool
