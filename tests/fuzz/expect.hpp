// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// How a fuzz target says that what it tested is wrong: it ends the program, as a crash would.
#pragma once

#include <cstdio>
#include <cstdlib>

#define FUZZ_EXPECT(condition, ...)                                                 \
  do {                                                                              \
    if (!(condition)) {                                                             \
      std::fprintf(stderr, "%s:%d: expected %s\n", __FILE__, __LINE__, #condition); \
      __VA_OPT__(std::fprintf(stderr, "%s\n", std::string(__VA_ARGS__).c_str());)   \
      std::abort();                                                                 \
    }                                                                               \
  } while (false)
