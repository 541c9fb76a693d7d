// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#ifndef _WIN32
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <climits>
#include <cstdlib>
#include <limits>
#include <memory>

#include "space/system.hpp"

namespace pgdr::detail::system {

constexpr double unlimited = std::numeric_limits<double>::infinity();

void* reserve_addresses(std::size_t bytes) noexcept {
#ifdef MAP_NORESERVE
  constexpr int flags = MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE;
#else
  constexpr int flags = MAP_PRIVATE | MAP_ANONYMOUS;
#endif
  void* const first = mmap(nullptr, bytes, PROT_NONE, flags, -1, 0);
  return first == MAP_FAILED ? nullptr : first;
}

bool provide_memory(void* first, std::size_t bytes) noexcept { return mprotect(first, bytes, PROT_READ | PROT_WRITE) == 0; }

void discard_memory(void* first, std::size_t bytes) noexcept {
#ifdef __linux__
  madvise(first, bytes, MADV_DONTNEED);
#else  // elsewhere the advice need not empty the pages; mapped anew they are empty
  mmap(first, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_FIXED, -1, 0);
#endif
}

void release_addresses(void* first, std::size_t bytes) noexcept { munmap(first, bytes); }

void ask_for_huge_pages([[maybe_unused]] void* memory, [[maybe_unused]] std::size_t bytes) noexcept {
#ifdef MADV_HUGEPAGE
  constexpr std::uintptr_t huge_page = std::uintptr_t{1} << 21;
  const auto address = reinterpret_cast<std::uintptr_t>(memory);
  const std::uintptr_t first = (address + huge_page - 1) / huge_page * huge_page,
                       last = (address + bytes) / huge_page * huge_page;
  if (first < last) madvise(reinterpret_cast<void*>(first), last - first, MADV_HUGEPAGE);
#endif
}

double limit_on_addresses() noexcept {
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) return unlimited;
  return static_cast<double>(limit.rlim_cur);
}

double physical_memory() noexcept {
  const auto bytes = static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
  return bytes > 0 ? bytes : unlimited;
}

std::uint64_t peak_resident() noexcept {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
#ifdef __APPLE__
  constexpr std::uint64_t unit = 1;
#else
  constexpr std::uint64_t unit = 1024;
#endif
  return static_cast<std::uint64_t>(usage.ru_maxrss) * unit;
}

std::optional<FileType> file_type(const std::string& name) noexcept {
  struct stat status;
  if (::stat(name.c_str(), &status) != 0) return std::nullopt;
  if (S_ISREG(status.st_mode)) return FileType::regular;
  if (S_ISDIR(status.st_mode)) return FileType::folder;
  return S_ISSOCK(status.st_mode) ? FileType::socket : FileType::other;
}

bool is_regular_itself(const std::string& name) noexcept {
  struct stat status;
  return lstat(name.c_str(), &status) == 0 && S_ISREG(status.st_mode);
}

bool may_be_written(const std::string& name) noexcept { return ::access(name.c_str(), W_OK) == 0; }
bool is_there(const std::string& name) noexcept { return ::access(name.c_str(), F_OK) == 0; }

std::string real_name(const std::string& name) {
  const std::unique_ptr<char, decltype(&std::free)> real(::realpath(name.c_str(), nullptr), std::free);
  return real ? std::string(real.get()) : std::string();
}

std::optional<std::string> link_text(const std::string& name) {
  char text[PATH_MAX];
  const ssize_t n = ::readlink(name.c_str(), text, sizeof text);
  if (n < 0) return std::nullopt;
  return std::string(text, static_cast<std::size_t>(n));
}

std::FILE* create_new(const std::string& name) noexcept { return std::fopen(name.c_str(), "wbx"); }

namespace {

std::FILE* stream_of(int file) noexcept {
  if (file < 0) return nullptr;
  std::FILE* const stream = ::fdopen(file, "wb");
  if (stream == nullptr) {
    const int reason = errno;
    ::close(file);
    errno = reason;
  }
  return stream;
}

}  // namespace

std::FILE* open_stream(const std::string& name) noexcept {
  return stream_of(::open(name.c_str(), O_WRONLY | O_NOCTTY | O_CLOEXEC));
}

std::FILE* open_descriptor(int descriptor) noexcept { return stream_of(::fcntl(descriptor, F_DUPFD_CLOEXEC, 3)); }

Access access_of_descriptor(int descriptor) noexcept {
  const int flags = ::fcntl(descriptor, F_GETFL);
  if (flags < 0) return Access::none;
  return (flags & O_ACCMODE) == O_RDONLY ? Access::read_only : Access::writable;
}

void take_over_mode(std::FILE* stream, const std::string& old) noexcept {
  const int to = ::fileno(stream);
  struct stat status;
  if (::stat(old.c_str(), &status) != 0) return;
  if (::fchown(to, status.st_uid, status.st_gid) != 0 && ::fchown(to, static_cast<uid_t>(-1), status.st_gid) != 0)
    status.st_mode &= ~static_cast<mode_t>(S_IRWXG);  // which were those of another group
  if (::fchmod(to, status.st_mode & (S_IRWXU | S_IRWXG | S_IRWXO)) != 0) return;
}

bool replace_file(const std::string& from, const std::string& to) noexcept { return std::rename(from.c_str(), to.c_str()) == 0; }

int open_for_places(const std::string& name) noexcept { return ::open(name.c_str(), O_WRONLY | O_CLOEXEC); }

std::int64_t write_at(int descriptor, const char* bytes, std::size_t count, std::uint64_t place) noexcept {
  for (;;) {
    const ssize_t n = ::pwrite(descriptor, bytes, count, static_cast<off_t>(place));
    if (n >= 0 || errno != EINTR) return n;
  }
}

bool close_descriptor(int descriptor) noexcept { return ::close(descriptor) == 0; }

}  // namespace pgdr::detail::system
#endif
