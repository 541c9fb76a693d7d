// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "transport/shared_error.hpp"

#include <array>
#include <new>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace pgdr::detail {
namespace {

/// What an error is thrown as; the values travel.
enum class Type : std::uint8_t { usage, diagnosed, input, file, cancelled, resource, failure, other };

Type type_of(const Error& error) {
  if (dynamic_cast<const UsageError*>(&error)) return Type::usage;
  if (dynamic_cast<const DiagnosedError*>(&error)) return Type::diagnosed;
  if (dynamic_cast<const InputError*>(&error)) return Type::input;
  if (dynamic_cast<const FileError*>(&error)) return Type::file;
  if (dynamic_cast<const CancelledError*>(&error)) return Type::cancelled;
  if (dynamic_cast<const ResourceError*>(&error)) return Type::resource;
  if (dynamic_cast<const RankFailure*>(&error)) return Type::failure;
  return Type::other;
}

void put(MessageWriter& message, Type type, const Diagnostic& d, std::span<const Diagnostic> all = {}) {
  message.put(type);
  put_diagnostic(message, d);
  message.put(std::uint64_t{all.size()});
  for (const Diagnostic& one : all) put_diagnostic(message, one);
}

std::vector<Diagnostic> get_diagnostics(MessageReader& message) {
  std::vector<Diagnostic> all;
  for (auto left = message.get<std::uint64_t>(); left > 0; --left)
    all.push_back(get_diagnostic(message));  // ends with the message
  return all;
}

std::string words(int rank, const char* what) { return "rank " + std::to_string(rank) + ": " + what; }

Errc get_code(MessageReader& message) {
  const auto code = message.get<Errc>();
  if (code < Errc{} || code > Errc::internal) fail_message("an error of another rank has no known code");
  return code;
}

}  // namespace

void fail_message(const char* what) { throw ResourceError({.code = Errc::internal, .message = what}); }

void put_diagnostic(MessageWriter& message, const Diagnostic& d) {
  message.put(d.code);
  message.put(d.message);
  message.put(d.file);
  message.put(d.line);
  message.put(d.ids);
  message.put(d.points);
}

Diagnostic get_diagnostic(MessageReader& message) {
  Diagnostic d;
  d.code = get_code(message);
  d.message = message.get_text();
  d.file = message.get_text();
  d.line = message.get<std::uint64_t>();
  d.ids = message.get_all<std::int64_t>();
  d.points = message.get_all<std::array<double, 3>>();
  return d;
}

void put_error(MessageWriter& message, const std::exception_ptr& error, int rank) {
  try {
    std::rethrow_exception(error);
  } catch (const InputError& e) {
    put(message, type_of(e), e.diagnostic(), e.diagnostics());
  } catch (const Error& e) {
    put(message, type_of(e), e.diagnostic());
  } catch (const std::bad_alloc&) {
    put(message, Type::resource, {.code = Errc::out_of_memory, .message = words(rank, "out of memory")});
  } catch (const std::exception& e) {
    put(message, Type::failure, {.code = Errc::rank_failed, .message = words(rank, e.what())});
  } catch (...) {
    put(message, Type::failure, {.code = Errc::rank_failed, .message = words(rank, "an unknown exception")});
  }
}

void throw_error(MessageReader& message) {
  const auto type = message.get<Type>();
  Diagnostic d = get_diagnostic(message);
  std::vector<Diagnostic> all = get_diagnostics(message);
  message.require_end();
  switch (type) {
    case Type::usage: throw UsageError(std::move(d));
    case Type::diagnosed: throw DiagnosedError(std::move(d), std::move(all));
    case Type::input: throw InputError(std::move(d), std::move(all));
    case Type::file: throw FileError(std::move(d));
    case Type::cancelled: throw CancelledError(std::move(d));
    case Type::resource: throw ResourceError(std::move(d));
    case Type::failure: throw RankFailure(std::move(d));
    case Type::other: throw Error(std::move(d));
  }
  fail_message("an error of another rank has no known type");
}

}  // namespace pgdr::detail
