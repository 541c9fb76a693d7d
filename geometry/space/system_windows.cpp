// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Compiled by mingw-w64 (.ci/mingw), never run: docs/installing.md.
#ifdef _WIN32
#define NOMINMAX
#define WIN32_LEAN_AND_MEAN
#include <windows.h>
// After windows.h.
#include <fcntl.h>
#include <io.h>
#include <psapi.h>
#include <sys/stat.h>

#include <cerrno>
#include <filesystem>
#include <limits>

#include "space/system.hpp"

namespace pgdr::detail::system {

namespace {

constexpr double unlimited = std::numeric_limits<double>::infinity();

/// What the calls of Windows say, as errno says it elsewhere.
void set_errno() noexcept {
  switch (GetLastError()) {
    case ERROR_FILE_NOT_FOUND:
    case ERROR_PATH_NOT_FOUND: errno = ENOENT; break;
    case ERROR_ACCESS_DENIED:
    case ERROR_SHARING_VIOLATION: errno = EACCES; break;
    case ERROR_DISK_FULL: errno = ENOSPC; break;
    default: errno = EIO;
  }
}

std::FILE* stream_of(int file) noexcept { return file < 0 ? nullptr : _fdopen(file, "wb"); }

}  // namespace

void* reserve_addresses(std::size_t bytes) noexcept { return VirtualAlloc(nullptr, bytes, MEM_RESERVE, PAGE_NOACCESS); }

bool provide_memory(void* first, std::size_t bytes) noexcept {
  return VirtualAlloc(first, bytes, MEM_COMMIT, PAGE_READWRITE) != nullptr;
}

void discard_memory(void* first, std::size_t bytes) noexcept {
  if (VirtualFree(first, bytes, MEM_DECOMMIT)) VirtualAlloc(first, bytes, MEM_COMMIT, PAGE_READWRITE);
}

void release_addresses(void* first, std::size_t) noexcept { VirtualFree(first, 0, MEM_RELEASE); }
void ask_for_huge_pages(void*, std::size_t) noexcept {}  // takes a privilege that users do not have
double limit_on_addresses() noexcept { return unlimited; }

double physical_memory() noexcept {
  MEMORYSTATUSEX status{};
  status.dwLength = sizeof status;
  return GlobalMemoryStatusEx(&status) ? static_cast<double>(status.ullTotalPhys) : unlimited;
}

std::uint64_t peak_resident() noexcept {
  PROCESS_MEMORY_COUNTERS counters{};
  if (!K32GetProcessMemoryInfo(GetCurrentProcess(), &counters, sizeof counters)) return 0;
  return counters.PeakWorkingSetSize;
}

std::optional<FileType> file_type(const std::string& name) noexcept {
  struct _stat64 status;
  if (_stat64(name.c_str(), &status) != 0) return std::nullopt;
  if ((status.st_mode & _S_IFREG) != 0) return FileType::regular;
  return (status.st_mode & _S_IFDIR) != 0 ? FileType::folder : FileType::other;
}

bool is_regular_itself(const std::string& name) noexcept { return file_type(name) == FileType::regular; }
bool may_be_written(const std::string& name) noexcept { return _access(name.c_str(), 2) == 0; }
bool is_there(const std::string& name) noexcept { return _access(name.c_str(), 0) == 0; }

std::string real_name(const std::string& name) {
  std::error_code failed;
  const std::filesystem::path real = std::filesystem::canonical(name, failed);
  if (failed) errno = ENOENT;
  return failed ? std::string() : real.string();
}

std::optional<std::string> link_text(const std::string& name) {
  std::error_code failed;
  const std::filesystem::path link = std::filesystem::read_symlink(name, failed);
  if (failed) return std::nullopt;
  return link.string();
}

std::FILE* create_new(const std::string& name) noexcept {
  return stream_of(_open(name.c_str(), _O_WRONLY | _O_BINARY | _O_CREAT | _O_EXCL | _O_NOINHERIT, _S_IREAD | _S_IWRITE));
}

std::FILE* open_stream(const std::string& name) noexcept {
  return stream_of(_open(name.c_str(), _O_WRONLY | _O_BINARY | _O_NOINHERIT));
}

std::FILE* open_descriptor(int descriptor) noexcept { return stream_of(_dup(descriptor)); }
Access access_of_descriptor(int descriptor) noexcept {
  return _get_osfhandle(descriptor) == -1 ? Access::none : Access::writable;
}
void take_over_mode(std::FILE*, const std::string&) noexcept {}  // new files have the rights of their folder

bool replace_file(const std::string& from, const std::string& to) noexcept {
  if (MoveFileExA(from.c_str(), to.c_str(), MOVEFILE_REPLACE_EXISTING)) return true;
  set_errno();
  return false;
}

int open_for_places(const std::string& name) noexcept { return _open(name.c_str(), _O_WRONLY | _O_BINARY | _O_NOINHERIT); }

std::int64_t write_at(int descriptor, const char* bytes, std::size_t count, std::uint64_t place) noexcept {
  constexpr std::size_t most = std::size_t{1} << 30;
  OVERLAPPED at{};
  at.Offset = static_cast<DWORD>(place);
  at.OffsetHigh = static_cast<DWORD>(place >> 32);
  DWORD written = 0;
  const auto handle = reinterpret_cast<HANDLE>(_get_osfhandle(descriptor));
  if (WriteFile(handle, bytes, static_cast<DWORD>(count < most ? count : most), &written, &at)) return written;
  set_errno();
  return -1;
}

bool close_descriptor(int descriptor) noexcept { return _close(descriptor) == 0; }

}  // namespace pgdr::detail::system
#endif
