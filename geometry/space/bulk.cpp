// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "space/bulk.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

namespace pgdr::detail {

namespace {
thread_local const Pieces* pieces_here = nullptr;
}

PiecesHere::PiecesHere(const Pieces* pieces) : before_(std::exchange(pieces_here, pieces)) {}
PiecesHere::~PiecesHere() { pieces_here = before_; }
const Pieces* PiecesHere::current() { return pieces_here; }

void Bulk::run(std::size_t count, std::size_t block, const std::function<void(std::size_t, std::size_t)>& f) const {
  if (pieces_ && count > block)
    return pieces_->run((count + block - 1) / block, [&](std::size_t i) {
      const PiecesHere none(nullptr);
      if (!stopped()) f(i * block, std::min(count, (i + 1) * block));
    });
  if (!parallel_ || count <= block) {  // one block needs no help
    for (std::size_t first = 0; first < count && !stopped(); first += block) f(first, std::min(count, first + block));
    return;
  }
  tbb::this_task_arena::isolate([&] {
    tbb::task_group_context own(tbb::task_group_context::isolated);
    const auto some = [&](const tbb::blocked_range<std::size_t>& r) {
      if (!stopped()) f(r.begin(), r.end());
    };
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, block), some, own);
  });
}

}  // namespace pgdr::detail
