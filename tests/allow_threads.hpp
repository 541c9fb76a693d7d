// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// PGDR_TEST_TBB: whether tests may run visits on oneTBB. Not under the thread sanitizer, which does not see TBB's own
// synchronisation and reports it.
#pragma once

#include <cstddef>

#if defined(__SANITIZE_THREAD__)
#define PGDR_TEST_TBB 0
#elif defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define PGDR_TEST_TBB 0
#endif
#endif
#ifndef PGDR_TEST_TBB
#define PGDR_TEST_TBB 1
#endif

#if PGDR_TEST_TBB
#include <tbb/global_control.h>
#endif

namespace pgdr::test {

/// Lets TBB start as many threads, whatever the machine has.
class AllowThreads {
 public:
#if PGDR_TEST_TBB
  explicit AllowThreads(std::size_t n) : control_(tbb::global_control::max_allowed_parallelism, n) {}

 private:
  tbb::global_control control_;
#else
  explicit AllowThreads(std::size_t) {}
#endif
};

}  // namespace pgdr::test
