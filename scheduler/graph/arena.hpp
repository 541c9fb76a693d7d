// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The task arena that visits run in: the caller's, or one of another number of threads.
#pragma once

#include <functional>

namespace pgdr::detail {

/// The number of threads that `in_arena(threads, ...)` has: as many as are asked for (0: all of the caller's arena), but no more
/// than TBB allows the program, so that TBB prints no warning.
int arena_threads(int threads);

/// Calls f in the caller's arena if that has as many threads as asked for, else in an arena of its own.
void in_arena(int threads, const std::function<void()>& f);

/// Calls f as in_arena does. Who cancels the caller's tasks does not cancel f.
void in_arena_to_the_end(int threads, const std::function<void()>& f);

/// The slot of the calling thread in its arena: no two threads that run there at one time have the same.
int arena_slot();

}  // namespace pgdr::detail
