// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Ranks as threads of one process: what most tests of ranks use. Messages come in any order, and a rank that waits for what will
// never come is an error, not a test that hangs.
#pragma once

#include <chrono>
#include <condition_variable>
#include <exception>
#include <map>
#include <mutex>
#include <optional>
#include <random>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>
#include <tuple>
#include <utility>
#include <vector>

#include "pgdr/transport.hpp"

namespace pgdr::test {

/// The messages of all ranks. A message is in flight until the rank that gets it is told of it; which one that is, of those in
/// flight to it, is drawn by lot.
class LocalNetwork {
 public:
  LocalNetwork(int ranks, std::uint64_t seed) : boxes_(static_cast<std::size_t>(ranks)) {
    for (std::size_t r = 0; r < boxes_.size(); ++r) boxes_[r].random.seed(seed + r);
  }

  int size() const { return static_cast<int>(boxes_.size()); }

  void send(int from, int to, std::uint64_t tag, Bytes message) {
    const std::scoped_lock lock(mutex_);
    if (!sent_.insert({from, to, tag}).second)
      throw std::logic_error("rank " + std::to_string(from) + " sent two messages of tag " + std::to_string(tag));
    Box& box = boxes_.at(static_cast<std::size_t>(to));
    box.in_flight.push_back({{from, tag}, std::move(message)});
    changed_.notify_all();
  }

  Bytes receive(int rank, int from, std::uint64_t tag) {
    std::unique_lock lock(mutex_);
    Box& box = box_of(rank);
    const Key key{from, tag};
    while (true) {
      while (!box.arrived.count(key) && !box.in_flight.empty()) deliver_any(box);
      if (const auto found = box.arrived.find(key); found != box.arrived.end()) {
        Bytes message = std::move(found->second);
        box.arrived.erase(found);
        return message;
      }
      if (box_of(from).has_ended)
        fail("rank " + std::to_string(from) + " has ended, and rank " + std::to_string(rank) + " waits for it");
      box.waits_for = key;
      if (all_wait()) {
        is_stuck_ = true;
        changed_.notify_all();
      }
      if (is_stuck_) fail("all ranks wait for each other");
      changed_.wait(lock);
      box.waits_for.reset();
    }
  }

  /// Nothing more comes from this rank.
  void end(int rank) {
    const std::scoped_lock lock(mutex_);
    box_of(rank).has_ended = true;
    changed_.notify_all();
  }

  /// A moment of no work, of a length drawn by lot: so that ranks overtake each other.
  void dawdle(int rank) {
    std::chrono::microseconds moment;
    {
      const std::scoped_lock lock(mutex_);
      moment = std::chrono::microseconds(box_of(rank).random() % 50);
    }
    std::this_thread::sleep_for(moment);
  }

 private:
  using Key = std::pair<int, std::uint64_t>;  // from, tag
  struct Box {
    std::vector<std::pair<Key, Bytes>> in_flight;
    std::map<Key, Bytes> arrived;
    std::optional<Key> waits_for;
    bool has_ended = false;
    std::mt19937_64 random;
  };

  Box& box_of(int rank) { return boxes_.at(static_cast<std::size_t>(rank)); }

  [[noreturn]] static void fail(const std::string& why) { throw RankFailure({.code = Errc::rank_failed, .message = why}); }

  static void deliver_any(Box& box) {
    std::swap(box.in_flight[box.random() % box.in_flight.size()], box.in_flight.back());
    box.arrived.insert(std::move(box.in_flight.back()));
    box.in_flight.pop_back();
  }

  /// Does every rank wait or has it ended, and has none a message to look at, or a rank to give up?
  bool all_wait() {
    for (const Box& box : boxes_) {
      if (box.has_ended) continue;
      if (!box.waits_for || !box.in_flight.empty() || box_of(box.waits_for->first).has_ended) return false;
    }
    return true;
  }

  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<Box> boxes_;
  std::set<std::tuple<int, int, std::uint64_t>> sent_;
  bool is_stuck_ = false;
};

class LocalTransport final : public Transport {
 public:
  LocalTransport(LocalNetwork& network, int rank) : network_(network), rank_(rank) {}
  ~LocalTransport() override { network_.end(rank_); }

  int rank() const override { return rank_; }
  int size() const override { return network_.size(); }
  void send(int to, std::uint64_t tag, Bytes message) override {
    network_.dawdle(rank_);
    network_.send(rank_, to, tag, std::move(message));
  }
  Bytes receive(int from, std::uint64_t tag) override { return network_.receive(rank_, from, tag); }

 private:
  LocalNetwork& network_;
  const int rank_;
};

/// What f(Transport&) threw on each rank, by rank; null where it returned. `seed`: of the order in which messages come.
template <class F>
std::vector<std::exception_ptr> errors_of_local_ranks(int ranks, std::uint64_t seed, F f) {
  LocalNetwork network(ranks, seed);
  std::vector<std::exception_ptr> errors(static_cast<std::size_t>(ranks));
  std::vector<std::jthread> threads;
  for (int rank = 0; rank < ranks; ++rank)
    threads.emplace_back([&, rank] {
      try {
        LocalTransport transport(network, rank);
        f(static_cast<Transport&>(transport));
      } catch (...) {
        errors[static_cast<std::size_t>(rank)] = std::current_exception();
      }
    });
  threads.clear();
  return errors;
}

/// Is it that of a rank which only waited for another?
inline bool is_rank_failure(const std::exception_ptr& error) {
  try {
    if (error) std::rethrow_exception(error);
  } catch (const RankFailure&) {
    return true;
  } catch (...) {
  }
  return false;
}

/// Runs f(Transport&) on each rank, and throws what the lowest rank threw, but a RankFailure only if nothing else was thrown.
template <class F>
void run_on_local_ranks(int ranks, std::uint64_t seed, F f) {
  const std::vector<std::exception_ptr> errors = errors_of_local_ranks(ranks, seed, f);
  for (const bool failures : {false, true})
    for (const std::exception_ptr& error : errors)
      if (error && is_rank_failure(error) == failures) std::rethrow_exception(error);
}

}  // namespace pgdr::test
