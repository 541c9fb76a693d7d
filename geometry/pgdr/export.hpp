// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// What a shared libpgdr exports: what is declared in a header whose namespace bears PGDR_API. Function templates do not
// inherit that from the namespace: their explicit instantiations, in the source files, bear it themselves (and
// tools/check_sources.py sees to it). Everything else is compiled hidden. The same objects make the static library.
#pragma once

#if defined(__GNUC__)
#define PGDR_API __attribute__((visibility("default")))
#else
#define PGDR_API
#endif
