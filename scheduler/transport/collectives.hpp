// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// What all ranks do together, over send and receive alone: trees and rounds of a number that grows with the logarithm of the
// ranks'.
#pragma once

#include <bit>
#include <cstdint>
#include <exception>
#include <optional>
#include <span>
#include <type_traits>
#include <vector>

#include "pgdr/transport.hpp"
#include "transport/message.hpp"

namespace pgdr::detail {

/// What a rank has sent, and how long it waited.
struct Traffic {
  std::uint64_t messages = 0;    ///< sent to other ranks
  std::uint64_t bytes_sent = 0;  ///< in these
  double seconds_waiting = 0;    ///< in receive(), of all ranks
};

/// One conversation of all ranks: they make the object, and call its functions, in the same order. One thread a rank. All throw
/// RankFailure where another rank has failed. An object is no dearer than its counters: make as many as are wanted.
class Collectives {
 public:
  explicit Collectives(Transport& transport);
  Collectives(const Collectives&) = delete;
  Collectives& operator=(const Collectives&) = delete;

  int rank() const { return rank_; }
  int size() const { return size_; }
  const Traffic& traffic() const { return traffic_; }
  /// Has together() thrown? Then it has on all ranks.
  bool has_failed() const { return has_failed_; }

  /// What each rank gave, by rank.
  std::vector<Bytes> all_gather(Bytes own);
  /// The same for small arrays of numbers. If there is an error on any rank, all throw as together() does.
  std::vector<std::vector<std::uint64_t>> all_gather(std::span<const std::uint64_t> own, const std::exception_ptr& error);
  /// Rank q gets the q-th message of each, by rank. A rank may give itself one. @pre one message a rank
  std::vector<Bytes> exchange(std::vector<Bytes> to_each);
  /// The same with these ranks alone: the i-th message goes to neighbours[i], and the i-th of the result is from it.
  /// @pre they are different; if q is a neighbour of r then so is r of q
  std::vector<Bytes> exchange_with(std::span<const int> neighbours, std::vector<Bytes> messages);
  /// The message of `root`, on all; those of the others do not matter.
  Bytes broadcast(int root, Bytes message);
  /// What each rank gave, by rank, on `root`; nothing on the others. Each sends to it directly: such messages are large.
  std::vector<Bytes> gather(int root, Bytes own);
  /// The message that `root` has for this rank; those of the others do not matter. @pre there, one message a rank
  Bytes scatter(int root, std::vector<Bytes> to_each);

  // Of each place of small arrays of equal lengths, over all ranks; the same on all. Sums of doubles depend on how many ranks
  // there are.
  std::vector<std::uint64_t> sum(std::span<const std::uint64_t> values);
  std::vector<std::uint64_t> max(std::span<const std::uint64_t> values);
  std::vector<std::uint64_t> min(std::span<const std::uint64_t> values);
  std::vector<double> sum(std::span<const double> values);
  std::vector<double> max(std::span<const double> values);
  std::vector<double> min(std::span<const double> values);
  std::uint64_t sum(std::uint64_t value) { return sum(std::span(&value, 1)).front(); }
  std::uint64_t max(std::uint64_t value) { return max(std::span(&value, 1)).front(); }
  std::uint64_t min(std::uint64_t value) { return min(std::span(&value, 1)).front(); }
  /// Of each place of arrays of equal lengths join(a, b) over all ranks, with the same result on all if it does not matter in
  /// which order.
  template <Sendable T, class Join>
  std::vector<T> reduce(std::span<const T> values, Join join);
  /// The sum over the ranks before this one.
  std::uint64_t exclusive_sum(std::uint64_t value);

  /// Runs f, which must not talk to other ranks. If it threw on any rank then all throw: what the lowest of these threw, as it is
  /// on this rank, and as shared_error.hpp says on the others. @returns what f does
  template <class F>
  std::invoke_result_t<F> together(F&& f) {
    if constexpr (std::is_void_v<std::invoke_result_t<F>>) {
      agree(caught([&] { f(); }));
    } else {
      std::optional<std::invoke_result_t<F>> result;
      agree(caught([&] { result.emplace(f()); }));
      return std::move(*result);
    }
  }

  /// Throws on all ranks, as together() does, if there is an error on any; null: none here.
  void agree(const std::exception_ptr& error);
  /// What the action throws; null: nothing. For one of several actions after which ranks agree once. @throws RankFailure
  template <class Action>
  static std::exception_ptr caught(Action action) {
    try {
      action();
    } catch (const RankFailure&) {
      throw;  // there may be nobody left to agree with
    } catch (...) {
      return std::current_exception();
    }
    return nullptr;
  }

 private:
  /// The error of rank `first`, on all.
  [[noreturn]] void throw_of(int first, const std::exception_ptr& error);
  /// Begins a function: a number for its tags.
  void begin() { call_ += 1; }
  std::uint64_t tag(std::uint64_t round) const { return conversation_ << 40 | call_ << 8 | round; }
  void send(int to, Bytes message, std::uint64_t round = 0);
  Bytes receive(int from, std::uint64_t round = 0);

  Transport& transport_;
  const int rank_, size_;
  const std::uint64_t conversation_;
  std::uint64_t call_ = 0;
  Traffic traffic_;
  bool has_failed_ = false;
};

/// By recursive doubling: after round k one knows of 2^k ranks, and both of a pair join the same two arrays, so that all come to
/// the same. Ranks beyond the largest power of two join one below each at first, and hear from it at last.
template <Sendable T, class Join>
std::vector<T> Collectives::reduce(std::span<const T> values, Join join) {
  begin();
  std::vector<T> all(values.begin(), values.end());
  const auto tell = [&](int to, std::uint64_t round) {
    MessageWriter message;
    for (const T& value : all) message.put(value);
    send(to, message.take(), round);
  };
  const auto hear = [&](int from, std::uint64_t round, auto take) {
    const Bytes message = receive(from, round);
    MessageReader reader(message);
    for (T& value : all) value = take(value, reader.get<T>());
    reader.require_end();
  };
  const auto other = [](const T&, const T& b) { return b; };
  const int paired = static_cast<int>(std::bit_floor(static_cast<unsigned>(size_)));
  if (rank_ >= paired) {
    tell(rank_ - paired, 0);
    hear(rank_ - paired, 1, other);
    return all;
  }
  if (rank_ + paired < size_) hear(rank_ + paired, 0, join);
  std::uint64_t round = 0;
  for (int bit = 1; bit < paired; bit *= 2, ++round) {
    tell(rank_ ^ bit, round);
    hear(rank_ ^ bit, round, join);
  }
  if (rank_ + paired < size_) tell(rank_ + paired, 1);
  return all;
}

}  // namespace pgdr::detail
