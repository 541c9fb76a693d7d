// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "io/write_target.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <climits>
#include <cstdlib>
#include <memory>
#include <optional>
#include <string_view>
#include <system_error>

#include "pgdr/error.hpp"

namespace pgdr::detail {
namespace {

constexpr int most_links = 40;  // as many as Linux follows

/// The name of what exists, without links; empty if there is nothing, or no way to it.
std::string real_name(const std::string& name) {
  const std::unique_ptr<char, decltype(&std::free)> real(::realpath(name.c_str(), nullptr), std::free);
  return real ? std::string(real.get()) : std::string();
}

/// Where a link leads, as it says; none if it is no link.
std::optional<std::string> linked_name(const std::string& name) {
  char text[PATH_MAX];
  const ssize_t n = ::readlink(name.c_str(), text, sizeof text);
  if (n < 0) return std::nullopt;
  const std::string_view link(text, static_cast<std::size_t>(n));
  return link.starts_with('/') ? std::string(link) : folder_of(name).append(link);
}

/// The number of a descriptor of this process by its name in the folder of all of them.
std::optional<int> own_descriptor(const std::string& name) {
  const std::string_view last = std::string_view(name).substr(name.rfind('/') + 1);
  int number = -1;
  const auto [end, error] = std::from_chars(last.data(), last.data() + last.size(), number);
  if (error != std::errc() || end != last.data() + last.size()) return std::nullopt;
  const std::string folder = real_name(folder_of(name));
  if (folder.empty() || folder != real_name("/proc/self/fd")) return std::nullopt;
  return number;
}

/// One that is closed, or open for reading alone, cannot be written.
WriteTarget open_descriptor(const std::string& file, int number) {
  const int flags = ::fcntl(number, F_GETFL);
  if (flags < 0) cannot_write(file, errno);
  if ((flags & O_ACCMODE) == O_RDONLY) cannot_write(file, EBADF);
  return {WriteTarget::Kind::descriptor, file, number};
}

/// What is there already.
WriteTarget existing(const std::string& file, mode_t mode) {
  if (S_ISDIR(mode)) cannot_write(file, EISDIR);
  if (S_ISSOCK(mode)) cannot_write(file, "it is a socket");
  if (::access(file.c_str(), W_OK) != 0) cannot_write(file, errno);
  if (!S_ISREG(mode)) return {WriteTarget::Kind::stream, file, -1};
  std::string real = real_name(file);
  if (real.empty()) cannot_write(file, errno);
  return {WriteTarget::Kind::old_file, std::move(real), -1};
}

}  // namespace

WriteTarget target_of(const std::string& file) {
  std::string last = file;  // behind the links
  for (int i = 0; i < most_links; ++i) {
    if (const std::optional<int> number = own_descriptor(last)) return open_descriptor(file, *number);
    std::optional<std::string> link = linked_name(last);
    if (!link) break;
    last = std::move(*link);
  }
  struct stat status;
  if (::stat(file.c_str(), &status) == 0) return existing(file, status.st_mode);
  if (errno != ENOENT) cannot_write(file, errno);
  return {WriteTarget::Kind::new_file, std::move(last), -1};
}

std::string folder_of(const std::string& file) {
  const std::size_t slash = file.rfind('/');
  return slash == std::string::npos ? std::string("./") : file.substr(0, slash + 1);
}

void cannot_write(const std::string& file, const char* why) {
  throw FileError(Diagnostic{Errc::cannot_write, std::string("cannot be written: ").append(why), file, 0, {}, {}});
}

void cannot_write(const std::string& file, int error_number) {
  cannot_write(file, std::generic_category().message(error_number).c_str());
}

}  // namespace pgdr::detail
