// SPDX-FileCopyrightText: 2026 The pgdr authors
// SPDX-License-Identifier: Apache-2.0
//
// Files of gmsh's formats as gmsh itself writes them, in all variants, made here from one small model.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <sstream>
#include <string>
#include <vector>

namespace pgdr::test {

struct MshVariant {
  int version = 4;  ///< 2 or 4
  bool binary = false;
  bool big_endian = false;
  int size_bytes = 8;  ///< of a count or tag in version 4

  std::string name() const {
    std::string text = version == 2 ? "msh22" : "msh41";
    if (binary) text += big_endian ? "_big" : "_binary";
    return size_bytes == 8 ? text : text + "_small";
  }
};

inline const std::vector<MshVariant> msh_variants{{2, false}, {2, true},       {2, true, true},    {4, false},
                                                  {4, true},  {4, true, true}, {4, true, false, 4}};

struct MshElement {
  int type;    ///< gmsh's number
  int entity;  ///< of the dimension of the type
  std::vector<int> nodes;
};

struct MshModel {
  struct Entity {
    int tag;
    std::vector<int> physical;
  };
  struct Node {
    int tag;
    std::array<double, 3> point;
  };
  std::vector<std::string> names;               ///< lines of $PhysicalNames
  std::array<std::vector<Entity>, 4> entities;  ///< by dimension
  std::vector<Node> nodes;
  std::vector<MshElement> elements;
  std::string other_sections;
};

/// Puts numbers as text or as bytes.
class MshText {
 public:
  explicit MshText(const MshVariant& v) : v_(v) {}
  std::string text;

  void line(const std::string& words) { text += words + "\n"; }
  void i(int value) { put(static_cast<std::int32_t>(value)); }
  void size(std::size_t value) {
    if (v_.version == 2)
      i(static_cast<int>(value));
    else if (v_.size_bytes == 8)
      put(static_cast<std::uint64_t>(value));
    else
      put(static_cast<std::uint32_t>(value));
  }
  void d(double value) { put(value); }
  /// A line ends here, in a text.
  void end() {
    if (!v_.binary) text += "\n";
  }
  void end_section(const std::string& name) { text += (v_.binary ? "\n" : "") + name + "\n"; }

 private:
  template <class T>
  void put(T value) {
    if (!v_.binary) {
      std::ostringstream out;
      out.precision(17);
      out << value << " ";
      text += out.str();
      return;
    }
    std::array<char, sizeof(T)> bytes;
    std::memcpy(bytes.data(), &value, sizeof value);
    if (v_.big_endian == (std::endian::native == std::endian::little)) std::reverse(bytes.begin(), bytes.end());
    text.append(bytes.data(), bytes.size());
  }

  MshVariant v_;
};

inline int msh_dimension(int type) {
  return type == 15 ? 0 : type == 1 || type == 8 ? 1 : type == 2 || type == 3 || type == 9 ? 2 : 3;
}

inline void put_nodes_2(MshText& out, const MshModel& m) {
  out.line("$Nodes");
  out.line(std::to_string(m.nodes.size()));
  for (const auto& n : m.nodes) {
    out.i(n.tag);
    for (const double x : n.point) out.d(x);
    out.end();
  }
  out.end_section("$EndNodes");
}

inline void put_elements_2(MshText& out, const MshModel& m, const MshVariant& v) {
  out.line("$Elements");
  out.line(std::to_string(m.elements.size()));
  int number = 0;
  for (const MshElement& e : m.elements) {
    int physical = 0;
    for (const auto& entity : m.entities[static_cast<std::size_t>(msh_dimension(e.type))])
      if (entity.tag == e.entity && !entity.physical.empty()) physical = std::abs(entity.physical[0]);
    if (v.binary) {
      for (const int word : {e.type, 1, 2, ++number, physical, e.entity}) out.i(word);
    } else {
      for (const int word : {++number, e.type, 2, physical, e.entity}) out.i(word);
    }
    for (const int n : e.nodes) out.i(n);
    out.end();
  }
  out.end_section("$EndElements");
}

inline void put_entities_4(MshText& out, const MshModel& m) {
  out.line("$Entities");
  for (const auto& list : m.entities) out.size(list.size());
  out.end();
  for (std::size_t d = 0; d < 4; ++d) {
    for (const auto& e : m.entities[d]) {
      out.i(e.tag);
      for (int k = 0; k < (d == 0 ? 3 : 6); ++k) out.d(0.5);
      out.size(e.physical.size());
      for (const int p : e.physical) out.i(p);
      if (d > 0) {
        out.size(2);
        out.i(1);
        out.i(-2);
      }
      out.end();
    }
  }
  out.end_section("$EndEntities");
}

/// Two blocks; the second is parametric on a curve, as gmsh writes them on request.
inline void put_nodes_4(MshText& out, const MshModel& m) {
  out.line("$Nodes");
  const std::size_t half = m.nodes.size() / 2;
  for (const std::size_t n : {std::size_t{2}, m.nodes.size(), std::size_t{1}, std::size_t{1000}}) out.size(n);
  out.end();
  for (int block = 0; block < 2; ++block) {
    const std::size_t begin = block == 0 ? 0 : half, end = block == 0 ? half : m.nodes.size();
    for (const int word : {block, 1, block}) out.i(word);
    out.size(end - begin);
    out.end();
    for (std::size_t i = begin; i < end; ++i) {
      out.size(static_cast<std::size_t>(m.nodes[i].tag));
      out.end();
    }
    for (std::size_t i = begin; i < end; ++i) {
      for (const double x : m.nodes[i].point) out.d(x);
      if (block == 1) out.d(0.25);
      out.end();
    }
  }
  out.end_section("$EndNodes");
}

inline void put_elements_4(MshText& out, const MshModel& m) {
  out.line("$Elements");
  for (const std::size_t n : {m.elements.size(), m.elements.size(), std::size_t{1}, m.elements.size()}) out.size(n);
  out.end();
  std::size_t number = 0;
  for (const MshElement& e : m.elements) {
    for (const int word : {msh_dimension(e.type), e.entity, e.type}) out.i(word);
    out.size(1);
    out.end();
    out.size(++number);
    for (const int n : e.nodes) out.size(static_cast<std::size_t>(n));
    out.end();
  }
  out.end_section("$EndElements");
}

inline std::string msh_file(const MshModel& m, const MshVariant& v) {
  MshText out(v);
  out.line("$MeshFormat");
  out.line((v.version == 2 ? "2.2 " : "4.1 ") + std::string(v.binary ? "1 " : "0 ") + std::to_string(v.size_bytes));
  if (v.binary) {
    out.i(1);
    out.line("");
  }
  out.line("$EndMeshFormat");
  if (!m.names.empty()) {
    out.line("$PhysicalNames");
    out.line(std::to_string(m.names.size()));
    for (const std::string& name : m.names) out.line(name);
    out.line("$EndPhysicalNames");
  }
  if (v.version == 4) put_entities_4(out, m);
  v.version == 4 ? put_nodes_4(out, m) : put_nodes_2(out, m);
  v.version == 4 ? put_elements_4(out, m) : put_elements_2(out, m, v);
  return out.text + m.other_sections;
}

/// Two tetrahedra of two physical groups, all their outer faces but one, two lines, a point.
inline MshModel two_tetrahedra() {
  MshModel m;
  m.names = {"2 4 \"a wall, # with all signs\"", "3 7 \"first\"", "1 2 \"pgdr marker -6\""};
  m.entities[0] = {{3, {11}}, {4, {}}};
  m.entities[1] = {{1, {2}}, {2, {}}};
  m.entities[2] = {{1, {4, 9}}, {5, {-3}}};
  m.entities[3] = {{1, {7}}, {2, {8}}};
  // Tags with gaps, in no order.
  m.nodes = {{10, {0, 0, 0}}, {3, {1, 0, 0}}, {20, {0, 1, 0}}, {21, {0, 0, 1}}, {5, {0.75, 0.75, 0.75}}};
  m.elements = {{15, 3, {10}},         {15, 4, {5}},         {1, 1, {10, 3}},    {1, 2, {3, 20}},     {2, 1, {10, 20, 3}},
                {2, 1, {10, 3, 21}},   {2, 5, {10, 21, 20}}, {2, 5, {3, 20, 5}}, {2, 5, {20, 21, 5}}, {4, 1, {10, 3, 20, 21}},
                {4, 2, {3, 20, 21, 5}}};
  return m;
}

}  // namespace pgdr::test
