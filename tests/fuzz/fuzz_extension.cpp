// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The format of one program: PGDR_FUZZ_EXTENSION.
#include <string_view>

extern const std::string_view fuzz_extension;
constinit const std::string_view fuzz_extension = PGDR_FUZZ_EXTENSION;
