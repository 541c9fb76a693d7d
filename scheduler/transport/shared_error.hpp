// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// An error that travels: what one rank threw is thrown by all, of the same type where the type is one of error.hpp.
#pragma once

#include <exception>

#include "transport/message.hpp"

namespace pgdr::detail {

void put_diagnostic(MessageWriter& message, const Diagnostic& d);
/// @throws ResourceError internal if it is none
Diagnostic get_diagnostic(MessageReader& message);

/// The error of this rank, for the others. An exception that is no Error travels as its words.
void put_error(MessageWriter& message, const std::exception_ptr& error, int rank);

/// Throws what put_error() wrote: the same Error; ResourceError out_of_memory for std::bad_alloc; else RankFailure rank_failed
/// with the words and the rank. @throws ResourceError internal if it is none
[[noreturn]] void throw_error(MessageReader& message);

}  // namespace pgdr::detail
