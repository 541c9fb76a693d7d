// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "transport/collectives.hpp"

#include <algorithm>
#include <chrono>
#include <utility>

#include "transport/shared_error.hpp"

namespace pgdr {

Transport::~Transport() = default;

namespace detail {

Collectives::Collectives(Transport& transport)
    : transport_(transport), rank_(transport.rank()), size_(transport.size()), conversation_(transport.begin_conversation()) {}

void Collectives::send(int to, Bytes message, std::uint64_t round) {
  if (to != rank_) {
    ++traffic_.messages;
    traffic_.bytes_sent += message.size();
  }
  transport_.send(to, tag(round), std::move(message));
}

Bytes Collectives::receive(int from, std::uint64_t round) {
  const auto start = std::chrono::steady_clock::now();
  Bytes message = transport_.receive(from, tag(round));
  traffic_.seconds_waiting += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return message;
}

std::vector<Bytes> Collectives::all_gather(Bytes own) {
  begin();
  std::vector<Bytes> found;  // of this rank, the next, ...
  found.push_back(std::move(own));
  std::uint64_t round = 0;
  for (int step = 1; step < size_; step *= 2, ++round) {
    const int count = std::min(step, size_ - step);
    MessageWriter message;
    for (int i = 0; i < count; ++i) message.put(found[static_cast<std::size_t>(i)]);
    send((rank_ + size_ - step) % size_, message.take(), round);
    const Bytes answer = receive((rank_ + step) % size_, round);
    MessageReader reader(answer);
    for (int i = 0; i < count; ++i) found.push_back(reader.get_all<std::byte>());
    reader.require_end();
  }
  std::rotate(found.begin(), found.end() - rank_, found.end());
  return found;
}

std::vector<Bytes> Collectives::exchange(std::vector<Bytes> to_each) {
  std::vector<int> all(static_cast<std::size_t>(size_));
  // From the next rank on, so that not all send to rank 0 first.
  for (int i = 0; i < size_; ++i) all[static_cast<std::size_t>(i)] = (rank_ + i) % size_;
  std::rotate(to_each.begin(), to_each.begin() + rank_, to_each.end());
  std::vector<Bytes> received = exchange_with(all, std::move(to_each));
  std::rotate(received.begin(), received.end() - rank_, received.end());
  return received;
}

std::vector<Bytes> Collectives::exchange_with(std::span<const int> neighbours, std::vector<Bytes> messages) {
  begin();
  std::vector<Bytes> received(neighbours.size());
  for (std::size_t i = 0; i < neighbours.size(); ++i) {
    if (neighbours[i] == rank_)
      received[i] = std::move(messages[i]);  // such messages may be the largest
    else
      send(neighbours[i], std::move(messages[i]));
  }
  for (std::size_t i = 0; i < neighbours.size(); ++i)
    if (neighbours[i] != rank_) received[i] = receive(neighbours[i]);
  return received;
}

Bytes Collectives::broadcast(int root, Bytes message) {
  begin();
  // A binomial tree: counted from the root, rank v hears from v without its lowest bit, and tells those with one lower bit more.
  const int v = (rank_ + size_ - root) % size_;
  int bit = 1;
  while (bit < size_ && !(v & bit)) bit *= 2;
  if (v > 0) message = receive((v - bit + root) % size_);
  for (bit /= 2; bit > 0; bit /= 2)
    if (v + bit < size_) send((v + bit + root) % size_, message);
  return message;
}

std::vector<Bytes> Collectives::gather(int root, Bytes own) {
  begin();
  send(root, std::move(own));
  std::vector<Bytes> received;
  for (int from = 0; rank_ == root && from < size_; ++from) received.push_back(receive(from));
  return received;
}

Bytes Collectives::scatter(int root, std::vector<Bytes> to_each) {
  begin();
  for (int to = 0; rank_ == root && to < size_; ++to) send(to, std::move(to_each[static_cast<std::size_t>(to)]));
  return receive(root);
}

std::vector<std::vector<std::uint64_t>> Collectives::all_gather(std::span<const std::uint64_t> own,
                                                                const std::exception_ptr& error) {
  MessageWriter message;
  message.put(std::uint64_t{error ? 1u : 0u});
  message.put(std::vector<std::uint64_t>(own.begin(), own.end()));
  const std::vector<Bytes> all = all_gather(message.take());
  std::vector<std::vector<std::uint64_t>> rows;
  for (const Bytes& bytes : all) {
    MessageReader reader(bytes);
    if (reader.get<std::uint64_t>() != 0) throw_of(static_cast<int>(rows.size()), error);
    rows.push_back(reader.get_all<std::uint64_t>());
    reader.require_end();
  }
  return rows;
}

std::vector<std::uint64_t> Collectives::sum(std::span<const std::uint64_t> values) {
  return reduce(values, [](std::uint64_t a, std::uint64_t b) { return a + b; });
}
std::vector<std::uint64_t> Collectives::max(std::span<const std::uint64_t> values) {
  return reduce(values, [](std::uint64_t a, std::uint64_t b) { return std::max(a, b); });
}
std::vector<std::uint64_t> Collectives::min(std::span<const std::uint64_t> values) {
  return reduce(values, [](std::uint64_t a, std::uint64_t b) { return std::min(a, b); });
}
std::vector<double> Collectives::sum(std::span<const double> values) {
  return reduce(values, [](double a, double b) { return a + b; });
}
std::vector<double> Collectives::max(std::span<const double> values) {
  return reduce(values, [](double a, double b) { return std::max(a, b); });
}
std::vector<double> Collectives::min(std::span<const double> values) {
  return reduce(values, [](double a, double b) { return std::min(a, b); });
}

std::uint64_t Collectives::exclusive_sum(std::uint64_t value) {
  MessageWriter own;
  own.put(value);
  const std::vector<Bytes> all = all_gather(own.take());
  std::uint64_t before = 0;
  for (int q = 0; q < rank_; ++q) before += MessageReader(all[static_cast<std::size_t>(q)]).get<std::uint64_t>();
  return before;
}

void Collectives::agree(const std::exception_ptr& error) {
  const auto here = static_cast<std::uint64_t>(rank_), none = static_cast<std::uint64_t>(size_);
  const std::uint64_t first = min(error ? here : none);
  if (first != none) throw_of(static_cast<int>(first), error);
}

void Collectives::throw_of(int first, const std::exception_ptr& error) {
  has_failed_ = true;
  MessageWriter own;
  if (first == rank_) put_error(own, error, rank_);
  const Bytes message = broadcast(first, own.take());
  if (first == rank_) std::rethrow_exception(error);
  MessageReader reader(message);
  throw_error(reader);
}

}  // namespace detail
}  // namespace pgdr
