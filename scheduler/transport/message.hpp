// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// What is in a message: values one after the other, as they lie in memory. A reader believes nothing: what is cut short or
// senseless is an error.
#pragma once

#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "pgdr/transport.hpp"

namespace pgdr::detail {

/// What may lie in a message: plain values that any bits make. No bool, which only two bytes make, and no pointer.
template <class T>
concept Sendable = std::is_trivially_copyable_v<T> && !std::is_pointer_v<T> && !std::is_same_v<T, bool>;

/// @throws ResourceError internal
[[noreturn]] void fail_message(const char* what);

class MessageWriter {
 public:
  template <Sendable T>
  void put(const T& value) {
    put_bytes(&value, sizeof(T));
  }
  /// With its length.
  template <Sendable T>
  void put(std::span<const T> values) {
    put(static_cast<std::uint64_t>(values.size()));
    if (!values.empty()) put_bytes(values.data(), values.size_bytes());
  }
  template <Sendable T>
  void put(std::span<T> values) requires(!std::is_const_v<T>) {
    put(std::span<const T>(values));
  }
  template <Sendable T>
  void put(const std::vector<T>& values) {
    put(std::span<const T>(values));
  }
  void put(std::string_view text) { put(std::span<const char>(text)); }
  void put(const std::string& text) { put(std::string_view(text)); }
  void put(const char* text) { put(std::string_view(text)); }

  void reserve(std::size_t bytes) { bytes_.reserve(bytes); }
  std::size_t size() const { return bytes_.size(); }  ///< in bytes, so far
  Bytes take() { return std::move(bytes_); }

 private:
  void put_bytes(const void* from, std::size_t count) {
    const auto* const first = static_cast<const std::byte*>(from);
    bytes_.insert(bytes_.end(), first, first + count);
  }

  Bytes bytes_;
};

/// Reads what a MessageWriter wrote, in the same order. The bytes outlive it. Every function throws ResourceError internal where
/// the message has no such thing.
class MessageReader {
 public:
  explicit MessageReader(std::span<const std::byte> bytes) : left_(bytes) {}

  template <Sendable T>
  T get() {
    T value;
    get_bytes(&value, sizeof(T));
    return value;
  }
  template <Sendable T>
  std::vector<T> get_all() {
    std::vector<T> values(get_count(sizeof(T)));
    if (!values.empty()) get_bytes(values.data(), values.size() * sizeof(T));
    return values;
  }
  std::string get_text() {
    const std::vector<char> text = get_all<char>();
    return {text.begin(), text.end()};
  }
  /// A number of things that follow, of `least` bytes or more each: no more than there can be. @pre least > 0
  std::size_t get_count(std::size_t least) {
    const auto count = get<std::uint64_t>();
    if (count > left_.size() / least) fail_message("a message of another rank promises more than it has");
    return static_cast<std::size_t>(count);
  }

  bool at_end() const { return left_.empty(); }
  /// For the last one to read: nothing may follow.
  void require_end() const {
    if (!at_end()) fail_message("a message of another rank has more than it should");
  }

 private:
  void get_bytes(void* to, std::size_t count) {
    if (count > left_.size()) fail_message("a message of another rank is cut short");
    std::memcpy(to, left_.data(), count);
    left_ = left_.subspan(count);
  }

  std::span<const std::byte> left_;
};

}  // namespace pgdr::detail
