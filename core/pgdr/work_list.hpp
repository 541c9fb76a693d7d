// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// What waits to be treated in one region: encroached subsegments, then subfacets, then faces to be flipped, then poor
// elements by buckets of their circumradius; first in first out within each. Plain containers; one thread at a time.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "pgdr/mesh.hpp"

namespace pgdr {

enum class EntryKind : std::uint8_t { edge, face, flip, cell };

/// An entity or element as the D+1 vertices of its cell and which of its edges or faces. The entry is dead when the
/// slot `cell` no longer holds that cell: whatever took its place has been listed anew.
template <int D>
struct Entry {
  static constexpr std::uint8_t over_bound = 0, not_delaunay = 1;  ///< `which` of kind cell: why it is listed

  CellId cell;
  std::array<VertexId, D + 1> vertices;
  EntryKind kind : 4;
  std::uint8_t which : 4;
  std::uint8_t bucket;  ///< kind cell: floor(log2(side of the domain / circumradius)), clamped
  std::uint16_t birth;  ///< of the cell

  bool alive(const Mesh<D>& mesh) const { return mesh.holds(cell, vertices, birth); }
};
static_assert(sizeof(Entry<3>) == 24);

/// First in, first out, in blocks: what was read is given back at once and used again while it is in the cache.
template <class T>
class Fifo {
 public:
  Fifo() = default;
  Fifo(Fifo&& o) noexcept { swap(o); }
  Fifo& operator=(Fifo&& o) noexcept {
    swap(o);
    return *this;
  }
  ~Fifo() { clear(); }

  bool empty() const { return size_ == 0; }
  std::size_t size() const { return size_; }
  void push(const T& item) {
    if (!last_) {
      first_ = last_ = new Block;
      head_ = tail_ = 0;
    } else if (tail_ == block_items) {
      last_ = last_->next = new Block;
      tail_ = 0;
    }
    last_->items[tail_++] = item;
    ++size_;
  }
  /// @pre !empty()
  T pop() {
    const T item = first_->items[head_++];
    --size_;
    if (size_ == 0) {
      clear();
    } else if (head_ == block_items) {
      delete std::exchange(first_, first_->next);
      head_ = 0;
    }
    return item;
  }
  /// The n-th from the front, 0 being the next; null if there are fewer in its block.
  const T* ahead(std::size_t n) const {
    return n < size_ && head_ + n < block_items ? &first_->items[head_ + n] : nullptr;
  }
  /// Calls f for each in order, and empties the list.
  template <class F>
  void drain(F f) {
    while (!empty()) f(pop());
  }

 private:
  static constexpr std::size_t block_items = (1024 - 2 * sizeof(void*)) / sizeof(T);
  struct Block {
    Block* next = nullptr;
    std::array<T, block_items> items;
  };

  void clear() {
    while (first_) delete std::exchange(first_, first_->next);
    last_ = nullptr;
    size_ = 0;
  }
  void swap(Fifo& o) {
    std::swap(first_, o.first_);
    std::swap(last_, o.last_);
    std::swap(head_, o.head_);
    std::swap(tail_, o.tail_);
    std::swap(size_, o.size_);
  }

  Block *first_ = nullptr, *last_ = nullptr;
  std::size_t head_ = 0, tail_ = 0, size_ = 0;  ///< head_ in the first block, tail_ in the last
};

/// Two input entities that meet where something was refused.
struct EntityPair {
  std::array<EntityRef, 2> entities;
};

/// An entry that was refused, and by what; nothing if no pair of entities was at fault.
template <int D>
struct Refusal {
  Entry<D> entry;
  std::optional<EntityPair> pair;
  std::uint32_t order = 1;       ///< of the claim that it took to find out
  std::uint64_t generation = 0;  ///< in which
};

template <int D>
class WorkList {
 public:
  Fifo<Entry<D>> edges, faces, flips;
  std::vector<Refusal<D>> refused;

  void push(const Entry<D>& e) {
    switch (e.kind) {
      case EntryKind::edge: return edges.push(e);
      case EntryKind::face: return faces.push(e);
      case EntryKind::flip: return flips.push(e);
      case EntryKind::cell: break;
    }
    while (first_ + static_cast<int>(poor_.size()) <= e.bucket) poor_.emplace_back();
    for (; first_ > e.bucket; --first_) poor_.emplace(poor_.begin());
    poor_[static_cast<std::size_t>(e.bucket - first_)].push(e);
    ++waiting_;
  }

  bool empty() const { return edges.empty() && faces.empty() && flips.empty() && waiting_ == 0; }
  std::size_t size() const { return edges.size() + faces.size() + flips.size() + waiting_; }
  /// Poor elements, dead ones among them.
  std::size_t poor() const { return waiting_; }
  /// Bucket of the largest poor element. @pre poor() > 0
  int first_bucket() {
    while (poor_.front().empty()) {
      poor_.erase(poor_.begin());
      ++first_;
    }
    return first_;
  }
  /// One of the largest. Those that come soon after are fetched into the cache. @pre poor() > 0
  Entry<D> pop_poor(const Mesh<D>& mesh) {
    --waiting_;
    auto& bucket = poor_[static_cast<std::size_t>(first_bucket() - first_)];
    if (const Entry<D>* e = bucket.ahead(fetched_ahead)) {
      mesh.prefetch(e->cell);
      for (const VertexId v : e->vertices) mesh.prefetch(v);
    }
    return bucket.pop();
  }
  /// Calls f for every entry that waits, in the order in which they would be treated, and empties the list.
  template <class F>
  void drain(F f) {
    edges.drain(f);
    faces.drain(f);
    flips.drain(f);
    for (auto& bucket : poor_) bucket.drain(f);
    poor_.clear();
    first_ = 0;
    waiting_ = 0;
  }

 private:
  static constexpr std::size_t fetched_ahead = 4;

  std::vector<Fifo<Entry<D>>> poor_;  ///< of the buckets from first_ on
  int first_ = 0;
  std::size_t waiting_ = 0;
};

}  // namespace pgdr
