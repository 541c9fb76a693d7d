// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "paths/file_slices.hpp"

#include <algorithm>
#include <cerrno>
#include <utility>

#include "paths/write_target.hpp"
#include "space/system.hpp"

namespace pgdr::detail {
namespace {

constexpr std::uint64_t slice = 1 << 20;

}  // namespace

FileSlices::FileSlices(const std::string& name, std::string target) : target_(std::move(target)) {
  waiting_.reserve(slice);
  file_ = system::open_for_places(name);
  if (file_ < 0) fail(errno);
}

FileSlices::~FileSlices() {
  if (file_ >= 0) (void)system::close_descriptor(file_);  // whoever wants to know calls close()
}

void FileSlices::begin_at(std::uint64_t place) {
  write(std::exchange(waiting_, {}));
  waiting_.reserve(slice);
  place_ = place;
}

void FileSlices::put(std::string_view bytes) {
  const std::uint64_t end = place_ + waiting_.size() + bytes.size(), whole = end - end % slice;
  if (whole <= place_ + waiting_.size()) {
    waiting_ += bytes;
    return;
  }
  if (!waiting_.empty()) {  // up to the next multiple as one slice, then many at once
    const auto rest = static_cast<std::size_t>(slice - (place_ + waiting_.size()) % slice);
    waiting_ += bytes.substr(0, rest);
    bytes.remove_prefix(std::min(rest, bytes.size()));
    write(waiting_);
    waiting_.clear();
  }
  const auto now = static_cast<std::size_t>(whole - std::min(whole, place_));
  write(bytes.substr(0, now));
  waiting_ = bytes.substr(now);
}

void FileSlices::close() {
  begin_at(0);
  if (!system::close_descriptor(std::exchange(file_, -1))) fail(errno);
}

void FileSlices::write(std::string_view bytes) {
  while (!bytes.empty()) {
    const std::int64_t n = system::write_at(file_, bytes.data(), bytes.size(), place_);
    if (n <= 0) fail(n < 0 ? errno : EIO);
    bytes.remove_prefix(static_cast<std::size_t>(n));
    place_ += static_cast<std::uint64_t>(n);
  }
}

void FileSlices::fail(int error_number) const { cannot_write(target_, error_number); }

}  // namespace pgdr::detail
