// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "command.hpp"

#include <cstdio>
#include <new>

#include "console.hpp"
#include "pgdr/output_files.hpp"
#include "pgdr/version.hpp"
#include "run_files.hpp"

namespace pgdr::tool {
namespace {

void say(const char* what) noexcept { std::fprintf(stderr, "pgdr: error: %s\n", what); }

/// Runs `action`, turns what it throws into words on stderr, an entry of the report, and an exit code. Of several ranks the first
/// speaks, unless it cannot be reached.
template <class Action>
int guarded(Report& report, const Ranks& ranks, Action action) {
  const auto say_here = [&ranks](const char* what) {
    if (ranks.is_first() || ranks.are_lost()) say(what);
  };
  const auto fail = [&](const Error& e, ExitCode code) {
    say_here(e.what());
    report.add_error(e.diagnostic());
    return code;
  };
  const auto fail_untyped = [&](Errc code, const char* what) {
    say_here(what);
    report.add_error({.code = code, .message = what});
    return exit_resource;
  };
  try {
    return action();
  } catch (const UsageError& e) {
    return fail(e, exit_usage);
  } catch (const InputError& e) {
    return fail(e, exit_input);
  } catch (const FileError& e) {
    return fail(e, exit_file);
  } catch (const Error& e) {
    return fail(e, exit_resource);
  } catch (const std::bad_alloc&) {
    return fail_untyped(Errc::out_of_memory, "out of memory");
  } catch (const std::exception& e) {
    return fail_untyped(Errc::internal, e.what());
  }
}

/// The exit code of a run, and of what came after it: what it says of a mesh counts more than that this could not be said.
int with_later(int code, int later) {
  if (later == exit_done) return code;
  return code == exit_done || code == exit_poor_left || later == exit_resource ? later : code;
}

int execute(const Arguments& arguments, Report& report, const Ranks& ranks) {
  report.set("version", PGDR_VERSION_STRING);
  const std::string& report_file = std::visit([](const auto& a) -> const std::string& { return a.report; }, arguments);
  bool writes_report = false;
  int code = guarded(report, ranks, [&] {
    ranks.on_first([&] {
      const RunFiles files(arguments);
      files.require_own_report();
      if (!report_file.empty()) require_writable(report_file);
      writes_report = !report_file.empty();
      files.require_own_outputs();
    });
    return std::visit(
        [&](const auto& a) {
          using A = std::decay_t<decltype(a)>;
          if constexpr (std::is_same_v<A, MeshArguments>)
            return mesh(a, report, ranks);
          else if constexpr (std::is_same_v<A, CheckArguments>)
            return check(a, report);
          else if constexpr (std::is_same_v<A, InfoArguments>)
            return info(a, report);
          else if constexpr (std::is_same_v<A, JoinArguments>)
            return join(a, report);
          else
            return view(a, report);
        },
        arguments);
  });
  code = with_later(code, guarded(report, ranks, [] { return require_printed(), exit_done; }));
  if (!writes_report) return code;
  return with_later(code, guarded(report, ranks, [&] { return report.write(report_file), exit_done; }));
}

/// Runs `action`; what it throws ends with exit_resource, without needing any memory.
template <class Action>
int last_resort(Action action) noexcept {
  try {
    return action();
  } catch (const std::bad_alloc&) {
    say("out of memory");
  } catch (const std::exception& e) {
    say(e.what());
  } catch (...) {
    say("an unknown exception");
  }
  return exit_resource;
}

}  // namespace

int execute(const Arguments& arguments, const Ranks& ranks) noexcept {
  Report report;
  const int code = last_resort([&] { return ranks.largest(execute(arguments, report, ranks)); });
  if (code == exit_resource) {
    for (const std::string& file : report.mesh_files) remove_output(file);
    if (!report.trace_file.empty()) remove_output(report.trace_file);
  }
  return code;
}

int run(int argc, const char* const* argv) noexcept {
  return last_resort([&] {
    const auto parsed = parse(argc, argv);
    return std::holds_alternative<int>(parsed) ? std::get<int>(parsed) : execute(std::get<Arguments>(parsed));
  });
}

}  // namespace pgdr::tool
