// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "paths/write_target.hpp"

#include <cerrno>
#include <charconv>
#include <optional>
#include <string_view>
#include <system_error>

#include "pgdr/error.hpp"
#include "space/system.hpp"

namespace pgdr::detail {
namespace {

constexpr int most_links = 40;  // as many as Linux follows

/// Where a link leads, as it says; none if it is no link.
std::optional<std::string> linked_name(const std::string& name) {
  std::optional<std::string> link = system::link_text(name);
  if (link && !link->starts_with('/')) link = folder_of(name).append(*link);
  return link;
}

/// The number of a descriptor of this process by its name in the folder of all of them.
std::optional<int> own_descriptor(const std::string& name) {
  const std::string_view last = std::string_view(name).substr(name.rfind('/') + 1);
  int number = -1;
  const auto [end, error] = std::from_chars(last.data(), last.data() + last.size(), number);
  if (error != std::errc() || end != last.data() + last.size()) return std::nullopt;
  const std::string folder = system::real_name(folder_of(name));
  if (folder.empty() || folder != system::real_name("/proc/self/fd")) return std::nullopt;
  return number;
}

/// One that is closed, or open for reading alone, cannot be written.
WriteTarget open_descriptor(const std::string& file, int number) {
  const system::Access access = system::access_of_descriptor(number);
  if (access == system::Access::none) cannot_write(file, errno);
  if (access == system::Access::read_only) cannot_write(file, EBADF);
  return {WriteTarget::Kind::descriptor, file, number};
}

/// What is there already.
WriteTarget existing(const std::string& file, system::FileType type) {
  if (type == system::FileType::folder) cannot_write(file, EISDIR);
  if (type == system::FileType::socket) cannot_write(file, "it is a socket");
  if (!system::may_be_written(file)) cannot_write(file, errno);
  if (type != system::FileType::regular) return {WriteTarget::Kind::stream, file, -1};
  std::string real = system::real_name(file);
  if (real.empty()) cannot_write(file, errno);
  return {WriteTarget::Kind::old_file, std::move(real), -1};
}

}  // namespace

bool names_stream(const std::string& file) {
  return file.size() > 2 && file.starts_with("-.") && file.find('/') == std::string::npos;
}

WriteTarget target_of(const std::string& file) {
  constexpr int standard_output = 1;
  if (names_stream(file)) return open_descriptor(file, standard_output);
  std::string last = file;  // behind the links
  for (int i = 0; i < most_links; ++i) {
    if (const std::optional<int> number = own_descriptor(last)) return open_descriptor(file, *number);
    std::optional<std::string> link = linked_name(last);
    if (!link) break;
    last = std::move(*link);
  }
  if (const std::optional<system::FileType> type = system::file_type(file)) return existing(file, *type);
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
