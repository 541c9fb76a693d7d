// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// A mesh on ranks in files. Files grow under temporary names, which rank 0 replaces once all ranks have written what is theirs;
// an error of one is an error of all.
#include <algorithm>
#include <memory>
#include <string>

#include "io/formats.hpp"
#include "output/piece_join.hpp"
#include "pgdr/io.hpp"
#include "pgdr/output_files.hpp"
#include "pgdr/ranks.hpp"
#include "ranks/values.hpp"
#include "transport/collectives.hpp"
#include "transport/message.hpp"

namespace pgdr {
namespace {

using detail::Collectives;
using detail::FileOutput;

/// One file, of which each rank writes its rows.
template <int D>
void write_rows(Collectives& ranks, const std::string& file, const MeshPiece<D>& piece) {
  std::unique_ptr<FileOutput> out;  // of rank 0
  const std::string own_name = ranks.together([&] {
    if (ranks.rank() > 0) return std::string();
    out = std::make_unique<FileOutput>(file);
    out->close();
    return out->pending().temporary;
  });
  detail::MessageWriter message;
  message.put(own_name);
  const Bytes bytes = ranks.broadcast(0, message.take());
  const std::string name = detail::MessageReader(bytes).get_text();
  ranks.together([&] {
    detail::FileSlices slices(name, file);
    detail::write_vtu_rows<D>(piece, ranks.rank() == 0, slices);
  });
  ranks.together([&] {
    if (out) out->commit();
  });
}

/// The pieces of another division that this rank writes, the first of which is `first`.
template <int D>
std::vector<MeshPiece<D>> divided(Collectives& ranks, const MeshPiece<D>& piece, std::uint64_t count) {
  const auto size = static_cast<std::uint64_t>(ranks.size());
  std::vector<Bytes> messages = ranks.together([&] {
    std::vector<Bytes> to_each;
    for (std::uint64_t r = 0; r < size; ++r) {
      detail::MessageWriter message;
      for (std::uint64_t k = first_row_of_part(count, r, size); k < first_row_of_part(count, r + 1, size); ++k)
        detail::put_piece(message, detail::part_of_piece<D>(piece, k, count));
      to_each.push_back(message.take());
    }
    return to_each;
  });
  messages = ranks.exchange(std::move(messages));
  return ranks.together([&] {
    std::vector<detail::MessageReader> readers(messages.begin(), messages.end());
    const auto own = static_cast<std::uint64_t>(ranks.rank());
    std::vector<MeshPiece<D>> pieces;
    for (std::uint64_t k = first_row_of_part(count, own, size); k < first_row_of_part(count, own + 1, size); ++k) {
      std::vector<MeshPiece<D>> parts;
      for (detail::MessageReader& reader : readers) parts.push_back(detail::get_piece<D>(reader));
      pieces.push_back(detail::joined_parts<D>(parts, k, count));
    }
    return pieces;
  });
}

/// Files of pieces, and the one that names them, of rank 0.
template <int D>
void write_pieces(Collectives& ranks, const std::string& file, const MeshPiece<D>& piece, std::uint64_t count) {
  const auto size = static_cast<std::uint64_t>(ranks.size()), rank = static_cast<std::uint64_t>(ranks.rank());
  const std::vector<MeshPiece<D>> pieces = count == size ? std::vector{piece} : divided(ranks, piece, count);
  std::vector<std::unique_ptr<FileOutput>> files;
  ranks.together([&] {
    for (std::uint64_t k = 0; k < pieces.size(); ++k) {
      files.push_back(std::make_unique<FileOutput>(detail::name_of_piece(file, first_row_of_part(count, rank, size) + k)));
      detail::write_vtu_of_piece<D>(pieces[k], *files.back());
      files.back()->close();
    }
  });
  detail::MessageWriter own;
  for (const auto& f : files) {
    if (f->is_stream()) continue;
    own.put(f->pending().temporary);
    own.put(f->pending().target);
  }
  const std::vector<Bytes> names = ranks.gather(0, own.take());
  ranks.together([&] {
    if (rank > 0) return;
    std::vector<detail::PendingFile> pending;
    for (const Bytes& bytes : names) {
      detail::MessageReader message(bytes);
      while (!message.at_end()) {
        std::string temporary = message.get_text();
        pending.push_back({std::move(temporary), message.get_text()});
      }
    }
    FileOutput out(file);
    out.put(detail::pvtu_text<D>(piece, count, file));
    out.close();
    if (!out.is_stream()) pending.push_back(out.pending());
    detail::publish_together(pending);
    out.set_published();
  });
  for (const auto& f : files) f->set_published();
}

/// Any file, of a mesh that rank 0 can have whole.
template <int D>
void write_gathered(Collectives& ranks, const std::string& file, const MeshPiece<D>& piece, const WriteOptions& options) {
  constexpr std::uint64_t most_ids = 0xfffffffe;
  if (std::max({piece.total.points, piece.total.cells, piece.total.subfacets, piece.total.subsegments}) > most_ids)
    throw ResourceError(
        {.code = Errc::ids_exhausted, .message = "only .vtu and .pvtu hold more than 2^32 - 2 points or cells", .file = file});
  detail::MessageWriter own;
  ranks.together([&] { detail::put_piece(own, piece); });
  const std::vector<Bytes> messages = ranks.gather(0, own.take());
  ranks.together([&] {
    if (ranks.rank() > 0) return;
    std::vector<MeshPiece<D>> pieces;
    for (const Bytes& bytes : messages) {
      detail::MessageReader message(bytes);
      pieces.push_back(detail::get_piece<D>(message));
    }
    write_mesh<D>(join_pieces<D>(pieces), file, options);
  });
}

}  // namespace

template <int D>
void write_mesh(Transport& transport, const std::string& file, const DistributedResult<D>& result, const WriteOptions& options) {
  Collectives ranks(transport);
  const std::string extension = detail::lower_extension(file);
  // Ranks write their rows in any order, which needs a file.
  const bool to_file = ranks.sum(ranks.together([&] { return std::uint64_t{ranks.rank() == 0 && is_written_to(file)}; })) == 0;
  if (extension == ".vtu" && to_file) return write_rows<D>(ranks, file, result.piece);
  if (extension != ".pvtu") return write_gathered<D>(ranks, file, result.piece, options);
  const std::uint64_t count = options.pieces == 0 ? static_cast<std::uint64_t>(ranks.size()) : options.pieces;
  if (count > most_pieces)
    throw UsageError({.code = Errc::bad_option, .message = "a mesh is written in up to 100,000 pieces", .file = file});
  write_pieces<D>(ranks, file, result.piece, count);
}

template PGDR_API void write_mesh<2>(Transport&, const std::string&, const DistributedResult<2>&, const WriteOptions&);
template PGDR_API void write_mesh<3>(Transport&, const std::string&, const DistributedResult<3>&, const WriteOptions&);

}  // namespace pgdr
