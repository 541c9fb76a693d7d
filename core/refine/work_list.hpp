// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The work list of one node. Encroached entities go by buckets of the radii of their balls, largest first, in a bucket the
// subsegments before the subfacets, each first in first out. So no mesh in between has many small entities and nothing between
// them, which would have a quadratic number of cells (after Hudson, Miller and Phillips 2006, Sparse Voronoi Refinement). Then
// violations to be flipped, first in first out, then poor elements. Elements that are too big go by buckets of their
// circumradius, largest first. Elements of poor shape alone go by their shortest edge, shortest first, which makes meshes up to
// a third smaller than the largest circumradius first (docs/selectors.md). Where a node must become fit to be split, and
// before smaller entities, they go by buckets, too. Plain containers; one thread at a time.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <new>
#include <optional>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "mesh/entity_pair.hpp"
#include "mesh/mesh.hpp"
#include "mesh/surroundings.hpp"
#include "refine/numbers.hpp"
#include "rule/cell_bounds.hpp"

namespace pgdr {

/// What an entry is: a subsegment, a subfacet, a face that is not locally Delaunay, a poor element.
enum class EntryKind : std::uint8_t { edge, face, flip, cell };

/// A subsegment, subfacet, violation or poor element that waits: a cell, and which of its edges or faces. The entry is dead once
/// the slot no longer holds that cell: whatever took its place was listed anew.
template <int D>
struct Entry {
  // Why an element is listed, the `which` of kind cell.
  static constexpr int over_size = 0;         ///< it is too big, whatever its shape
  static constexpr int not_delaunay = 1;      ///< it is beside a violation that no flip repairs
  static constexpr int over_radius_edge = 2;  ///< it is poor in shape alone

  /// `place`: its order.
  Entry(CellId slot, std::uint16_t born, EntryKind kind, int which, int size_bucket = 0, std::uint32_t place = 0)
      : cell(slot),
        order(place),
        birth(born),
        bucket(static_cast<std::uint8_t>(size_bucket)),
        what_(static_cast<std::uint8_t>(static_cast<int>(kind) << 4 | which)) {}

  CellId cell;  ///< the slot of the cell
  /// For elements of poor shape alone: the least goes first. For elements that are too big: CellVerdict::over_size. For entities:
  /// the least goes first, of their list.
  std::uint32_t order;
  std::uint16_t birth;  ///< of the cell
  /// floor(log2(side of the domain / radius)), clamped; of the circumsphere (kind cell; 0 in a stage with a treatment), or of the
  /// entity's smallest sphere (edge, face).
  std::uint8_t bucket;

  EntryKind kind() const { return static_cast<EntryKind>(what_ >> 4); }  ///< what it is
  int which() const { return what_ & 15; }  ///< the number of the edge or face in the cell; for kind cell, why it is listed
  bool alive(const Mesh<D>& mesh) const { return mesh.birth(cell) == birth; }  ///< is the cell still there?

 private:
  std::uint8_t what_;  // kind and which, four bits each
};
static_assert(sizeof(Entry<3>) == 12 && sizeof(Entry<2>) == 12);

/// A queue, first in first out, in blocks: the memory of what was read is used again while it is in the cache. The first block is
/// small, since a tree has thousands of queues with few entries.
template <class T>
class Fifo {
 public:
  static_assert(std::is_trivially_copyable_v<T> && alignof(T) <= 8);

  Fifo() = default;
  Fifo(Fifo&& o) noexcept { swap(o); }  ///< takes what o has
  /// Trades with o.
  Fifo& operator=(Fifo&& o) noexcept {
    swap(o);
    return *this;
  }
  ~Fifo() { clear(); }

  bool empty() const { return size_ == 0; }   ///< is nothing in it?
  std::size_t size() const { return size_; }  ///< so many are in it
  /// Puts the item behind all others.
  void push(const T& item) {
    if (!last_ || tail_ == last_->capacity) [[unlikely]]
      append_block();
    last_->items()[tail_++] = item;
    ++size_;
  }
  /// @pre !empty()
  T pop() {
    const T item = first_->items()[head_++];
    --size_;
    if (size_ == 0) {
      clear();
    } else if (head_ == first_->capacity) {
      drop_first();
      head_ = 0;
    }
    return item;
  }
  /// The n-th from the front, 0 being the next; null if there are fewer, or if it is beyond the second block.
  const T* ahead(std::size_t n) const {
    if (n >= size_) return nullptr;
    std::size_t i = head_ + n;
    if (i < first_->capacity) return &first_->items()[i];
    i -= first_->capacity;
    return i < first_->next->capacity ? &first_->next->items()[i] : nullptr;
  }
  /// Calls f for each in order, to be changed.
  template <class F>
  void for_each(F f) {
    std::uint32_t i = head_;
    for (Block* b = first_; b; b = b->next, i = 0)
      for (const std::uint32_t end = b == last_ ? tail_ : b->capacity; i < end; ++i) f(b->items()[i]);
  }
  /// Calls f for the first n in order, or for all if there are fewer.
  template <class F>
  void for_first(std::size_t n, F f) const {
    std::uint32_t i = head_;
    for (Block* b = first_; b && n > 0; b = b->next, i = 0)
      for (const std::uint32_t end = b == last_ ? tail_ : b->capacity; i < end && n > 0; ++i, --n) f(b->items()[i]);
  }
  /// Calls f for each in order, and takes it out; `soon(item)` some turns before. False if `stop()`, which is asked now and then,
  /// has ended it early.
  template <class F, class Soon, class Stop>
  bool drain(F f, Soon soon, const Stop& stop) {
    while (!empty()) {
      if (stop()) return false;
      for (std::size_t n = 0; n < between_looks && !empty(); ++n) {
        if (const T* item = ahead(drained_ahead)) soon(*item);
        f(pop());
      }
    }
    return true;
  }
  /// Calls f for each in order, and empties the list.
  template <class F>
  void drain(F f) {
    drain(
        f, [](const T&) {}, [] { return false; });
  }

  static constexpr std::size_t between_looks = 1024;  ///< so many items, some of whose cells are far apart in memory

 private:
  static constexpr std::size_t drained_ahead = 12;
  struct alignas(8) Block {
    Block* next;
    std::uint32_t capacity;
    T* items() { return std::launder(reinterpret_cast<T*>(this + 1)); }
  };
  static constexpr std::uint32_t most_items = (1024 - 8 - sizeof(Block)) / sizeof(T), least_items = most_items / 5;

  static Block* new_block(std::uint32_t capacity) {
    return new (::operator new(sizeof(Block) + capacity * sizeof(T))) Block{nullptr, capacity};
  }
  [[gnu::noinline]] void append_block() {
    if (!last_) {
      first_ = last_ = new_block(least_items);
      head_ = 0;
    } else {
      last_ = last_->next = new_block(static_cast<std::uint32_t>(std::clamp<std::size_t>(size_ / 2, least_items, most_items)));
    }
    tail_ = 0;
  }
  void drop_first() { ::operator delete(std::exchange(first_, first_->next)); }
  void clear() {
    while (first_) drop_first();
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
  std::uint32_t head_ = 0, tail_ = 0;  ///< head_ in the first block, tail_ in the last
  std::size_t size_ = 0;
};

/// A heap, least `order` first; ties in an order that depends on what was pushed and popped alone.
template <int D>
class EntryHeap {
 public:
  bool empty() const { return items_.empty(); }           ///< is nothing in it?
  std::size_t size() const { return items_.size(); }      ///< so many are in it
  const Entry<D>& top() const { return items_.front(); }  ///< the least. @pre !empty()
  /// Adds it.
  void push(const Entry<D>& e) {
    items_.push_back(e);
    std::push_heap(items_.begin(), items_.end(), later);
  }
  /// Takes the least out. @pre !empty().
  Entry<D> pop() {
    std::pop_heap(items_.begin(), items_.end(), later);
    const Entry<D> e = items_.back();
    items_.pop_back();
    if (items_.empty()) std::vector<Entry<D>>().swap(items_);
    return e;
  }
  /// Calls f for each, to be changed, but for its order.
  template <class F>
  void for_each(F f) {
    for (Entry<D>& e : items_) f(e);
  }
  /// Calls f for n, or for all if there are fewer: roughly those that go first.
  template <class F>
  void for_first(std::size_t n, F f) const {
    for (std::size_t i = 0; i < std::min(n, items_.size()); ++i) f(items_[i]);
  }
  /// Calls f for each, and takes it out. False if `stop()`, which is asked now and then, has ended it early.
  template <class F, class Stop>
  bool drain(F f, const Stop& stop) {
    std::size_t n = 0;
    while (n < items_.size() && !stop())
      for (const std::size_t end = std::min(items_.size(), n + Fifo<Entry<D>>::between_looks); n < end; ++n) f(items_[n]);
    const bool is_done = n == items_.size();
    if (is_done) {
      std::vector<Entry<D>>().swap(items_);
    } else {
      items_.erase(items_.begin(), items_.begin() + static_cast<std::ptrdiff_t>(n));
      std::make_heap(items_.begin(), items_.end(), later);
    }
    return is_done;
  }

 private:
  static bool later(const Entry<D>& a, const Entry<D>& b) { return a.order > b.order; }
  std::vector<Entry<D>> items_;
};

/// A refused entry, and what the decision rested on.
template <int D>
struct Refusal {
  Entry<D> entry;                  ///< the entry
  std::optional<EntityPair> pair;  ///< the two entities at fault; nothing if none were
  std::uint32_t order = 1;         ///< order of the claim of the visit that decided
  /// The cells that were looked at: while these stay, and the neighbours of those that the visit owned, so does the decision.
  std::vector<CellName> seen;
  std::size_t owned = 0;           ///< the first of these are so many that the visit owned; 0 also if neighbours do not count
  bool again = false;              ///< it is to be tried again, whatever has changed
  std::uint64_t surroundings = 0;  ///< `surroundings_of` these cells, when it was decided
  std::uint64_t versions = 0;      ///< in a stage with a treatment: ElementStage::version of the element, when it was decided
};

/// The work list of one node, and what was refused there.
template <int D>
class WorkList {
 public:
  EntryHeap<D> entities;            ///< encroached subsegments and subfacets
  Fifo<Entry<D>> flips;             ///< faces that are not locally Delaunay
  std::vector<Refusal<D>> refused;  ///< what was refused, for as long as the cells that decided are there

  /// Adds an entry of any kind.
  void push(const Entry<D>& e) {
    switch (e.kind()) {
      case EntryKind::edge:
      case EntryKind::face: return push_entity(e);
      case EntryKind::flip: return flips.push(e);
      case EntryKind::cell: return push_poor(e);
    }
  }
  /// Adds a poor element.
  void push_poor(const Entry<D>& e) {
    if (static_cast<std::size_t>(e.bucket - first_) >= poor_.size()) [[unlikely]]
      make_bucket(e.bucket);
    Bucket& bucket = poor_[static_cast<std::size_t>(e.bucket - first_)];
    if (e.which() == Entry<D>::over_radius_edge) {
      bucket.by_shape.push(e);
    } else {
      bucket.others.push(e);
      ++others_;
      to_come_ += e.order;
      bucket.to_come += e.order;
    }
    ++waiting_;
  }

  /// Does nothing wait?
  bool empty() const { return entities.empty() && flips.empty() && waiting_ == 0; }
  /// How many entries wait, dead ones among them.
  std::size_t size() const { return entities.size() + flips.size() + waiting_; }
  /// How many poor elements wait, dead ones among them.
  std::size_t poor() const { return waiting_; }
  /// About how many cells will take the place of those that are too big, dead ones among them.
  std::uint64_t to_come() const { return to_come_; }
  /// Is there work for several nodes: do `least` poor elements wait, or will `numbers::cells_a_poor_element` times as many cells
  /// take the place of those that are too big?
  bool is_crowded(std::size_t least) const { return waiting_ >= least || to_come_ >= numbers::cells_a_poor_element * least; }
  /// The same of the elements in those buckets alone that `counts(bucket)`.
  template <class Counts>
  bool is_crowded(std::size_t least, Counts counts) const {
    std::size_t waiting = 0;
    std::uint64_t to_come = 0;
    for (std::size_t i = 0; i < poor_.size(); ++i)
      if (counts(first_ + static_cast<int>(i))) {
        waiting += poor_[i].others.size() + poor_[i].by_shape.size();
        to_come += poor_[i].to_come;
      }
    return waiting >= least || to_come >= numbers::cells_a_poor_element * least;
  }
  /// May it be so once this many more cells were looked at, some of which may be poor?
  bool may_be_crowded_with(std::size_t more, std::size_t least) const {
    return waiting_ + more >= least || to_come_ + most_cells_to_fill * more >= numbers::cells_a_poor_element * least;
  }
  /// The bucket of the largest element that is too big; a large number if there is none.
  int first_bucket_of_too_big() const {
    std::size_t i = 0;
    while (others_ > 0 && poor_[i].others.empty()) ++i;
    return others_ > 0 ? first_ + static_cast<int>(i) : std::numeric_limits<int>::max();
  }
  /// The bucket of the largest poor element. @pre poor() > 0
  int first_bucket() {
    while (poor_.front().empty()) {
      poor_.erase(poor_.begin());
      ++first_;
    }
    return first_;
  }
  /// Takes one of the largest poor elements out. Those that come soon after are fetched into the cache. @pre poor() > 0
  Entry<D> pop_largest(const Mesh<D>& mesh) {
    Bucket& bucket = poor_[static_cast<std::size_t>(first_bucket() - first_)];
    return bucket.others.empty() ? pop(bucket.by_shape) : pop_other(bucket, mesh);
  }
  /// Takes out one of the largest elements that are too big, or else the element of poor shape that goes first. @pre poor() > 0
  Entry<D> pop_poor(const Mesh<D>& mesh) {
    Bucket* best = nullptr;
    for (Bucket& bucket : poor_) {
      if (others_ > 0 && !bucket.others.empty()) return pop_other(bucket, mesh);
      if (others_ == 0 && !bucket.by_shape.empty() && (!best || bucket.by_shape.top().order < best->by_shape.top().order))
        best = &bucket;
    }
    return pop(best->by_shape);
  }
  /// Calls f for up to n elements that wait behind this one, which was taken out, in about the order in which they will be: those
  /// that are too big in its bucket, or, if it is of poor shape alone, all such. They may be dead.
  template <class F>
  void for_next(const Entry<D>& e, std::size_t n, F f) const {
    const auto of_shape = e.which() == Entry<D>::over_radius_edge;
    for (std::size_t i = 0; i < poor_.size(); ++i) {
      if (of_shape) {
        poor_[i].by_shape.for_first(n, f);
        n -= std::min(n, poor_[i].by_shape.size());
      } else if (first_ + static_cast<int>(i) == e.bucket) {
        poor_[i].others.for_first(n, f);
      }
    }
  }
  /// Calls f for every entry that waits, in an order that depends on what was pushed and popped alone, and takes it out.
  /// `soon(entry)` some turns before, of most. False if `stop()`, which is asked now and then, has ended it early: the rest
  /// waits.
  template <class F, class Soon, class Stop>
  bool drain(F f, Soon soon, const Stop& stop) {
    if (!entities.drain(f, stop) || !flips.drain(f, soon, stop)) return false;
    for (Bucket& bucket : poor_)
      if (!drain(bucket, f, soon, stop)) return false;
    std::vector<Bucket>().swap(poor_);
    return true;
  }
  /// Calls f for every entry, and empties the list.
  template <class F>
  void drain(F f) {
    drain(
        f, [](const Entry<D>&) {}, [] { return false; });
  }
  /// Calls f for every entry that waits, to be changed, but for what decides its place.
  template <class F>
  void for_each(F f) {
    entities.for_each(f);
    flips.for_each(f);
    for (Bucket& bucket : poor_) {
      bucket.others.for_each(f);
      bucket.by_shape.for_each(f);
    }
  }

 private:
  static constexpr std::size_t fetched_ahead = 4, cells_fetched_ahead = 12;

  struct alignas(64) Bucket {
    Fifo<Entry<D>> others;
    EntryHeap<D> by_shape;      ///< over the radius-edge bound alone
    std::uint64_t to_come = 0;  ///< see to_come()
    bool empty() const { return others.empty() && by_shape.empty(); }
  };
  void push_entity(Entry<D> e) {
    constexpr unsigned turns = 25;  // bits; where it overflows those of a bucket are out of turn
    const std::uint32_t kind = e.kind() == EntryKind::face ? 1 : 0, turn = pushed_++ & ((1u << turns) - 1);
    e.order = std::uint32_t{e.bucket} << (turns + 1) | kind << turns | turn;
    entities.push(e);
  }
  [[gnu::noinline]] void make_bucket(int number) {
    if (poor_.empty()) first_ = number;
    while (first_ + static_cast<int>(poor_.size()) <= number) poor_.emplace_back();
    for (; first_ > number; --first_) poor_.emplace(poor_.begin());
  }
  template <class F, class Soon, class Stop>
  bool drain(Bucket& bucket, F f, Soon soon, const Stop& stop) {
    const auto take_other = [&](const Entry<D>& e) {
      count_out(bucket, e);
      f(e);
    };
    const auto take = [&](const Entry<D>& e) {
      --waiting_;
      f(e);
    };
    return bucket.others.drain(take_other, soon, stop) && bucket.by_shape.drain(take, stop);
  }
  Entry<D> pop(EntryHeap<D>& heap) {
    --waiting_;
    return heap.pop();
  }
  /// It goes: one that is too big.
  void count_out(Bucket& bucket, const Entry<D>& e) {
    --waiting_;
    --others_;
    to_come_ -= e.order;
    bucket.to_come -= e.order;
  }
  Entry<D> pop_other(Bucket& bucket, const Mesh<D>& mesh) {
    if (const Entry<D>* e = bucket.others.ahead(cells_fetched_ahead)) mesh.prefetch(e->cell);
    if (const Entry<D>* e = bucket.others.ahead(fetched_ahead)) mesh.prefetch_vertices(e->cell);
    const Entry<D> e = bucket.others.pop();
    count_out(bucket, e);
    return e;
  }

  std::vector<Bucket> poor_;  ///< of the buckets from first_ on
  int first_ = 0;
  std::uint32_t pushed_ = 0;  ///< entities
  std::size_t waiting_ = 0, others_ = 0;
  std::uint64_t to_come_ = 0;
};

}  // namespace pgdr
