// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// The elements of a .msh file as they come: types, tags of nodes and elements, labels by physical group.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "io/read/file_mesh.hpp"
#include "scan/line_scanner.hpp"

namespace pgdr::detail {

/// A type of element that gmsh numbers `number`.
struct MshType {
  std::int32_t number;
  std::int32_t code;  ///< the number of the type with the corners alone
  int dimension;
  std::size_t corners, nodes;  ///< the corners come first
  std::string_view name;
};
using MshNodes = std::array<std::uint64_t, 10>;  ///< tags, of which a type uses the first

/// `items` in another order: the i-th is that at order[i].
template <class T>
std::vector<T> permuted(const std::vector<T>& items, const std::vector<std::size_t>& order) {
  std::vector<T> out;
  out.reserve(items.size());
  for (const std::size_t i : order) out.push_back(items[i]);
  return out;
}

class MshElements {
 public:
  /// @param in for the place of errors; outlives this
  MshElements(const LineScanner& in, bool lines) : in_(in), with_lines_(lines) {}
  void keep_lines(bool keep) { with_lines_ = keep; }

  /// @throws unknown_format for elements of higher order, but for lines, triangles and tetrahedra of the second, and what is no
  ///   element
  MshType type_of(std::int32_t code) const;

  void name_physical(int dimension, int physical, double label) { names_[{dimension, physical}] = label; }
  void set_physical(int dimension, std::int32_t entity, int physical) { physical_[{dimension, entity}] = physical; }
  /// 0 for an entity of no group.
  double label_of_entity(int dimension, std::int32_t entity) const;
  double label_of_physical(int dimension, int physical) const;

  /// @param tags increasing
  void set_nodes(std::vector<std::uint64_t> tags);
  /// The number of the node with this tag; none if there is no such. @pre set_nodes()
  std::optional<std::uint32_t> find_node(std::uint64_t tag) const;
  /// @throws index_out_of_range
  void add(const MshType& type, std::uint64_t tag, const MshNodes& nodes, double label);
  /// Puts the elements into `mesh`, in the order of their tags.
  void finish(FileMesh& mesh);

 private:
  template <std::size_t N>
  struct List {
    std::vector<FileMesh::Element<N>> elements;
    std::vector<std::uint64_t> tags;
    std::vector<std::uint32_t> lines;
  };

  std::uint32_t node(std::uint64_t tag, std::uint64_t element) const;
  template <std::size_t N>
  void append(List<N>& list, std::uint64_t tag, const std::array<std::uint32_t, 8>& nodes, double label);
  template <std::size_t N>
  static void sort(List<N>& list);
  void add_point(std::uint32_t node, double label);

  const LineScanner& in_;
  bool with_lines_;
  std::map<std::pair<int, int>, double> names_;
  std::map<std::pair<int, std::int32_t>, int> physical_;
  std::vector<std::uint64_t> nodes_;
  bool dense_ = true;  ///< the tags of the nodes have no gaps
  List<2> edges_;
  List<3> triangles_;
  List<4> quadrilaterals_, tetrahedra_;
  std::string_view other_cells_;
  std::uint64_t other_line_ = 0;
  std::vector<std::uint32_t> other_corners_;
  std::vector<int> point_markers_;
  std::vector<std::uint8_t> required_, mid_sides_;
};

}  // namespace pgdr::detail
