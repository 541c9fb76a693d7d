// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Where visits run: in the caller's task arena, or in one of fewer threads.
#pragma once

#include <functional>

namespace pgdr::detail {

/// Threads that `in_arena(threads, ...)` has: what is asked for (0: all of the caller's arena), but no more than TBB allows
/// the program, so that TBB has nothing to warn of on stderr.
int arena_threads(int threads);

/// Calls f in the caller's arena if that has as many threads as asked for, else in an arena of its own.
void in_arena(int threads, const std::function<void()>& f);

/// The same for work that must not stay undone: somebody who cancels the caller's tasks does not cancel it.
void in_arena_to_the_end(int threads, const std::function<void()>& f);

/// The place of the calling thread in its arena: no two threads that run there at one time have the same.
int arena_slot();

}  // namespace pgdr::detail
