// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The version of these headers, for the preprocessor. The one place where it is written: the build reads it from here.
// Versions with equal major and minor numbers are compatible (as long as the major number is 0).
#pragma once

#define PGDR_VERSION_MAJOR 0         ///< changes with what breaks programs, once it is 1
#define PGDR_VERSION_MINOR 1         ///< changes with what is new
#define PGDR_VERSION_PATCH 0         ///< changes with what is repaired
#define PGDR_VERSION_STRING "0.1.0"  ///< the three, with points between

/// One number to compare with: 10000 major + 100 minor + patch.
#define PGDR_VERSION (PGDR_VERSION_MAJOR * 10000 + PGDR_VERSION_MINOR * 100 + PGDR_VERSION_PATCH)
