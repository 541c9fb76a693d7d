// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// How good a mesh is of which each rank has a piece. Ranks tell each other counts of regions and of values, never cells.
#include "pgdr/ranks.hpp"
#include "quality/quality_of_part.hpp"
#include "transport/collectives.hpp"
#include "transport/message.hpp"

namespace pgdr {

template <int D>
QualitySummary summarize_quality(Transport& transport, const MeshPiece<D>& piece) {
  using detail::CountsOfRegion, detail::QualityOfPart;
  detail::Collectives ranks(transport);
  if (ranks.size() == 1) return summarize_quality(piece.mesh);
  QualityOfPart part = ranks.together([&] { return QualityOfPart::of(piece.mesh); });
  const std::vector<Bytes> messages = ranks.all_gather(ranks.together([&] {
    detail::MessageWriter own;
    own.put(part.own());
    return own.take();
  }));
  ranks.together([&] {
    std::vector<CountsOfRegion> all;
    for (const Bytes& bytes : messages) {
      detail::MessageReader message(bytes);
      const auto counts = message.get_all<CountsOfRegion>();
      all.insert(all.end(), counts.begin(), counts.end());
      message.require_end();
    }
    part.take(all);
  });
  for (int round = 0; round < QualityOfPart::rounds; ++round) {
    const std::vector<std::uint64_t> own = ranks.together([&] { return part.counts(round); });
    part.narrow(round, ranks.sum(own));
  }
  return ranks.together([&] { return part.summary(); });
}

template PGDR_API QualitySummary summarize_quality<2>(Transport&, const MeshPiece<2>&);
template PGDR_API QualitySummary summarize_quality<3>(Transport&, const MeshPiece<3>&);

}  // namespace pgdr
