// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The numbers of vertices of a mesh of which each rank has a part: input points have theirs, the others get theirs along a curve
// of space, each rank on a stretch of it.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <queue>
#include <utility>
#include <vector>

#include "compact/stripped_cells.hpp"
#include "mesh/mesh.hpp"
#include "pgdr/domain.hpp"
#include "ranks/exchange.hpp"
#include "space/bulk.hpp"
#include "space/spatial_order.hpp"

namespace pgdr::detail {

/// Of a vertex, cell, subfacet or subsegment of the whole mesh.
using Number = std::uint64_t;

/// A vertex on its way.
template <int D>
struct Placed {
  Point<D> point;
  Home home;
};

/// A Steiner vertex by its place on the curve, which is all that its number depends on.
template <int D>
struct OnCurve {
  std::uint64_t key;
  Point<D> point;
  friend bool operator<(const OnCurve& a, const OnCurve& b) {
    return a.key != b.key ? a.key < b.key : lex_less(a.point, b.point);
  }
};

/// Numbers the vertices of this rank's cells.
template <int D>
class VertexNumbering {
 public:
  /// @param drop  input points that no cell has get no numbers
  VertexNumbering(Collectives& ranks, const Mesh<D>& mesh, const Domain<D>& domain, const Bulk& bulk, bool drop)
      : ranks_(ranks), mesh_(mesh), bulk_(bulk), curve_(domain.points()), drop_(drop), input_(domain.points().size()) {}

  void run(const StrippedCells<D>& own) {
    list(own);
    find_unused();
    const std::vector<std::size_t> begin = begin_of_ranks(choose_splitters());
    std::vector<std::vector<Placed<D>>> to_each(static_cast<std::size_t>(ranks_.size()));
    for (std::size_t q = 0; q < to_each.size(); ++q) {
      to_each[q].reserve(begin[q + 1] - begin[q]);
      for (std::size_t i = begin[q]; i < begin[q + 1]; ++i)
        to_each[q].push_back({point(own_[i]), mesh_.vertex(own_[i].vertex).home});
    }
    std::vector<std::vector<Placed<D>>> of_each = exchange_lists(ranks_, std::move(to_each));
    std::vector<std::vector<Number>> answers = number(of_each);
    std::vector<std::vector<Placed<D>>>().swap(of_each);
    const auto numbers = exchange_lists(ranks_, std::move(answers));
    for (std::size_t q = 0; q < numbers.size(); ++q)
      for (std::size_t i = begin[q]; i < begin[q + 1]; ++i) numbers_[index(own_[i].vertex)] = numbers[q].at(i - begin[q]);
    std::vector<Own>().swap(own_);
  }

  Number points() const { return points_; }       ///< of the whole mesh
  Number input_points() const { return input_; }  ///< of these, of the input
  /// Points of the Domain that no cell of any rank has, ascending.
  const std::vector<std::uint32_t>& unused() const { return unused_; }
  /// By index(VertexId), of the vertices of the rank's own cells.
  const std::vector<Number>& numbers() const { return numbers_; }
  /// The Steiner vertices of this rank's stretch, in their order: once; and the number of the first.
  std::vector<Placed<D>> take_stretch() { return std::move(stretch_); }
  Number first_of_stretch() const { return first_; }

 private:
  struct Own {
    std::uint64_t key;
    VertexId vertex;
  };
  const Point<D>& point(const Own& own) const { return mesh_.point(own.vertex); }
  OnCurve<D> place(const Own& own) const { return {own.key, point(own)}; }

  /// The Steiner vertices of the cells, along the curve. Input points have their numbers already.
  void list(const StrippedCells<D>& own) {
    constexpr Number used = 0;
    numbers_.assign(mesh_.vertex_bound(), no_number);
    own.each([&](const auto& cell, std::uint16_t) {
      for (const std::uint32_t v : cell) std::atomic_ref(numbers_[v]).store(used, std::memory_order_relaxed);
    });
    const auto record = [&](std::size_t v) -> const VertexRecord<D>& {
      return mesh_.vertex(VertexId{static_cast<std::uint32_t>(v)});
    };
    const auto is_input = [&](std::size_t v) { return record(v).home.kind() == EntityKind::vertex; };
    own_ = bulk_.collect<Own>(
        numbers_.size(), [&](std::size_t v) { return numbers_[v] == used && !is_input(v); },
        [&](std::size_t v) {
          return Own{curve_.key(record(v).point), VertexId{static_cast<std::uint32_t>(v)}};
        });
    bulk_.each(numbers_.size(), [&](std::size_t v) {
      if (numbers_[v] == used && is_input(v)) numbers_[v] = record(v).home.id();
    });
    bulk_.sort(own_, [&](const Own& a, const Own& b) { return a.key != b.key ? a.key < b.key : lex_less(point(a), point(b)); });
  }

  /// Input points that no rank has in a cell; and the numbers of the others without them.
  void find_unused() {
    constexpr std::size_t width = 64;
    std::vector<std::uint64_t> used((static_cast<std::size_t>(input_) + width - 1) / width, 0);
    const auto is_input = [&](std::size_t v) {
      return numbers_[v] != no_number && mesh_.vertex(VertexId{static_cast<std::uint32_t>(v)}).home.kind() == EntityKind::vertex;
    };
    for (std::size_t v = 0; v < numbers_.size(); ++v)
      if (is_input(v)) used[numbers_[v] / width] |= std::uint64_t{1} << numbers_[v] % width;
    MessageWriter message;
    message.put(used);
    for (const Bytes& bytes : ranks_.all_gather(message.take())) {
      const std::vector<std::uint64_t> of_rank = MessageReader(bytes).get_all<std::uint64_t>();
      for (std::size_t i = 0; i < used.size(); ++i) used[i] |= of_rank.at(i);
    }
    for (std::uint32_t p = 0; p < input_; ++p)
      if ((used[p / width] >> p % width & 1) == 0) unused_.push_back(p);
    if (!drop_) return;
    input_ -= unused_.size();
    for (std::size_t v = 0; v < numbers_.size(); ++v)
      if (is_input(v))
        numbers_[v] -= static_cast<Number>(std::lower_bound(unused_.begin(), unused_.end(), numbers_[v]) - unused_.begin());
  }

  /// Places that cut the curve into stretches of about as many vertices, counted once for each rank that has them.
  std::vector<OnCurve<D>> choose_splitters() {
    constexpr std::uint64_t samples_a_rank = 32;
    const auto ranks = static_cast<std::uint64_t>(ranks_.size());
    const std::uint64_t step = std::max<std::uint64_t>(1, ranks_.sum(std::uint64_t{own_.size()}) / (samples_a_rank * ranks));
    MessageWriter message;
    std::vector<OnCurve<D>> samples;
    for (std::size_t i = 0; i < own_.size(); i += static_cast<std::size_t>(step)) samples.push_back(place(own_[i]));
    message.put(samples);
    samples.clear();
    for (const Bytes& bytes : ranks_.all_gather(message.take())) {
      const std::vector<OnCurve<D>> more = MessageReader(bytes).get_all<OnCurve<D>>();
      samples.insert(samples.end(), more.begin(), more.end());
    }
    std::sort(samples.begin(), samples.end());
    std::vector<OnCurve<D>> splitters;
    for (std::uint64_t r = 1; r < ranks && !samples.empty(); ++r)
      splitters.push_back(samples[static_cast<std::size_t>(first_row_of_part(samples.size(), r, ranks))]);
    return splitters;
  }

  /// Where the vertices of each rank's stretch begin among this rank's own; and their number.
  std::vector<std::size_t> begin_of_ranks(const std::vector<OnCurve<D>>& splitters) const {
    std::vector<std::size_t> begin{0};
    for (const OnCurve<D>& splitter : splitters)
      begin.push_back(static_cast<std::size_t>(
          std::lower_bound(own_.begin(), own_.end(), splitter, [&](const Own& a, const OnCurve<D>& s) { return place(a) < s; }) -
          own_.begin()));
    begin.resize(static_cast<std::size_t>(ranks_.size()) + 1, own_.size());
    return begin;
  }

  /// Of the vertices that each rank has on this rank's stretch, along the curve, their numbers, in its order.
  std::vector<std::vector<Number>> number(const std::vector<std::vector<Placed<D>>>& of_each) {
    struct Next {
      OnCurve<D> place;
      std::size_t rank;
    };
    std::vector<std::vector<Number>> numbers(of_each.size());
    const auto is_behind = [](const Next& a, const Next& b) { return b.place < a.place; };
    std::priority_queue<Next, std::vector<Next>, decltype(is_behind)> queue(is_behind);
    const auto push_next = [&](std::size_t rank) {
      if (numbers[rank].size() == of_each[rank].size()) return;
      const Point<D>& p = of_each[rank][numbers[rank].size()].point;
      queue.push({{curve_.key(p), p}, rank});
    };
    std::size_t most = 0;
    for (const auto& list : of_each) most += list.size();
    stretch_.reserve(most);
    for (std::size_t rank = 0; rank < of_each.size(); ++rank) {
      numbers[rank].reserve(of_each[rank].size());
      push_next(rank);
    }
    while (!queue.empty()) {
      const Next next = queue.top();
      queue.pop();
      const Placed<D>& v = of_each[next.rank][numbers[next.rank].size()];
      if (stretch_.empty() || stretch_.back().point != v.point) stretch_.push_back(v);
      numbers[next.rank].push_back(stretch_.size() - 1);
      push_next(next.rank);
    }
    const std::uint64_t count = stretch_.size();
    first_ = input_ + ranks_.exclusive_sum(count);
    points_ = input_ + ranks_.sum(count);
    for (std::vector<Number>& list : numbers)
      for (Number& n : list) n += first_;
    return numbers;
  }

  Collectives& ranks_;
  const Mesh<D>& mesh_;
  const Bulk& bulk_;
  const HilbertCurve<D> curve_;
  const bool drop_;
  Number input_;
  std::vector<std::uint32_t> unused_;
  static constexpr Number no_number = ~Number{0};
  std::vector<Own> own_;  // Steiner vertices, until they have numbers
  std::vector<Number> numbers_;
  std::vector<Placed<D>> stretch_;
  Number first_ = 0, points_ = 0;
};

}  // namespace pgdr::detail
