// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
#include <string>

#include "io/field_formats.hpp"
#include "io/formats.hpp"
#include "io/write/vtu_layout.hpp"
#include "paths/file_slices.hpp"

namespace pgdr::detail {
namespace {

/// A file of which somebody has all rows, from its beginning to its end.
template <int D>
void put_file(const VtuPart<D>& part, FileOutput& out) {
  const std::vector<VtuArray> arrays = arrays_of<D>(part);
  out.put(vtu_head<D>(part.total, arrays));
  for (auto array = arrays.rbegin(); array != arrays.rend(); ++array) {
    out.put_binary(array->bytes);
    out.put(array->content);
    for (const VtuArray::Rows& rows : array->rows) out.put_blocks(rows.count, rows.put);
  }
  out.put(vtu_tail);
}

}  // namespace

template <int D>
void write_vtu(const OutputMesh<D>& mesh, const std::vector<PeriodicPairs>& periodic, const MidSides<D>* middles,
               FileOutput& out) {
  VtuPart<D> part = VtuPart<D>::whole(mesh);
  part.middles = middles;
  part.set_periodic(periodic);
  put_file<D>(part, out);
}

template <int D>
void write_vtu_with_fields(const OutputMesh<D>& mesh, const MeshFields& fields, const std::vector<PeriodicPairs>& periodic,
                           const MidSides<D>* middles, FileOutput& out) {
  VtuPart<D> part = VtuPart<D>::whole(mesh);
  part.middles = middles;
  part.set_periodic(periodic);
  part.fields = &fields;
  put_file<D>(part, out);
}

template <int D>
void write_vtu_of_piece(const MeshPiece<D>& piece, FileOutput& out) {
  put_file<D>(VtuPart<D>::file_of_piece(piece), out);
}

template <int D>
void write_vtu_rows(const MeshPiece<D>& piece, bool frame, FileSlices& out) {
  const VtuPart<D> part = VtuPart<D>::rows_of(piece);
  const std::vector<VtuArray> arrays = arrays_of<D>(part);
  const std::string head = vtu_head<D>(part.total, arrays);
  if (frame) {
    out.begin_at(0);
    out.put(head);
    for (const VtuArray& array : arrays) {
      TextBuffer bytes;
      bytes.put_binary(array.bytes);
      bytes.put(array.content);
      out.begin_at(head.size() + array.offset);
      out.put(bytes.text());
    }
    out.begin_at(head.size() + arrays.front().offset + sizeof(std::uint64_t) + arrays.front().bytes);
    out.put(vtu_tail);
  }
  for (auto array = arrays.rbegin(); array != arrays.rend(); ++array)
    for (const VtuArray::Rows& rows : array->rows) {
      if (rows.count == 0) continue;
      out.begin_at(head.size() + array->offset + sizeof(std::uint64_t) + rows.at);
      put_in_blocks(rows.count, rows.put, [&out](std::string_view bytes) { out.put(bytes); });
    }
  out.close();
}

template void write_vtu<2>(const OutputMesh<2>&, const std::vector<PeriodicPairs>&, const MidSides<2>*, FileOutput&);
template void write_vtu<3>(const OutputMesh<3>&, const std::vector<PeriodicPairs>&, const MidSides<3>*, FileOutput&);
template void write_vtu_with_fields<2>(const OutputMesh<2>&, const MeshFields&, const std::vector<PeriodicPairs>&,
                                       const MidSides<2>*, FileOutput&);
template void write_vtu_with_fields<3>(const OutputMesh<3>&, const MeshFields&, const std::vector<PeriodicPairs>&,
                                       const MidSides<3>*, FileOutput&);
template void write_vtu_of_piece<2>(const MeshPiece<2>&, FileOutput&);
template void write_vtu_of_piece<3>(const MeshPiece<3>&, FileOutput&);
template void write_vtu_rows<2>(const MeshPiece<2>&, bool, FileSlices&);
template void write_vtu_rows<3>(const MeshPiece<3>&, bool, FileSlices&);

}  // namespace pgdr::detail
