// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include "ranks/volumes_on_ranks.hpp"

#include <algorithm>
#include <cstdint>
#include <vector>

#include "transport/message.hpp"

namespace pgdr::detail {

void VolumesOnRanks::join(std::span<SidesOfEntity> sides) {
  const auto larger = [](SidesOfEntity a, const SidesOfEntity& b) {
    for (std::size_t side : {0u, 1u}) a[side].take(b[side]);
    return a;
  };
  std::ranges::copy(ranks_.reduce(std::span<const SidesOfEntity>(sides), larger), sides.begin());
}

void VolumesOnRanks::add(std::span<ExactSum> sums) {
  const std::vector<Bytes> all = ranks_.all_gather(ranks_.together([&] {
    MessageWriter message;
    for (const ExactSum& sum : sums) message.put(sum.to_words());
    return message.take();
  }));
  ranks_.together([&] {
    for (std::size_t q = 0; q < all.size(); ++q) {
      if (static_cast<int>(q) == ranks_.rank()) continue;
      MessageReader message(all[q]);
      for (ExactSum& sum : sums) {
        const auto words = message.get_all<std::int64_t>();
        if (words.empty()) fail_message("a message of another rank has a sum without words");
        sum.add(ExactSum::of_words(words));
      }
      message.require_end();
    }
  });
}

}  // namespace pgdr::detail
