// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "console.hpp"

#ifdef _WIN32
#include <io.h>
#include <windows.h>
// After windows.h.
#include <psapi.h>
#else
#include <fcntl.h>
#include <sys/resource.h>
#include <unistd.h>
#endif

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <system_error>

namespace pgdr::tool {

#ifdef _WIN32
void prepare_process() {}

std::uint64_t peak_rss_bytes() {
  PROCESS_MEMORY_COUNTERS counters{};
  if (!K32GetProcessMemoryInfo(GetCurrentProcess(), &counters, sizeof counters)) return 0;
  return counters.PeakWorkingSetSize;
}

static bool speaks_to_terminal() { return _isatty(_fileno(stderr)) != 0; }
#else
void prepare_process() {
  // Opened for reading, so that writing fails.
  for (int number = 0; number <= 2; ++number)
    if (fcntl(number, F_GETFD) < 0 && open("/", O_RDONLY | O_DIRECTORY) < 0) return;
  std::signal(SIGPIPE, SIG_IGN);
}

std::uint64_t peak_rss_bytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;  // Linux counts kilobytes
}

static bool speaks_to_terminal() { return isatty(STDERR_FILENO) != 0; }
#endif

void require_printed() {
  errno = 0;
  const bool has_failed = std::fflush(stdout) != 0;
  if (!has_failed && std::ferror(stdout) == 0) return;
  const std::string why = errno != 0 ? ": " + std::generic_category().message(errno) : std::string();
  std::clearerr(stdout);
  throw FileError({.code = Errc::cannot_write, .message = "cannot be written" + why, .file = "standard output"});
}

void print_row(std::string_view label, const std::string& text) {
  std::printf("%-10.*s %s\n", static_cast<int>(label.size()), label.data(), text.c_str());
}

void print_warnings(const std::vector<Diagnostic>& warnings) {
  constexpr std::size_t most = 5;
  for (std::size_t i = 0; i < warnings.size() && i < most; ++i)
    std::fprintf(stderr, "pgdr: warning: %s\n", Error(warnings[i]).what());
  if (warnings.size() > most) std::fprintf(stderr, "pgdr: and %zu more warnings\n", warnings.size() - most);
}

ProgressLine::ProgressLine(bool wanted) : shown_(wanted && speaks_to_terminal()) {}

void ProgressLine::operator()(const Progress& p) {
  const auto now = std::chrono::steady_clock::now();
  if (!shown_ || now < next_) return;
  next_ = now + std::chrono::milliseconds(100);
  dirty_ = true;
  std::fputs("\r\033[K", stderr);
  if (p.done) std::fprintf(stderr, "%3.0f %%, ", 100 * *p.done);
  std::fprintf(stderr, "%s: %llu vertices", p.stage, static_cast<unsigned long long>(p.vertices));
  if (p.waiting > 0) std::fprintf(stderr, ", %llu waiting", static_cast<unsigned long long>(p.waiting));
  std::fflush(stderr);
}

void ProgressLine::clear() {
  if (dirty_) std::fputs("\r\033[K", stderr);
  dirty_ = false;
}

}  // namespace pgdr::tool
