// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// What the library asks of the operating system beyond the C++ standard, and no other file of it asks: system_posix.cpp and
// system_windows.cpp are its two sides. (The command asks for terminals and signals besides: tools/console.cpp,
// tools/signals.cpp.) Names of files are strings; what fails leaves its reason in errno. Any thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <optional>
#include <string>

namespace pgdr::detail::system {

// Memory.

/// Addresses without memory behind them, which count against nothing but a limit on addresses. nullptr where there are none.
void* reserve_addresses(std::size_t bytes) noexcept;
/// Puts memory, zeros, behind reserved addresses, whole pages. false where there is none.
[[nodiscard]] bool provide_memory(void* first, std::size_t bytes) noexcept;
/// Gives the memory behind whole pages back; they are zeros when they are read again.
void discard_memory(void* first, std::size_t bytes) noexcept;
void release_addresses(void* first, std::size_t bytes) noexcept;
/// Fewer faults and misses of the page table; only a wish.
void ask_for_huge_pages(void* memory, std::size_t bytes) noexcept;

double limit_on_addresses() noexcept;    ///< bytes that this process may have; infinity where nobody limits it
double physical_memory() noexcept;       ///< bytes that the machine has; infinity where that is not known
std::uint64_t peak_resident() noexcept;  ///< bytes that this process had at most; 0 where that is not known

// Files.

enum class FileType { regular, folder, socket, other };
enum class Access { none, read_only, writable };

/// Of what a name leads to, behind links; none, with errno, where there is nothing.
std::optional<FileType> file_type(const std::string& name) noexcept;
/// Is the name itself, no link, that of a regular file? Allocates nothing.
bool is_regular_itself(const std::string& name) noexcept;
bool may_be_written(const std::string& name) noexcept;
bool is_there(const std::string& name) noexcept;
/// The name of what exists, without links; empty, with errno, if there is nothing, or no way to it.
std::string real_name(const std::string& name);
/// What a link says; none if it is no link.
std::optional<std::string> link_text(const std::string& name);

/// A stream of a file that was not there before; nullptr, with errno.
std::FILE* create_new(const std::string& name) noexcept;
/// A stream to what is there: a device, a FIFO once somebody reads it. nullptr, with errno.
std::FILE* open_stream(const std::string& name) noexcept;
/// A stream of its own to what a descriptor of this process leads to. nullptr, with errno.
std::FILE* open_descriptor(int descriptor) noexcept;
Access access_of_descriptor(int descriptor) noexcept;
/// Gives a new file the owner, group and permissions of an old one, as far as the process may.
void take_over_mode(std::FILE* to, const std::string& old) noexcept;
/// Puts a file in the place of another, or of none, in one step. false, with errno.
[[nodiscard]] bool replace_file(const std::string& from, const std::string& to) noexcept;

/// Writes into a file at places of the caller's choice.
int open_for_places(const std::string& name) noexcept;  ///< a descriptor; negative, with errno
/// @returns the bytes written, at least 1; 0 or less, with errno, where none were
std::int64_t write_at(int descriptor, const char* bytes, std::size_t count, std::uint64_t place) noexcept;
[[nodiscard]] bool close_descriptor(int descriptor) noexcept;

}  // namespace pgdr::detail::system
